"""The tables that are lowered before the parts of a machine are."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from mdlgen.geometry.arrays import Floats
from mdlgen.model.press.faces import Bow, Face, Facets
from mdlgen.model.tables import Contacts, RollerPart, SheetPart


class Before(NamedTuple):
    """The tables that are lowered before a part is."""

    sheets: tuple[SheetPart, ...]
    contacts: Contacts
    rollers: tuple[RollerPart, ...]
    # the face of a part, by name, that a pressed roller at a place, by name, meets; None: none
    face: Callable[[str, Floats, str], Face | Bow | Facets | None]
