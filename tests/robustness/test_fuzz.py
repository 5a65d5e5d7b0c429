"""Random and mutated scenes, texts and meshes: one line and a known exit code, whatever comes.

200 examples of each, the same ones every time; as many as MDLGEN_FUZZ says with
`MDLGEN_FUZZ=10000 python -m pytest tests/robustness/test_fuzz.py`. With MDLGEN_FUZZ_PART=0/2 a process does
every other one of the scenes, and leaves the rest to one with 1/2.
"""

from __future__ import annotations

import contextlib
import copy
import gc
import io
import itertools
import json
import os
import re
import resource
import struct
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from papers import on_paper
from scenes import SCENES, TEXTS, paths
from solids import ascii_stl, binary, brick, cylinder, obj
from unsaid import UNSAID

import mdlgen
from mdlgen.__main__ import MANY
from mdlgen.cli import app
from mdlgen.paths import samples
from mdlgen.spec.solid import Solid, signed_volume

COUNT = int(os.environ.get("MDLGEN_FUZZ", "200"))
PART, PARTS = (int(k) for k in os.environ.get("MDLGEN_FUZZ_PART", "0/1").split("/"))
NUMBER = itertools.count()
NAN = re.compile(rb"(?<![\w.])nan(?!\w)")
# without Phase.explain, which traces, and so tells of times that are none
PHASES = (Phase.generate, Phase.shrink)
FUZZ = settings(max_examples=COUNT, suppress_health_check=list(HealthCheck), database=None, phases=PHASES)
# Of each example, on a machine that does nothing else [s], [MB].
MOST_TIME, MOST_MEMORY = 5.0, 500.0

MDL = [
    mdlgen.emit(mdlgen.lower(mdlgen.loads(json.dumps(scene))))
    for scene in SCENES
    if not scene.get("loads") and scene["name"] not in UNSAID
]
# the shortest tell as much as the longest
MDL = sorted(MDL, key=len)[:5]
PIECES = sorted({word for text in MDL for word in re.findall(r"\*\w+\(|\w+|[^\w\s]", text)})[::7]


NUMBERS = st.one_of(
    st.floats(),
    st.integers(),
    st.sampled_from([0.0, -1.0, 1e-300, 5e-324, 1e-20, 1e-19, 1e-9, 1e9, 1e19, 1e20, 1e300, 10**40]),
)
WORDS = st.one_of(
    st.text(max_size=20),
    st.sampled_from(
        [
            "",
            "x",
            "-z",
            "note",
            "*",
            "?",
            "x_max",
            "1e400",
            ".nan",
            '"\n*BeginMDL( a )',
            "\u2028",
            "{%",
            "`",
            "../x",
        ]
    ),
)
UNITS = st.sampled_from(
    ["mm", "m", "g", "kg", "ms", "s", "N", "MPa", "rad/s", "N*mm/rad", "N/mm^1.5", "x", "^9", ""]
)
QUANTITIES = st.builds("{} {}".format, NUMBERS, UNITS)
LEAVES = st.one_of(st.none(), st.booleans(), NUMBERS, WORDS, QUANTITIES)
VALUES = st.recursive(
    LEAVES, lambda v: st.one_of(st.lists(v, max_size=4), st.dictionaries(WORDS, v, max_size=3))
)


@st.composite
def mutated(draw: st.DrawFn) -> str:
    """A sample with some values changed, most of them to others that a scene might have."""
    scene = copy.deepcopy(draw(st.sampled_from(SCENES)))
    for _ in range(draw(st.integers(1, 3))):
        path = draw(st.sampled_from(list(paths(scene))))
        node = scene
        for key in path[:-1]:
            node = node[key]
        old = node[path[-1]]
        number = re.fullmatch(r"[-+0-9.eE]+( .+)", old) if isinstance(old, str) else None
        how = draw(st.sampled_from(["like", "like", "like", "any", "gone"]))
        if how == "gone":
            del node[path[-1]]
        elif how == "like" and number:
            node[path[-1]] = f"{draw(NUMBERS)}{number[1]}"
        elif how == "like" and isinstance(old, (int, float)):
            node[path[-1]] = draw(NUMBERS)
        else:
            node[path[-1]] = draw(VALUES)
    return json.dumps(scene, allow_nan=True)


@st.composite
def edited(draw: st.DrawFn, texts: list[str], pieces: list[str]) -> str:
    """A text with pieces put in, doubled and left out."""
    text = draw(st.sampled_from(texts))
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(text)))
        end = min(len(text), at + draw(st.integers(0, 30)))
        kind = draw(st.sampled_from(["in", "out", "twice", "swap", "any"]))
        if kind == "in":
            text = text[:at] + draw(st.sampled_from(pieces)) + text[at:]
        elif kind == "out":
            text = text[:at] + text[end:]
        elif kind == "twice":
            text = text[:end] + text[at:]
        elif kind == "swap":
            text = text[:at] + draw(st.sampled_from(pieces)) + text[end:]
        else:
            text = text[:at] + draw(st.text(max_size=5)) + text[end:]
    return text


