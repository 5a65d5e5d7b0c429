"""Values that are no single value: the two of a pair, and what nothing is known of."""

from __future__ import annotations

from typing import Any


class Pair:
    """The left and the right one."""

    __slots__ = ("l", "r")

    def __init__(self, l: Any, r: Any):
        self.l = l
        self.r = r

    def __str__(self) -> str:
        return f"the pair of {self.l} and {self.r}"


class Unmade:
    """An entity of the standard include, or of a missing one; none of its values are known."""

    def __init__(self, name: str, why: str):
        self.name = name
        self.why = why

    def __str__(self) -> str:
        return self.name
