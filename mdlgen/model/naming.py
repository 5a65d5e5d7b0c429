"""Identifiers of the Model: short, and unique without regard to case."""

from __future__ import annotations

from collections.abc import Iterable

from mdlgen.errors import SpecError


def box(sheet: str, i: int, j: int) -> str:
    """Box in column i, row j of a sheet."""
    return f"{sheet}_{i}_{j}"


def bushing(sheet: str, kind: str, i: int, j: int, end: str = "") -> str:
    """Joint behind box (i, j) along `kind` (x, y) or at a clamp (c), at the corner `end` (a, b)."""
    return f"{sheet}_{kind}_{i}_{j}{end and '_' + end}"


def check_unique(kind: str, names: Iterable[str]) -> None:
    """Raises SpecError where two names of one kind meet: 'note' with box 0 and a roller 'note_0_0'."""
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(name.lower(), name)
        if other is not name:
            raise SpecError(f"two {kind} would be called {name!r}; rename the part of that name")
