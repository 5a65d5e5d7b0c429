"""Events of a run as a person says them, those of several rollers at once in one row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mdlgen.report.html.wording import shown
from mdlgen.results.verdict import creep_in_words, motor_in_words


def happened(events: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Rows of a table by time: `time_ms`, `kind`, `places` and `text`; places are rollers, the part of a
    stub, or what holds a sheet that creeps."""
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    for event in events:
        kind, text = str(event["kind"]).replace("_", " "), _WORDS.get(event["kind"], _other)(event)
        place = str(
            event.get("roller")
            or event.get("part")
            or event.get("sensor")
            or ", ".join(event.get("held_by", ()))
        )
        # events that look alike: both sides of a machine
        key = shown(event["time_ms"]), kind, text
        row = rows.setdefault(key, {"time_ms": event["time_ms"], "kind": kind, "places": [], "text": text})
        row["places"].append(place)
    return list(rows.values())


def _moves(event: Mapping[str, Any]) -> str:
    what = "comes" if event["kind"] == "enter" else "leaves"
    return f"{event['sheet']} {what} at {shown(event['speed_mm_per_s'])} mm/s"


def _slips(event: Mapping[str, Any]) -> str:
    text = f"{event['sheet']} slips by {shown(event['mean_mm_per_s'])} mm/s on average"
    part = event.get("part_of_surface_speed")
    if part is not None:
        text += f" ({100.0 * part:.2g} % of the surface's speed)"
    return (
        f"{text}, {shown(event['max_mm_per_s'])} mm/s at most, in {shown(event['contact_ms'])} ms of contact"
    )


def _waits(event: Mapping[str, Any]) -> str:
    what = "is jammed" if event["kind"] == "jam" else "waits"
    part = 100.0 * event["part_of_surface_speed"]
    by = f", held by {', '.join(event['held_by'])}" if event.get("held_by") else ""
    time = shown(event["duration_ms"])
    return f"{event['sheet']} {what}, {time} ms, at {part:.2g} % of the surface's speed{by}"


def _gap(event: Mapping[str, Any]) -> str:
    gap = event["gap_mm"]
    text = f"{event['sheet']} comes {shown(abs(gap))} mm " + (
        f"behind {event['before']}" if gap >= 0.0 else f"before the end of {event['before']}"
    )
    return text if event["gap_ms"] is None else f"{text}, {shown(event['gap_ms'])} ms after it left"


def _feeds(event: Mapping[str, Any]) -> str:
    who = f"{event['sheet']} and {event['other']}"
    text = f"{who} go on together for {shown(event['duration_ms'])} ms"
    return f"{text}, the slower one by {shown(event['way_mm'])} mm"


def _stub(event: Mapping[str, Any]) -> str:
    below = f"{shown(event['below_mm'])} mm below its face"
    return f"{event['sheet']} is stopped by its end for {shown(event['duration_ms'])} ms, {below}"


def _other(event: Mapping[str, Any]) -> str:
    numbers = (f"{key} {shown(value)}" for key, value in event.items() if isinstance(value, float))
    return f"{event['sheet']}: {', '.join(numbers)}"


def _creeps(event: Mapping[str, Any]) -> str:
    return f"{event['sheet']} {creep_in_words(event)}"


def _sees(event: Mapping[str, Any]) -> str:
    text = f"{event['sheet']} at {shown(event['speed_mm_per_s'])} mm/s"
    if event["kind"] == "cleared":
        return f"{text} has gone" + (
            "" if event["covered_ms"] is None else f", after {shown(event['covered_ms'])} ms"
        )
    text += f", skew {shown(event['skew_deg'])} deg"
    return text if event["gap_mm"] is None else f"{text}, {shown(event['gap_mm'])} mm behind the one before"


def _rule(event: Mapping[str, Any]) -> str:
    return f"rule {event['rule']}, {event['when']}: {event['does']}"


_WORDS = {
    "enter": _moves, "leave": _moves, "slip": _slips, "wait": _waits, "jam": _waits, "gap": _gap,
    "double_feed": _feeds, "stub": _stub, "creep": _creeps,
    "covered": _sees, "cleared": _sees, "rule": _rule,
    "stall": motor_in_words, "lost_steps": motor_in_words, "limiter_slips": motor_in_words,
}  # fmt: skip
