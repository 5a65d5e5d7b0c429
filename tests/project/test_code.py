"""What the code is to look like, where a linter does not see it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from places import ROOT

# the house's own words for what the field has a word for
PRIVATE = re.compile(
    r"\b(told|settle|settled|march|seal|sealed|knob|knobs|foot|feet|piled|plant|deal|chatter)\b", re.I
)
FOLDERS = ("mdlgen", "backends", "docs/_generate", "tests")
MOST_PARAMETERS = 9
# arrays of kernels whose columns have names
NAMED = {
    *("arc", "clutch", "counters", "energies", "factored", "law", "out", "pace", "press", "results", "rim"),
    *("rows", "sums", "totals"),
}
MOST_LINES = 400


@cache
def sources(*folders: str) -> dict[str, str]:
    """Python files by their paths in the checkout."""
    files = (file for folder in folders for file in (ROOT / folder).rglob("*.py"))
    link = ROOT / "mdlgen" / "backends"
    return {
        file.relative_to(ROOT).as_posix(): file.read_text("utf-8")
        for file in files
        if link not in file.parents
    }


def names(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Identifiers and docstrings of a module, each with its line."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield getattr(node, "lineno", 1), ast.get_docstring(node) or ""
        for field in ("name", "id", "attr", "arg", "asname"):
            if isinstance(name := getattr(node, field, None), str):
                yield getattr(node, "lineno", 1), name


def test_names_and_docstrings_have_the_words_of_the_field() -> None:
    found = [
        f"{file}:{line}: {words}"
        for file, text in sources(*FOLDERS).items()
        for line, name in names(ast.parse(text))
        if (words := ", ".join(PRIVATE.findall(name)))
    ]
    assert found == []


def kernels(tree: ast.AST) -> Iterator[ast.FunctionDef]:
    """Functions that numba can compile."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and any("njit" in ast.unparse(d) for d in node.decorator_list):
            yield node


def test_no_kernel_has_many_parameters() -> None:
    counts = {
        f"{file}:{kernel.name}": len(kernel.args.args)
        for file, text in sources("mdlgen", "backends").items()
        for kernel in kernels(ast.parse(text))
    }
    assert len(counts) > 200
    assert {name: count for name, count in counts.items() if count > MOST_PARAMETERS} == {}


def bare(index: ast.expr) -> bool:
    """Whether a column is a number, or so many behind a number that is no name."""
    column = index.elts[-1] if isinstance(index, ast.Tuple) else index
    if isinstance(column, ast.BinOp):
        names = [node.id for node in ast.walk(column) if isinstance(node, ast.Name)]
        return isinstance(column.right, ast.Constant) and not any(name.strip("_").isupper() for name in names)
    return isinstance(column, ast.Constant)


def test_columns_that_have_a_name_are_called_by_it() -> None:
    found = [
        f"{file}:{node.lineno}: {ast.unparse(node)}"
        for file, text in sources("mdlgen/mechanics", "backends").items()
        for kernel in kernels(ast.parse(text))
        for node in ast.walk(kernel)
        if isinstance(node, ast.Subscript) and bare(node.slice)
        if getattr(node.value, "attr", getattr(node.value, "id", "")) in NAMED
    ]
    assert found == []


def test_no_file_is_long() -> None:
    counts = {file: len(text.splitlines()) for file, text in sources(*FOLDERS).items()}
    generated = {file for file in counts if Path(file).parts[:2] == ("tests", "golden")}
    assert {f: n for f, n in counts.items() if n > MOST_LINES and f not in generated} == {}


def test_the_list_of_a_release_names_tests_once() -> None:
    names = [line for line in (ROOT / "tests/release.txt").read_text("utf-8").splitlines() if "::" in line]
    assert len(names) == len(set(names)) > 0
    for name in names:
        file, test = name.split("::")
        assert f"def {test.split('[')[0]}(" in (ROOT / file).read_text("utf-8"), name
