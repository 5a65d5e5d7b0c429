"""Whether a run went as its scene asks."""

from __future__ import annotations

from mdlgen.results.result import Result


def as_asked(result: Result) -> bool:
    """A run whose step is searched is within its tolerance. One at a step that is given is complete; how far
    it is off depends on that step, and its estimate says it. Exudyn compares none that take long."""
    alone = result.solver == "exudyn" and "would take some" in result.error_unknown
    return result.ok or (result.usable and (result.model.run.step is not None or alone))
