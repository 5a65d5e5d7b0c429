"""The data shared by all cases of a study: plain, so that any process on any machine can have it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdlgen.spec.limits import DEFAULT

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.spec.load import Document
    from mdlgen.spec.scene import Scene
    from mdlgen.study.design.case import Case
    from mdlgen.study.design.expression import Expression
    from mdlgen.study.design.link import Link


@dataclass(frozen=True)
class Task:
    """The scene as it was written, and the request for each run of it."""

    spec: str  # the file's name, and its text
    text: str
    beside: str  # folder of the files that it names
    sets: tuple[str, ...] = ()
    limits: tuple[str, ...] = ()
    solver: str = "auto"
    check_step: bool = False
    measures: tuple[tuple[str, str], ...] = ()  # name and expression of each
    events: tuple[str, ...] = ()  # names of those that say whether something happened
    lets: tuple[str, ...] = ()  # values that follow a variable, as of --let
    keep: bool = False  # the files of each run come back with its row

    @classmethod
    def of(cls, asked: Mapping[str, Any]) -> Task:
        """From a journal. Raises KeyError, TypeError or ValueError for other data."""
        record = dict(asked)
        for name in ("sets", "limits", "events", "lets"):
            record[name] = tuple(str(item) for item in record[name])
        record |= {name: str(record[name]) for name in ("spec", "text", "beside", "solver")}
        record |= {name: bool(record[name]) for name in ("check_step", "keep")}
        record["measures"] = tuple((str(name), str(text)) for name, text in record["measures"])
        return cls(**record)

    def scene(self, case: Case | None = None) -> Scene:
        """The Scene of a case; None: as it was written. Raises SpecError, OutputError."""
        from mdlgen.spec.load import meant

        limits = DEFAULT.raised(self.limits)
        return meant(_document(self).copy(), self.overrides(case), Path(self.beside), limits)

    def overrides(self, case: Case | None = None) -> tuple[str, ...]:
        """All that is set in a case, `PATH=VALUE` each, with what follows its variables. Raises SpecError."""
        if case is None:
            return self.sets
        links = _links(self.lets)
        free = {link.name for link in links}
        values = dict(case.values)
        own = replace(case, values=tuple(value for value in case.values if value[0] not in free))
        follow = tuple((link.path, link.text(values[link.name])) for link in links)
        return (*self.sets, *own.overrides, *replace(case, values=follow).overrides)

    def model(self, case: Case | None = None) -> Model:
        """The tables of a case. Raises SpecError, OutputError."""
        from mdlgen.model.lower import lower

        return lower(self.scene(case))

    def expressions(self) -> tuple[tuple[str, Expression], ...]:
        """Its measures, read once in a process."""
        return _expressions(self.measures)


@lru_cache(maxsize=4)
def _document(task: Task) -> Document:
    """To parse a text takes longer than all else before a run is begun."""
    from mdlgen.spec.load import parse

    return parse(task.text, task.spec, DEFAULT.raised(task.limits))


@lru_cache(maxsize=4)
def _expressions(measures: tuple[tuple[str, str], ...]) -> tuple[tuple[str, Expression], ...]:
    from mdlgen.study.design.expression import read

    return tuple((name, read(text, "--measure")) for name, text in measures)


@lru_cache(maxsize=4)
def _links(lets: tuple[str, ...]) -> tuple[Link, ...]:
    from mdlgen.study.design.link import parse_link

    return tuple(parse_link(text) for text in lets)


def task(spec: Path, sets: list[str] | None = None, limits: list[str] | None = None, **asked: object) -> Task:
    """Of a file. Raises SpecError, OutputError for one that cannot be read."""
    from mdlgen.spec.load import read

    beside = str(spec.parent.resolve())
    return Task(str(spec), read(spec), beside, tuple(sets or ()), tuple(limits or ()), **asked)  # type: ignore[arg-type]
