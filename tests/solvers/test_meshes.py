"""Meshes: files that are read or refused, the contact law, runs, text and deck."""

from __future__ import annotations

import itertools
import json
import math
import os
import re
import subprocess
import sys
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from numba import njit
from ruamel.yaml import YAML
from solids import ascii_stl, binary, brick, cylinder, flats, halved, obj, prism

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.mechanics.contact import box_cylinder
from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law, Plate
from mdlgen.mechanics.mesh import LOST, box_mesh, mesh_tables
from mdlgen.mechanics.plate import STRAIGHT, box_plane
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT
from mdlgen.mechanics.tree import build_tree, closest, depth_at
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.spec.limits import DEFAULT, Tally
from mdlgen.spec.load import load, loads
from mdlgen.spec.solid import BYTES, moments, read_solid
from mdlgen.verify.verification import verify

PICK = samples() / "pick.yaml"
ZERO, EYE = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
K, HALF = 300.0, (3.35, 3.175, 0.05)
LAW = Law(K, True, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)

SHAPES = """
name: shapes
materials: {m: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets: {note: {material: m, size: [40 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [2, 2]}}
rollers:
  r: {center: [0 mm, 0 mm, -8 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 1 g, drive: {speed: 100 rad/s}}
  c: {center: [0 mm, 0 mm, 6 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 1 g,
      press: {direction: -z, stiffness: 0.3 N/mm, preload: 2 N}}
meshes:
  one: {file: round.stl, center: [0 mm, 0 mm, -8 mm], on: r, mass: 2 g, rotation: [0 deg, 5 deg, 0 deg]}
  two: {file: small.obj, units: cm, center: [0 mm, 0 mm, 6 mm], on: c, density: 1.2 g/cm^3, at: centres}
  three: {file: wedge.stl, center: [1 mm, 2 mm, -30 mm], rotation: [10 deg, 20 deg, 30 deg]}
contacts:
- {between: [r, c], stiffness: 30 N/mm^1.5, friction: 0}
- {between: [note, "t*"], stiffness: 30 N/mm^1.5, friction: 0}
- {between: [note, one], stiffness: 30 N/mm^1.5, friction: 0.2}
run: {duration: 1 ms}
"""
WEDGE = prism([(0, -1), (30, -1), (30, 3), (0, 0)], 30)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("solids")
    (made / "round.stl").write_bytes(binary(*cylinder(7.5, 5.0, 64)))
    (made / "small.obj").write_text(obj(*cylinder(0.5, 0.5, 24)))
    (made / "wedge.stl").write_text(ascii_stl(*WEDGE))
    return made


def scene_of(folder, *changes, text=SHAPES):
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return loads(text, folder=folder)


# -- files


@pytest.mark.parametrize("form", ["binary", "ascii", "obj", "inside out", "as rectangles"])
def test_all_formats_give_the_same_solid(tmp_path, form):
    corners, triangles = brick(4.0, 6.0, 10.0)
    corners = corners + np.array([1.0, -2.0, 3.0])
    if form == "binary":
        name, content = "a.stl", binary(corners, triangles)
    elif form == "ascii":
        name, content = "a.STL", ascii_stl(corners, triangles).encode()
    elif form == "obj":
        name, content = "a.obj", ("o x\n# y\n" + obj(corners, triangles)).encode()
    elif form == "inside out":
        name, content = "a.obj", obj(corners, triangles[:, ::-1]).encode()
    else:
        x, y, z = np.array([4.0, 6.0, 10.0]) / 2
        eight = [(i * x + 1, j * y - 2, k * z + 3) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
        faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "-6 -5 -1 -2", "1 3 7 5", "2/1/1 6/2/1 8/3/1 4/4/1"]
        lines = [f"v {a} {b} {c}" for a, b, c in eight] + [f"f {face}" for face in faces]
        name, content = "a.obj", "\n".join(lines).encode()
    (tmp_path / name).write_bytes(content)
    solid = read_solid(name, tmp_path, "mm", Tally())
    volume, middle, second = moments(solid.corners, solid.triangles)
    assert volume == pytest.approx(240.0, rel=1e-12)
    np.testing.assert_allclose(middle, [1.0, -2.0, 3.0], atol=1e-12)
    np.testing.assert_allclose(second, np.diag([16.0, 36.0, 100.0]) / 12, atol=1e-11)


