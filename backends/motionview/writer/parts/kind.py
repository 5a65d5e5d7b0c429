"""Rows of a kind of part for its template in an MDL file, and the names of its graphics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar

from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.model.tables import MachinePart, Model

P = TypeVar("P", bound=MachinePart)


@dataclass(frozen=True)
class PartView:
    """One part: what the template of its kind is given, as `part`."""

    template: ClassVar[str]
    name: str
    given: list[Value]


class Kind(Generic[P]):
    """Contents of an MDL file for one kind of part."""

    def view(self, model: Model, part: P, given: list[Value]) -> PartView:
        """The row of a part; `given` are the values of its data set."""
        raise NotImplementedError

    def graphics(self, part: P) -> list[str]:
        """Names of the graphics of a part."""
        raise NotImplementedError
