"""Whether a run went as its scene asks."""

from __future__ import annotations

from mdlgen.results.result import Result


def as_asked(result: Result) -> bool:
    """A run whose step is searched is within its tolerance. One at a step that is given is complete; how far
    it is off depends on that step, and its estimate says it."""
    return result.ok or (result.model.run.step is not None and result.usable)
