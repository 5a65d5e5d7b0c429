"""A step is measured by the island of bodies that it moves, and each group of parts keeps its own energy."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.islands import islands
from mdlgen.backends.lattice.integrate.passes import one_pass
from mdlgen.model.lower import lower
from mdlgen.registry import solve
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

# A block falls on its edge; another one flies past, far above.
IMPACT = """
name: impact
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  n: {material: p, size: [30 mm, 20 mm], thickness: 4 mm, mass: 5 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 11.193903031 mm], rotation: [0 deg, 40 deg, 0 deg],
    velocity: [0.5 m/s, 0 m/s, -0.8 m/s]}
%s
planes: {t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm], mass: 1 g}}
contacts:
  - {between: [n, t], stiffness: 2000 N/mm^1.5, friction: 0.9, restitution: 0.4, smoothing: 2 mm/s}
%s
run: {duration: 6 ms, margin: 20 mm}
"""
FAR = "center: [0 mm, 0 mm, 5000 mm], velocity: [0 m/s, {} m/s, 0 m/s]}}"
OTHER = "  f: {material: p, size: [20 mm, 20 mm], thickness: 1 mm, mass: 0.3 g, boxes: [1, 1], "
# The velocity of n after the impact, by a Runge-Kutta solution of the same law in the plane of its motion,
# with steps of 1e-7 ms [mm/ms].
AFTER = (-0.237468, 0.167135)
# What 1.5 times the tolerance is of a tenth of the block's length in the run: what its estimate may miss.
NEAR = 1.5e-3 * 3.0 / 6.0


def _impact(speed: float, contact: str = "") -> Result:
    other = OTHER + FAR.format(speed) if speed else ""
    return solve(lower(loads(IMPACT % (other, contact))), "lattice")


@pytest.mark.parametrize(
    ("speed", "contact"),
    [
        (0.0, ""),
        (5.0, ""),
        (40.0, ""),
        (5.0, "  - {between: [f, t], stiffness: 100 N/mm^1.5, friction: 0.1}"),
    ],
)
def test_a_fast_body_elsewhere_changes_no_impact(speed: float, contact: str) -> None:
    result = _impact(speed, contact)
    assert result.ok
    first = next(sheet.first for sheet in result.model.sheets if sheet.name == "n")
    x, _, z = result.velocity[-1, first]
    assert (x, z) == pytest.approx(AFTER, abs=NEAR)


def test_energies_of_groups_are_judged_one_by_one() -> None:
    """What a block loses does not count less because another one flies past with 500 times its energy."""
    alone, beside = (_impact(speed).energy for speed in (0.0, 40.0))
    assert beside.of == ("n",)
    assert beside.scale == pytest.approx(alone.scale, rel=1e-3)
    assert alone.of == ()  # there is one group
    with_all = 0.5 * 0.3 * 40.0**2
    assert beside.kinetic > with_all > 50.0 * beside.scale


LANDING = """
name: landing
materials: {p: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}}
sheets:
  n: {material: p, size: [67 mm, 60 mm], thickness: 0.1 mm, mass: 0.34 g, boxes: [5, 4],
    center: [0 mm, 0 mm, 1 mm]}
planes: {t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm], mass: 1 g}}
contacts:
  - {between: [n, t], stiffness: 100 N/mm^1.5, friction: 0.3, restitution: 0.4, smoothing: 10 mm/s}
run: {duration: 80 ms}
"""


@pytest.mark.parametrize("step", [0.05, 0.09, 0.11, 0.12, 0.2])
@pytest.mark.parametrize("height", [1.0, 3.17])
def test_a_sheet_that_falls_flat_comes_to_rest_at_any_step(step: float, height: float) -> None:
    model = lower(loads(LANDING, overrides=[f"sheets.n.center=[0 mm, 0 mm, {height} mm]"]))
    result = one_pass(model, build(model), step, made=5e-5)
    assert result.ok
    assert np.abs(result.velocity[-1]).max() < 1e-3  # [mm/ms]; it fell at 0.14 and more
    # each corner holds a quarter of the box's weight: depth (m g/k)^(2/3)
    depth = (0.34 / 20 * 9.81e-3 / 100.0) ** (2 / 3)
    assert result.position[-1, :20, 2] == pytest.approx(0.05 - depth, abs=2e-4)


@pytest.mark.parametrize("times", [1e-6, 1e-3, 1e3, 1e6])
def test_iterations_end_at_any_mass_and_stiffness(times: float) -> None:
    """Masses and stiffnesses by the same factor leave the motion as it is, so only round-off may differ."""
    ways = []
    for factor in (1.0, times):
        values = {
            "sheets.n.mass": f"{0.34 * factor!r} g",
            "materials.p.E_md": f"{3530 * factor!r} MPa",
            "materials.p.E_cd": f"{1113 * factor!r} MPa",
            "materials.p.D_md": f"{0.4 * factor!r} N*mm",
            "materials.p.D_cd": f"{0.24 * factor!r} N*mm",
            "contacts.0.stiffness": f"{100 * factor!r} N/mm^1.5",
            "run.duration": "30 ms",
        }
        model = lower(loads(LANDING, overrides=[f"{path}={value}" for path, value in values.items()]))
        result = one_pass(model, build(model), 0.1, made=5e-5)
        assert result.ok
        ways.append(result.position[:, :20])
    # it strikes the plate at 14 ms; where a corner touches first is decided by round-off
    assert ways[1] == pytest.approx(ways[0], abs=1e-4)


def test_parts_that_may_touch_form_groups() -> None:
    """Fixed and driven parts pass no motion on, so sheets on one plate are two groups."""
    text = IMPACT % (OTHER + FAR.format(1), "  - {between: [f, t], stiffness: 1 N/mm^1.5, friction: 0.1}")
    for contact, groups in (("", 2), ("  - {between: [f, n], stiffness: 1 N/mm^1.5, friction: 0.1}\n", 1)):
        model = lower(loads(text.replace("run:", contact + "run:")))
        found = islands(model, build(model))
        assert len(set(found.group[found.answers].tolist())) == groups
        assert found.least[:2] == pytest.approx([0.1 * 20 / 6, 0.1 * 30 / 6])  # f, n
