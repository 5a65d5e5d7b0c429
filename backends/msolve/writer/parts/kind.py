"""Contents of a script for a kind of part: its values, and the graphics on which contacts act."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar, Generic, TypeVar

from mdlgen.altair.rims import Side
from mdlgen.model.tables import MachinePart, Model

P = TypeVar("P", bound=MachinePart)
Table = dict[str, Any]


class Kind(Generic[P]):
    """Contents of a script for one kind. The function that makes a part is in the template named like it."""

    note: ClassVar[str] = ""  # comment above the values
    pressed: ClassVar[bool] = False  # true where some slide on springs
    recorded: ClassVar[bool] = False  # true where quantities of some are recorded

    def table(self, model: Model, part: P) -> Table:
        """The values of a part."""
        raise NotImplementedError

    def graphics(self, part: P, side: Side) -> int:
        """Number of graphics on which a contact with one side of it acts."""
        return 1

    def is_round(self, part: P, side: Side) -> bool:
        """True if the graphic of that side is a cylinder."""
        return False

    def labels(self, part: P) -> Iterator[str]:
        """Labels of the objects that are made in addition to its body, by which the reader finds them."""
        yield from ()
