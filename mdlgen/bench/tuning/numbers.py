"""The numbers of the file tuning.py of the lattice solver: value, unit, origin, and where they are read."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

PACKAGE = "mdlgen.backends.lattice"
MODULE = f"{PACKAGE}.kernels.tuning"
# The comment above a number: unit in brackets, origin, meaning.
COMMENT = re.compile(r"(?P<unit>\[.*?)?\b(?P<origin>Derived|Measured|Convention)\b")


@dataclass(frozen=True)
class Number:
    """A number of tuning.py. `frozen`: why it cannot be changed while the solver runs; empty if it can."""

    name: str
    value: float
    unit: str = ""
    origin: str = ""
    frozen: str = ""

    def times(self, factor: float) -> float:
        """The number times a factor; a count stays a count, and is 1 at least."""
        return max(1, round(self.value * factor)) if isinstance(self.value, int) else self.value * factor


def folder() -> Path:
    """The folder of the lattice solver. Imports nothing of it."""
    spec = find_spec(PACKAGE)
    assert spec is not None and spec.origin is not None
    return Path(spec.origin).parent


def numbers() -> list[Number]:
    """All numbers, in the order of their file, with why some cannot be varied."""
    root = folder()
    found = parsed((root / "kernels" / "tuning.py").read_text("utf-8"))
    names = {number.name for number in found}
    frozen: dict[str, str] = {number.name: "it is 0" for number in found if number.value == 0}
    for path in sorted(root.rglob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        for name, line in at_import(tree, names):
            frozen.setdefault(name, f"read at import, {path.relative_to(root).as_posix()}:{line}")
    return [Number(n.name, n.value, n.unit, n.origin, frozen.get(n.name, "")) for n in found]


def parsed(text: str) -> list[Number]:
    """The numbers that the text of tuning.py assigns."""
    lines, found = text.splitlines(), []
    for node in ast.parse(text).body:
        if not isinstance(node, ast.Assign):
            continue
        comment, at = [], node.lineno - 2
        while at >= 0 and lines[at].startswith("#") and not lines[at].startswith("# --"):
            comment.insert(0, lines[at][2:])
            at -= 1
        match = COMMENT.match(" ".join(comment))
        unit, origin = ((match["unit"] or "").strip(" ."), match["origin"]) if match else ("", "")
        both = zip(_parts(node.targets[0]), _parts(node.value), strict=True)
        for target, value in both:
            assert isinstance(target, ast.Name)
            found.append(Number(target.id, _value(value), unit, origin))
    return found


def _parts(node: ast.expr) -> list[ast.expr]:
    return node.elts if isinstance(node, ast.Tuple) else [node]


def _value(node: ast.expr) -> float:
    """The value of an expression of numbers alone."""
    allowed = (ast.Constant, ast.UnaryOp, ast.BinOp, ast.operator, ast.unaryop)
    assert all(isinstance(part, allowed) for part in ast.walk(node)), ast.unparse(node)
    return eval(compile(ast.Expression(node), "tuning", "eval"), {"__builtins__": {}})


def imported(tree: ast.Module, names: set[str]) -> tuple[dict[str, str], set[str]]:
    """How a module calls numbers of tuning.py: its name of each -> the number's; names of the file itself."""
    own: dict[str, str] = {}
    files: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                if node.module == MODULE and alias.name in names:
                    own[alias.asname or alias.name] = alias.name
                if f"{node.module}.{alias.name}" == MODULE:
                    files.add(alias.asname or alias.name)
    return own, files


def number_of(node: ast.AST, own: dict[str, str], files: set[str], names: set[str]) -> str | None:
    """The number that an expression reads, or None."""
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
        return own.get(node.id)
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in files:
        return node.attr if node.attr in names else None
    return None


def at_import(tree: ast.Module, names: set[str]) -> list[tuple[str, int]]:
    """Numbers that a module reads as it is imported, outside of functions or in their heads, with lines."""
    own, files = imported(tree, names)
    inside = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, (ast.FunctionDef, ast.Lambda))
        for piece in (node.body if isinstance(node.body, list) else [node.body])
        for part in ast.walk(piece)
    }
    found = []
    for node in ast.walk(tree):
        name = number_of(node, own, files, names)
        if name is not None and id(node) not in inside:
            assert isinstance(node, (ast.Name, ast.Attribute))
            found.append((name, node.lineno))
    return found
