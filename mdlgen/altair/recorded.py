"""Contacts whose forces solvers record, as a sum over the pairs of bodies of two parts."""

from __future__ import annotations

import re

from mdlgen.altair.rims import meetings
from mdlgen.model.tables import BOX_BOX, Model

_PART = re.compile(r"(.*) \(([1-9]\d{0,5}) of ([1-9]\d{0,5})\)")
MOST_SUMMED = 200
"""Pairs whose forces are summed in one expression: longer ones would be some 5,000 characters."""


def recorded(model: Model) -> list[int]:
    """Rows of Model.contacts whose force on their second part is recorded.

    Left out are those of two sheets, and those of more than MOST_SUMMED pairs.
    """
    rows = model.contacts
    return [row for row, many in counts(model).items() if rows.kind[row] != BOX_BOX and many <= MOST_SUMMED]


def unrecorded(model: Model) -> list[int]:
    """Rows that are left out for their many pairs."""
    rows = model.contacts
    return [row for row, many in counts(model).items() if rows.kind[row] != BOX_BOX and many > MOST_SUMMED]


def counts(model: Model) -> dict[int, int]:
    """Statements of each row that has any, by row."""
    found: dict[int, int] = {}
    for met in meetings(model):
        row = int(model.pairs.contact[met.pair])
        found[row] = found.get(row, 0) + 1
    return dict(sorted(found.items()))


def called(model: Model, row: int) -> str:
    """Name of the request of a row."""
    return f"o_{model.contacts.part_a[row]}_on_{model.contacts.part_b[row]}"


def part_of(label: str, part: int, parts: int) -> str:
    """Label of one of several requests whose numbers are a sum together, counted from 1."""
    return label if parts == 1 else f"{label} ({part} of {parts})"


def whole(label: str) -> tuple[str, int, int] | None:
    """The label of the whole, the number of the part, and how many parts there are; None for another
    label."""
    found = _PART.fullmatch(label)
    return None if found is None else (found[1], int(found[2]), int(found[3]))
