"""Judges the requirements of a scene after a run, and lists events that a reader should know of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.model.tables import Floats
from mdlgen.results.estimates import SAFETY_REST
from mdlgen.results.notable import notable
from mdlgen.results.over_time import series
from mdlgen.results.passing import came, there
from mdlgen.results.result import OK
from mdlgen.results.sensors import MEASURES
from mdlgen.spec.require import OF_SENSORS, OF_SHEETS, Requirement, requirement
from mdlgen.units import parse_unit, same

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Endings of names in the summary, and the units that they stand for; the longest first.
UNITS = {
    "_mm_per_s": "mm/s",
    "_rad_per_s": "rad/s",
    "_per_mm": "1/mm",
    "_n_mm": "N*mm",
    "_mm": "mm",
    "_deg": "deg",
    "_ms": "ms",
    "_n": "N",
    "_w": "W",
}
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Outcome:
    """Outcome of one requirement. `value` and `margin` are in `unit`; a margin below zero is the shortfall. A
    measure that is not known has the value None, and its requirement is missed."""

    requirement: str
    passed: bool
    value: float | None
    unit: str
    margin: float | None
    of: str | None = None  # the sheet that is worst, of a measure that every sheet has
    doubtful: bool = False  # true if the error of the run could reverse it

    def __str__(self) -> str:
        verdict = "pass" if self.passed else "FAIL"
        if self.doubtful:
            verdict += ", but within the error"
        if self.value is None:
            return f"{verdict}  {self.requirement}: not known"
        if self.margin is None:
            text = f"{verdict}  {self.requirement}"
            if self.of:  # of several sheets the first for which it is not so
                return f"{text}: {self.of}" + (f" and {self.value - 1:g} more" if self.value > 1 else "")
            return text + (
                f": {self.value:g} times" if self.value and self.requirement.startswith("no ") else ""
            )
        unit = "" if self.unit in ("", "%") else f" {self.unit}"
        end = self.unit if self.unit == "%" else ""
        # a value that is small compared with its distance from the limit is round-off
        value = 0.0 if abs(self.value) < ROUND_OFF * abs(self.margin) else self.value
        whose = f" of {self.of}" if self.of else ""
        unit = end + unit
        return f"{verdict}  {self.requirement}: {value:.4g}{unit}{whose}, margin {self.margin:.3g}{unit}"


def verdict(result: Result, record: Mapping[str, Any]) -> dict[str, Any]:
    """The content of `verdict` in summary.json, from a summary: `passed` (None: nothing is required), each
    requirement with its value and margin, and notable events in words. A requirement also says if the error
    of the run could reverse it. Raises SpecError."""
    outcomes = judge(result, record)
    return {
        "passed": all(o.passed for o in outcomes) if outcomes else None,
        "requirements": [
            {
                "requirement": o.requirement,
                "passed": o.passed,
                "value": o.value,
                "unit": o.unit,
                "margin": o.margin,
                "doubtful": o.doubtful,
                **({"of": o.of} if o.of else {}),
            }
            for o in outcomes
        ],
        "events": [in_words(event) for event in notable(record.get("events", ()))],
    }


def outcomes_of(record: Mapping[str, Any]) -> list[Outcome]:
    """The outcomes that a summary holds."""
    return [Outcome(**row) for row in record.get("verdict", {}).get("requirements", ())]


def in_words(event: Mapping[str, Any]) -> str:
    """An event as a person says it."""
    if event["kind"] == "creep":
        return f"{event['sheet']} {creep_in_words(event)}"
    if event["kind"] == "rule":
        return f"rule {event['rule']} ({event['when']}): {event['does']} at {event['time_ms']:.4g} ms"
    if "sheet" not in event:
        return motor_in_words(event)
    kind = str(event["kind"]).replace("_", " ")
    where = event.get("roller") or event.get("part") or event.get("sensor")
    who = f"{event['sheet']} and {event['other']}" if "other" in event else str(event["sheet"])
    text = f"{kind} of {who}" + (f" at {where}" if where else "")
    if event["kind"] == "slip":
        part = f"{100.0 * abs(event['part_of_surface_speed']):.0f} % of the surface's speed"
        return f"{text}, {part}, most at {event['time_ms']:.4g} ms"
    text += f" from {event['time_ms']:.4g} ms"
    if event.get("held_by"):
        text += f", held by {', '.join(event['held_by'])}"
    if "way_mm" in event:
        text += f", the slower one goes {event['way_mm']:.3g} mm"
    return text


def motor_in_words(event: Mapping[str, Any]) -> str:
    """The message about an event of a motor or a torque limiter."""
    at = f"at {event['roller']} from {event['time_ms']:.4g} ms"
    if event["kind"] == "lost_steps":
        return f"stepper {at} loses {event['steps']} steps"
    if event["kind"] == "stall":
        return f"motor {at} stalls for {event['duration_ms']:.4g} ms with {event['torque_n_mm']:.4g} N mm"
    return f"limiter {at} slips for {event['duration_ms']:.4g} ms by {event['slip_rad']:.3g} rad"


def creep_in_words(event: Mapping[str, Any]) -> str:
    """The message about a sheet that creeps; `friction.sticking` of the contact avoids it."""
    smoothing, stiction = event["smoothing_mm_per_s"], event["stiction_velocity_mm_per_s"]
    speed = f"{'smoothing' if smoothing == stiction else 'stiction velocity'} {stiction:.3g} mm/s"
    return (
        f"is held by friction at {', '.join(event['held_by'])} for {event['duration_ms']:.3g} ms and creeps "
        f"by {event['creep_mm']:.2g} mm: {speed}; sticking holds it"
    )


def judge(result: Result, record: Mapping[str, Any]) -> list[Outcome]:
    """The outcome of each requirement, with the doubt that `doubts` has found; of a run that ended early none
    is known. Raises SpecError for a measure that the run has not."""
    if not result.usable:
        return [Outcome(text, False, None, "", None) for text in result.model.require]
    return [_with_doubt(found, result) for found in _judged(result, record)]


def _judged(result: Result, record: Mapping[str, Any]) -> list[Outcome]:
    return [judged(result, record, k) for k in range(len(result.model.require))]


def judged(result: Result, record: Mapping[str, Any], k: int) -> Outcome:
    """The outcome of the requirement of index k, without doubt. Raises SpecError as `judge`."""
    wanted = requirement(result.model.require[k])
    try:
        if wanted.event:
            return _event(wanted, record)
        return _state(result, record, wanted) if wanted.state else _limit(result, record, wanted)
    except ValueError as error:
        raise SpecError(f"{wanted.text!r}: {error}", ("require", k)) from None


def doubts(
    result: Result, record: Mapping[str, Any], others: Sequence[tuple[Result, Mapping[str, Any]]]
) -> dict[str, float]:
    """Error bound of each value: SAFETY_REST times the difference to the first of the runs at other
    steps, each with its record; for an event the number of times by which they differ. inf where the error
    of a complete run is not known; none where no other run was asked for."""
    if not result.usable or not result.model.require:
        return {}
    if not others or result.error_unknown:
        unknown = result.status != OK
        return dict.fromkeys(result.model.require, math.inf) if unknown else {}
    found = {}
    for one, other in zip(_judged(result, record), _judged(*others[0]), strict=True):
        if one.value is None or other.value is None:
            found[one.requirement] = math.inf
            continue
        apart = abs(one.value - other.value)
        found[one.requirement] = apart if one.margin is None else SAFETY_REST * apart
    return found


def _with_doubt(found: Outcome, result: Result) -> Outcome:
    doubt = result.doubts.get(found.requirement, 0.0)
    if found.margin is None:  # an event, which happened or did not; or a value that is not known
        return replace(found, doubtful=found.value is not None and doubt > 0.0 and doubt >= found.value)
    return replace(found, doubtful=doubt > 0.0 and doubt >= abs(found.margin))


def _event(wanted: Requirement, record: Mapping[str, Any]) -> Outcome:
    count = 0
    for event in record["events"]:
        keys = ("sheet", "roller", "other", "part", "sensor")
        parts = {event.get(key) for key in keys} | {*event.get("held_by", ())}
        count += event["kind"] == wanted.event and (wanted.part is None or wanted.part in parts)
    return Outcome(wanted.text, count == 0, float(count), "", None)


def _state(result: Result, record: Mapping[str, Any], wanted: Requirement) -> Outcome:
    """Verdict on the state of a sheet, a stream or a sensor at the end; the value counts those not in it."""
    part = str(wanted.part)
    streams = dict(result.model.reactions.streams)
    sheets = [result.model.sheets[k].name for k in streams.get(part, ())]
    names, key = sheets if part in streams and wanted.state in OF_SHEETS else [part], f"{wanted.state}_ms"
    if wanted.state in OF_SENSORS:
        wrong = [part] if record["sensors"][part]["covered"] == (wanted.state == "clear") else []
    else:
        # one that is there throughout has no times
        wrong = [
            n for n in names if record["sheets"][n].get(key, 0.0 if key == "entered_ms" else None) is None
        ]
    if wanted.negated:
        wrong = [name for name in names if name not in wrong]
    first = wrong[0] if wrong and len(names) > 1 else None
    return Outcome(wanted.text, not wrong, float(len(wrong)), "", None, first)


def _limit(result: Result, record: Mapping[str, Any], wanted: Requirement) -> Outcome:
    assert wanted.measure is not None, "a requirement without an event has a measure"
    if wanted.sensor is not None:
        return _at_sensor(record, wanted, wanted.sensor)
    each = (head := wanted.measure.partition(".")[0]) not in record
    if each and head != wanted.measure:
        _in_each(record, head)
    names = _concerned(result, record, wanted) if each else [None]
    if not names:
        return Outcome(wanted.text, False, None, wanted.unit, None)
    rows = []
    for name in names:
        path = f"sheets.{name}.{wanted.measure}" if each else wanted.measure
        values, unit = _values(result, record, path, wanted)
        rows.append((*_worst(values, wanted), unit, name))
    value, margin, unit, of = min(rows, key=lambda row: -math.inf if row[1] is None else row[1])
    shown = wanted.unit or unit
    per = 0.01 if shown == "%" else parse_unit(shown).factor if shown else 1.0
    if value is None or margin is None:
        return Outcome(wanted.text, False, None, shown, None, of)
    return Outcome(
        wanted.text, margin >= 0.0, value / per, shown, margin / per, of if len(names) > 1 else None
    )


def _in_each(record: Mapping[str, Any], head: str) -> None:
    """Raises ValueError where the head of a dotted name is neither a table nor a measure of each sheet."""
    tables = [key for key, value in record.items() if isinstance(value, Mapping) and value]
    own = [_bare(key) for sheet in record["sheets"].values() for key in sheet]
    if head not in own:
        known = list(dict.fromkeys([*tables, *own]))
        raise ValueError(
            f"there is no {head!r}{did_you_mean(head, known) or ';'} there are {', '.join(known)}"
        )


def _at_sensor(record: Mapping[str, Any], wanted: Requirement, sensor: str) -> Outcome:
    """Outcome for sheets that passed a sensor; if none did, or no two, nothing is known."""
    name = MEASURES[wanted.measure or ""]
    if wanted.measure == "gap" and same(wanted.dimension, parse_unit("ms").dimension):
        name = "gap_ms"  # a gap is a length or a time, as its limit is
    unit = next(unit for end, unit in UNITS.items() if name.endswith(end))
    own = parse_unit(unit)
    if not same(own.dimension, wanted.dimension):
        raise ValueError(
            f"{wanted.measure} at {sensor} is in {unit}, the limit {wanted.unit or 'has no unit'}; "
            f"give the limit in {unit}{', or in ms' if wanted.measure == 'gap' else ''}"
        )
    passed = [row for row in record["sensors"][sensor]["passed"] if row[name] is not None]
    value, margin = _worst(np.array([own.factor * row[name] for row in passed]), wanted)
    if value is None or margin is None:
        return Outcome(wanted.text, False, None, wanted.unit, None)
    per = parse_unit(wanted.unit).factor
    worst = min(passed, key=lambda row: abs(own.factor * row[name] - value))["sheet"]
    of = worst if len(passed) > 1 else None
    return Outcome(wanted.text, margin >= 0.0, value / per, wanted.unit, margin / per, of)


def _concerned(result: Result, record: Mapping[str, Any], wanted: Requirement) -> list[str]:
    """The sheets that a measure of every sheet is asked of: those that are there at its time, or were at any;
    of when sheets come in and leave all."""
    when, names = there(result), list(record["sheets"])
    if when is None or str(wanted.measure).removesuffix("_ms") in ("entered", "left"):
        return names
    if wanted.at is not None:
        at = int(np.argmin(np.abs(result.time - wanted.at)))
        return [name for k, name in enumerate(names) if when[at, k]]
    return [name for k, name in enumerate(names) if came(result, k)]


def _worst(values: Floats, wanted: Requirement) -> tuple[float | None, float | None]:
    """The value with the least margin, and that margin."""
    if not values.size or not np.isfinite(values).all():
        return None, None
    margins = np.minimum(values - wanted.low, wanted.high - values)
    at = int(margins.argmin())
    return float(values[at]), float(margins[at])


def _values(result: Result, record: Mapping[str, Any], path: str, wanted: Requirement) -> tuple[Floats, str]:
    """Values of a measure in internal units at the times asked for, and the unit of the summary."""
    value, unit = _of_summary(record, path)
    own = parse_unit(unit) if unit else None
    if wanted.unit not in ("", "%") or own is not None:
        have = (0.0, 0.0, 0.0, 0.0) if own is None else own.dimension
        if not same(have, wanted.dimension):
            has = f"is in {unit}" if unit else "has no unit"
            raise ValueError(
                f"{path} {has}, the limit {f'is in {wanted.unit}' if wanted.unit else 'has no unit'}"
            )
    if wanted.throughout:
        return _while_there(result, path, series(result, path)), unit
    if wanted.at is not None:
        end = result.model.run.duration
        if not 0.0 <= wanted.at <= end * (1.0 + 1e-9):
            raise ValueError(f"{wanted.at:g} ms is not in the run of {end:g} ms")
        return np.array([np.interp([wanted.at], result.time, series(result, path))[0]]), unit
    if value is None:
        return np.zeros(0), unit
    return np.array([value * (own.factor if own is not None else 1.0)]), unit


def _while_there(result: Result, path: str, values: Floats) -> Floats:
    """Values of a measure of a sheet at the times at which the sheet is present."""
    when, words = there(result), path.split(".")
    number = {sheet.name: k for k, sheet in enumerate(result.model.sheets)}
    if when is None or words[0] != "sheets" or words[1] not in number:
        return values
    return values[when[:, number[words[1]]]]


def _of_summary(record: Mapping[str, Any], path: str) -> tuple[float | None, str]:
    """A number of the summary by its dotted name without the unit: of a vector its length, of what joints
    bore the greatest in size; and the unit that its name in the summary has."""
    node: Any = record
    unit = ""
    for part in path.split("."):
        if isinstance(node, (list, tuple)) and part in ("x", "y", "z") and len(node) == 3:
            node = node["xyz".index(part)]
            continue
        if not isinstance(node, Mapping):
            raise ValueError(f"{path} continues behind a number")
        key, unit = _key(node, part, path)
        node = node[key]
    if isinstance(node, Mapping):
        peaks = {k: v for k, v in node.items() if k.startswith(("max", "min"))}
        if not peaks:
            raise ValueError(f"{path} is no number; it has {', '.join(map(str, node))}")
        unit = unit or next((u for k in peaks for end, u in UNITS.items() if k.endswith(end)), "")
        node = max((abs(v) for v in peaks.values() if v is not None), default=None)
    if isinstance(node, (list, tuple)):
        node = None if any(v is None for v in node) else math.hypot(*node)
    if isinstance(node, str):
        raise ValueError(f"{path} is a text")
    return (None if node is None else float(node)), unit


def _key(node: Mapping[str, Any], part: str, path: str) -> tuple[str, str]:
    if part in node:
        ends = next(((end, unit) for end, unit in UNITS.items() if part.endswith(end)), ("", ""))
        return part, ends[1]
    for end, unit in UNITS.items():
        if f"{part}{end}" in node:
            return f"{part}{end}", unit
    known = [_bare(key) for key in node]
    raise ValueError(
        f"there is no {part!r} in {path}{did_you_mean(part, known) or ';'} there are {', '.join(known)[:200]}"
    )


def _bare(key: str) -> str:
    return next((key.removesuffix(end) for end in UNITS if key.endswith(end)), key)
