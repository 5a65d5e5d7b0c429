"""Files of meshes: which are read, which are refused, with their place."""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
import tracemalloc

import numpy as np
import pytest
from mesh_scenes import SHAPES, scene_of, solids_in
from solids import ascii_stl, binary, brick, cylinder, obj

import mdlgen
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.registry import emitter
from mdlgen.spec.limits import DEFAULT, Tally
from mdlgen.spec.load import loads
from mdlgen.spec.solid import BYTES, moments, read_solid


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return solids_in(tmp_path_factory.mktemp("solids"))


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


def test_a_wrong_unit_is_reported(folder):
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
