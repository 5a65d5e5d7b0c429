"""Rows of a deck for a kind of part, after the bodies."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import MachinePart, Model

P = TypeVar("P", bound=MachinePart)
LAST = 4


class Kind(Generic[P]):
    """Rows of a deck for one kind of part; a method that is not overridden adds none."""

    rank: ClassVar[int] = LAST  # order of its rows among those of other kinds

    def add_frame(self, deck: Deck, model: Model, part: P) -> None:
        """Adds its axes."""

    def shown(self, model: Model, part: P) -> list[Shown]:
        """The boxes that show it."""
        return []

    def add_shell(self, deck: Deck, model: Model, part: P) -> None:
        """Adds the triangles that show it."""

    def add_joints(self, deck: Deck, model: Model, part: P) -> None:
        """Adds joints, springs, drives, and recorded quantities."""