YAML_PIECES = [
    "&a ",
    "*a",
    "!!int ",
    "- ",
    ": ",
    "{",
    "}",
    "[",
    "]",
    "\n",
    "\t",
    "#",
    "|",
    ">",
    "'",
    '"',
    "<<: ",
    "---\n",
]
YAML_PIECES += ["%YAML 1.1\n", "1e-3", ".inf", "0x10", "1_000", "~", "? ", "\\x00", "9" * 400, "[" * 60]
ANY = st.one_of(st.text(), st.binary().map(lambda raw: raw.decode("latin-1")))
SPEC = st.one_of(mutated(), mutated(), edited(TEXTS, YAML_PIECES), VALUES.map(json.dumps), ANY)
MDL_PIECES = [
    *PIECES,
    '*Include( "x" )\n',
    "{",
    "`",
    "1/0",
    "9^9^9",
    "(" * 300,
    "*if( 1 )\n",
    "*EndDefine()\n",
    "e+400",
]
TEXT = st.one_of(edited(MDL, MDL_PIECES), edited(MDL, MDL_PIECES), ANY)


SOLIDS = [brick(4.0, 6.0, 10.0), cylinder(7.5, 5.0, 8)]
FORMS = {"part.stl": binary, "part.STL": lambda *solid: ascii_stl(*solid).encode()}
FORMS["part.obj"] = lambda *solid: obj(*solid).encode()
FLOATS = [float("nan"), float("inf"), -1e38, 1e-45, -0.0, 9.0]
MESH_PIECES = [struct.pack("<f", v).decode("latin-1") for v in FLOATS]
MESH_PIECES += [struct.pack("<I", n).decode("latin-1") for n in (0, 1, 11, 13, 2**31, 2**32 - 1)]
MESH_PIECES += [
    "solid x\n",
    "endsolid",
    "facet normal 0 0 1\n",
    "outer loop",
    "endloop",
    "endfacet",
    "vertex ",
]
MESH_PIECES += [
    " 1e400 ",
    " nan ",
    "-inf",
    "1_0",
    "9" * 5000,
    "\n",
    "\r",
    "\0",
    "#",
    " ",
    "\\\n",
    "f 1 2 3\n",
]
MESH_PIECES += [
    "f -1 -2 -3\n",
    "f 1/2/3 2//3 3/ 0\n",
    f"f 1 2 {2**32}\n",
    "v 1 2\n",
    "v nan 0 0\n",
    "l 1 2\n",
]


@st.composite
def bent(draw: st.DrawFn) -> tuple[str, bytes]:
    """A closed surface some of whose corners are moved: flat, through itself, inside out, or too large."""
    corners, triangles = draw(st.sampled_from(SOLIDS))
    corners = corners.copy()
    number = st.one_of(st.integers(-12, 12), st.floats(-20.0, 20.0), NUMBERS.filter(lambda v: abs(v) < 1e38))
    for _ in range(draw(st.integers(0, 4))):
        corners[draw(st.integers(0, len(corners) - 1)), draw(st.integers(0, 2))] = draw(number)
    name = draw(st.sampled_from(sorted(FORMS)))
    return name, FORMS[name](corners, triangles)


@st.composite
def mesh_bytes(draw: st.DrawFn) -> tuple[str, bytes]:
    """The file of a mesh with pieces put in, doubled and left out."""
    name = draw(st.sampled_from(sorted(FORMS)))
    texts = [FORMS[name](*solid).decode("latin-1") for solid in SOLIDS]
    return name, draw(edited(texts, MESH_PIECES)).encode("latin-1", "replace")


MESH = st.one_of(bent(), mesh_bytes(), st.tuples(st.sampled_from(sorted(FORMS)), st.binary()))
MESHED = on_paper(
    """
name: meshed
materials: {{m: PLATE_PAPER}}
sheets: {{note: {{material: m, size: [40 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [2, 2]}}}}
rollers:
  r: {{center: [0 mm, 0 mm, -8 mm], axis: y, radius: 7 mm, width: 5 mm, mass: 1 g, drive: {{speed: 9 rad/s}}}}
meshes: {{part: {{file: {file}, units: {units}, center: [0 mm, 0 mm, -5.04 mm]{on}}}}}
contacts: [{{between: [note, part], stiffness: 30 N/mm^1.5, friction: 0.2}}]
""",
    template=True,
)


