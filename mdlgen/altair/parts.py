"""Kinds of parts that an output has: a file for each, and a refusal for what has none."""

from __future__ import annotations

from collections.abc import Container
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

from mdlgen.errors import RefusedError
from mdlgen.model.parts.kinds import KINDS, kind_of
from mdlgen.model.tables import MachinePart, Model


def by_kind(package: ModuleType) -> dict[type[MachinePart], Any]:
    """Modules of a package for kinds of parts, by their KIND. Each file has the name of its kind; a kind
    without a file is left out."""
    names = {kind.part: f"{package.__name__}.{kind.name}" for kind in KINDS}
    return {part: import_module(name).KIND for part, name in names.items() if find_spec(name) is not None}


def refuse_unwritten(model: Model, written: Container[type], what: str) -> None:
    """Raises RefusedError by name for a part of a kind that is not `written`: the output would name it
    without having it."""
    for part in model.machine:
        if type(part) not in written:
            raise RefusedError(
                f"{what}: {part.name} is a {part.kind}, which is not written yet; run this scene locally",
                (kind_of(part).table, part.name),
            )