def test_moments_of_a_cylinder_of_many_sides_are_those_of_a_prism():
    """A regular n-gon: area n/2 R^2 sin(2 pi/n), and over it the mean of x^2 is R^2/12 (2 + cos(2 pi/n))."""
    n, radius, width = 12, 7.5, 5.0
    volume, middle, second = moments(*cylinder(radius, width, n))
    turn = 2 * math.pi / n
    assert volume == pytest.approx(width * n / 2 * radius**2 * math.sin(turn), rel=1e-12)
    across = radius**2 * (2 + math.cos(turn)) / 12
    np.testing.assert_allclose(second, np.diag([across, width**2 / 12, across]), atol=1e-11)
    np.testing.assert_allclose(middle, 0.0, atol=1e-12)


def test_mass_and_inertia_of_the_model(folder):
    model = lower(scene_of(folder))
    one, three, two = model.meshes
    assert (one.mass, three.mass) == (2.0, 1.0)
    assert two.mass == pytest.approx(1.2e-3 * 1e3 * moments(*cylinder(0.5, 0.5, 24))[0], rel=1e-7)
    # what is on a roller counts with it: its mass, and its inertia about the axis
    r, c = model.roller("r"), model.roller("c")
    across = 7.5**2 * (2 + math.cos(math.pi / 32)) / 12
    assert r.carried == pytest.approx((2.0, 2.0 * 2 * across), rel=1e-6)
    assert c.carried[0] == two.mass and model.bodies.fixed[three.body] and not model.bodies.fixed[one.body]
    # axes of the inertia of a wedge are no axes of its file; the tensor is what they make
    volume, _, second = moments(three.corners, three.triangles)
    tensor = three.principal @ np.diag(three.gyration) @ three.principal.T
    np.testing.assert_allclose(tensor, np.trace(second) * np.eye(3) - second, atol=1e-9)
    assert np.linalg.det(three.principal) == pytest.approx(1.0)
    assert volume == pytest.approx(30 * (30 * 1 + 30 * 3 / 2), rel=1e-6)


def broken(what):
    corners, triangles = cylinder(7.5, 5.0, 32)
    good = binary(corners, triangles)
    if what == "a triangle too few":
        return good[:-50], "claims 128 triangles, which are 6484 bytes; the file has 6434"
    if what == "2^32 triangles claimed":
        return good[:80] + b"\xff\xff\xff\xff" + good[84:], "claims 4294967295 triangles"
    if what == "nan":
        return good[:100] + b"\x00\x00\xc0\x7f" + good[104:], "is not finite"
    if what == "a hole":
        return binary(corners, triangles[:-1]), "not watertight: 3 sides of triangles have no neighbour"
    if what == "one turned over":
        turned = triangles.copy()
        turned[7] = turned[7, ::-1]
        return binary(corners, turned), "not watertight"
    if what == "three at a side":
        return binary(
            corners, np.concatenate([triangles, triangles[:1], triangles[:1, ::-1]])
        ), "more than two"
    if what == "nothing inside":
        flat = [(0, 1, 2), (0, 2, 1)]
        return binary([(0, 0, 0), (9, 0, 0), (0, 9, 0)], flat), "no volume inside"
    if what == "through itself":  # one corner pulled across: more inside out than inside, about the middle
        solid, sides = brick(4.0, 6.0, 10.0)
        solid[1, 1], solid[8, 1] = 9.0, 6.0
        return binary(solid, sides), "goes through itself"
    if what == "empty":
        return good[:80] + bytes(4), "no triangles"
    if what == "too short":
        return b"solid", "too few for an STL"
    if what == "flat ones":
        sliver = np.tile([[5, 5, 6]], (20, 1))
        return binary(corners, np.concatenate([triangles, sliver])), "two corners in one place"
    text = ascii_stl(corners, triangles)
    if what == "a word wrong":
        return text.replace("endloop", "endlop", 1).encode(), "'endloop' is due"
    if what == "a number wrong":
        return text.replace("vertex 7.5", "vertex 7,5", 1).encode(), "is not a number"
    if what == "a number of Python":
        return text.replace("vertex 7.5", "vertex 7_5", 1).encode(), "is not a number"
    if what == "a number of 65 digits":  # the exponent behind them counts
        return text.replace("vertex 7.5 ", f"vertex 7.{'5' * 61}e1 ", 1).encode(), "more than 64 letters"
    if what == "a word too many":
        return text.replace("outer loop", "outer loop x", 1).encode(), "facet 0: not one solid"
    if what == "no end":
        return text.replace("endsolid", "end").encode(), "no endsolid"
    if what == "two solids":
        return (text + text).encode(), "not one solid"
    raise AssertionError(what)


