"""Plain rows for the templates: names, labels and numbers, already in MotionView's units.

What can be a formula is not here: it stands in the templates. Here is what rows of several kinds have.
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
        """What the text sets it to."""
        return self.formula or self.number


class Axis(NamedTuple):
    """A direction: a global vector, or one of its own with components."""

    vector: str
    own: tuple[str, str, str] | None
