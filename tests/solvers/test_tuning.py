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


def assigned(tree: ast.Module) -> list[tuple[list[str], ast.expr, int]]:
    """Assignments of a module to names in capitals: the names, the value, the line."""
    found = []
    for node in tree.body:
        if not isinstance(node, (ast.Assign, ast.AnnAssign)) or node.value is None:
            continue
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        names = [n.id for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)]
        if names and all(name.isupper() for name in names):
            found.append((names, node.value, node.lineno))
    return found


def numbers(value: ast.expr) -> list[float]:
    """Numbers of an assignment that do not name columns, states or bits: whole ones from 0 or 1 on."""
    parts = value.elts if isinstance(value, ast.Tuple) else [value]
    known = (ast.Constant, ast.UnaryOp, ast.BinOp, ast.operator, ast.unaryop)
    if not all(isinstance(n, known) for part in parts for n in ast.walk(part)):
        return []
    found = [eval(compile(ast.Expression(part), "", "eval")) for part in parts]
    if not all(isinstance(v, (int, float)) for v in found):
        return []
    names = all(isinstance(v, int) for v in found) and min(found) <= 1 and len(set(found)) >= len(found) - 1
    return found if any(found) and not names else []


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda p: str(p.relative_to(ROOT)))
def test_no_other_file_has_such_a_number(path: Path) -> None:
    if path.samefile(tuning.__file__) or path == ROOT / "kernels" / "state.py":
        return
    for names, value, _ in assigned(ast.parse(path.read_text("utf-8"))):
        if not set(names) <= LAYOUT.get(path.name, set()):
            assert not numbers(value), f"{path.name}: {names} stands outside of tuning.py"


def test_what_counts_as_a_number() -> None:
    def of(text: str) -> bool:
        return bool(numbers(ast.parse(text).body[0].value))  # pyright: ignore

    assert all(map(of, ("A = 8", "A, B = 8, 5", "A = 1.0 / 3.0", "A: float = 2.0**-52", "A, B = 1.0, 0.3")))
    assert not any(map(of, ("A, B, C = 0, 1, 2", "A, B = 1, 0", "A = -1", "A = 2.0 * B", "A = None")))


def test_each_number_has_an_origin_and_is_used_once_named() -> None:
    lines, seen = SOURCE.splitlines(), []
    for names, _, line in assigned(ast.parse(SOURCE)):
        at, comment = line - 2, []
        while lines[at].startswith("#") and not lines[at].startswith("# --"):
            comment.insert(0, lines[at][2:])
            at -= 1
        text = " ".join(comment)
        origin = r"(\[[^]]+\][^.]*[. ])?.{0,20}(Derived|Measured|Convention)\b"
        assert re.match(origin, text), (names, text)
        seen += names
    assert len(seen) == len(set(seen)) <= MOST
    used = set()
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.endswith("kernels.tuning"):
                used |= {name.name for name in node.names}
            if (
                isinstance(node, ast.Attribute)
                and isinstance(node.value, ast.Name)
                and node.value.id == "tuning"
            ):
                used.add(node.attr)
    assert sorted(set(seen) - used) == []
