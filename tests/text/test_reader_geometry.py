"""Points, markers, bodies and graphics as the reader of MDL works them out."""

from __future__ import annotations

import math

import pytest
from readings import read_clean


def test_points_may_come_in_any_order_and_lean_on_single_coordinates() -> None:
    found = read_clean(
        "*SetPoint( a, b.y+1, 0, 0 )",
        "*SetPoint( b, 5, 7, a.x )",
        '*Point( a, "a" )',
        '*Point( b, "b" )',
    )
    assert found["points"] == {"a": (8, 0, 0), "b": (5, 7, 8)}


@pytest.mark.parametrize(
    ("orientation", "x", "z"),
    [
        ("TWOAXES, ZX, DXDYDZ, 0, 0, 2, DXDYDZ, 1, 1, 5", (0.5**0.5, 0.5**0.5, 0), (0, 0, 1)),
        ("TWOAXES, YZ, DXDYDZ, 0.0, -1, 0, DXDYDZ, 0, 0, 1", (-1, 0, 0), (0, 0, 1)),
        ("TWOAXES, XZ, POINT, p_a, VECTOR, V_Global_Z", (1, 0, 0), (0, 0, 1)),
        ("TWOAXES, ZY, VECTOR, v, VECTOR, Global_Frame.xaxis", (0, 0, 1), (0, 1, 0)),
        ("ONEAXIS, Z, POINT, p_a", (0, 1, 0), (1, 0, 0)),
        ("ONEAXIS, Z, DXDYDZ, 0, 0, -3", (1, 0, 0), (0, 0, -1)),
        ("ONEAXIS, Z, VECTOR, v", (-1, 0, 0), (0, 1, 0)),
        ("ANGLES, Global_Frame, 90, 0, 0", (0, 1, 0), (0, 0, 1)),
        ("ANGLES, Global_Frame, 0, 90, 0", (1, 0, 0), (0, -1, 0)),
        ("ANGLES, Global_Frame, 90, 90, 90", (0, 0, 1), (1, 0, 0)),
    ],
)
def test_orientation(orientation: str, x: tuple[float, ...], z: tuple[float, ...]) -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( p_a, "a" )',
        '*Vector( v, "v" )',
        '*Marker( mrk, "m", B_Ground, p )',
        "*SetPoint( p, 1, 2, 3 )",
        "*SetPoint( p_a, 9, 2, 3 )",
        "*SetVector( v, 0, 4, 0 )",
        f"*SetOrientation( mrk, {orientation} )",
    )["markers"]["mrk"]
    assert found["origin"] == (1, 2, 3)
    assert found["axes"][0] == pytest.approx(x, abs=1e-15)
    assert found["axes"][2] == pytest.approx(z, abs=1e-15)


def test_a_place_in_the_axes_of_a_marker() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        '*Marker( mrk, "m", B_Ground, p )',
        "*SetPoint( p, 10, 0, 0 )",
        "*SetOrientation( mrk, TWOAXES, ZX, DXDYDZ, 0, 0, 1, DXDYDZ, 0, 1, 0 )",
        "*SetPoint( q, loc_rel_to( {1, 2+0, 3}, mrk )[0], loc_rel_to( {1, 2, 3}, mrk )[1]",
        "         , mrk.yaxis.x+Global_Frame.origin.x )",
    )
    assert found["points"]["q"] == pytest.approx((8, 1, -1), abs=1e-15)


def test_boxes_cylinders_and_spheres() -> None:
    found = read_clean(
        '*Point( p, "p" )',
        '*Point( q, "q" )',
        '*Body( b, "b", p )',
        "*SetPoint( p, 1, 0, 0 )",
        "*SetPoint( q, 1, 0, 8 )",
        "*SetBodyInertia( b, 1, 1, 1, 1 )",
        '*Graphic( g1, "g", BOX, b, CENTER, p, ZX, VECTOR, V_Global_Z, VECTOR, V_Global_X, 2, 4, 6, 3 )',
        '*Graphic( g2, "g", BOX, b, CORNER, p, ZX, VECTOR, V_Global_Z, VECTOR, V_Global_X, 2, 4, 6, 3 )',
        '*Graphic( g3, "g", BOX, b, FACE, p, ZX, q, VECTOR, V_Global_X, 2, 4, 3 )',
        '*Graphic( g4, "g", CYLINDER, b, p, POINT, q, 5, g4.r1, , 2, CAPBOTH, 3 )',
        '*Graphic( g5, "g", CYLINDER, b, p, VECTOR, V_Global_Y, 5, 3, 10, -10/2, CAPBEGIN, 3 )',
        '*Graphic( g6, "g", SPHERE, b, q, g1.r1+2, 3 )'
        if False
        else '*Graphic( g6, "g", SPHERE, b, q, 2, 3 )',
    )["graphics"]
    assert (found["g1"]["center"], found["g1"]["lengths"]) == ((1, 0, 0), (2, 4, 6))
    assert found["g2"]["center"] == (2, 2, 3)
    assert (found["g3"]["center"], found["g3"]["lengths"]) == ((1, 0, 4), (2, 4, 8))
    assert (found["g4"]["start"], found["g4"]["axis"], found["g4"]["length"]) == ((1, 0, 2), (0, 0, 1), 8)
    assert (found["g4"]["radii"], found["g5"]["radii"]) == ((5, 5), (5, 3))
    assert (found["g5"]["start"], found["g5"]["axis"]) == ((1, -5, 0), (0, 1, 0))
    assert (found["g6"]["center"], found["g6"]["radius"]) == ((1, 0, 8), 2)


def test_mass_from_graphics() -> None:
    """A box of 1000 mm3 and a cone that is twice as long as wide; closed forms of a textbook."""
    found = read_clean(
        '*Point( p, "p" )',
        '*Body( b, "b", p )',
        '*Body( b2, "b", p )',
        "*SetPoint( p, 0, 0, 0 )",
        "*Set( b.inertia_props_from_graphic, true )",
        "*Set( b2.inertia_props_from_graphic, true )",
        '*Graphic( g, "g", BOX, b, CENTER, p, ZX, VECTOR, V_Global_X, VECTOR, V_Global_Y, 5, 10, 20, 3 )',
        '*Graphic( g2, "g", CYLINDER, b2, p, VECTOR, V_Global_Z, 10, 0, 20, 0, CAPBOTH, 3 )',
    )["bodies"]
    mass = 7.86e-3
    assert found["b"]["mass"] == pytest.approx(mass)
    # Z of the box lies along x, X along y: lengths are 20, 5 and 10 along x, y and z
    squares = (5**2 + 10**2, 20**2 + 10**2, 20**2 + 5**2)
    assert found["b"]["inertia"][:3] == pytest.approx([mass * s / 12 for s in squares])
    cone = 7.86e-6 * math.pi * 100 * 20 / 3
    assert found["b2"]["mass"] == pytest.approx(cone)
    assert found["b2"]["cm"] == pytest.approx((0, 0, 5))
    assert found["b2"]["inertia"][2] == pytest.approx(0.3 * cone * 100)
    assert found["b2"]["inertia"][0] == pytest.approx(cone * (3 / 20 * 100 + 3 / 80 * 400))
