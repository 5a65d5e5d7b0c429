"""The entities of a deck by kind, and by kind and id."""

from __future__ import annotations

from collections.abc import Iterator

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader.entity import Entity
from mdlgen.backends.motionsolve.reader.parse import children


class Index:
    """Entities of the Model; a duplicate id or name within a kind raises SpecError with file:line."""

    def __init__(self, model: etree._Element, file: str):
        self._kinds: dict[str, dict[int, Entity]] = {}
        self.single: dict[str, Entity] = {}
        for element in children(model):
            entity = Entity(element, file)
            if element.get("id") is None:
                self.single[str(element.tag)] = entity
                continue
            kind = self._kinds.setdefault(str(element.tag), {})
            if kind.setdefault(entity.id(), entity) is not entity:
                raise entity.wrong(f"id {entity.id()} is taken by {kind[entity.id()].name}")

    def of_kind(self, kind: str) -> Iterator[Entity]:
        """Entities of a kind, in the order of the deck."""
        yield from self._kinds.get(kind, {}).values()

    def get(self, user: Entity, attribute: str, kind: str) -> Entity:
        """The entity that an attribute names by its id."""
        return self.by_id(user, user.id(attribute), kind)

    def by_id(self, user: Entity, number: int, kind: str) -> Entity:
        """The entity with an id, which `user` needs."""
        found = self._kinds.get(kind, {}).get(number)
        if found is None:
            raise user.wrong(f"there is no {kind} {number}")
        return found
