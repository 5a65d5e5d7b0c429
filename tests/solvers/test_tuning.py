"""Numbers of the solver that are not physics stand in one file, each with its origin."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from mdlgen.backends.lattice.kernels import tuning

ROOT = Path(tuning.__file__).resolve().parents[1]
SOURCE = Path(tuning.__file__).read_text("utf-8")
# Of arrays and of the processor: not chosen, but what the words of a record and a vector are.
LAYOUT = {"band.py": {"PAD", "_VECTOR"}, "eight.py": {"EIGHT"}}
# 132 when they were first put together; each that goes lowers it.
MOST = 132


def assigned(tree: ast.Module) -> list[tuple[ast.Assign, list[str]]]:
    """Assignments of a module to names in capitals."""
    found = []
    for node in tree.body:
        if isinstance(node, ast.Assign):
            names = [n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name)]
            if names and all(name.isupper() for name in names):
                found.append((node, names))
    return found


def numbers(value: ast.expr) -> list[float]:
    """Numbers of an assignment that are no 0, 1, 2 ...: those name columns, states and bits."""
    parts = value.elts if isinstance(value, ast.Tuple) else [value]
    try:
        values = [ast.literal_eval(part) for part in parts]
    except ValueError:
        return []
    if not all(isinstance(v, (int, float)) for v in values):
        return []
    columns = all(isinstance(v, int) for v in values) and (len(values) > 1 or values[0] in (-1, 0, 1, 2))
    return values if any(values) and not columns else []


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda p: str(p.relative_to(ROOT)))
def test_no_other_file_has_such_a_number(path: Path) -> None:
    if path.name in ("tuning.py", "state.py", "arrays.py"):
        return
    for node, names in assigned(ast.parse(path.read_text("utf-8"))):
        if not set(names) <= LAYOUT.get(path.name, set()):
            assert not numbers(node.value), f"{path.name}: {names} stands outside of tuning.py"


def test_each_number_has_an_origin_and_is_used_once_named() -> None:
    lines, seen = SOURCE.splitlines(), []
    for node, names in assigned(ast.parse(SOURCE)):
        at, comment = node.lineno - 2, []
        while lines[at].startswith("#") and not lines[at].startswith("# --"):
            comment.insert(0, lines[at][2:])
            at -= 1
        text = " ".join(comment)
        assert re.match(r"(\[[^]]+\],? ?)*(, parts of a box\. )?(Derived|Measured|Convention)\b", text), (
            names,
            text,
        )
        seen += names
    assert len(seen) == len(set(seen)) <= MOST
    used = "\n".join(p.read_text("utf-8") for p in ROOT.rglob("*.py") if p.name != "tuning.py")
    assert [name for name in seen if not re.search(rf"\b{name}\b", used)] == []
