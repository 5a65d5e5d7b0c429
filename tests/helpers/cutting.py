"""Runs that are cut off after some checkpoints."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from mdlgen.runs.checkpoint import Checkpointer, State


class Cut(Exception):
    """A run is cut off."""


def written_with() -> dict[str, str]:
    return {"run.json": "{}"}


class Cutting(Checkpointer):
    """Keeps a state at every stored time, or the last `most` of these, and cuts off after some."""

    def __init__(
        self,
        folder: Path,
        provenance: Callable[[], dict[str, str]] | None,
        after: int,
        most: float = math.inf,
    ):
        super().__init__(folder, 0.0, provenance)
        self.left, self._most = after, most

    def save(self, number: int, state: State) -> None:
        if self.left <= self._most:
            super().save(number, state)
        self.left -= 1
        if self.left == 0:
            raise Cut