def command(*args: str) -> tuple[int, str]:
    """Exit code and standard error of a command in this process, within its time and memory."""
    out, err = io.StringIO(), io.StringIO()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    started = time.process_time()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            app(list(args), prog_name="mdlgen")
        except SystemExit as ended:
            assert isinstance(ended.code, int)
            code = ended.code
        else:
            code = 0
    assert time.process_time() - started < MOST_TIME
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024 < MOST_MEMORY
    assert "Traceback" not in err.getvalue()
    return code, err.getvalue()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where scenes are written; what is compiled for the first run is compiled before times are taken, and
    cycles are collected as rarely as a command has it."""
    gc.set_threshold(MANY)
    short = ["run.duration=0.5 ms", "run.step=0.1 ms"]
    mdlgen.solve(mdlgen.lower(mdlgen.load(samples() / "verify" / "drop.yaml", short)), "lattice")
    return tmp_path_factory.mktemp("fuzz")


def clear(folder: Path) -> None:
    for path in sorted(folder.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()


SHORT = ["--set", "run.duration=0.5 ms", "--set", "run.step=0.1 ms", "--solver", "lattice"]


@pytest.mark.filterwarnings("error")
@pytest.mark.filterwarnings("default::UserWarning")
@FUZZ
@given(text=SPEC, run=st.integers(0, 9))
def test_scenes(folder: Path, text: str, run: int) -> None:
    clear(folder)
    spec = folder / "scene.yaml"
    spec.write_bytes(text.encode("utf-8", "surrogatepass"))
    code = through(spec)
    if run == 0 and code == 0 and "static" not in text:  # SHORT heals what is wrong with a run
        solved(spec)


@pytest.mark.filterwarnings("error")
@pytest.mark.filterwarnings("default::UserWarning")
@FUZZ
@given(mesh=MESH, on=st.booleans(), units=st.sampled_from(["mm", "mm", "cm", "in"]), run=st.integers(0, 19))
def test_meshes(folder: Path, mesh: tuple[str, bytes], on: bool, units: str, run: int) -> None:
    clear(folder)
    name, raw = mesh
    (folder / name).write_bytes(raw)
    spec = folder / "scene.yaml"
    more = ", on: r, density: 1 g/cm^3" if on else ""
    spec.write_text(MESHED.format(file=name, units=units, on=more))
    if checked(spec) == 0:
        closed(mdlgen.load(spec).meshes["part"].solid)
        if run <= 1:  # a file is read once, and the text names it
            through(spec)
        if run == 0:
            solved(spec)


def closed(solid: Solid) -> None:
    """Each side once there and once back, and something inside."""
    assert np.isfinite(solid.corners).all() and signed_volume(solid.corners, solid.triangles) > 0.0
    sides = [(t[k], t[k - 2]) for t in solid.triangles.tolist() for k in range(3)]
    assert len(set(sides)) == len(sides) and {(b, a) for a, b in sides} == set(sides)


def one_line(err: str, spec: Path) -> bool:
    """Whether each mistake has a line, 20 of them at most; one more says how many are left."""
    lines = err.splitlines()
    own = [line for line in lines if line.startswith((str(spec), "mdlgen: "))]
    return 1 <= len(own) <= 20 and len(lines) - len(own) <= (1 if len(own) == 20 else 0)


def checked(spec: Path) -> int:
    """Exit code of check."""
    code, err = command("check", str(spec), "-q")
    assert code in (0, 2), err
    assert code == 0 or one_line(err, spec), err
    return code


def through(spec: Path) -> int:
    """Exit code of check, after text, deck and script of the scene; of one that another process does, 2."""
    if next(NUMBER) % PARTS != PART:
        return 2
    folder, code = spec.parent, checked(spec)
    for name in ("mdl", "deck", "script"):
        file = folder / f"out.{name}"
        ended, err = command(
            name,
            str(spec),
            "-q",
            "-o",
            str(file),
            *(["--companion", str(folder / "out.py")] if name == "mdl" else []),
        )
        # what cannot be read cannot be written, and what can may still be refused by name
        assert ended in ((0, 2) if code == 0 else (2,)), err
        assert ended == 0 or one_line(err, spec), err
        assert file.exists() == (ended == 0)
        if ended == 0:
            # as a word of its own, and not one that the scene has as a name
            assert not NAN.search(file.read_bytes()) or NAN.search(spec.read_bytes())
            assert name != "mdl" or command("lint", str(file), "-q")[0] == 0
    assert not [*folder.rglob(".*")]  # nothing that is half written
    return code


def solved(spec: Path) -> None:
    """Runs a scene for a short while."""
    folder = spec.parent
    ended, err = command("run", str(spec), "-q", "-o", str(folder / "d"), *SHORT)
    # 5: it ran, and its files stand, but missed its tolerance; 6: or what the scene requires
    assert ended in (0, 2, 4, 5, 6), err
    assert ended == 0 or one_line(err, spec), err
    # 4: what there is up to where it ended early, if it began
    written = (folder / "d" / "summary.json").exists()
    assert written == (ended in (0, 5, 6)) or ended == 4


@pytest.mark.filterwarnings("error")
@FUZZ
@given(text=TEXT)
def test_texts(folder: Path, text: str) -> None:
    clear(folder)
    file = folder / "text.mdl"
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    code, err = command("lint", str(file), "-q", "--values", str(folder / "values.json"))
    assert code in (0, 2), err
    if (folder / "values.json").exists():
        json.loads((folder / "values.json").read_text(), parse_constant=pytest.fail)


def test_the_samples_that_are_mutated_run(folder: Path) -> None:
    """Else the above would only see refusals."""
    for scene in SCENES:
        assert mdlgen.lower(mdlgen.loads(json.dumps(scene))).name
    spec = folder / "whole.yaml"
    spec.write_text(json.dumps(SCENES[0]))
    assert command("check", str(spec), "-q")[0] == 0
