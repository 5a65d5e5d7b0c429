"""Poisson's effect of plates in both solvers: closed forms, conservation, damping, tension.

The rows of the validation have Navier's plate and cantilevers on 24 x 16 boxes.
"""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.awake import Parts, awake
from mdlgen.bench.momentum import momentum
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.results.strain import histories
from mdlgen.results.tension import tension_of
from mdlgen.spec.load import load, loads

BOTH = pytest.mark.parametrize("solver", ["lattice", "exudyn"])
E, NU, THICK = 2000.0, 0.4, 0.5
SIZE = (60.0, 40.0)


def plate(boxes: str, more: str = "", run: str = "analysis: static", rest: str = "", nu: float = NU) -> Model:
    """An isotropic film without gravity."""
    d = E * THICK**3 / 12
    return lower(
        loads(f"""
name: patch
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  p: {{E_md: {E} MPa, E_cd: {E} MPa, G: {E / 2 / (1 + nu)!r} MPa, D_md: {d!r} N*mm, D_cd: {d!r} N*mm,
      D_twist: {d / 2 / (1 + nu)!r} N*mm, poisson: {nu}{rest}}}
sheets:
  n: {{material: p, size: [60 mm, 40 mm], thickness: {THICK} mm, mass: 2 g, boxes: {boxes}, layout: plate
      {more}}}
run: {{{run}}}
""")
    )


def solved(model: Model, solver: str) -> Result:
    result = mdlgen.solve(model, solver)
    assert result.usable, result.status
    return result


def across(result: Result, what: int, part: float = 1 / 6) -> float:
    """Minus the mean curvature (2) or strain (1) along y over the one along x, in the middle of a sheet."""
    measured = histories(result, np.array([len(result.time) - 1]))
    assert measured is not None
    joints, stretch, bend = measured
    values = (bend if what == 2 else stretch)[0]
    middle = np.abs(joints.at[:, 0]) < part * result.model.sheets[0].size[0]
    along, beside = (float(values[middle & (joints.axis == axis)].mean()) for axis in (0, 1))
    return -beside / along


def test_the_sample_is_a_saddle() -> None:
    """What its head says: 0.38 within 1 % in the middle, and flat across without poisson."""
    sample = samples() / "saddle.yaml"
    assert across(solved(lower(load(sample)), "lattice"), 2) == pytest.approx(0.38, rel=1e-2)
    flat = solved(lower(load(sample, ["materials.film.poisson=0"])), "lattice")
    assert abs(across(flat, 2)) < 1e-6


@BOTH
def test_a_strip_pulled_at_a_clamp_contracts(solver: str) -> None:
    """Far from the clamp by nu; the tension of each section is the load, where joints along y have none."""
    model = lower(
        loads(f"""
name: pulled
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: {E} MPa, E_cd: 1500 MPa, D_md: 20 N*mm, D_cd: 20 N*mm, poisson: {NU}}}}}
sheets:
  n: {{material: p, size: [90 mm, 20 mm], thickness: {THICK} mm, mass: 1 g, boxes: [18, 4], layout: plate,
      clamp: {{edge: x_min}}}}
loads: [{{sheet: n, edge: x_max, force: [2 N, 0 N, 0 N]}}]
run: {{analysis: static}}
""")
    )
    result = solved(model, solver)
    assert across(result, 1) == pytest.approx(NU, rel=5e-3)
    tension = tension_of(result, 0)
    assert tension is not None and tension.axis == 0
    # joints pull along themselves, and next to the clamp they turn in the plane by some 1e-3 rad
    assert tension.force[-1] == pytest.approx(2.0, rel=1e-5)


SPIN = ", spin: [200 rad/s, 90 rad/s, 50 rad/s], shape: {curl: {radius: 60 mm, along: y}, start: flat}"


def test_a_small_load_on_a_stiff_plate_is_balanced_to_rounding() -> None:
    """Exudyn's Newton iteration ended by an absolute residual of 1e-8 N, which is 0.3 % of this load."""
    sets = [
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "sheets.film.boxes=[12,4]",
        "sheets.film.size=[120 mm, 10 mm]",
        "sheets.film.clamp={edge: x_min}",
        "supports=[]",
        "probes={}",
        "loads=[{sheet: film, edge: x_max, force: [0 N, 0 N, 3e-9 N]}]",
    ]
    model = lower(load(samples() / "saddle.yaml", sets))
    heights = [solved(model, solver).position[-1, :, 2].max() for solver in ("lattice", "exudyn")]
    assert heights[1] == pytest.approx(heights[0], rel=2e-4)


@pytest.mark.parametrize("poisson", [0.3, 0.45])
def test_a_free_plate_keeps_energy_and_momentum(poisson: float) -> None:
    """Bent across by its curl, it springs open while it turns; no damping, and none lost to round-off."""
    model = plate("[6, 4]", SPIN, "duration: 3 ms, step: 0.01 ms", ", damping: {ratio: 0}", poisson)
    result = solved(model, "lattice")
    # the midpoint rule keeps what is of second order: a step of 0.01 ms leaves some 1e-5
    assert abs(result.energy.balance_error) < 2e-4
    linear, angular = momentum(result)
    assert np.abs(linear - linear[0]).max() < 1e-9 * np.abs(angular).max()
    assert np.abs(angular - angular[0]).max() < 1e-8 * np.abs(angular[0]).max()


def test_both_solvers_find_the_same_motion() -> None:
    model = plate("[4, 3]", SPIN, "duration: 2 ms, tolerance: 1e-3", ", damping: {time: 0.05 ms}")
    one, two = (solved(model, solver) for solver in ("lattice", "exudyn"))
    moved = np.abs(one.position[-1] - one.position[0]).max()
    assert np.abs(one.position[-1] - two.position[-1]).max() < 1e-3 * moved


def test_what_is_awake_keeps_its_corners() -> None:
    """Of two sheets one sleeps: the corners of the other one name the same bushings, in fewer joints."""
    text = "{material: p, size: [60 mm, 40 mm], thickness: 0.5 mm, mass: 2 g, boxes: [3, 3], layout: plate"
    model = lower(
        loads(f"""
name: two
materials: {{p: {{E_md: {E} MPa, E_cd: {E} MPa, D_md: 20 N*mm, D_cd: 20 N*mm, poisson: 0.3}}}}
sheets: {{a: {text}}}, b: {text}, center: [0 mm, 0 mm, 0.5 mm]}}}}
contacts: [{{between: [a, b], stiffness: 100 N/mm^1.5, friction: 0.3}}]
""")
    )
    system = build(model)
    half, _ = awake(system, Parts(model, system), np.array([True, False]))
    mine = system.corners[system.corners["sheet"] == 1]
    assert len(half.corners) == len(mine) == 4
    rows = half.joints["row"][half.corners["joint"]]
    assert (rows == system.joints["row"][mine["joint"]]).all()
    assert (half.tables.corners["run"] == 0).all() and (half.tables.runs[0, 2] == 1)
