"""A row of a campaign: what became of one scene."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

# With a result (exit code 0 of `mdlgen run`); with one whose error is above the tolerance or unknown (5);
# none.
OK, INACCURATE, NONE = "ok", "inaccurate", "none"


@dataclass(frozen=True)
class Finer:
    """Quantities of a run compared with runs at an eighth of its step, and at a sixteenth where one is above
    its estimate by more than ABOVE."""

    compared: int = 0  # that have an estimate
    unknown: int = 0  # that have none
    above: tuple[tuple[str, float], ...] = ()  # name, error over estimate, of those above ABOVE
    apart: tuple[str, ...] = ()  # above, but the two finer runs do not agree how large the error is
    failed: str = ""  # why there is no finer run


@dataclass(frozen=True)
class CampaignRow:
    """What became of a scene; `reason` says why it has no result, or why that is inaccurate."""

    number: int
    kind: str
    status: str
    reason: str = ""
    chaotic: bool = False
    boxes: int = 0
    solver: str = ""
    step_ms: float | None = None
    steps: int | None = None
    estimate: float | None = None  # the one that run.tolerance judges
    estimate_of: str | None = None
    cpu_s: float | None = None  # processor time of the run, all passes; the time at which it was stopped
    wall_s: float | None = None
    stopped: bool = False  # whether it was stopped at the limit of time
    rejected: tuple[str, ...] = ()  # why earlier draws of this scene were rejected
    finer: Finer | None = None  # of one in ten

    def json(self) -> dict[str, Any]:
        """Plain data; numbers that are not finite are left out."""
        from mdlgen.results.summary import plain

        return plain(asdict(self))
