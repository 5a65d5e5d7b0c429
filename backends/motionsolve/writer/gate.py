"""Second gate for names and labels: what is written must be from the allow-lists, and no name twice."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from mdlgen.altair.labels import check_allowed
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model import naming
from mdlgen.model.tables import Model


class Labelled(Protocol):
    """Attributes that every row of an entity has."""

    @property
    def name(self) -> str: ...

    @property
    def label(self) -> str: ...


_BUILT_IN = ("B_Ground", "MODEL")


def check(model: Model, deck: Deck) -> None:
    """Raises SpecError for a name or label not from the allow-lists, and a name that two things have."""
    own = [marker.name for marker in deck.markers if "." not in marker.name]
    names = [*_BUILT_IN, *own, *(row.name for row in _entities(deck))]
    labels = [marker.label for marker in deck.markers] + [row.label for row in _entities(deck)]
    check_allowed((model.name, *names), labels)
    naming.check_unique("things in the deck", names)


def _entities(deck: Deck) -> Iterator[Labelled]:
    yield from deck.bodies
    yield from deck.joints
    yield from deck.motions
    yield from deck.springs
    for group in deck.bushing_groups:
        yield from group.bushings
    yield from deck.splines
    yield from deck.curved
    yield from deck.loads
    yield from deck.clutches
    yield from deck.contacts
    yield from deck.surfaces
    yield from deck.requests
    yield from deck.solids
    yield from deck.shells
