"""The notebooks of the manual: their cells run one after the other, and they are stored without outputs."""

from __future__ import annotations

import ast
import json
import time
from pathlib import Path
from typing import Any

import pytest
from places import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
MOST = 10.0  # [s]


def run(cell: str, space: dict[str, Any], name: str) -> object:
    """Runs a cell as a notebook does; the value of its last expression."""
    tree = ast.parse(cell, name)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, name, "exec"), space)
    return None if last is None else eval(compile(ast.Expression(last.value), name, "eval"), space)


def test_there_are_two() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["friction", "nip"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    record = json.loads(path.read_text("utf-8"))
    cells = [cell for cell in record["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells), "store it without outputs"
    space: dict[str, Any] = {"__name__": "__main__"}
    started = time.process_time()
    shown = [run("".join(cell["source"]), space, f"{path.name}:{k}") for k, cell in enumerate(cells)]
    assert time.process_time() - started < MOST
    # what it is about is there to see
    assert any(hasattr(value, "_repr_png_") for value in shown)
    if path.stem == "nip":
        assert shown[1] == [] and [text[:4] for text in shown[2]] == ["W123"]
