"""Files made to do harm: each ends with one line, exit code 2, and about as much work as a good one."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from forked import Commands, Ended
from solids import ascii_stl, binary, brick, obj

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.paths import samples
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.load import load, loads

SAMPLE = samples() / "transport_4x4.yaml"
TEXT = SAMPLE.read_text("utf-8")
CURVE = "E_md: 3530 MPa"
ONE = binary(*brick(4.0, 6.0, 10.0))


@pytest.fixture(scope="module")
def commands(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Commands]:
    made = Commands(tmp_path_factory.mktemp("printed"))
    yield made
    made.close()


def changed(old: str, new: str) -> str:
    assert old in TEXT
    return TEXT.replace(old, new, 1)


ATTACKS: dict[str, str] = {
    "alias bomb": "a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\n",
    "500-deep nesting": "a: " + "[" * 500 + "]" * 500,
    "5000-digit integer": changed("[10, 20]", f"[{'9' * 5000}, 20]"),
    "object": "name: !!python/object/apply:os.system ['id']\n",
    "duplicate key": changed("rollers:", "rollers:\n  a: 1\nrollers:"),
    "nan": changed("friction: 0.33", "friction: .nan"),
    "1e400": changed("friction: 0.33", "friction: 1e400"),
    "1e400 g": changed("0.72 g", "1e400 g"),
    "1e200 mm": changed("67 mm", "1e200 mm"),
    "1e-300 mm": changed("67 mm", "1e-300 mm"),
    "statement in a name": changed("  note:", '  "note\\"\\n*BeginMDL( x )":'),
    "U+2028": changed("  note:", '  "note\\u2028x":'),
    "name with a path": changed("name: transport_4x4", 'name: "../../x"'),
    "path with ..": changed(CURVE, "curve_md: {file: ../passwd}"),
    "symlink out": changed(CURVE, "curve_md: {file: out.csv}"),
    "absolute path": changed(CURVE, "curve_md: {file: /etc/passwd}"),
    "device file": changed(CURVE, "curve_md: {file: zero.csv}"),
    "named pipe": changed(CURVE, "curve_md: {file: pipe.csv}"),
    **{
        f"mesh: {what}": changed("rollers:", f"meshes: {{m: {{file: {file}}}}}\nrollers:")
        for what, file in {
            "2^32 triangles": "claims.stl",
            "no end": "endless.stl",
            "index out of range": "range.obj",
            "not a mesh at all": "text.obj",
            "too large": "large.stl",
            "symlink out": "out.stl",
            "folder": "folder.stl",
            "device file": "zero.stl",
            "named pipe": "pipe.stl",
            "path with ..": "../mesh.stl",
        }.items()
    },
    "1e10 boxes": changed("[10, 20]", "[100000, 100000]"),
    "1e9 outputs": changed("duration: 50 ms", "duration: 50 ms, print_step: 1e-5 ms"),
    "NUL": "\0" * 10_000,
    "a long line": changed("name:", f"{'k' * 1_000_000}: 1\nname:"),
}


def lay(folder: Path) -> None:
    """What the attacks name."""
    folder.mkdir()
    beside = folder.parent
    (beside / "passwd").write_text("0, 0 MPa\n")
    (beside / "mesh.stl").write_bytes(ONE)
    text, corners = ascii_stl(*brick(4.0, 6.0, 10.0)), obj(*brick(4.0, 6.0, 10.0))
    files: dict[str, str | bytes] = {
        "claims.stl": ONE[:80] + b"\xff\xff\xff\xff" + ONE[84:],
        "endless.stl": text.replace("endsolid", "facet") + "facet normal 0 0 0\n" * 100_000,
        "range.obj": corners + "f 1 2 11\n",
        "text.obj": TEXT,
        "large.stl": b"",
    }
    for name, content in files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    os.truncate(folder / "large.stl", 10**12)  # that takes no room
    targets = {
        "out.csv": "../passwd",
        "zero.csv": "/dev/zero",
        "out.stl": "../mesh.stl",
        "zero.stl": "/dev/zero",
    }
    for name, target in targets.items():
        (folder / name).symlink_to(target)
    for name in ("pipe.csv", "pipe.stl"):
        os.mkfifo(folder / name)
    (folder / "folder.stl").mkdir()


@pytest.fixture(scope="module")
def usual(tmp_path_factory: pytest.TempPathFactory, commands: Commands) -> Ended:
    """What a good scene takes."""
    return commands.run(tmp_path_factory.mktemp("usual"), "check", str(SAMPLE), "-q")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
@pytest.mark.parametrize("attack", ATTACKS)
def test_known_attacks(tmp_path: Path, attack: str, usual: Ended, commands: Commands) -> None:
    folder = tmp_path / "scene"
    lay(folder)
    (folder / "bad.yaml").write_text(ATTACKS[attack], "utf-8")
    before = sorted(p.name for p in folder.iterdir())
    ended = commands.run(folder, "mdl", "bad.yaml")
    assert (ended.code, ended.out) == (2, "")
    assert re.fullmatch(r"bad\.yaml:\d+:\d+: [^\n]+\n", ended.err), ended.err
    assert sorted(p.name for p in folder.iterdir()) == before
    # of the second for each the most is the start of the process
    assert ended.cpu < 3.0 * usual.cpu + 0.1
    assert ended.memory < 300.0


def test_many_values(tmp_path: Path, usual: Ended, commands: Commands) -> None:
    (tmp_path / "bad.yaml").write_text("a: [" + "1," * 900_000 + "]")
    ended = commands.run(tmp_path, "check", "bad.yaml")
    assert ended.code == 2 and "--limit values=50001" in ended.err
    assert ended.cpu < 8.0 * usual.cpu
    assert ended.memory < 300.0


def test_a_device_has_no_end(tmp_path: Path, commands: Commands) -> None:
    for command in ("check", "lint"):
        ended = commands.run(tmp_path, command, "/dev/zero")
        assert ended.code in (2, 3) and len(ended.err.splitlines()) == 1
        assert "larger than" in ended.err
        assert ended.memory < 500.0


def refused(text: str, *wishes: str) -> SpecError:
    with pytest.raises(SpecError) as refusal:
        mdlgen.lower(loads(text, limits=DEFAULT.raised(wishes)))
    return refusal.value


@pytest.mark.parametrize(
    ("wish", "path"),
    [
        ("boxes=199", ("sheets", "note", "boxes")),
        ("pairs=111", ("contacts", 4)),
        ("contacts=11", ("contacts", 4, "between")),
        ("states=5e3", ("run", "print_step")),
        ("values=200", ()),
    ],
)
def test_each_limit_is_named_and_can_be_raised(wish: str, path: tuple[Any, ...]) -> None:
    text = changed("duration: 50 ms", "duration: 50 ms, print_step: 1 ms")
    error = refused(text, wish)
    name = wish.partition("=")[0]
    assert f"--limit {name}=" in error.message
    assert error.path[:1] == path[:1]
    raised = re.search(rf"{name}=\S+", error.message)
    assert raised
    # what the message tells to write helps, in as many goes as there are entries to count
    for _ in range(400):
        try:
            mdlgen.lower(loads(text, limits=DEFAULT.raised([raised[0]])))
            return
        except SpecError as again:
            raised = re.search(rf"{name}=\S+", again.message)
            assert raised
    raise AssertionError(raised)


def test_boxes_of_all_sheets_count() -> None:
    scene = json.loads(json.dumps({"name": "many", "materials": {}, "sheets": {}}))
    scene["materials"]["m"] = {"E_md": "1 GPa", "E_cd": "1 GPa"}
    one = {"material": "m", "size": ["9 mm", "9 mm"], "thickness": "1 mm", "mass": "1 g", "boxes": [300, 200]}
    scene["sheets"] = {"a": one, "b": one}
    assert "boxes of all sheets: 120000, allowed are 100000" in refused(json.dumps(scene)).message


@pytest.mark.parametrize("wish", ["boxes", "boxes=", "boxes=-1", "boxes=0", "boxes=1e99", "boxes=nan", "x=1"])
def test_a_limit_is_a_name_and_a_count(wish: str) -> None:
    with pytest.raises(SpecError, match="NAME=COUNT"):
        DEFAULT.raised([wish])


@pytest.mark.parametrize(
    ("old", "new", "meant"),
    [
        ("thickness: 0.1 mm", "thickness: 0.1 m", "Did you mean 0.1 mm?"),
        ("thickness: 0.1 mm", "thickness: 100 mm", "Did you mean 0.1 mm?"),
        ("0.72 g", "0.72 gr", "did you mean g?"),
        ("3530 MPa", "3530 Mpa", "did you mean MPa?"),
        ("ramp: 5 ms", "ramp: 5 sec", "did you mean s?"),
        ("67 mm", "67 MM", "did you mean mm?"),
    ],
)
def test_slips_of_units(old: str, new: str, meant: str) -> None:
    assert meant in refused(changed(old, new)).message


SIZES = ("1e-19", "1e-9", "1e9", "1e19")


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(
    "old", ["67 mm", "0.72 g", "3530 MPa", "0.15 N*mm/rad", "7.5 mm", "300 N/mm^1.5", "186.7 rad/s"]
)
@pytest.mark.filterwarnings("error")
def test_extreme_values_end_in_one_line_or_a_text(old: str, size: str) -> None:
    unit = old.partition(" ")[2]
    try:
        assert "nan" not in mdlgen.emit(mdlgen.lower(loads(changed(old, f"{size} {unit}"))))
    except SpecError as error:
        assert "\n" not in str(error)


def test_byte_order_mark_and_other_line_ends(tmp_path: Path) -> None:
    wanted = mdlgen.emit(mdlgen.lower(load(SAMPLE)))
    kinds: dict[str, Callable[[str], str]] = {
        "dos": lambda text: "\ufeff" + text.replace("\n", "\r\n"),
        "mac": lambda text: text.replace("\n", "\r"),
    }
    for name, kind in kinds.items():
        (tmp_path / name).write_bytes(kind(TEXT).encode())
        assert mdlgen.emit(mdlgen.lower(load(tmp_path / name))) == wanted


def test_yaml_1_2_numbers() -> None:
    assert loads(changed("friction: 0.33", "friction: 1e-3")).contacts[5].friction.static == 1e-3


def test_too_little_memory_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from mdlgen import registry
    from mdlgen.cli import app

    def full(name: str) -> None:
        raise MemoryError

    monkeypatch.setattr(registry, "emitter", full)
    with pytest.raises(SystemExit) as ended:
        app(["mdl", str(SAMPLE), "-o", str(tmp_path / "t.mdl")], prog_name="mdlgen")
    assert ended.value.code == 4
    assert capsys.readouterr().err.count("\n") == 1


def test_an_interrupt_while_the_command_line_is_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    import mdlgen.__main__ as entry

    def interrupted() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("mdlgen.cli.main", interrupted)
    with pytest.raises(SystemExit) as ended:
        entry.main()
    assert ended.value.code == 130


def test_a_run_of_too_many_steps_is_refused() -> None:
    sets = ["run.duration=1e12 ms", "run.print_step=1e9 ms", "sheets.note.boxes=[2,2]"]
    with pytest.raises(SpecError, match="would take"):
        mdlgen.solve(mdlgen.lower(load(SAMPLE, sets)), "lattice")
