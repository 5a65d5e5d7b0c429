"""The result of a campaign: its rows, seed, machine and versions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from mdlgen.bench.campaign.counts import counts
from mdlgen.bench.campaign.row import CampaignRow


@dataclass
class Campaign:
    """The rows of a campaign, sorted by number, with its seed, limit, machine and versions."""

    seed: int
    count: int
    limit: float  # [s] for each scene
    machine: dict[str, Any] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    rows: list[CampaignRow] = field(default_factory=list)
    sticking: bool = False  # in every second contact

    def json(self) -> dict[str, Any]:
        """The content of campaign.json."""
        head = {"seed": self.seed, "count": self.count, "limit_s": self.limit, "sticking": self.sticking}
        machine = {"machine": self.machine, "versions": self.versions}
        return {**head, **machine, "counts": counts(self.rows).json(), "rows": [r.json() for r in self.rows]}
