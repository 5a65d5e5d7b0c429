"""Compares two or more runs: values that were set differently, their results, and the distances between the
sheets."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any

from mdlgen.errors import SpecError
from mdlgen.results.compare import compare
from mdlgen.results.result import Result

# of summary.json: a list of events or of names is no number to compare; verdicts have a table of their own
_LEFT_OUT = ("events", "versions", "estimates", "estimate_scales", "verdict", "rules")
# Numbers nearer to each other than this part of the greatest, or than this, are the same.
SAME = 1e-9
# Results that judge a design. Places of extremes, and the computing cost, follow behind them.
_OUTCOMES = ("sheets.", "probes.", "rollers.", "planes.")
_DETAILS = ("boxes", "bushings", "at_mm", "at_ms", "joint", "contacts", "rounds")


def differences(
    results: Sequence[Result], names: Sequence[str], summaries: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """For the page: parameters and lines of the scene that are not the same in all runs; rows of numbers
    that are not (what, one value a run, differences to the first and their parts of it), first `outcomes`,
    then `others`; those that are the `same`; and the distance of each run from the first."""
    flat = [dict(_flat({k: v for k, v in record.items() if k not in _LEFT_OUT})) for record in summaries]
    keys = list(dict.fromkeys(key for record in flat for key in record))
    outcomes, others, same = [], [], []
    for key in keys:
        values = [record.get(key) for record in flat]
        row: dict[str, Any] = {"what": key, "values": values, "less": None}
        if not any(isinstance(value, str) for value in values):
            row["less"] = [_less(v, values[0]) for v in values[1:]]
        if _equal(values):
            same.append(row)
        else:
            (outcomes if _is_outcome(key) else others).append(row)
    return {
        "names": list(names),
        "outcomes": outcomes,
        "others": others,
        "same": same,
        "parameters": _parameters(results),
        "lines": [_lines(results[0], other) for other in results[1:]],
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


def _is_outcome(key: str) -> bool:
    return key.startswith(_OUTCOMES) and not set(key.split(".")) & set(_DETAILS)


def _equal(values: Sequence[Any]) -> bool:
    """True if all runs have one value, but for round-off."""
    if any(value is None or isinstance(value, str) for value in values):
        return len(set(values)) == 1
    return max(values) - min(values) <= SAME * max(1.0, *map(abs, values))


def _less(value: Any, first: Any) -> tuple[float, float | None] | None:
    """Difference to the first run, and which part of that it is."""
    if value is None or first is None:
        return None
    less = float(value) - float(first)
    return less, less / abs(first) if abs(first) > SAME else None


def _lines(first: Result, other: Result) -> str:
    """The lines of both scenes, as they were written, that are not the same."""
    found = difflib.unified_diff(first.source.split("\n"), other.source.split("\n"), n=0, lineterm="")
    return "\n".join(line for line in found if not line.startswith(("---", "+++", "@@")))


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
    """Distance of a run from the first one, or the reason why it is not known."""
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