BROKEN = """a triangle too few, 2^32 triangles claimed, nan, a hole, one turned over, three at a side,
nothing inside, through itself, empty, too short, flat ones, a word wrong, a number wrong,
a number of Python, a number of 65 digits, a word too many, no end, two solids"""


@pytest.mark.parametrize("what", BROKEN.replace("\n", " ").split(", "))
def test_a_broken_file_is_refused_in_one_line_at_its_place(folder, what):
    content, message = broken(what)
    (folder / "bad.stl").write_bytes(content)
    with pytest.raises(SpecError) as found:
        scene_of(folder, ("wedge.stl", "bad.stl"))
    text = str(found.value)
    assert message in text and "\n" not in text and text.startswith("scene:") and "meshes.three" in text


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("f 1 2 99999", "a vertex that is not there"),
        ("f 1 2 0", "a vertex that is not there"),
        ("f 1 2 -99999", "a vertex that is not there"),
        (f"f 1 2 {2**64}", "a vertex that is not there"),
        (f"f 1 2 {'9' * 5000}", "a number is due"),
        ("f 1 2 1_0", "a number is due"),
        ("f" + " 1" * 60_000, "a line of more than"),
        ("f 1 2 x", "a number is due"),
        ("v 1 2", "is not read"),
        ("curv 1 2 3", "is not read"),
        ("v 1 2 nan\nv 1 2 inf", "is not finite"),
    ],
)
def test_a_broken_obj_is_refused_with_its_line(folder, line, message):
    (folder / "bad.obj").write_text(obj(*cylinder(7.5, 5.0, 16)) + line + "\n")
    with pytest.raises(SpecError, match=message):
        scene_of(folder, ("small.obj", "bad.obj"))


def test_a_wrong_unit_is_told(folder):
    for unit, hint in (("m", "did you mean units: mm"), ("in", None)):
        change = ("wedge.stl,", f"wedge.stl, units: {unit},")
        if hint is None:
            assert lower(scene_of(folder, change)).meshes[1].scale == 25.4
            continue
        with pytest.raises(SpecError, match=hint):
            scene_of(folder, change)
    (folder / "metres.stl").write_bytes(binary(cylinder(0.0075, 0.005, 16)[0], cylinder(1, 1, 16)[1]))
    with pytest.raises(SpecError, match="did you mean units: m"):
        scene_of(folder, ("wedge.stl", "metres.stl"))


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("../bad.stl", "is not a file in the folder"),
        ("/dev/zero", "is not a file in the folder"),
        ("none.stl", "No such file"),
        ("part.step", "neither .stl nor .obj"),
        ("folder.stl", "is not a plain file|Is a directory"),
        ("pipe.stl", "is not a plain file"),
        ("device.stl", "leads out of the folder"),
        ("loop.stl", "cannot read"),
        ("large.stl", "25000001 bytes.* --limit triangles=1000.. raises"),
    ],
)
def test_what_is_no_file_of_a_part_is_refused(folder, file, message):
    (folder / "folder.stl").mkdir(exist_ok=True)
    if not (folder / "pipe.stl").exists():
        os.mkfifo(folder / "pipe.stl")
        (folder / "device.stl").symlink_to("/dev/zero")
        (folder / "loop.stl").symlink_to("loop.stl")
        with open(folder / "large.stl", "wb") as stream:
            stream.truncate(BYTES * DEFAULT.triangles + 1)
    with pytest.raises(SpecError, match=message) as found:
        scene_of(folder, ("wedge.stl", file))
    assert "\n" not in str(found.value)


