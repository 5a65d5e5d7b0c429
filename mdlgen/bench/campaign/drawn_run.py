"""A run of a scene of a campaign, as a case of a suite."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING

from mdlgen.bench.campaign.scene import drawn
from mdlgen.bench.case import Run

if TYPE_CHECKING:
    from mdlgen.model.tables import Model


@dataclass(frozen=True)
class DrawnRun(Run):
    """The scene of that seed and number; `sample` is a name for it."""

    seed: int = 1
    number: int = 1

    def model(self) -> Model:
        """The scene, lowered. Raises SpecError."""
        return drawn(self.seed, self.number).model(self.sets)

    def text(self) -> str:
        """The scene as it is drawn."""
        return drawn(self.seed, self.number).text

    def command(self, solver: str) -> str:
        """The command that repeats it, at its own step."""
        chosen = ("--seed", str(self.seed), "--only", str(self.number), "--solver", solver)
        return shlex.join(["mdlgen", "bench", "campaign", *chosen])
