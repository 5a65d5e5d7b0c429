"""The warning that stands first wherever a run is shown that is not within its tolerance or ended early."""

from __future__ import annotations

from mdlgen.results.chaos import command, in_words
from mdlgen.results.estimates import accuracy
from mdlgen.results.result import Result


def mark(result: Result) -> str | None:
    """One line; None where there is nothing to say."""
    if result.ok:
        return None
    if result.usable:
        return f"inaccurate: {accuracy(result)}"
    end, duration = float(result.time[-1]) if len(result.time) else 0.0, result.model.run.duration
    if result.model.run.analysis == "static":
        return f"no result: {result.status}"
    if end < duration * (1.0 - 1e-9):
        return f"ended early, at {end:.6g} of {duration:g} ms: {result.status}"
    return f"no result: {result.status}"


def chaotic(result: Result, spec: str) -> str | None:
    """The message about a chaotic run, with the command of a sweep; None for others."""
    found = result.chaotic
    if found is None:
        return None
    center = next(sheet.center for sheet in result.model.sheets if sheet.name == found.sheet)
    return f"{in_words(found)}: {command(found, tuple(center.tolist()), spec)}"
