"""Labels and names of texts: from an allow-list, and those of grid points."""

from __future__ import annotations

import re
from collections.abc import Iterable

from mdlgen.errors import SpecError
from mdlgen.model.tables import SheetPart

IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,199}")
LABEL = re.compile(r"[A-Za-z0-9 _.,:;+/#()=\-]{0,200}")


def node(sheet: SheetPart, x: int, y: int, frames: tuple[int, int]) -> str:
    """Grid point of a sheet; around a dog-ear it is at one place on the flat side, at one on the ear, and for
    the joints between them halfway."""
    one, two = sorted(frames) if sheet.bend is not None and sheet.bend.axis < 0 else (0, 0)
    end = "" if two == 0 else f"_{one}" if one == two else f"_{one}_{two}"
    return f"{sheet.name}_node_{x}_{y}{end}"


def check_allowed(identifiers: Iterable[str] = (), labels: Iterable[str] = ()) -> None:
    """Second gate before a text is written. Raises SpecError for what the allow-lists do not hold."""
    for name in identifiers:
        if not IDENTIFIER.fullmatch(name):
            raise SpecError(f"{name[:80]!r} is not an identifier")
    for label in labels:
        if not LABEL.fullmatch(label):
            raise SpecError(f"{label[:80]!r} holds characters that a label must not have")
