"""The bench of the numbers: a module reads its numbers from the table after the change, and each outcome
stands in the right part of the report. No kernel is compiled here."""

from __future__ import annotations

import ast
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from mdlgen.bench.tuning import run as runs
from mdlgen.bench.tuning import varied
from mdlgen.bench.tuning.numbers import Number, at_import, numbers, parsed
from mdlgen.bench.tuning.report import deciding, page, said, table, unused
from mdlgen.bench.tuning.row import CUT, Outcome, Reference, Tuning, TuningRow
from mdlgen.bench.tuning.scenes import SCENES
from mdlgen.bench.tuning.worker import Found, compared
from mdlgen.cli import app

MODULE = """
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.tuning import TRIANGLES, CLOSER as SHARE

ROWS = 2 * TRIANGLES

def njit(**options):
    return lambda function: (function, options)

@njit(cache=True, error_model="numpy")
def kernel(x, part=SHARE):
    return [SHARE * x for _ in range(TRIANGLES)], tuning.CLOSER, (lambda: SHARE)()
"""
FILE = """
# [mm] Convention: a length.
LENGTH = 0.5

# -- A head
# Measured at an earlier state: two counts.
MANY, FEW = 8, 3

# Derived: of a double.
SMALL = 2.0**-52
"""


def test_the_file_of_numbers_is_read_with_units_and_origins() -> None:
    assert parsed(FILE) == [
        Number("LENGTH", 0.5, "[mm]", "Convention"),
        Number("MANY", 8, "", "Measured"),
        Number("FEW", 3, "", "Measured"),
        Number("SMALL", 2.0**-52, "", "Derived"),
    ]


def test_each_number_of_the_solver_has_an_origin_and_few_are_frozen() -> None:
    found = numbers()
    assert len(found) > 100 and all(number.origin for number in found)
    frozen = {number.name: number.frozen for number in found if number.frozen}
    assert "mixing.py" in frozen["MIXED"], "it gives the size of an array at import"
    assert len(frozen) < 0.1 * len(found)


def test_a_count_stays_a_count() -> None:
    assert Number("A", 5).times(0.5) == 2 and Number("A", 1).times(0.5) == 1
    assert Number("A", 5.0).times(0.5) == 2.5


def test_numbers_in_functions_are_read_from_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = varied.varying(MODULE, {"CLOSER": 0, "TRIANGLES": 1}, {"TRIANGLES"})
    monkeypatch.setattr(varied, "TABLE", np.array([0.25, 3.0]))
    scope: dict[str, Any] = {varied.NAME: varied.TABLE}
    exec(compile(tree, "module", "exec"), scope)
    kernel, options = scope["kernel"]
    assert options == {"error_model": "numpy"}, "code that holds an address is not cached"
    assert scope["ROWS"] == 2 * scope["TRIANGLES"], "at import the module's own number counts"
    assert kernel(2.0) == ([0.5] * 3, 0.25, 0.25)
    varied.TABLE[:] = 0.5, 2.0
    assert kernel(2.0) == ([1.0] * 2, 0.5, 0.5)


def test_numbers_that_are_read_at_import_are_found() -> None:
    assert at_import(ast.parse(MODULE), {"CLOSER", "TRIANGLES"}) == [("TRIANGLES", 5), ("CLOSER", 11)]


def test_numba_reads_the_table_by_its_address() -> None:
    """The least size is that of `make_constant_array` of numba's BaseContext."""
    assert varied.TABLE.nbytes > 10**6


def test_the_solver_must_not_be_imported_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mdlgen.backends.lattice", np)
    before = list(sys.meta_path)
    with pytest.raises(RuntimeError, match="imported already"):
        varied.install([])
    assert sys.meta_path == before


def test_there_are_twelve_scenes_three_with_the_step_searched() -> None:
    models = [scene.model() for scene in SCENES]
    assert len(models) == len({scene.name for scene in SCENES}) == 12
    moving = [model for model in models if model.run.analysis != "static"]
    assert sum(model.run.step is None for model in moving) == 3


