"""A text, read: its report and its values from one pass."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Any

from backends.motionview.reader.expand import expand
from backends.motionview.reader.program import program
from backends.motionview.reader.report import Notes, Report
from backends.motionview.reader.scanner import statements
from backends.motionview.reader.source import Source
from backends.motionview.reader.values import values


class Reading:
    """Raises SpecError where the text cannot be meant as a model; all else is in `report`."""

    def __init__(self, text: str, file: str):
        self.source = Source(text, file)
        self.notes = Notes()
        with _without_collection():
            self.program = program(statements(self.source, self.notes), self.notes)
            self.expansion = expand(self.program, self.notes)
        self.world = self.expansion.world

    @cached_property
    def values(self) -> dict[str, dict[str, Any]]:
        """Every evaluated entity, by kind and full name."""
        with _without_collection():
            return values(self.world, self.notes)

    @cached_property
    def report(self) -> Report:
        """Everything that was found."""
        from backends.motionview.reader.lint import lint

        _ = self.values
        with _without_collection():
            lint(self)
        return Report(self.notes.findings(), len(self.program.statements))


@contextmanager
def _without_collection() -> Iterator[None]:
    """Nothing is thrown away while a text is read, and looking for it takes a third of the time."""
    running = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if running:
            gc.enable()
