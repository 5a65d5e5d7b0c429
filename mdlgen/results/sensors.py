"""Readings of sensors over a run: how often each was covered, and each sheet that passed it."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Measures of a sheet that passes a sensor, by the word of a requirement, and its name in the summary.
MEASURES = {
    "gap": "gap_mm",
    "speed": "speed_mm_per_s",
    "skew": "skew_deg",
    "position": "position_mm",
}
OF_PASSING = (*MEASURES.values(), "gap_ms")


def of_sensors(result: Result) -> dict[str, dict[str, Any]]:
    """By name: `count`, how often each was covered; whether it is `covered` at the end; `passed`, each sheet
    that went by, with the times [ms] at which it covered and cleared the sensor, None: not yet."""
    found: dict[str, dict[str, Any]] = {}
    for sensor in result.model.reactions.sensors:
        own = [row for row in result.reactions if row.get("sensor") == sensor.name]
        passed = []
        for row, after in pairwise([*own, {}]):
            if row["kind"] != "covered":
                continue
            cleared = after.get("time_ms")
            numbers = {name: row[name] for name in OF_PASSING}
            passed.append(
                {"sheet": row["sheet"], "covered_at_ms": row["time_ms"], "cleared_at_ms": cleared} | numbers
            )
        covered = bool(own) and own[-1]["kind"] == "covered"
        found[sensor.name] = {"count": len(passed), "covered": covered, "passed": passed}
    return found


def of_rules(result: Result) -> list[dict[str, Any]]:
    """Each rule as it is listed: its condition `when`, and how often it `acted`."""
    acts = [row["rule"] for row in result.reactions if row["kind"] == "rule"]
    return [
        {"when": rule.when, "acted": acts.count(k)} for k, rule in enumerate(result.model.reactions.rules)
    ]