def states(end: float) -> Found:
    """A run of one body, which moves along x to `end` [mm]."""
    place = np.array([[[0.0, 0.0, 0.0]], [[end, 0.0, 0.0]]])
    return Found("ok", True, 10, 40, (np.array([0.0, 1.0]), place, place, place, place), 0.1)


def test_a_run_is_compared_with_its_reference() -> None:
    same = compared("a", 2.0, states(2.0), states(2.0))
    assert same.same and not same.decided and same.moved == 0.0 and same.iterations == 1.0
    other = compared("a", 2.0, states(2.0), states(2.2)._replace(iterations=20))
    assert not other.same and other.moved == pytest.approx(0.1) and other.iterations == 0.5
    ends = compared("a", 2.0, states(2.0), states(2.0)._replace(status="too deep", ended=False))
    assert ends.decided and ends.moved is None and not ends.same
    cut = compared("a", 2.0, states(2.0), CUT)
    assert cut.decided and cut.status == CUT and not cut.ended


def made() -> Tuning:
    """One number of each kind on two scenes."""

    def alike(scene: str) -> Outcome:
        return Outcome(scene, "ok", True, False, True, 0.0, 1.0, 1.0)

    changed = Outcome("air", "ok", True, False, False, 0.02, 1.5, 1.0)
    cut = Outcome("stack", CUT, False, True)
    found = [
        Number("IDLE", 2.0),
        Number("DECIDES", 8),
        Number("MOVES", 0.5, "[mm]"),
        Number("FIXED", 5, "", "", "why"),
    ]
    both = (alike("air"), alike("stack"))
    rows = [TuningRow("IDLE", 0.5, 1.0, both), TuningRow("IDLE", 2.0, 4.0, both)]
    rows += [TuningRow("DECIDES", 0.5, 4, (alike("air"), cut)), TuningRow("DECIDES", 2.0, 16, both)]
    rows += [TuningRow("MOVES", 0.5, 0.25, (changed, alike("stack"))), TuningRow("MOVES", 2.0, 1.0, both)]
    return Tuning(found, references=[Reference("air", "air", "ok", True, 10, 40, 1.0, 0.1)], rows=rows)


def test_each_number_stands_where_it_belongs() -> None:
    found = made()
    assert [number.name for number in unused(found)] == ["IDLE"]
    assert [number.name for number in deciding(found)] == ["DECIDES"]
    text = table(found)
    assert "- `DECIDES` = 4 (x 0.5): stack (cut)" in text
    assert "| `MOVES` | 0.5 [mm] |  | 3/4 | 2.0e-02 air | 1.50 air |  |  |" in text
    assert "- `FIXED`: why" in text and "interrupted" not in text
    assert page(found).startswith("# Numbers of the solver") and page(found).endswith("\n")
    assert said(found.rows[2]) == "DECIDES x 0.5: changes 1 of 2 scenes, decides whether a run ends: stack"
    found.rows = found.rows[:2]
    assert "2 numbers have no result yet" in table(found)


def test_the_command_writes_its_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found, shown = made(), tmp_path / "tuning.md"
    monkeypatch.setattr(runs, "numbers", lambda: found.numbers)
    monkeypatch.setattr(runs, "_messages", lambda: iter([*found.references, *found.rows]))
    command = ["bench", "tuning", "-o", str(tmp_path / "out"), "--page", str(shown)]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert (tmp_path / "out" / "tuning.md").read_text("utf-8") in done.output
    assert len(json.loads((tmp_path / "out" / "tuning.json").read_text("utf-8"))["rows"]) == 6
    assert "# Numbers of the solver" in shown.read_text("utf-8")


@pytest.mark.parametrize("words", [["--quick"], ["--solver", "lattice"], ["--only", "1"], ["--sticking"]])
def test_options_of_other_suites_are_refused(words: list[str], tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["bench", "tuning", *words, "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and "tuning takes the options" in done.output


def test_it_runs_alone(tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["bench", "tuning", "impact", "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and "tuning runs alone" in done.output


def test_without_numba_one_line_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "numba", None)
    done = CliRunner().invoke(app, ["bench", "tuning", "-o", str(tmp_path / "out")])
    assert done.exit_code != 0 and "mdlgen[compile]" in done.output and "Traceback" not in done.output
