"""A row of a campaign: the outcome of one scene."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

# The result of `mdlgen run` has exit code 0; its error is above the tolerance or unknown (exit code 5); there
# is no result.
OK, INACCURATE, NONE = "ok", "inaccurate", "none"


@dataclass(frozen=True)
class Finer:
    """Errors of a run relative to their estimates, from a run at an eighth of its step. Where one is above
    ABOVE, a run at a sixteenth checks the eighth."""

    compared: int = 0  # number of quantities with an estimate
    unknown: int = 0  # number of quantities without one
    above: tuple[tuple[str, float], ...] = ()  # name, error over estimate, of those above ABOVE
    apart: tuple[str, ...] = ()  # those of `above` on which the two finer runs do not agree
    failed: str = ""  # why there is no finer run


@dataclass(frozen=True)
class CampaignRow:
    """The outcome of a scene; `reason` says why it has no result, or why its result is inaccurate."""

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
    stopped: bool = False  # true if it was stopped at the limit of time
    rejected: tuple[str, ...] = ()  # why earlier draws of this scene were rejected
    finer: Finer | None = None  # of one in ten

    def json(self) -> dict[str, Any]:
        """Plain data; numbers that are not finite are left out."""
        from mdlgen.results.summary import plain

        return plain(asdict(self))
