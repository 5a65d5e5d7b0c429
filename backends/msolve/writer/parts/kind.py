"""What a script has of a kind of part: its values, and what contacts act on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar, Generic, TypeVar

from mdlgen.altair.rims import Side
from mdlgen.model.tables import MachinePart, Model

P = TypeVar("P", bound=MachinePart)
Table = dict[str, Any]


class Kind(Generic[P]):
    """What a script has of one kind. The function that makes one stands in a template called as one is."""

    note: ClassVar[str] = ""  # above the values
    pressed: ClassVar[bool] = False  # some slide on springs
    recorded: ClassVar[bool] = False  # something is recorded of some

    def table(self, model: Model, part: P) -> Table:
        """The values of a part."""
        raise NotImplementedError

    def graphics(self, part: P, side: Side) -> int:
        """How many graphics a contact with one side of it acts on."""
        return 1

    def is_round(self, part: P, side: Side) -> bool:
        """Whether that is a cylinder."""
        return False

    def labels(self, part: P) -> Iterator[str]:
        """Labels of what is made beside its body, by which it is found again."""
        yield from ()
