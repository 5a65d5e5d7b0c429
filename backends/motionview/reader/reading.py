"""An MDL file that was read: its report and its values, from one pass."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any

from mdlgen.backends.motionview.reader.change import Changes
from mdlgen.backends.motionview.reader.expand import expand
from mdlgen.backends.motionview.reader.include import Includes
from mdlgen.backends.motionview.reader.instance import Attached, acting_on, attachments
from mdlgen.backends.motionview.reader.program import program
from mdlgen.backends.motionview.reader.remainder import Rest, remainder
from mdlgen.backends.motionview.reader.report import Notes, Report
from mdlgen.backends.motionview.reader.source import Source
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.values import values


class Reading:
    """Raises SpecError where the text cannot be meant as a model; all else is in `report`.

    Files that the text includes are read from `folder`, and none without it.
    """

    def __init__(self, text: str, file: str, folder: Path | None = None):
        self.notes = Notes()
        self.includes = Includes(Source(text, file), self.notes, folder)
        with _without_collection():
            self.program = program(self.includes.statements(), self.notes)
            self.expansion = expand(self.program, self.notes)
        self.world = self.expansion.world

    @cached_property
    def values(self) -> dict[str, dict[str, Any]]:
        """Every evaluated entity, by kind and full name."""
        with _without_collection():
            return values(self.world, self.notes)

    def changed(
        self, path: str, text: str, without: tuple[str, ...] = ()
    ) -> dict[str, dict[str, Any]] | None:
        """Values of all entities that may depend on a number, if it were `text`; see `change.Changes`."""
        with _without_collection():
            return self._changes.values(path, text, without)

    @cached_property
    def _changes(self) -> Changes:
        return Changes(self.expansion)

    def attachments(self, instance: str) -> list[Attached]:
        """Entities that an instance (`sys_note.`) has for the attachments of its definition."""
        return attachments(self.expansion, instance)

    def acting_on(self, instance: str) -> list[Statement]:
        """Statements around an instance that act on its bodies."""
        return acting_on(self.expansion, instance)

    def remainder(self) -> list[Rest]:
        """Statements that the values do not represent."""
        return list(remainder(self.expansion))

    def instances(self, definition: str) -> list[str]:
        """Prefixes of the names of entities in each instance of a system definition (`sys_note.`)."""
        world = self.world
        return [
            scope.path
            for scope in world.scopes
            if scope.definition is not None and scope.definition.name == definition and world.alive(scope)
        ]

    @cached_property
    def report(self) -> Report:
        """Everything that was found."""
        from mdlgen.backends.motionview.reader.lint import lint

        _ = self.values
        with _without_collection():
            lint(self)
        return Report(self.notes.findings(), len(self.program.statements))


@contextmanager
def _without_collection() -> Iterator[None]:
    """Disables garbage collection: no garbage arises while a file is read, and the search takes a third of
    the time."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            if not gc.get_freeze_count():
                gc.freeze()  # excludes the objects that were read from the next collections
                gc.unfreeze()
            gc.enable()
