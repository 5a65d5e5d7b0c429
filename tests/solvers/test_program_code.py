"""Code of a shipped program: its parts, what it gives beside that of numba, its files and its cache."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic import moving, small_model

from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.paths import samples
from mdlgen.program import build, compare, emit, file, layout, native, parts
from mdlgen.program.file import Unfit
from mdlgen.program.layout import Misfit
from mdlgen.results.estimates import between

CALLS = """
@table = internal constant [2 x double] [double 2.0, double 3.0]
define internal fastcc double @twice(double %x) noinline {
  %y = load double, ptr @table
  %z = fmul double %x, %y
  ret double %z
}
define internal fastcc double @0(double %x) noinline {
  %y = call fastcc double @twice(double %x)
  %z = fadd double %y, 1.0
  ret double %z
}
define double @one(double %x) {
  %y = call fastcc double @0(double %x)
  ret double %y
}
define double @two(double %x) {
  %y = call fastcc double @twice(double %x)
  %z = call fastcc double @0(double %y)
  ret double %z
}
"""


@pytest.mark.parametrize("count", [1, 2, 3, 9])
@pytest.mark.parametrize(("processors", "apart"), [(1, True), (2, True), (2, False)])
def test_parts_of_a_module_call_each_other(
    monkeypatch: pytest.MonkeyPatch, count: int, processors: int, apart: bool
) -> None:
    import llvmlite.binding as llvm

    target = emit.host()
    if apart and target.form != emit.APART:
        pytest.skip("one object file is made of a program here")
    target = target._replace(form=emit.APART if apart else emit.JOINED)
    monkeypatch.setattr(parts, "WORTH", 0)
    monkeypatch.setattr(parts, "OWN", 0)
    monkeypatch.setattr(native, "processors", lambda: processors)
    bitcodes = parts.split(llvm.parse_assembly(CALLS), count)
    assert len(bitcodes) == count
    codes = native.emitted(target, bitcodes, range(count if apart else 1))
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), emit.machine(target))
    for code in codes:
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    kind = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
    one, two = (kind(engine.get_function_address(name)) for name in ("one", "two"))
    assert (one(5.0), two(5.0)) == (11.0, 21.0)


@pytest.mark.parametrize("harm", ["no python", "one that fails", "one that says nothing"])
def test_a_part_that_no_other_process_makes_is_made_here(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, harm: str
) -> None:
    import llvmlite.binding as llvm

    bitcode = llvm.parse_assembly("define double @one(double %x) {\n  ret double %x\n}\n").as_bitcode()
    script = tmp_path / "emit.py"
    script.write_text("raise SystemExit(3)" if harm == "one that fails" else "")
    monkeypatch.setattr(native, "processors", lambda: 2)
    if harm == "no python":
        monkeypatch.setattr(sys, "executable", str(tmp_path / "none"))
    else:
        monkeypatch.setattr(emit, "__file__", str(script))
    target = emit.host()._replace(form=emit.APART)
    first, second = native.emitted(target, [bitcode, bitcode], (0, 1))
    assert first == second and len(first) > 100


def test_every_sample_is_compared() -> None:
    there = {path.relative_to(samples()).with_suffix("").as_posix() for path in samples().rglob("*.yaml")}
    assert compare.CALM.keys() | compare.RATTLING.keys() == there
    assert not compare.CALM.keys() & compare.RATTLING.keys()
    assert compare.EXUDYN.keys() <= there


@pytest.mark.skipif(
    not os.environ.get("MDLGEN_COMPARE"), reason="numba compiles for minutes: MDLGEN_COMPARE=1"
)
@pytest.mark.parametrize(
    ("solver", "names"), [("lattice", compare.CALM | compare.RATTLING), ("exudyn", compare.EXUDYN)]
)
def test_samples_run_as_shipped_as_by_numba(solver: str, names: dict[str, tuple[str, ...]]) -> None:
    """Places agree to 1e-9 of the travel; where contacts rattle, all with an estimate to that."""
    rows = list(compare.compared(solver, names, 1))
    assert [row.name for row in rows] == list(names)
    assert [str(row) for row in rows if not row.same] == []


def test_a_comparison_sees_what_differs() -> None:
    model = small_model()
    estimates = between([moving(model)])
    travel = estimates["sheets.note.position"].scale
    boxes = slice(model.sheets[0].first, model.sheets[0].first + model.sheets[0].count)
    force = next(name for name in estimates if name.endswith("support.max_force"))

    def run(off: float = 0.0, took: float = 1.0, **more: Any) -> compare.Run:
        result = replace(moving(model), **more)
        result.position[:, boxes, 2] += off
        result.estimates = {
            name: replace(found, value=1e-3 if name in ("sheets.note.position", force) else None)
            for name, found in estimates.items()
        }
        return compare.Run(result, took)

    for name, off, same in (
        ("transport_4x4", 0.9e-9, True),
        ("transport_4x4", 1.1e-9, False),
        ("pick", 1.9e-3, True),  # less than twice the estimate
        ("pick", 2.1e-3, False),
    ):
        row = compare._row("lattice", name, [[run()] * 5, [run(off * travel, 0.9)] * 5])
        assert row.same == same, row
        assert row.slower == (name == "transport_4x4")
        assert not compare._row("lattice", name, [[run()], [run(off * travel, 0.9)]]).slower
    for name in ("transport_4x4", "pick"):
        assert compare._row("lattice", name, [[run()], [run(steps=6)]]).same == (name == "pick")
    turned = moving(model).rotation + 2e-9
    assert not compare._row("lattice", "transport_4x4", [[run()], [run(rotation=turned)]]).same
    # of what run.tolerance does not judge, each that has an estimate
    for part, same in ((1.9e-3, True), (2.1e-3, False)):
        statistics = moving(model).statistics
        statistics.max_force[-1] += part * estimates[force].scale
        row = compare._row("lattice", "pick", [[run()], [run(statistics=statistics)]])
        assert (row.same, row.of) == (same, force)
    slid = moving(model)
    roller = next(each for each in model.rollers if each.press is not None)
    slid.position[:, roller.body] += roller.press.direction * 2.1e-4 * travel
    row = compare._row("lattice", "pick", [[run()], [run(position=slid.position)]])
    assert (row.same, row.of) == (False, f"rollers.{roller.name}.slide")  # judged, without an estimate
    failed = run(status="no convergence")
    assert not compare._row("lattice", "pick", [[failed], [failed]]).same


def test_a_process_runs_a_sample_by_the_code_that_it_is_asked_for() -> None:
    if not PROGRAM.code().startswith("shipped"):
        pytest.skip(f"the program of this machine is {PROGRAM.code()}")
    process = compare.Process("shipped")
    try:
        run = process.run("lattice", "transport_4x4", ("run.duration=1 ms", "run.step=0.1 ms"))
    finally:
        process.close()
    assert (run.result.status, run.result.steps) == ("ok", 10)
    assert run.took > 0.0 and len(run.result.position) > 2


def test_types_are_reported_and_checked() -> None:
    kind = layout.described((np.zeros((2, 3)), 1.5, 2, True))
    assert kind == ["tuple", [["array", "<f8", 2, "C", True], "f8", "i8", "b1"]]
    assert layout.words(kind) == 9 + 3
    for value in (None, "text", [1.0], 1j, np.zeros(3)[None].T[::-1].view("V4")):
        if not isinstance(value, np.ndarray):
            with pytest.raises(Misfit):
                layout.described(value)
    write, buffer = layout.writer(kind, 0), bytearray(8 * 12)
    write(buffer, (np.zeros((2, 3)), 1.5, 2, True))
    frozen = np.zeros((2, 3))
    frozen.setflags(write=False)
    for wrong in (
        (np.zeros((2, 3)), 1.5, 2.5, True),
        (np.zeros((2, 3)), True, 2, True),
        (np.zeros((2, 3)), 1.5, 2, 1),
        (np.zeros((2, 3)), 1.5, 2),
        (np.zeros((3, 2)).T, 1.5, 2, True),
        (np.zeros((2, 3), np.float32), 1.5, 2, True),
        (np.zeros(6), 1.5, 2, True),
        (frozen, 1.5, 2, True),
    ):
        with pytest.raises(Misfit):
            write(buffer, wrong)


def test_a_file_that_is_none_is_reported(tmp_path: Path) -> None:
    for raw in (b"", b"{}\n", b'{"format": 1}\n', b"[1]\n", b'{"format": 2}\nx', b"\xff\xfe\n"):
        (tmp_path / "a.program").write_bytes(raw)
        with pytest.raises(Unfit, match=r"damaged|another form"):
            file.read(tmp_path / "a.program")
    with pytest.raises(Unfit, match=r"there is no b\.program"):
        file.read_head(tmp_path / "b.program")


def test_the_cache_is_shown_and_cleared(tmp_path: Path) -> None:
    home = tmp_path / "cache"
    (home / "programs").mkdir(parents=True)
    (home / "programs" / "lattice.o").write_bytes(bytes(2_000_000))
    (home / "letter.txt").write_text("not ours")

    def command(*args: str) -> tuple[int, str]:
        done = subprocess.run(
            [sys.executable, "-m", "mdlgen", "cache", *args],
            env={**os.environ, "MDLGEN_CACHE": str(home)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.stderr == ""
        return done.returncode, done.stdout

    assert command() == (0, f"{home}: 2.0 MB\n")
    assert command("--clear") == (0, "removed 2.0 MB\n")
    assert [path.name for path in home.iterdir()] == ["letter.txt"]
    code, out = command("--check")
    fits = [program.head for program in build.programs()]
    assert code == (0 if all(_fits(head) for head in fits) else 3)
    assert len(out.splitlines()) == len(fits)


def _fits(head: Any) -> bool:
    try:
        head()
    except Unfit:
        return False
    return True
