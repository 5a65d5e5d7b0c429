"""Requirements of a scene: parses the texts of `require`.

no EVENT [at PART]
[not] SHEET entered | left, [not] STREAM entered | left, [not] SENSOR covered | clear    at the end
MEASURE below VALUE | above VALUE | within VALUE [of VALUE] | from VALUE to VALUE    [at TIME | throughout]
gap | speed | skew | position  at SENSOR  below VALUE | ..
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from mdlgen.errors import did_you_mean
from mdlgen.units import parse_number, parse_quantity, parse_unit, same

EVENTS = (
    *("entered", "left", "enter", "leave", "slip", "gap", "wait", "jam", "double_feed", "stub", "creep"),
    *("covered", "cleared", "rule"),
    *("stall", "lost_steps", "limiter_slips"),
)
# of each sheet that goes by a sensor
AT_SENSORS = ("gap", "speed", "skew", "position")
# what a sheet, all of a stream, or a sensor is at the end
OF_SHEETS, OF_SENSORS = ("entered", "left"), ("covered", "clear")
FORMS = (
    "no EVENT [at PART], SHEET entered, SHEET left, SENSOR covered, SENSOR clear, "
    "these with not before them, MEASURE below VALUE, MEASURE above VALUE, MEASURE within "
    "VALUE [of VALUE], MEASURE from VALUE to VALUE, with at TIME or throughout behind the last four; and "
    "gap, speed, skew or "
    "position at SENSOR before below, above, within, from"
)
MOST = 200  # characters of one
_NO = re.compile(r"no\s+(\S+)(?:\s+at\s+(\S+))?", re.ASCII)
_STATE = re.compile(rf"(not\s+)?([A-Za-z]\w*)\s+({'|'.join((*OF_SHEETS, *OF_SENSORS))})", re.ASCII)
_LIMIT = re.compile(
    r"([A-Za-z_][\w.]*)(?:\s+at\s+([A-Za-z]\w*))?\s+(below|above|within|from)\s+(.+?)(?:\s+(throughout)|\s+at\s+(.+?))?",
    re.ASCII,
)
_NONE = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Requirement:
    """One requirement: an event that must not be, a state at the end, or a measure between two limits (inf:
    none there)."""

    text: str
    event: str | None = None
    part: str | None = None  # at which the event must not be, None: anywhere
    sensor: str | None = None  # at which each sheet is measured
    state: str | None = None  # which `part` has to be in at the end, or must not be where it is `negated`
    negated: bool = False
    measure: str | None = None  # dotted name in the summary, without its unit
    low: float = -math.inf  # in the internal units
    high: float = math.inf
    unit: str = ""  # in which values are shown, empty: a plain number
    dimension: tuple[float, float, float, float] = _NONE
    at: float | None = None  # [ms]; None: at the end
    throughout: bool = False


def requirement(text: str) -> Requirement:
    """Reads one. Raises ValueError, with the forms that are allowed."""
    text = " ".join(text.split())
    if len(text) > MOST:
        raise ValueError(f"{text[:40]!r}... has {len(text)} characters; allowed are {MOST}")
    found = _NO.fullmatch(text)
    if found:
        event, part = found[1], found[2]
        if event not in EVENTS:
            raise ValueError(
                f"{event!r} is no event{did_you_mean(event, EVENTS)}; events are {', '.join(EVENTS)}"
            )
        return Requirement(text, event=event, part=part)
    found = _STATE.fullmatch(text)
    if found:
        return Requirement(text, part=found[2], state=found[3], negated=found[1] is not None)
    found = _LIMIT.fullmatch(text)
    if not found:
        signs = "; in place of < and > write below and above" if re.search("[<>]", text) else ""
        raise ValueError(f"{text[:80]!r} is not understood{signs}; the forms are {FORMS}")
    measure, sensor, how, values, always, time = found.groups()
    if sensor is not None and (measure not in AT_SENSORS or always or time):
        raise ValueError(
            f"{text[:80]!r} is not understood; of sheets that go by a sensor there are "
            f"{', '.join(AT_SENSORS)}, as gap at exit from 20 mm to 30 mm, without a time"
        )
    low, high, unit = _limits(how, values)
    return Requirement(
        text=text,
        measure=measure,
        sensor=sensor,
        low=low,
        high=high,
        unit=unit,
        dimension=_dimension(unit),
        at=None if time is None else parse_quantity(time, "ms"),
        throughout=always is not None,
    )


def _dimension(unit: str) -> tuple[float, float, float, float]:
    return _NONE if unit in ("", "%") else parse_unit(unit).dimension


def _limits(how: str, values: str) -> tuple[float, float, str]:
    """Both limits, and the unit of the first value."""
    word = {"from": " to ", "within": " of "}.get(how)
    first, _, second = values.partition(word) if word else (values, "", "")
    if how == "from" and not second:
        raise ValueError(f"'from {first}' has no end; write 'from VALUE to VALUE'")
    one, unit = _value(first)
    other, behind = _value(second) if second else (0.0, unit)
    if not same(_dimension(unit), _dimension(behind)):
        raise ValueError(f"{first.strip()} and {second.strip()} have units of two kinds")
    if how == "below":
        return -math.inf, one, unit
    if how == "above":
        return one, math.inf, unit
    if how == "within":
        if one < 0.0:
            raise ValueError(f"'within {first.strip()}' is below zero; nothing is within it")
        return other - one, other + one, unit
    if other < one:
        raise ValueError(f"'from {first.strip()} to {second.strip()}' ends below its begin")
    return one, other, unit


def _value(text: str) -> tuple[float, str]:
    """A value in internal units and its unit; a plain number, and % of 1, have none."""
    text = text.strip()
    if text.endswith("%"):
        text, part = text[:-1].strip(), 0.01
    else:
        part = None
    try:
        number = float(text)
    except ValueError:
        if part is not None:
            raise ValueError(f"{text[:40]!r} is not a number in front of %") from None
        return parse_number(text, "1 mm")
    if not math.isfinite(number):
        raise ValueError(f"{text[:40]!r} is not finite")
    return (number, "") if part is None else (number * part, "%")
