"""The scene's part of an MDL file: all of a model; in a host the definitions of the sheets, and their
file."""

from __future__ import annotations

from typing import Any

from mdlgen.errors import Place


class Scope:
    """`definitions` are the names of those that make the sheets; None where the whole text is the scene."""

    def __init__(self, reading: Any, definitions: frozenset[str] | None, instances: tuple[str, ...] = ()):
        self.definitions = definitions
        self.instances = instances
        made = {name: d.statement.source.file for name, d in reading.program.definitions.items()}
        begin = reading.program.begin
        host = begin.source.file if begin is not None else None
        self.files = {made[name] for name in definitions or () if name in made} - {host}
        self._lines = _lines(reading, definitions) if definitions is not None else {}

    def holds(self, place: Place) -> bool:
        """True if the statement at a place is the scene's."""
        if self.definitions is None or place.file in self.files:
            return True
        return any(first <= place.line <= last for first, last in self._lines.get(place.file, ()))

    def has(self, rest: Any) -> bool:
        """True if a statement is the scene's, or sets something of it from outside."""
        about = rest.about or ""
        return any(about.startswith(i) for i in self.instances) or self.holds(rest.statement.place())


def _lines(reading: Any, definitions: frozenset[str]) -> dict[str, list[tuple[int, int]]]:
    """First and last lines of the definitions, by file."""
    found: dict[str, list[tuple[int, int]]] = {}
    begun: list[Any] = []
    for statement in reading.program.statements:
        if statement.key.startswith("define"):
            begun.append(statement)
        elif statement.key == "enddefine" and begun:
            first = begun.pop()
            if first.arg(0) in definitions:
                place = first.place()
                found.setdefault(place.file, []).append((place.line, statement.place().line))
    return found
