"""Runs that more than one test looks at: small, and by the real solver."""

from __future__ import annotations

from functools import lru_cache

import mdlgen
from mdlgen.paths import samples
from mdlgen.results.result import Result


@lru_cache(maxsize=8)
def ran(sample: str, *overrides: str) -> Result:
    """The result of a sample."""
    result = mdlgen.solve(mdlgen.lower(mdlgen.load(samples() / f"{sample}.yaml", overrides)))
    assert result.ok, result.status
    return result


def transport(*more: str) -> Result:
    return ran("transport_4x4", "sheets.note.boxes=[5,8]", *more)
