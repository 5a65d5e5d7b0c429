"""Two or more runs beside each other: numbers, what was set differently, and how far apart the sheets are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mdlgen.errors import SpecError
from mdlgen.results.compare import compare
from mdlgen.results.result import Result

# of summary.json: a list of events or of names is no number to compare
_LEFT_OUT = ("events", "versions", "estimates", "estimate_scales")


def differences(
    results: Sequence[Result], names: Sequence[str], summaries: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """For the page: rows of numbers (what, one value a run, differences to the first), of parameters that
    are not the same in all runs, and the distance of each run from the first."""
    flat = [dict(_flat({k: v for k, v in record.items() if k not in _LEFT_OUT})) for record in summaries]
    keys = list(dict.fromkeys(key for record in flat for key in record))
    numbers = []
    for key in keys:
        values = [record.get(key) for record in flat]
        if any(isinstance(value, str) for value in values):
            if len(set(values)) > 1:
                numbers.append({"what": key, "values": values, "less": None})
            continue
        numbers.append({"what": key, "values": values, "less": [_less(v, values[0]) for v in values[1:]]})
    return {
        "names": list(names),
        "numbers": numbers,
        "parameters": _parameters(results),
        "distances": [_distance(results[0], other) for other in results[1:]],
    }


def _flat(value: Any, path: str = "") -> list[tuple[str, Any]]:
    """Every number of nested objects and lists, by dotted path."""
    if isinstance(value, dict):
        return [pair for key, item in value.items() for pair in _flat(item, f"{path}.{key}".lstrip("."))]
    if isinstance(value, list):
        names = "xyz" if len(value) == 3 else range(len(value))
        return [pair for name, v in zip(names, value, strict=True) for pair in _flat(v, f"{path}.{name}")]
    return [(path, value)]


def _less(value: Any, first: Any) -> float | None:
    return None if value is None or first is None else float(value) - float(first)


def _parameters(results: Sequence[Result]) -> list[dict[str, Any]]:
    tables = [
        {(p.data_set, p.member): (p.label, p.value, p.unit) for p in result.model.parameters}
        for result in results
    ]
    keys = list(dict.fromkeys(key for table in tables for key in table))
    found = []
    for key in keys:
        values = [table[key][1] if key in table else None for table in tables]
        if len(set(values)) > 1:
            label, _, unit = next(table[key] for table in tables if key in table)
            found.append({"what": ".".join(key), "label": label, "unit": unit, "values": values})
    return found


def _distance(first: Result, other: Result) -> dict[str, Any]:
    """How far a run is from the first, or why that cannot be said."""
    try:
        found = compare(first, other)
    except SpecError as error:
        return {"reason": error.message}
    return {
        "reason": None,
        "rms_mm": found.position_rms_mm,
        "axes_mm": dict(zip("xyz", found.position_axes_mm, strict=True)),
        "max_mm": found.position_max_mm,
        "relative": found.relative,
        "travel_mm": found.travel_difference_mm,
        "nip_force": found.nip_force,
    }
