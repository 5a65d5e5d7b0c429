"""The contact law of meshes, and the search among their triangles."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from laws import box_cylinder, box_mesh, box_plane
from mesh_scenes import turn
from solids import binary, brick, cylinder, flats, halved

from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law, Plate
from mdlgen.mechanics.mesh import LOST
from mdlgen.mechanics.mesh_side import LEANING, LEVEL, ramp
from mdlgen.mechanics.mesh_tables import mesh_tables
from mdlgen.mechanics.plate import STRAIGHT
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT
from mdlgen.mechanics.tree import build_tree, closest, depth_at
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

ZERO, EYE = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
K, HALF = 300.0, (3.35, 3.175, 0.05)
LAW = Law(K, True, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)


def test_the_nearest_triangle_is_that_of_a_search_through_all():
    corners, triangles = halved(*halved(*flats(7.5, 5.0, 24, 5.0)))
    bounds, links, table = build_tree(corners, triangles, 1.0)
    assert links[0, 2] == len(links) and links[:, 1].sum() == len(table) == len(triangles)
    random = np.random.default_rng(5)
    for _ in range(200):
        at = tuple(random.uniform(-8, 8, 3) * [1, 0.4, 1])
        depth, found = depth_at(bounds, links, table, 0, len(links), at, 1.0)
        distances = [math.dist(at, closest(row, at)) for row in table]
        inside = abs(at[0]) < 5 and abs(at[1]) < 2.5 and is_inside(corners, triangles, at)
        if min(distances) > 1.0 or not inside:
            assert depth < 0.0
        else:
            assert depth == pytest.approx(min(distances), rel=1e-9)
            assert distances[found] == pytest.approx(depth, rel=1e-9)


def is_inside(corners, triangles, at):
    """By the solid angle of all triangles."""
    a, b, c = (corners[triangles[:, k]] - at for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    top = np.einsum("ni,ni->n", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ni,ni->n", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(top, la * lb * lc + ab * lc + bc * la + ca * lb).sum() > 2 * math.pi


def parts(tmp_path, solid, on="", at="nodes"):
    """The mesh of one part, for compiled code, and the body that it moves with."""
    (tmp_path / "part.stl").write_bytes(binary(*solid))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [9 mm, 9 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}}\n"
        "rollers: {r: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 1 g}}\n"
        f"meshes: {{p: {{file: part.stl, at: {at}, mass: 1 g{on}}}}}\n"
    )
    model = lower(loads(text, folder=tmp_path))
    body = model.rollers[0].body if "on:" in on else model.meshes[0].body
    return mesh_tables(model), tuple(model.bodies.position[body]), model.bodies.rotation[body]


def press(part, place, tilt=EYE, half=HALF, exposed=0, turned=0.0):
    """What a box gets of a mesh whose body is turned about y."""
    meshes, xb, rb = part
    out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
    rb = tuple((turn("y", turned) @ rb).ravel())
    a, b = Frame(tuple(map(float, place)), tuple(np.ravel(tilt)), ZERO, ZERO), Frame(xb, rb, ZERO, ZERO)
    box_mesh(out, a, Box(half, exposed), b, (0.0, 1.0, 0.0), 0, meshes, LAW)
    return out


@pytest.mark.parametrize("at", ["nodes", "centres"])
@pytest.mark.parametrize("times", [0, 2])
def test_a_flat_box_on_a_flat_mesh_has_the_law_of_a_plane(tmp_path, at, times):
    """Whole, in part, and turned: neither the number of triangles nor where the depth is looked at counts."""
    solid = brick(40.0, 30.0, 4.0)
    for _ in range(times):
        solid = halved(*solid)
    part = parts(tmp_path, solid, at=at)
    whole = K * 0.02**1.5
    out = press(part, (1.0, 2.0, 2.05 - 0.02))
    assert out[12] == pytest.approx(whole, rel=1e-5) and out[2] == pytest.approx(whole, rel=1e-5)
    assert out[15] == pytest.approx(0.02, rel=1e-4) and abs(out[3:6]).max() < 1e-4 * whole
    # two thirds of it over the edge, on either side of the plate
    for side in (1.0, -1.0):
        out = press(part, (20.0 + 3.35 / 3, 0.0, side * 2.03))
        assert side * out[2] == pytest.approx(whole / 3, rel=1e-4)
    assert press(part, (23.4, 0.0, 2.03))[12] == 0.0 and press(part, (0.0, 0.0, 2.06))[12] == 0.0
    lean = turn("x", 1e-3)
    out, plane = press(part, (0.0, 0.0, 2.04), lean), np.zeros(OUT)
    a, b = Frame((0.0, 0.0, 2.04), tuple(lean.ravel()), ZERO, ZERO), Frame(ZERO, EYE, ZERO, ZERO)
    box_plane(plane, a, Box(HALF, 0), b, Plate(STRAIGHT, (20.0, 15.0, 2.0), 2.0, 0, ZERO, 0), LAW)
    # a plane has the mean of z^1.5 in the corners of the box, which is 3 % above that over its face
    assert out[2] == pytest.approx(plane[2], rel=0.04)


def test_an_outer_side_stubs_on_the_end_of_a_mesh_and_climbs_its_round(tmp_path):
    """A brick of 4 mm from x = -20 on, and a box whose leading side is 0.02 mm in. Sharp it pushes back by
    k z^1.5 alone; on a round of 0.5 mm along the line from the round's axis."""
    inside = -20.0 + 0.02 - HALF[0]
    part = parts(tmp_path, brick(40.0, 30.0, 4.0))
    for below in (0.1, 0.7, 1.5):
        out = press(part, (inside, 0.0, 2.0 - below), exposed=2)
        assert out[0] == pytest.approx(-K * 0.02**1.5, rel=1e-3) and abs(out[2]) < 1e-9
    # a side that has a neighbour in its sheet is no end: the top pushes it up, as far as it is covered
    assert press(part, (inside, 0.0, 2.0 - 0.1), exposed=0)[2] > 0.0
    part = parts(tmp_path, brick(40.0, 30.0, 4.0), on=", edge_radius: 0.5 mm")
    flat = press(part, (inside, 0.0, 2.0 - 0.7), exposed=2)
    assert flat[0] == pytest.approx(-K * 0.02**1.5, rel=1e-3)
    below, depth = 0.3, 0.01
    across = math.sqrt((0.5 - depth) ** 2 - (0.5 - below) ** 2)  # from the axis of the round
    out = press(part, (-20.0 + 0.5 - across - HALF[0], 0.0, 2.0 - below), exposed=2)
    assert out[12] == pytest.approx(K * depth**1.5, rel=1e-3)
    assert math.atan2(-out[0], out[2]) == pytest.approx(math.atan2(across, 0.5 - below), abs=1e-6)


