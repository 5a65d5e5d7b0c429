"""Statics of the fast solver: the elastica whatever the membrane, contacts at rest, honest ends."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.work import beginning, start
from mdlgen.backends.lattice.kernels.linear.band import empty
from mdlgen.backends.lattice.statics import rest as static
from mdlgen.errors import RefusedError
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.vector import exp_rotation
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import chosen
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads

pytestmark = pytest.mark.usefixtures("as_python")

STATIC = "run.analysis=static"
HELD = "at rest friction holds sheets on fixed planes alone"
LEAST = 2.0**-12  # the least part of a load that is tried: 1, then a quarter of it, six times
NOTHING = f"no balance was found above 0 % of the load: at {100 * LEAST:.3g} %"
SMOOTH = ("contacts.0.friction=0", "run.prune=false")
ELASTICA = 76.5308  # mm, heavy elastica of the sample
FLOOR = (
    "planes={floor: {center: [0 mm, 0 mm, -45 mm], normal: z, size: [300 mm, 300 mm, 10 mm], mass: 100 g}}",
    "contacts=[{between: [note, floor], stiffness: 100 N/mm^1.5, restitution: 0.1, friction: 0}]",
)
POST = (
    "rollers={post: {center: [0 mm, 20 mm, -25 mm], axis: x, radius: 8 mm, width: 60 mm, mass: 10 g}}",
    "contacts=[{between: [note, post], stiffness: 300 N/mm^1.5, restitution: 0.1, friction: 0}]",
)
NIP = """
name: nip
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {s: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  block: {material: s, size: [20 mm, 20 mm], thickness: 2 mm, mass: 2 g, boxes: [1, 1]}
rollers:
  post: {center: [0 mm, 0 mm, -6 mm], axis: y, radius: 5 mm, width: 8 mm, mass: 10 g}
  top: {center: [0 mm, 0 mm, 6 mm], axis: y, radius: 5 mm, width: 8 mm, mass: 10 g,
        press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts:
  - {between: [block, post], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0}
  - {between: [block, top], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0}
run: {analysis: static}
"""


def model(name: str, *overrides: str) -> Model:
    return lower(load(samples() / f"{name}.yaml", overrides))


def run(made: Model) -> Result:
    result = mdlgen.solve(made, "lattice")
    assert as_asked(result), result.status
    return result


def drop(result: Result) -> float:
    return -float(result.anchor_motion(0)[0][-1, 2])


def membrane(factor: float) -> tuple[str, str]:
    return (f"materials.eur10.E_md={3530 * factor!r} MPa", f"materials.eur10.E_cd={1113 * factor!r} MPa")


# -- sheets alone


BENT = "materials.eur10.curve_{}={{points: [[0, 0 MPa], [0.5 %, 9 MPa], [2 %, 18 MPa]], extrapolate: linear}}"


@pytest.mark.parametrize(
    ("spread", "bent", "away"),
    [
        (1e-4, (), 1e-9),
        (0.3, (), 1e-9),
        # a difference over 1e-5 mm of a cubic 0.03 mm long is off by its third derivative: (1e-5/0.03)^2
        (0.02, (BENT.format("md"), BENT.format("cd")), 1e-6),
        (0.3, (BENT.format("md"), BENT.format("cd")), 1e-6),
    ],
)
def test_the_stiffness_is_the_derivative_of_the_forces(
    spread: float, bent: tuple[str, ...], away: float
) -> None:
    """Any state, gaps and turns of `spread`; to the round-off of the differences."""
    from mdlgen.backends.lattice.kernels import forces
    from mdlgen.backends.lattice.kernels.statics import stiffness

    pulled = "loads=[{sheet: note, edge: y_max, force: [0.002 N, 0 N, 0.004 N]}]"
    made = model("cantilever", "sheets.note.boxes=[2,3]", pulled, *bent)
    system = build(made)
    state, _, _ = start(made, beginning(made, system))
    x, r = state[:2]
    rng = np.random.default_rng(1)

    def turned(b: int, by: np.ndarray) -> np.ndarray:
        turn = np.array(exp_rotation((float(by[0]), float(by[1]), float(by[2])))).reshape(3, 3)
        return (turn @ r[b].reshape(3, 3)).ravel()

    for b in system.nodes:
        x[b] += spread * rng.normal(size=3)
        r[b] = turned(b, spread * rng.normal(size=3))
    many = len(system.nodes)
    band = empty(many, system.reach)
    gaps = np.zeros((len(system.joints), 3))
    for gap, joint in zip(gaps, system.joints, strict=True):
        a, b = joint["a"], joint["b"]
        gap[:] = x[b] + r[b].reshape(3, 3) @ joint["rb"] - x[a] - r[a].reshape(3, 3) @ joint["ra"]
    stiffness.sheets_into(system.bodies, system.joints, system.points, system.loads, 1.0, gaps, x, r, band)
    full = np.zeros((6 * many, 6 * many))
    for node in range(many):
        count = min(6 * (system.reach + 1), 6 * (many - node))
        for c in range(6):
            full[6 * node : 6 * node + count, 6 * node + c] = band[node, c, :count]
    full = np.tril(full) + np.tril(full, -1).T

    def force() -> np.ndarray:
        f, still = np.zeros((len(x), 6)), np.zeros_like(x)
        motion = Motion(x, r, still, still)
        forces.joint_forces(system.joints, system.points, motion, f)
        forces.other_forces(system.tables, 1.0, motion, f)
        return f[system.nodes].ravel()

    exact = np.zeros_like(full)
    for k in range(6 * many):
        b, c = system.nodes[k // 6], k % 6
        kept = x[b].copy(), r[b].copy()
        for sign in (1.0, -1.0):
            if c < 3:
                x[b, c] += sign * 1e-5
            else:
                r[b] = turned(b, sign * 1e-5 * np.eye(3)[c - 3])
            exact[k] -= sign * force() / 2e-5
            x[b], r[b] = kept
    exact = 0.5 * (exact + exact.T)
    assert np.abs(full - exact).max() <= away * np.abs(exact).max()


@pytest.mark.parametrize("factor", [1.0, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("boxes", ["[2,20]", "[10,20]"])
def test_the_drop_does_not_depend_on_the_membrane(factor: float, boxes: str) -> None:
    """0.193 % is the lattice's own error; what the membrane adds is below 1e-6 of the drop."""
    found = drop(run(model("cantilever", f"sheets.note.boxes={boxes}", *membrane(factor))))
    assert found / ELASTICA - 1 == pytest.approx(1.931e-3, abs=2e-6)


def test_a_soft_and_hard_sheet_bent_both_ways_rests() -> None:
    """Loads along all axes; 1e4 times the membrane moves it by less than 1e-3 of its length."""
    pulled = (
        "loads=[{sheet: note, edge: y_max, force: [0.002 N, 0 N, 0.004 N]}]",
        "gravity=[1 m/s^2, 0.5 m/s^2, -3 m/s^2]",
    )
    soft, hard = (run(model("cantilever", *pulled, *membrane(factor))) for factor in (1.0, 1e4))
    assert np.abs(soft.position - hard.position).max() < 1e-3 * 127


def test_an_end_moment_closes_the_strip() -> None:
    """M = 2 pi D W/L, exactly so on any grid but for the membrane's own stretch."""
    moment = 2 * math.pi * 0.242 * 67 / 127
    result = run(
        model(
            "cantilever",
            "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
            f"loads=[{{sheet: note, edge: y_max, moment: [{moment!r} N*mm, 0 N*mm, 0 N*mm]}}]",
        )
    )
    place = result.anchor_motion(0)[0][-1]
    assert np.abs(place - [0.0, -63.5, 0.0]).max() < 1e-6 * 127


# -- contacts at rest


def test_a_box_sinks_into_a_plane_by_its_weight() -> None:
    """From above it and from within; (m g/k)^(2/3), to the residual that ends the iterations."""
    for height in ("5.01 mm", "4.9 mm", "8 mm"):
        made = model("verify/drop", STATIC, f"sheets.block.center=[0 mm, 0 mm, {height}]")
        result = run(made)
        sunk = (10 * 9.81e-3 / 1000) ** (2 / 3)
        assert 5.0 - result.position[-1, 0, 2] == pytest.approx(sunk, rel=1e-6)
        assert result.statistics.max_depth[0] == pytest.approx(sunk, rel=1e-6)
        assert result.contact_force[-1, 0] == pytest.approx(10 * 9.81e-3, rel=1e-6)
        assert np.abs(result.position[-1, 0, :2]).max() < 1e-9


def test_a_nip_shares_the_spring_between_both_rollers() -> None:
    """z = (F/k)^(2/3) on either side, F what the spring has left; the two-point rule is within (z/r)^2, r the
    radius of the spread: of the softer one (1/3)^(1/3) of 5 mm."""
    made = lower(loads(NIP))
    result = run(made)
    top = result.model.rollers[1].body
    force = 3.0 - 0.3 * (6.0 - result.position[-1, top, 2])
    assert result.statistics.max_depth == pytest.approx(
        [(force / k) ** (2 / 3) for k in (300, 100)], rel=7.6e-4
    )
    closed = sum(result.statistics.max_depth)
    assert 6.0 - result.position[-1, top, 2] == pytest.approx(closed, rel=1e-6)


@pytest.mark.parametrize("stop", [FLOOR, POST], ids=["plane", "roller"])
def test_a_hanging_strip_rests_where_a_damped_run_ends(stop: tuple[str, ...]) -> None:
    """Every box, 1e-3 of the sheet's length; they agree to 1e-9 where the run is long."""
    scene = ("sheets.note.boxes=[2,10]", "run.prune=false", *stop)
    still = run(model("cantilever", *scene))
    slow = (
        "run.analysis=transient",
        "run.duration=1500 ms",
        "run.print_step=500 ms",
        "run.step=0.1 ms",
        "materials.eur10.damping={ratio: 10, ratio_ty: 10, rotation: inertia}",
    )
    # the fall onto the stop is too fast for this step, and its energy not kept; where it ends is what counts
    moved = mdlgen.solve(model("cantilever", *scene, *slow), "lattice")
    assert np.abs(moved.velocity[-1]).max() < 1e-4
    assert np.abs(still.position[-1] - moved.position[-1]).max() < 1e-3 * 127
    assert still.contact_force[-1] == pytest.approx(moved.contact_force[-1], rel=1e-2)


def test_a_whole_sheet_lies_on_a_plane() -> None:
    """Every box carries its own weight."""
    result = run(
        model("cantilever", "sheets.note.clamp=null", "sheets.note.center=[0 mm, 0 mm, -39 mm]", *FLOOR)
    )
    sunk = (0.72 / 200 * 9.81e-3 / 100) ** (2 / 3)
    assert result.position[-1, :200, 2] == pytest.approx(np.full(200, -39.95 - sunk), abs=1e-3 * sunk)
    assert result.touched == 200


# -- balances that do not stand

COLUMN = """
name: column
gravity: [-{g!r} m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3530 MPa, E_cd: 3530 MPa, D_md: 0.40 N*mm, D_cd: 0.40 N*mm}}}}
sheets: {{n: {{material: p, size: [200 mm, 20 mm], thickness: 0.1 mm, mass: 0.32 g, boxes: [{boxes}, 1],
  layout: plate, clamp: {{edge: x_min, length: 0 mm}}}}}}
run: {{analysis: static}}
"""
GREENHILL = 7.8373  # rho g L^3/D at which a column falls under its own weight
GROUP = 80e-6 * 200**3 / 0.4 * 1e-3  # of 1 m/s^2


@pytest.mark.parametrize("part, stands", [(0.97, True), (1.03, False), (2.0, False), (9.0, False)])
def test_a_column_stands_up_to_greenhills_height(part: float, stands: bool) -> None:
    result = mdlgen.solve(lower(loads(COLUMN.format(g=part * GREENHILL / GROUP, boxes=40))), "lattice")
    assert as_asked(result) == stands, result.status
    if not stands:
        assert "the balance is unstable: it falls in" in result.status
        begins = float(result.status.split("above ")[1].split()[0]) / 100
        assert begins == pytest.approx(1 / part, rel=0.01)


def test_it_falls_in_as_many_directions_as_modes_are_past() -> None:
    """The second mode of Greenhill's column is at 55.977."""
    for part, many in ((50.0 / GREENHILL, "one direction"), (60.0 / GREENHILL, "2 directions")):
        result = mdlgen.solve(lower(loads(COLUMN.format(g=part * GREENHILL / GROUP, boxes=40))), "lattice")
        assert f"the balance is unstable: it falls in {many}, above" in result.status, result.status
        begins = float(result.status.split("above ")[1].split()[0]) / 100
        assert begins == pytest.approx(1 / part, rel=0.01)


# -- honest ends


def test_a_sheet_that_slides_has_no_balance() -> None:
    """Without friction nothing holds it; see test_overhang for what does."""
    aslope = "gravity=[1 m/s^2, 0 m/s^2, -9.81 m/s^2]"
    made = model("verify/drop", STATIC, "sheets.block.center=[0 mm, 0 mm, 5 mm]", aslope, *SMOOTH)
    result = mdlgen.solve(made, "lattice")
    assert not result.usable
    assert re.fullmatch(rf"{NOTHING} \S+ N are left on block_0_0; {HELD}", result.status), result.status


def test_a_sheet_that_falls_says_so() -> None:
    result = mdlgen.solve(model("verify/drop", STATIC), "lattice")
    assert not result.usable
    assert result.status.startswith(
        "block_0_0 goes beyond the bounds from which its contacts were chosen before it rests; "
    ), result.status
    free = mdlgen.solve(model("cantilever", "sheets.note.clamp=null", "sheets.note.boxes=[2,3]"), "lattice")
    # nothing holds a box: what is left on each is that part of its own weight
    left = 0.72 / 6 * 9.81e-3 * LEAST
    assert not free.usable
    assert re.fullmatch(rf"{NOTHING} {left:.3g} N are left on note_._.", free.status), free.status


def test_small_parts_that_all_balance_end_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """Parts that take many iterations do not grow; the cap is on all of them."""
    monkeypatch.setattr(static, "FIRST_PART", 0.01)
    monkeypatch.setattr(static, "REST_MOST", 10 * static.FEW_ITERATIONS)
    made = model("cantilever", "sheets.note.boxes=[1,2]")
    many = static.FEW_ITERATIONS + 1
    reason = static._parts(made, lambda level, load: (True, many, 0, 0.0), 1.0, (np.zeros(3),))
    assert reason == f"no balance was found above 10 % of the load in {10 * many} iterations"


def test_driven_rollers_are_refused_and_others_are_not() -> None:
    with pytest.raises(RefusedError, match="driven"):
        mdlgen.solve(model("transport_4x4", STATIC), "lattice")
    assert chosen("auto", lower(loads(NIP))) == ("lattice", "")
