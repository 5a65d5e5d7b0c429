"""Plain rows for the templates: names, labels and numbers, already in MotionView's units.

Formulas are in the templates, not here. This module has the rows that several kinds share.
"""

from __future__ import annotations

from typing import NamedTuple


class Value(NamedTuple):
    """A member of a data set that is a number."""

    member: str
    label: str
    number: str
    edit: str  # EDIT or NO_EDIT
    formula: str = ""  # that gives the number
    late: bool = False  # set behind all data sets, since it names values of others

    @property
    def said(self) -> str:
        """Formula or number to which the file sets it."""
        return self.formula or self.number


class Axis(NamedTuple):
    """A direction: a global vector, or one of its own with components."""

    vector: str
    own: tuple[str, str, str] | None
