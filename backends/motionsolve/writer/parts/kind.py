"""What a deck has of a kind of part, behind the bodies."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import MachinePart, Model

P = TypeVar("P", bound=MachinePart)
LAST = 4


class Kind(Generic[P]):
    """What a deck has of one kind; what it has nothing of adds nothing."""

    rank: ClassVar[int] = LAST  # where its rows stand among those of other kinds

    def add_frame(self, deck: Deck, model: Model, part: P) -> None:
        """Its axes."""

    def shown(self, model: Model, part: P) -> list[Shown]:
        """The boxes that show it."""
        return []

    def add_shell(self, deck: Deck, model: Model, part: P) -> None:
        """The triangles that show it."""

    def add_joints(self, deck: Deck, model: Model, part: P) -> None:
        """Joints, springs, drives, and what is recorded."""