def test_corners_of_no_triangle_are_none(tmp_path):
    """They would count for size and reach."""
    solid = obj(*brick(4.0, 6.0, 10.0))
    (tmp_path / "a.obj").write_text(solid)
    plain = read_solid("a.obj", tmp_path, "mm", Tally())
    extra = "".join(f"v {k} 900 0\n" for k in range(9999))
    (tmp_path / "b.obj").write_text(solid + extra)
    more = read_solid("b.obj", tmp_path, "mm", Tally())
    assert np.array_equal(more.corners, plain.corners) and np.array_equal(more.triangles, plain.triangles)


def test_triangles_of_all_meshes_are_limited_and_the_limit_can_be_raised(folder):
    """256, 96 and 16; what the message tells to write helps, in a go or two for each file."""
    wishes = ["triangles=100"]
    for path in ("one", "two", "two", "three"):  # lines, then triangles
        with pytest.raises(SpecError, match=rf"meshes.{path}: .* --limit \S+ raises this limit") as refused:
            loads(SHAPES, folder=folder, limits=DEFAULT.raised(wishes))
        wishes = re.findall(r"--limit (\S+)", str(refused.value))
    assert wishes == ["triangles=368"]
    assert len(loads(SHAPES, folder=folder, limits=DEFAULT.raised(wishes)).meshes) == 3


