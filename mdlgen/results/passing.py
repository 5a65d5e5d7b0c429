"""Presence of sheets that come in and leave during a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from mdlgen.results.result import Result

CAME, LEFT = 0, 1  # columns of Result.stays


def there(result: Result) -> NDArray[np.bool_] | None:
    """A mask of the sheets that are present at the stored times, (t, sheets); None: all at all times.

    A state at the time at which a sheet comes in or leaves is that without it, but for the first of a run.
    """
    if result.stays is None:
        return None
    time, came, left = result.time[:, None], result.stays[:, CAME], result.stays[:, LEFT]
    return ((time > came) | ((came == 0.0) & (time == 0.0))) & ~(time >= left)


def span(result: Result, sheet: int) -> tuple[int, int]:
    """The first and the last stored state in which a sheet is there; (0, -1): all, or none."""
    found = there(result)
    at = np.flatnonzero(found[:, sheet]) if found is not None else np.zeros(0, int)
    return (int(at[0]), int(at[-1])) if at.size else (0, -1)


def came(result: Result, sheet: int) -> bool:
    """True if a sheet was present at any time."""
    return result.stays is None or not bool(np.isnan(result.stays[sheet, CAME]))


def at_ends(result: Result, sheet: int) -> dict[str, float | None]:
    """Entries of a summary: when a sheet came in and left [ms], None: it did not; nothing where all sheets
    are present throughout."""
    if result.stays is None:
        return {}
    when = [None if np.isnan(value) else float(value) for value in result.stays[sheet]]
    return {"entered_ms": when[CAME], "left_ms": when[LEFT]}


def passages(result: Result) -> list[dict[str, Any]]:
    """Events `entered`, of what was not there from the start, and `left`."""
    found: list[dict[str, Any]] = []
    if result.stays is None:
        return found
    for sheet, when in zip(result.model.sheets, result.stays, strict=True):
        for kind, column in (("entered", CAME), ("left", LEFT)):
            time = float(when[column])
            if time > 0.0:
                found.append({"time_ms": time, "kind": kind, "sheet": sheet.name})
    return found
