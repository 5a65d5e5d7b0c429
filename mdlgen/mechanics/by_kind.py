"""All kinds of contact pairs that have a law, and kernels that choose among them by a pair's kind.

A kind is a module of mechanics.pairs. Such a kernel is written here as text: one comparison for each kind.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from inspect import signature
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

from mdlgen.mechanics import pairs
from mdlgen.program.kernel import BORROWS, Kernel


def _found() -> dict[int, ModuleType]:
    """The modules by the numbers of their kinds, in the order of these."""
    modules = [import_module(f"{pairs.__name__}.{found.name}") for found in iter_modules(pairs.__path__)]
    return {module.KIND: module for module in sorted(modules, key=lambda module: module.KIND)}


KINDS = _found()


def by_kind(owner: str, name: str, otherwise: Any = None, inline: bool = False) -> Kernel:
    """A kernel that calls the function `name` of a pair's kind, or returns the value of that name.

    owner: module that the kernel will be in; otherwise: a kernel or a value for kinds that have none of that
    name, None: all that it is called for have one; inline: it is put into its callers.
    """
    given = next((signature(each.py_func).parameters for each in _kernels(name)), ["pair"])
    names: dict[str, Any] = {"__name__": owner}
    results = {}
    for kind, module in KINDS.items():
        if hasattr(module, name):
            called = module.__name__.rpartition(".")[2]
            results[kind] = _result(names, called, getattr(module, name), given)
    last = results.popitem()[1] if otherwise is None else _result(names, "otherwise", otherwise, given)
    lines = [f"def {name}({', '.join(given)}):", "    kind = pair.kind"]
    for kind, result in results.items():
        lines += [f"    if kind == {kind}:", f"        return {result}"]
    text = "\n".join([*lines, f"    return {last}", ""])
    exec(compile(text, f"<{owner}: {name} by kind>", "exec"), names)
    return Kernel(names[name], {"error_model": "numpy", "forceinline": inline, **BORROWS}, text)


def _kernels(name: str) -> Iterator[Kernel]:
    return (own for kind in KINDS.values() if isinstance(own := getattr(kind, name, None), Kernel))


def _result(names: dict[str, Any], called: str, own: Any, given: Iterable[str]) -> str:
    """Source text for one kind: a value, or the call of a kernel, which is added to the names."""
    if not isinstance(own, Kernel):
        return repr(own)
    names[called] = own
    return f"{called}({', '.join(given)})"