HUGE = {
    "words of an STL": lambda n: b"solid x\nfacet " + b"a " * (n // 2) + b"\nendsolid x\n",
    "facets of an STL": lambda n: b"solid x\nfacet " + b"endfacet " * (n // 9) + b"\nendsolid x\n",
    "an STL without an end": lambda n: b"solid x\nfacet " + b"vertex 0 0 0\n" * (n // 13),
    "one word": lambda n: b"solid x\nfacet normal " + b"9" * n + b"\nendsolid\n",
    "corners": lambda n: b"v 1 2 3\n" * (n // 8),
    "lines": lambda n: b"\n" * n,
    "a face": lambda n: b"v 1 2 3\nf " + b"1 " * (n // 2),
    "faces": lambda n: b"v 1 2 3\n" + b"f 1 1 1\n" * (n // 8),
}


@pytest.mark.parametrize("what", HUGE)
def test_the_largest_files_take_little_memory_before_they_are_refused(tmp_path, what):
    """At most eight times the file, so 200 MB at 25 MB, whatever stands in it; here a tenth."""
    name, tenth = (
        ("a.stl" if "STL" in what or "word" in what else "a.obj"),
        Tally(DEFAULT.raised(["triangles=1e4"])),
    )
    (tmp_path / name).write_bytes(HUGE[what](BYTES * 10_000 - 40))
    tracemalloc.start()
    with pytest.raises(ValueError, match=rf"^{name}"):
        read_solid(name, tmp_path, "mm", tenth)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 8 * BYTES * 10_000


def test_a_text_alone_names_no_file():
    with pytest.raises(SpecError, match="only a scene that is itself read from a file"):
        loads(SHAPES)


def test_a_file_that_claims_too_much_ends_the_command_in_little_memory(folder):
    (folder / "huge.stl").write_bytes(broken("2^32 triangles claimed")[0])
    (folder / "huge.yaml").write_text(SHAPES.replace("wedge.stl", "huge.stl"))
    # a process begins with the greatest memory of the one that it was started from: one between is small
    message = "import resource, subprocess, sys; code = subprocess.run(sys.argv[1:]).returncode; "
    message += "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss); sys.exit(code)"
    command = [sys.executable, "-c", message, sys.executable, "-m", "mdlgen", "check", "huge.yaml"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert "huge.yaml:12" in done.stderr and "claims 4294967295 triangles" in done.stderr
    assert int(done.stdout) <= 300_000  # kB


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("on: r, mass: 2 g", "on: r", "give mass or density"),
        ("on: r, mass: 2 g", "on: r, mass: 2 g, density: 1 g/cm^3", "both given"),
        ("on: r, mass", "on: q, mass", "no roller 'q'"),
        ("[note, one], stiff", "[r, one], stiff", "a mesh touches sheets only"),
        (
            "[note, one], stiffness: 30",
            "[note, one], share: pair, stiffness: 30",
            "share: pair is not modelled",
        ),
        ("  three:", "  r:", "used twice"),
        ("units: cm", "units: ft", "mm"),
        ("at: centres", "at: middles", "nodes"),
    ],
)
def test_what_is_not_a_mesh_is_refused_in_one_line(folder, old, new, message):
    with pytest.raises(SpecError, match=message) as found:
        scene_of(folder, (old, new))
    assert "\n" not in str(found.value)


def test_a_mesh_that_unbalances_a_free_roller_is_refused_by_name(folder):
    model = lower(scene_of(folder, ("[0 mm, 0 mm, 6 mm], on", "[0.1 mm, 0 mm, 6 mm], on")))
    for solver in ("lattice", "exudyn"):
        with pytest.raises(RefusedError, match=r"mesh two: its middle of mass is 0\.1 mm off the axis of c"):
            mdlgen.solve(model, solver)
    assert emitter("motionview").emit(model)


# -- the tree


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


# -- the law


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


@njit
def _mesh(out, xa, ra, half, exposed, xb, rb, meshes, law):
    head, axis = meshes.heads[0], (0.0, 1.0, 0.0)
    a, b = Frame(xa, ra, ZERO, ZERO), Frame(xb, rb, ZERO, ZERO)
    box_mesh(out, a, Box(half, exposed), b, axis, head, meshes, law)


def turn(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]]}
    return np.array(rows[axis])


def press(part, place, tilt=EYE, half=HALF, exposed=0, turned=0.0):
    """What a box gets of a mesh whose body is turned about y."""
    meshes, xb, rb = part
    out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
    rb = tuple((turn("y", turned) @ rb).ravel())
    _mesh(out, tuple(map(float, place)), tuple(np.ravel(tilt)), half, exposed, xb, rb, meshes, LAW)
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
    block = press(part, (20.0 + 3.35 - 0.02, 0.0, 0.0), half=(3.35, 3.0, 2.0), exposed=15)
    assert block[0] == pytest.approx(K * 0.02**1.5, rel=1e-4)


def test_a_corner_on_a_slope_passes_from_one_law_to_the_other_without_a_step(tmp_path):
    part = parts(tmp_path, brick(40.0, 30.0, 40.0))
    forces = []
    for angle in np.linspace(0.0, 1.5, 400):
        # its edge 0.02 mm deep in the face x = 20, the box leaning by the angle
        tilt = turn("y", angle)
        edge = tilt @ [-3.35, 0.0, 0.0]
        out = press(part, (20.0 - 0.02 - edge[0], 0.0, -edge[2]), tilt, exposed=1)
        forces.append(out[0])
    assert max(abs(np.diff(forces))) < 0.05 * max(forces) and min(forces) > 0.5 * K * 0.02**1.5
    assert forces[0] == pytest.approx(K * 0.02**1.5, rel=1e-3)


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


# -- runs


def transport(folder, count, meshes=True, boxes=(10, 20)):
    """transport_4x4, its motor rollers as cylinders or as meshes of `count` sides, 4 count triangles."""
    record = YAML(typ="safe").load((samples() / "transport_4x4.yaml").read_text())
    record["sheets"]["note"]["boxes"] = list(boxes)
    if meshes:
        (folder / "roller.stl").write_bytes(binary(*cylinder(7.5, 5.0, count)))
        motors = [name for name in record["rollers"] if name.startswith("motor")]
        record["meshes"] = {
            f"rim_{n}": {
                "file": "roller.stl",
                "center": record["rollers"][n]["center"],
                "on": n,
                "mass": "1e-6 g",
            }
            for n in motors
        }
        (contact,) = [c for c in record["contacts"] if c["between"] == ["note", "motor_*"]]
        contact["between"] = ["note", "rim_*"]
    return lower(loads(json.dumps(record), folder=folder))


def test_a_roller_of_20000_triangles_transports_as_the_cylinder(tmp_path):
    meshed = transport(tmp_path, 5000)
    assert [len(m.triangles) for m in meshed.meshes] == [20000] * 4
    plain = transport(tmp_path, 0, meshes=False)
    assert len(meshed.pairs) == len(plain.pairs)
    # meshes are not halved, so the cylinders are not for the comparison; both at one step
    whole = replace(plain, run=replace(plain.run, symmetry=False, step=0.05))
    meshed = replace(meshed, run=replace(meshed.run, step=0.05))
    # by turns, since other work on the machine comes and goes
    runs = [[mdlgen.solve(model, "lattice") for model in (whole, meshed)] for _ in range(3)]
    one, two = (min(both, key=lambda r: r.wall_s) for both in zip(*runs, strict=True))
    assert one.ok and two.ok, (one.status, two.status)
    first, second = (r.summary()["sheets"]["note"] for r in (one, two))
    assert second["travel_mm"][0] == pytest.approx(first["travel_mm"][0], rel=0.01)
    assert second["speed_mm_per_s"][0] == pytest.approx(first["speed_mm_per_s"][0], rel=0.01)
    assert two.wall_s < 15 * one.wall_s  # the sweep over a mesh is not bounded yet
    # nips in full grip push alike
    rows = [
        row
        for row, b in enumerate(plain.contacts.part_b)
        if "motor" in b and plain.contacts.part_a[row] == "note"
    ]
    np.testing.assert_allclose(two.statistics.mean_force[rows], one.statistics.mean_force[rows], rtol=0.03)
    # and the meshes have turned with their rollers
    mesh = meshed.meshes[0]
    roller = meshed.rollers[mesh.on]
    turned = 2 * np.arccos(np.clip(abs(two.rotation[:, mesh.body] @ two.rotation[0, mesh.body]), 0, 1))
    angle = roller.turned(two.time)
    wrapped = np.abs((angle + np.pi) % (2 * np.pi) - np.pi)
    np.testing.assert_allclose(turned, wrapped, atol=1e-6)


def test_both_solvers_run_meshes_alike():
    """The sample: a lobe that turns, a ramp that stands; 1 % in where the note is and what pushes it."""
    model = lower(load(PICK))
    one, two = mdlgen.solve(model, "lattice"), mdlgen.solve(model, "exudyn")
    assert one.ok and two.ok, (one.status, two.status)
    first, second = one.summary(), two.summary()
    assert second["sheets"]["note"]["travel_mm"][0] == pytest.approx(
        first["sheets"]["note"]["travel_mm"][0], rel=0.01
    )
    assert (
        first["sheets"]["note"]["travel_mm"][0] > 5.0
        and first["meshes"]["ramp"]["contacts"]["note"]["max_force_n"] > 0
    )
    lobe = [r.statistics.mean_force[list(model.contacts.part_b).index("lobe")] for r in (one, two)]
    assert lobe[1] == pytest.approx(lobe[0], rel=0.05)
    body = next(m.body for m in model.meshes if m.name == "lobe")
    np.testing.assert_allclose(
        np.abs((one.rotation[-1, body] * two.rotation[-1, body]).sum()), 1.0, atol=1e-6
    )


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_run_ends_where_a_mesh_does_not_hold_a_box(tmp_path, solver):
    (tmp_path / "plate.stl").write_bytes(binary(*brick(60.0, 60.0, 0.8)))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [20 mm, 20 mm], thickness: 0.2 mm, mass: 1 g, boxes: [2, 2],\n"
        "             center: [0 mm, 0 mm, 1 mm]}}\n"
        "meshes: {p: {file: plate.stl}}\n"
        "contacts: [{between: [s, p], stiffness: 1e-4 N/mm^1.5, friction: 0}]\n"
        "run: {duration: 30 ms, step: 0.1 ms}\n"
    )
    result = mdlgen.solve(lower(loads(text, folder=tmp_path)), solver)
    assert not result.ok and "into mesh p" in result.status


def test_a_note_rests_on_a_mesh_as_on_a_plane(tmp_path):
    (tmp_path / "plate.stl").write_bytes(binary(*brick(60.0, 60.0, 2.0)))
    text = (
        "name: n\nmaterials: {{m: {{E_md: 1 GPa, E_cd: 1 GPa}}}}\n"
        "sheets: {{s: {{material: m, size: [20 mm, 20 mm], thickness: 0.2 mm, mass: 1 g, boxes: [2, 2],\n"
        "             center: [0 mm, 0 mm, 0.1 mm], velocity: [0.5 m/s, 0 m/s, 0 m/s]}}}}\n{part}\n"
        "contacts: [{{between: [s, p], stiffness: 10 N/mm^1.5, friction: 0.3, smoothing: 5 mm/s}}]\n"
        "run: {{duration: 30 ms, step: 0.05 ms}}\n"
    )
    mesh = "meshes: {p: {file: plate.stl, center: [0 mm, 0 mm, -1 mm]}}"
    plane = "planes: {p: {center: [0 mm, 0 mm, -1 mm], normal: z, size: [60 mm, 60 mm, 2 mm], mass: 1 g}}"
    one, two = (
        mdlgen.solve(lower(loads(text.format(part=p), folder=tmp_path)), "lattice") for p in (mesh, plane)
    )
    assert one.ok and two.ok, (one.status, two.status)
    way = two.sheet_motion(0)[0][-1, 0]
    assert way > 10.0 and one.sheet_motion(0)[0][-1, 0] == pytest.approx(way, rel=1e-3)


def test_the_samples_files_are_what_the_tests_make():
    assert (samples() / "meshes/lobe.obj").read_text().split("\n", 1)[1] == obj(*flats(7.5, 12, 96, 6.5))
    assert (samples() / "meshes/ramp.stl").read_text() == ascii_stl(*WEDGE, "ramp")


# -- text and deck


def test_meshes_are_the_same_in_text_script_deck_and_model(folder):
    scene = scene_of(folder)
    model = lower(scene)
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    turned = {p.data_set for p in model.parameters if p.data_set in scene.meshes}
    assert turned == set(scene.meshes) and found.turned is not None and found.turned.largest <= 1e-12
    assert [str(d) for d in verify(scene, model, only="sheets").all_differences()] == []
    assert not emitter("motionview").read(emitter("motionview").emit(model), "own").notes.findings()
    assert not emitter("motionsolve").validate(emitter("motionsolve").emit(model), "deck")


def test_a_changed_mesh_is_seen_in_text_and_deck(folder, tmp_path):
    scene = scene_of(folder)
    model = lower(scene)
    text, deck = (emitter(name).emit(model) for name in ("motionview", "motionsolve"))
    for old, new in (
        ('"wedge.stl"', '"round.stl"'),
        ("MARKER, m_three", "MARKER, m_one"),
        ("          , 0, 0, 0, 0, 0, 0, ds_three", "          , 0, 0, 1, 0, 0, 0, ds_three"),
        ("ds_two.real_scale, 10.0", "ds_two.real_scale, 1.0"),
        ("gcad_one, false", "gcad_three, false"),
        ("b_one, b_r, p_one_cm", "b_one, B_Ground, p_one_cm"),
    ):
        assert old in text, old
        changed = tmp_path / "changed.mdl"
        changed.write_text(text.replace(old, new, 1))
        assert verify(scene, model, text=changed).all_differences(), new
    corner = next(line for line in deck[deck.index("TriaMesh") :].splitlines()[6:] if line.count(".") == 3)
    changed = tmp_path / "changed.xml"
    changed.write_text(deck.replace(corner, corner.replace(corner.split()[0], "6.0", 1), 1))
    assert verify(scene, model, deck=changed).all_differences()


def test_a_mesh_without_a_contact_is_told(folder):
    model = lower(scene_of(folder, ('"t*"', "two")))
    assert ("W111", "meshes.three") in {(lint.code, lint.where) for lint in lints(model)}
    # a roller is there for what it turns
    assert [lint.code for lint in lints(lower(load(PICK)))] == []


def test_a_sample_is_copied_with_its_files(tmp_path):
    command = [sys.executable, "-m", "mdlgen", "new", "scene", "--from", "pick"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 0
    copied = load(tmp_path / "scene" / "pick.yaml")
    assert copied.meshes["lobe"].solid == load(PICK).meshes["lobe"].solid
