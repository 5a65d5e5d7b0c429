"""Makes the numbers of tuning.py variables, in one process.

Kernels hold global numbers as constants, so each change would take a new compilation of minutes. An import
hook therefore replaces each number in the body of a function by an element of the array TABLE. numba reads a
global array of more than a megabyte from memory and does not copy it into the code (see
`BaseContext.make_constant_array`), so a kernel that is compiled once follows changes of TABLE.

Nothing of the lattice solver may be imported before `install`.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import Any

import numpy as np

from mdlgen.bench.tuning.numbers import PACKAGE, Number, imported, number_of

# The name of TABLE in the modules that read it.
NAME = "__tuning_table__"
# Elements: above a megabyte numba refers to an array by its address.
TABLE = np.zeros(150_000)


class Varying(ast.NodeTransformer):
    """Replaces the numbers in the bodies of functions by elements of the table, and turns off the cache of
    compiled code, which would keep the address of TABLE."""

    def __init__(self, places: dict[str, int], whole: set[str], own: dict[str, str], files: set[str]):
        self._places, self._whole, self._own, self._files = places, whole, own, files
        self._names = {*places}
        self._inside = False

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        """The body alone: defaults and decorators are read at import."""
        node.decorator_list = [self.visit(each) for each in node.decorator_list]
        outer, self._inside = self._inside, True
        node.body = [self.visit(statement) for statement in node.body]
        self._inside = outer
        return node

    def visit_Lambda(self, node: ast.Lambda) -> ast.AST:
        """As of a function."""
        outer, self._inside = self._inside, True
        node.body = self.visit(node.body)
        self._inside = outer
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        """Decorators lose `cache=True`."""
        self.generic_visit(node)
        if isinstance(node.func, ast.Name) and node.func.id == "njit":
            node.keywords = [keyword for keyword in node.keywords if keyword.arg != "cache"]
        return node

    def visit_Name(self, node: ast.Name) -> ast.AST:
        """A number that is imported by its name."""
        return self._read(node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """A number that is read from the module."""
        found = self._read(node)
        return self.generic_visit(node) if found is node else found

    def _read(self, node: ast.expr) -> ast.AST:
        name = number_of(node, self._own, self._files, self._names) if self._inside else None
        if name is None or name not in self._places:
            return node
        kind = "int" if name in self._whole else "float"
        made = ast.parse(f"{kind}({NAME}[{self._places[name]}])", mode="eval").body
        for part in ast.walk(made):
            ast.copy_location(part, node)
        return made


def varying(text: str, places: dict[str, int], whole: set[str]) -> ast.Module:
    """The tree of a module that reads its numbers from the table. `places`: index of each in the table;
    `whole`: those that are counts."""
    tree = ast.parse(text)
    own, files = imported(tree, set(places))
    return ast.fix_missing_locations(Varying(places, whole, own, files).visit(tree))


class _Loader(SourceFileLoader):
    places: dict[str, int]
    whole: set[str]

    def get_code(self, fullname: str) -> CodeType:
        """The code of the changed module; no bytecode is read or written."""
        path = self.get_filename(fullname)
        tree = varying(self.get_data(path).decode("utf-8"), self.places, self.whole)
        return compile(tree, path, "exec", dont_inherit=True)

    def exec_module(self, module: ModuleType) -> None:
        """Runs the module, which finds TABLE among its globals."""
        module.__dict__[NAME] = TABLE
        super().exec_module(module)


class _Finder(MetaPathFinder):
    """Finds the modules of the lattice solver."""

    def __init__(self, places: dict[str, int], whole: set[str]):
        self._places, self._whole = places, whole

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: Any = None) -> ModuleSpec | None:
        """The spec of a module of the solver with the loader above; None for all others."""
        if not (fullname == PACKAGE or fullname.startswith(f"{PACKAGE}.")):
            return None
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is None or not isinstance(spec.loader, SourceFileLoader):
            return spec
        loader = _Loader(spec.loader.name, spec.loader.path)
        loader.places, loader.whole = self._places, self._whole
        spec.loader = loader
        return spec


def install(found: list[Number]) -> dict[str, int]:
    """Makes variables of the numbers that are not frozen; returns their places in TABLE. Raises RuntimeError
    where a module of the solver is imported already."""
    if any(name == PACKAGE or name.startswith(f"{PACKAGE}.") for name in sys.modules):
        raise RuntimeError("the lattice solver is imported already")
    free = [number for number in found if not number.frozen]
    places = {number.name: k for k, number in enumerate(free)}
    for number in free:
        TABLE[places[number.name]] = number.value
    whole = {number.name for number in free if isinstance(number.value, int)}
    sys.meta_path.insert(0, _Finder(places, whole))
    return places
