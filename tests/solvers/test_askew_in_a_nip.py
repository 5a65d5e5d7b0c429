"""A sheet that lies askew in a nip: its joints cross the rollers aslant."""

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

# a note of 0.5 g without friction, between rubber rollers of two sizes
ASKEW = """
name: askew
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets: {n: {material: p, size: [67 mm, 60 mm], thickness: 0.1 mm, mass: 0.5 g, boxes: [10, 5], layout: plate,
  turn: TURN deg, velocity: [0.4 m/s, 0 m/s, 0 m/s]}}
rollers:
  low: {center: [0 mm, 0 mm, -15.00358 mm], axis: y, radius: 15 mm, width: 30 mm, mass: 10 g}
  top: {center: [0 mm, 0 mm, 10.05 mm], axis: y, radius: 10 mm, width: 30 mm, mass: 5 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts: [{between: [n, "???"], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0, smoothing: 5 mm/s}]
run: {duration: 25 ms, margin: 30 mm, print_step: 0.25 ms}
"""


@pytest.mark.parametrize("degrees", [3, 17, 45])
@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_light_sheet_coasts_askew_as_it_does_straight(solver: str, degrees: int) -> None:
    """It keeps its speed at all times, and does not turn. (Nips added up over two lines of each part of a
    box drove it from 0.40 to 0.37 m/s at 17 degrees.)"""
    result = mdlgen.solve(lower(loads(ASKEW.replace("TURN", str(degrees)), "askew")), solver)
    assert as_asked(result), result.status
    mass = result.model.bodies.mass[:50]
    velocity = np.einsum("i,tij->tj", mass, result.velocity[:, :50]) / mass.sum()
    assert np.abs(velocity[:, 0] - 0.4).max() < 1e-3 * 0.4
    assert np.abs(velocity[:, 1]).max() < 1e-3 * 0.4
    assert np.abs(result.spin[:, :50, 2].mean(axis=1)).max() < 1e-3 * 0.4 / 30.0
    assert result.contact_force[-1].sum() == pytest.approx(2 * 3.0, rel=0.02)


def _leaning(width: float, mass: str) -> str:
    """The rollers lean out of the sheet, away from each other, so that the gap between them is a wedge."""
    lean = 1e-3
    return (
        ASKEW.replace("TURN deg", "0 deg")
        .replace("mass: 0.5 g", f"mass: {mass}")
        .replace("axis: y, radius: 15", f"axis: [0, 1, {lean}], radius: 15")
        .replace("axis: y, radius: 10", f"axis: [0, 1, {-lean}], radius: 10")
        .replace("direction: -z", f"direction: [0, {-lean}, -1]")
        .replace("width: 30 mm", f"width: {width} mm")
    )


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_rollers_that_lean_do_not_push_a_wider_sheet_along_their_axes(solver: str) -> None:
    """Their ends hold the sheet. (It was pushed by the sine of the angle times the force: to 0.3 m/s.)"""
    result = mdlgen.solve(lower(loads(_leaning(30.0, "0.5 g"), "leaning")), solver)
    assert as_asked(result), result.status
    mass = result.model.bodies.mass[:50]
    velocity = np.einsum("i,tij->tj", mass, result.velocity[:, :50]) / mass.sum()
    assert np.abs(velocity[:, 0] - 0.4).max() < 1e-3 * 0.4
    assert np.abs(velocity[:, 1]).max() < 1e-3 * 0.4


def test_rollers_that_lean_squeeze_out_a_sheet_between_their_ends() -> None:
    """A wedge: 2 F_N sin of the angle, along the axes, to the wide side."""
    result = mdlgen.solve(lower(loads(_leaning(90.0, "5 g"), "wedge")), "lattice")
    assert as_asked(result), result.status
    mass = result.model.bodies.mass[:50]
    sideways = np.einsum("i,ti->t", mass, result.velocity[:, :50, 1]) / mass.sum()
    expected = -2 * 3.0 * 1e-3 / 5e-3 * 25e-3
    assert sideways[-1] == pytest.approx(expected, rel=0.03)
