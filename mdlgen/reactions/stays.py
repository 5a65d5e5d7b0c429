"""The sheets in the machine during a run, and those that have entered and left."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.conditions import OF_STAY
from mdlgen.formulas import NONE, Amount
from mdlgen.model.passing import at_start
from mdlgen.model.tables import Model


class Stays:
    """Values of conditions about sheets that enter and leave."""

    def __init__(self, model: Model):
        self.there: NDArray[np.bool_] | None = None  # (sheets,); None: all
        self._came = np.array(at_start(model), bool)
        self._sheets = {sheet.name: k for k, sheet in enumerate(model.sheets)}
        self._streams = {name: list(sheets) for name, sheets in model.reactions.streams}
        things = (*self._sheets, *self._streams)
        self.words = {f"{name}.{word}" for name in things for word in OF_STAY}

    def turn(self, there: NDArray[np.bool_] | None) -> bool:
        """Takes over which sheets are there now; whether that changed."""
        if there is None or (self.there is not None and np.array_equal(there, self.there)):
            return False
        self._came |= there
        self.there = there.copy()
        return True

    def known(self, name: str) -> Amount | float:
        """Value of `SHEET.left`: 1 if the sheet has left, else 0. Value of `STREAM.left`: number of its
        sheets that have left. `entered` likewise."""
        thing, _, word = name.partition(".")
        left = np.zeros_like(self._came) if self.there is None else self._came & ~self.there
        found = self._came if word == "entered" else left
        if thing in self._sheets:
            return float(found[self._sheets[thing]])
        return Amount(float(found[self._streams[thing]].sum()), NONE)

    def kept(self) -> dict[str, Any]:
        there = None if self.there is None else self.there.tolist()
        return {"came": self._came.tolist(), "there": there}

    def restore(self, kept: dict[str, Any]) -> None:
        there = kept["there"]
        self._came, self.there = (
            np.array(kept["came"], bool),
            None if there is None else np.array(there, bool),
        )
