"""Runs that are cut off after some checkpoints."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from mdlgen.runs.checkpoint import Checkpointer, State


class Cut(Exception):
    """A run is cut off."""


def written_with() -> dict[str, str]:
    return {"run.json": "{}"}


class Cutting(Checkpointer):
    """Keeps a state at every stored time, and cuts off after some."""

    def __init__(self, folder: Path, provenance: Callable[[], dict[str, str]] | None, after: int):
        super().__init__(folder, 0.0, provenance)
        self.left = after

    def save(self, number: int, state: State) -> None:
        super().save(number, state)
        self.left -= 1
        if self.left == 0:
            raise Cut