@pytest.mark.parametrize("turned", [0.0, 0.3, 2.0])
@pytest.mark.parametrize("place", [(0.0, 0.0), (3.3, 0.0), (1.0, 2.4), (-3.6, -4.0)])
def test_a_mesh_of_a_cylinder_on_a_roller_is_that_roller(tmp_path, place, turned):
    """Force, torque and depth of a box that covers it all or in part; 500 sides, and four times as many."""
    high = 7.55 - 0.04
    axis, exact = (0.0, 1.0, 0.0), np.zeros(OUT)
    at = (*place, high)
    a, b = Frame(at, EYE, ZERO, ZERO), Frame(ZERO, EYE, ZERO, ZERO)
    box_cylinder(exact, a, Box(HALF, 0), b, Cylinder(axis, 7.5, 5.0), LAW)
    forces = []
    for solid in (cylinder(7.5, 5.0, 500), halved(*cylinder(7.5, 5.0, 500))):
        out = press(parts(tmp_path, solid, ", on: r"), at, turned=turned)
        forces.append(out[2])
        assert out[2] == pytest.approx(exact[2], rel=0.01, abs=1e-3 * K * 0.04**1.5)
        assert out[15] == pytest.approx(exact[15], abs=2e-4)
        np.testing.assert_allclose(out[3:6], exact[3:6], atol=0.03 * abs(exact[2]) * 3.35)
    assert forces[1] == pytest.approx(forces[0], rel=5e-3)


def test_boxes_share_a_mesh_on_a_roller(tmp_path):
    """Side by side, along and across, their sum is that of one wherever they meet."""
    part = parts(tmp_path, cylinder(7.5, 5.0, 500), ", on: r")
    one = press(part, (0.0, 0.0, 7.51))[2]
    for x in np.linspace(-0.9, 0.9, 5):
        for y in (-1.0, 0.7):
            four = [(x + i * 3.35, y + j * 3.175, 7.51) for i in (-1, 1) for j in (-1, 1)]
            assert sum(press(part, place)[2] for place in four) == pytest.approx(one, rel=2e-3)


