"""The subject of a verification: a scene, whole or its sheets alone, and files in place of mdlgen's own."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import read_exactly, read_text
from mdlgen.registry import TEXT, emitter
from mdlgen.spec.scene import Scene
from mdlgen.verify.expected.contacts import contacts, masters
from mdlgen.verify.expected.data import data
from mdlgen.verify.expected.motions import stations
from mdlgen.verify.expected.run import gravity, run, units
from mdlgen.verify.expected.sheets_only import of_sheets
from mdlgen.verify.expected.whole import expected
from mdlgen.verify.inputs.systems import definition, inside
from mdlgen.verify.readback import script
from mdlgen.verify.readback.values import Values, commanded, contact_outputs_of
from mdlgen.verify.tables import Table


@dataclass(frozen=True)
class File:
    """A file that was given."""

    text: str
    path: Path

    @staticmethod
    def read(path: Path | None, exactly: bool = False) -> File | None:
        """`exactly` keeps its line ends. Raises OutputError."""
        return None if path is None else File(read_exactly(path) if exactly else read_text(path), path)


class Read:
    """A text, read: `values` have the names of the scene, `prefix` is what the text has before them."""

    def __init__(self, reading: Any, prefix: str):
        self.reading = reading
        self.prefix = prefix
        self._by_command = True

    @cached_property
    def values(self) -> dict[str, Any]:
        return inside(self.reading.values, self.prefix)

    @property
    def has_numbers(self) -> bool:
        """True if the MDL file itself gives contacts their numbers."""
        return any("penalty" in record for record in self.values["contacts"].values())

    @cached_property
    def commanded(self) -> dict[str, dict[str, float]]:
        """Numbers that solver commands give contacts, by contact."""
        return commanded(self.values) if self._by_command else {}

    def without_commands(self) -> Read:
        """The same text, whose solver commands for contacts are passed over."""
        found = copy(self)
        found.__dict__.pop("commanded", None)
        found._by_command = False
        return found

    def changed(self, path: str, number: float) -> Values | None:
        """Values of what depends on a value of a data set, were it `number`."""
        # of a contact without numbers there is nothing that a value could change
        without = () if self.has_numbers else ("Contact",)
        values = self.reading.changed(self.prefix + path, repr(number), without)
        return None if values is None else inside(values, self.prefix)


class Subject:
    """A scene with its Model. `only_sheets`: the text is a system definition for a model of the user's own.

    Raises RefusedError for a scene that has no text, SpecError for a file that is none of its kind.
    """

    def __init__(self, scene: Scene, model: Model, only_sheets: bool, text: File | None):
        self.scene = scene
        self.model = model
        self.only = "sheets" if only_sheets or model.externals else None
        self.text = text
        self.backend = emitter(TEXT)
        self.times = stations(model)

    def said(self, model: Model | None = None) -> dict[str, Table]:
        """The expected tables of a Model."""
        model = model or self.model
        rows = contacts(model)
        said = expected(model, self.times) | {"data": data(model), "contacts": rows, "masters": masters(rows)}
        said |= {"run": run(model), "gravity": gravity(model), "units": units()}
        return of_sheets(said, model, self.text is not None) if self.only else said

    def reads(self, set_contact: bool) -> list[Read]:
        """The text that was given, or mdlgen's own; a host has one for each system of the sheets."""
        if self.text is None:
            return [self.own(set_contact)]
        path = self.text.path
        return self._read(self.backend.read(self.text.text, str(path), path.parent), str(path))

    def own(self, set_contact: bool, like: Read | None = None) -> Read:
        """The text that mdlgen writes; for the version of MotionView that `like` is for."""
        flips = like is None or any(record["flips"] for record in like.values["contacts"].values())
        options: dict[str, Any] = {}
        if like is not None:
            options = {} if flips or not like.values["contacts"] else {"target": "2025"}
            options |= {"forces": True} if contact_outputs_of(like.values) and not self.only else {}
        text = self.backend.emit(self.model, set_contact=set_contact, only=self.only, **options)
        return self._read(self.backend.read(text, "<text>"), "<text>")[0]

    def _read(self, reading: Any, file: str) -> list[Read]:
        for finding in reading.notes.findings():
            if finding.code == "no-model":
                raise SpecError(finding.message, place=finding.place)
        if not self.only:
            return [Read(reading, "")]
        wanted = definition(self.model)
        instances = reading.instances(wanted)
        if not instances:
            what = f"no instance of {wanted}, the sheets of {self.model.name}"
            raise SpecError(f"{file}: this text has {what}")
        return [Read(reading, instance) for instance in instances]

    def script(self, set_contact: bool) -> script.Script:
        """The script that mdlgen writes for a text; empty where there is nothing that it could set."""
        text = self.backend.companion(self.model, set_contact=set_contact, only=self.only)
        return script.NONE if text is None else script.read(text)
