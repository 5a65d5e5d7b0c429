"""Digests of the sources of kernels, by which a program is known to fit them."""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from mdlgen.program.kernel import Kernel, kernel_sources, options_of


@functools.cache
def sources_digest(rooms: tuple[str, ...]) -> str:
    """SHA-256 of all kernels of some packages: their sources, however lines end, the texts of those that
    no file has, and the numbers of other modules that they name."""
    return _digest(rooms, lambda path: path.read_bytes().replace(b"\r\n", b"\n"))


@functools.cache
def statements_digest(rooms: tuple[str, ...]) -> str:
    """SHA-256 of the same without comments, docstrings and layout, from which no code is made.

    It takes 0.3 s where the other takes 5 ms, so it is asked for only where the other one differs.
    """
    return _digest(rooms, lambda path: _statements(path.read_text("utf-8")).encode())


def _digest(rooms: tuple[str, ...], text: Callable[[Path], bytes]) -> str:
    found = hashlib.sha256()
    for room in rooms:
        for name, path in kernel_sources(room).items():
            module = importlib.import_module(name)
            found.update(f"{name}\n".encode())
            found.update(text(path))
            for line in _numbers(module):
                found.update(line.encode())
    return found.hexdigest()


def _statements(source: str) -> str:
    """A module without comments, docstrings and layout."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if (
            isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef))
            and ast.get_docstring(node) is not None
        ):
            node.body[0] = ast.Pass()
    return ast.unparse(tree)


def _numbers(module: Any) -> Iterator[str]:
    """Plain values that the kernels of a module name, most of which other modules state."""
    for name, kernel in sorted(vars(module).items()):
        if isinstance(kernel, Kernel) and kernel.__module__ == module.__name__:
            yield f"{name} {options_of(kernel)}\n{kernel.text}"
            for used in sorted(set(kernel.py_func.__code__.co_names)):
                value = kernel.py_func.__globals__.get(used)
                if isinstance(value, (bool, int, float, tuple)):
                    yield f"{used}={value!r}\n"