def test_the_edge_of_a_sheet_meets_a_wall(tmp_path):
    """Its outer side at right angles: k z^1.5; a side that is no outer one, and the top of the wall: none."""
    part = parts(tmp_path, brick(40.0, 30.0, 4.0))
    for exposed, sign in ((1, 1.0), (2, -1.0)):
        out = press(part, (sign * (20.0 + 3.35 - 0.02), 0.0, 0.0), exposed=exposed)
        assert sign * out[0] == pytest.approx(K * 0.02**1.5, rel=1e-4) and out[15] == pytest.approx(
            0.02, rel=1e-3
        )
        assert press(part, (sign * 23.33, 0.0, 0.0), exposed=3 - exposed)[12] == 0.0
        # lying on the plate, 5 mm from the wall, it feels the plate alone
        out = press(part, (sign * 11.65, 0.0, 2.04), exposed=exposed)
        assert out[2] == pytest.approx(K * 0.01**1.5, rel=1e-4) and abs(out[0]) < 1e-9
    # the pressure in a block falls to 0 over its edges: ratios of pressures are areas to the power 2/3
    block = press(part, (20.0 + 3.35 - 0.02, 0.0, 0.0), half=(3.35, 3.0, 2.0), exposed=15)
    a, b = ((3.35 / other) ** (2 / 3) * 0.02 / other for other in (3.0, 2.0))
    lost = 0.6 * (a + b) - 3 / 7 * a * b
    assert 0.01 < lost < 0.02
    assert block[0] == pytest.approx(K * 0.02**1.5 * (1.0 - lost), rel=1e-4)


def test_a_corner_on_a_slope_passes_from_one_law_to_the_other_without_a_step(tmp_path):
    part = parts(tmp_path, brick(40.0, 30.0, 40.0))
    forces = []
    for angle in np.linspace(0.0, 1.5, 400):
        # its edge 0.02 mm deep in the face x = 20, the box leaning by the angle
        tilt = turn("y", angle)
        edge = tilt @ [-3.35, 0.0, 0.0]
        out = press(part, (20.0 - 0.02 - edge[0], 0.0, -edge[2]), tilt, exposed=1)
        forces.append(out[0])
    assert max(abs(np.diff(forces))) < 0.05 * max(forces)
    assert forces[0] == pytest.approx(K * 0.02**1.5, rel=1e-3)
    # at last the broad face has nearly all of it: a wedge, whose corner is half of the thickness deeper
    flat, steep = math.sin(1.5), math.cos(1.5)
    wedge = K / (2 * HALF[0]) * (0.02 + HALF[2] * flat) ** 2.5 / (2.5 * steep * flat**2.5)
    assert forces[-1] == pytest.approx(wedge + ramp(steep, LEVEL, LEANING) * K * 0.02**1.5, rel=1e-3)
    assert min(forces) == forces[-1]


def test_the_work_of_a_contact_is_the_energy_that_it_stores(tmp_path):
    part = parts(tmp_path, flats(7.5, 5.0, 400, 6.0), ", on: r")
    for place, tilt in (((0.4, 0.2, 7.50), EYE), ((1.0, -0.5, 7.47), turn("y", 0.05))):
        step = 1e-5
        below, above = [press(part, np.add(place, (0, 0, s * step)), tilt) for s in (-1, 1)]
        force = press(part, place, tilt)[2]
        assert (below[13] - above[13]) / (2 * step) == pytest.approx(force, rel=0.02)


@pytest.mark.parametrize("on", [", on: r", ""])
def test_how_a_triangle_is_cut_does_not_change_its_force(tmp_path, on):
    """A side of the box passes over corners of triangles: what is left has a corner more or less."""
    corners, triangles = halved(*flats(7.5, 5.0, 60, 6.0))
    part = parts(tmp_path, (corners, triangles), on)
    lean, jumps = turn("y", 0.03) @ turn("x", 0.01), []
    for x, _, z in corners[(corners[:, 2] > 7.2) & (abs(corners[:, 1]) < 0.1)]:
        side = np.array([x, 0.0, z]) - lean @ [HALF[0], 0.0, 0.0]
        for y in np.linspace(-2.0, 2.0, 9):
            place = (side[0], y, 7.48)
            near = [press(part, np.add(place, (shift, 0, 0)), lean) for shift in (-1e-9, 0.0, 1e-9)]
            if near[0][12] > 0.01:
                jumps.append(max(abs(a - b).max() for a, b in itertools.pairwise(near)) / near[0][12])
    assert len(jumps) > 50 and max(jumps) < 1e-5


def test_what_is_too_deep_is_seen(tmp_path):
    """A plate of 0.6 mm: up to its middle a box is pushed out, beyond that the depth ends a run."""
    part = parts(tmp_path, brick(40.0, 30.0, 0.6))
    assert press(part, (0.0, 0.0, 0.35 - 0.29))[15] == pytest.approx(0.29, rel=1e-3)
    deep = press(part, (0.0, 0.0, 0.35 - 0.32))
    assert deep[15] > LOST and deep[2] > 0.0
