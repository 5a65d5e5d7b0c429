"""Counts of the rows of a campaign."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from mdlgen.bench.campaign.finer import FAR
from mdlgen.bench.campaign.row import INACCURATE, NONE, OK, CampaignRow

NUMBER = re.compile(r"[-+]?\d+\.?\d*(e[-+]?\d+)?")
# Names that scenes give to parts which they have several of.
PARTS = re.compile(r"\b(?:note|pile|nip|motor|idler)(?:_(?:#|upper|lower))*(?!\w)")


@dataclass(frozen=True)
class Counts:
    """Scenes by outcome, their times [s], and the quantities that were compared."""

    scenes: int
    ok: int
    inaccurate: int
    chaotic: int  # of the inaccurate ones
    none: int
    stopped: int  # of those without a result
    rejected: int  # draws that `check` did not accept
    median_s: float | None
    part_95_s: float | None
    most_s: float | None
    finer_scenes: int
    finer_failed: int
    compared: int
    unknown: int
    above: int
    far: int
    apart: int  # of those above: finer runs do not agree
    wrong: int  # far above, and the finer runs agree

    def json(self) -> dict[str, Any]:
        return asdict(self)


def counts(rows: Sequence[CampaignRow]) -> Counts:
    """Returns all numbers of the table."""
    times = [row.cpu_s for row in rows if row.cpu_s is not None]
    median, part, most = (float(np.quantile(times, q)) for q in (0.5, 0.95, 1.0)) if times else (None,) * 3
    finer = [row.finer for row in rows if row.finer is not None]
    found = [(name, times, name in each.apart) for each in finer for name, times in each.above]
    return Counts(
        scenes=len(rows),
        ok=sum(row.status == OK for row in rows),
        inaccurate=sum(row.status == INACCURATE for row in rows),
        chaotic=sum(row.status == INACCURATE and row.chaotic for row in rows),
        none=sum(row.status == NONE for row in rows),
        stopped=sum(row.stopped for row in rows),
        rejected=sum(len(row.rejected) for row in rows),
        median_s=median,
        part_95_s=part,
        most_s=most,
        finer_scenes=sum(not each.failed for each in finer),
        finer_failed=sum(bool(each.failed) for each in finer),
        compared=sum(each.compared for each in finer),
        unknown=sum(each.unknown for each in finer),
        above=len(found),
        far=sum(times > FAR for _, times, _ in found),
        apart=sum(apart for *_, apart in found),
        wrong=sum(times > FAR and not apart for _, times, apart in found),
    )


def alike(reason: str) -> str:
    """Returns a reason without numbers, names of parts and advice, to group by."""
    first = NUMBER.sub("#", reason.partition(";")[0]).replace("\n", " ")
    return PARTS.sub("X", first)[:160]


def grouped(rows: Sequence[CampaignRow], status: str) -> dict[str, list[CampaignRow]]:
    """Returns the rows of a status by reason, the most frequent first."""
    groups: dict[str, list[CampaignRow]] = {}
    for row in rows:
        if row.status == status:
            groups.setdefault("chaotic" if row.chaotic else alike(row.reason), []).append(row)
    return dict(sorted(groups.items(), key=lambda item: -len(item[1])))
