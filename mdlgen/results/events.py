"""Events of sheets, motors and torque limiters. Sheets enter and leave rollers, slip, wait, jam, leave gaps
and feed double. They are stopped by ends of plates, and creep where friction holds them.

All events are read from the stored states, so times are those of stored states (`run.print_step`). Exceptions
are sensors and rules, whose events the solver notes as they happen.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Model, RollerPart
from mdlgen.results.contact_line import contact_line
from mdlgen.results.creep import creeps
from mdlgen.results.held import holds
from mdlgen.results.motors import motor_events
from mdlgen.results.passing import passages, there
from mdlgen.results.stacked import stacked
from mdlgen.results.stays import SHORT, Stay, intervals, stays_at_meshes, stays_of
from mdlgen.results.stubs import stops
from mdlgen.units import PER_SECOND

if TYPE_CHECKING:
    from mdlgen.results.result import Result

KINDS = (
    *("entered", "left", "enter", "leave", "slip", "gap", "wait", "jam", "double_feed", "stub", "creep"),
    *("covered", "cleared", "rule"),
    *("stall", "lost_steps", "limiter_slips"),
)
# A sheet that is slower than this [mm/ms] stands: smoothed friction lets what waits under a force creep.
# One that is slower than this part of another one at the same roller is held back while that one is fed.
STANDS, HELD_PART = 0.01, 0.1


def events(result: Result) -> list[dict[str, Any]]:
    """Every event as an object with `time_ms`, `kind`, `sheet`, `roller` (of a stub `part`, of a creep
    `held_by`, of what a sensor sees `sensor`; of a rule neither, but `rule`) and numbers, by time.

    Kinds: `entered` and `left`, of a sheet that comes in and leaves during the run; `enter` and `leave`;
    `slip`, one for each stay of a sheet at a roller; `gap`, where a sheet enters
    a roller that another one was at before; `wait`; `jam`; `double_feed`; `stub`, where the end of a
    plate stops a sheet; `creep`, where regularised friction holds one; `covered` and `cleared`, of a sensor;
    without a sheet `rule`, as one acts, and `stall`, `lost_steps` and `limiter_slips` of a roller. A sheet
    that touches at the start
    enters at 0. docs/reference/events.md says what the numbers are.
    """
    if len(result.time) < 2:
        return []
    stays, together = stays_of(result), stacked(result)
    found = [event for stay in stays for event in _stay_events(result, stay)]
    found += _holds(result, [*stays, *stays_at_meshes(result)], together)
    found += _gaps(result, stays)
    found += _double_feeds(result, [*stays, *_beyond(result, stays, together)])
    found += _stubs(result)
    found += _creeps(result)
    found += result.reactions
    found += motor_events(result)
    found += passages(result)
    order = {"leave": 0, "enter": 1}
    return sorted(found, key=lambda e: (e["time_ms"], order.get(e["kind"], 2), _place(e), e.get("sheet", "")))


def _place(event: dict[str, Any]) -> str:
    if "held_by" in event and "roller" not in event:
        return next(iter(event["held_by"]), "")
    return event.get("roller") or event.get("part") or event.get("sensor") or ""


def _stubs(result: Result) -> list[dict[str, Any]]:
    """Events where the end of a plate stops a sheet that comes to it below, or above, its face."""
    found = []
    for stop in stops(result):
        for first, last in intervals(result.time, stop.held, SHORT):
            inside = slice(first, last + 1)
            if not (stop.force[inside] > 0.0).any():
                continue
            numbers = {
                "duration_ms": float(result.time[last] - result.time[first]),
                "below_mm": float(stop.below[first]),
            }
            at = {"time_ms": float(result.time[first]), "kind": "stub"}
            found.append(at | {"sheet": stop.sheet, "part": stop.part} | numbers)
    return found


def _creeps(result: Result) -> list[dict[str, Any]]:
    """Events where friction that does not stick holds a sheet."""
    contacts, found = result.model.contacts, []
    for creep in creeps(result):
        at = {"time_ms": float(result.time[creep.first]), "kind": "creep"}
        numbers = {
            "duration_ms": float(result.time[creep.last] - result.time[creep.first]),
            "creep_mm": creep.distance,
            "smoothing_mm_per_s": float(contacts.smoothing[creep.row]) * PER_SECOND,
            "stiction_velocity_mm_per_s": float(contacts.stiction_velocity[creep.row]) * PER_SECOND,
        }
        sheet = result.model.sheets[creep.sheet].name
        found.append(at | {"sheet": sheet, "held_by": list(creep.held_by)} | numbers)
    return found


def _beyond(result: Result, stays: list[Stay], together: np.ndarray | None) -> list[Stay]:
    """Sheets that do not touch a roller and lie over or under one that does, one stay for all such states."""
    found: list[Stay] = []
    if together is None:
        return found
    for roller in result.model.rollers:
        here = [s for s in stays if s.roller is roller]
        for sheet in range(len(result.model.sheets)):
            lies = np.zeros(len(result.time), bool)
            for stay in here:
                lies[stay.at] |= together[stay.at, stay.sheet, sheet]
            for stay in here:
                if stay.sheet == sheet:
                    lies[stay.at] = False
            at = np.flatnonzero(lies)
            if at.size:
                boxes = _boxes(result.model, sheet)
                line = contact_line(result, np.arange(boxes.start, boxes.stop), roller, at)
                found.append(Stay(sheet, roller, int(at[0]), int(at[-1]), False, at, line))
    return found


def _event(result: Result, kind: str, at: int, stay: Stay, **numbers: Any) -> dict[str, Any]:
    name = result.model.sheets[stay.sheet].name
    record = {"time_ms": float(result.time[at]), "kind": kind, "sheet": name, "roller": stay.roller.name}
    return record | numbers


def _holds(result: Result, stays: list[Stay], together: np.ndarray | None) -> list[dict[str, Any]]:
    """Waits and jams."""
    found = []
    for stay in stays:
        for hold in holds(result, stay, together):
            numbers: dict[str, Any] = {
                "duration_ms": hold.duration,
                "part_of_surface_speed": hold.part,
                "held_by": list(hold.by),
            }
            found.append(_event(result, "jam" if hold.jammed else "wait", hold.first, stay, **numbers))
    return found


def _stay_events(result: Result, stay: Stay) -> list[dict[str, Any]]:
    """Entering, leaving and slip."""

    def speed(at: int) -> float:
        return float(np.linalg.norm(result.sheet_velocity(stay.sheet, at))) * PER_SECOND

    found = [_event(result, "enter", stay.first, stay, speed_mm_per_s=speed(stay.first))]
    if stay.leaves:
        found.append(_event(result, "leave", stay.last + 1, stay, speed_mm_per_s=speed(stay.last + 1)))
    line = stay.line
    known = line.share > 0.0
    if not known.any():
        return found
    slip, surface = np.linalg.norm(line.sheet - line.roller, axis=1)[known], line.roller[known]
    worst = int(np.argmax(slip))
    numbers: dict[str, Any] = {
        "mean_mm_per_s": float(slip.mean()) * PER_SECOND,
        "max_mm_per_s": float(slip[worst]) * PER_SECOND,
        "contact_ms": float(result.time[stay.last] - result.time[stay.first]),
    }
    if stay.roller.speed:
        fast = float(np.linalg.norm(surface, axis=1).mean())
        numbers["part_of_surface_speed"] = float(slip.mean()) / fast if fast > 0.0 else None
    found.append(_event(result, "slip", int(stay.at[known][worst]), stay, **numbers))
    return found


def _faces(roller: RollerPart, other: RollerPart) -> bool:
    """True if two rollers are parallel, over each other, and clear each other by less than a radius."""
    away = other.center - roller.center
    along = abs(float(away @ roller.axis))
    across = float(np.linalg.norm(away - roller.axis * (away @ roller.axis)))
    parallel = abs(float(roller.axis @ other.axis)) > 1.0 - 1e-9
    near = across < roller.radius + other.radius + max(roller.radius, other.radius)
    return parallel and near and along < 0.5 * (roller.width + other.width)


def _gaps(result: Result, stays: list[Stay]) -> list[dict[str, Any]]:
    """The distance along the way from the end of the sheet that went before to the start of the next."""
    found, here_now = [], there(result)
    for roller in result.model.rollers:
        here = sorted((s for s in stays if s.roller is roller), key=lambda s: s.first)
        for before, stay in pairwise(here):
            if before.sheet == stay.sheet or stay.first == 0:
                continue
            rate = result.sheet_velocity(stay.sheet, stay.first)
            fast = float(np.linalg.norm(rate))
            if fast <= STANDS:  # it lay under the one before
                continue
            ahead = _reach(result, before.sheet, stay.first, rate / fast)
            behind = _reach(result, stay.sheet, stay.first, rate / fast)
            known = here_now is None or here_now[stay.first, before.sheet]  # one that has left is nowhere
            numbers: dict[str, Any] = {
                "before": result.model.sheets[before.sheet].name,
                "gap_mm": ahead[0] - behind[1] if known else None,
                "gap_ms": None,
            }
            if before.leaves and before.last < stay.first:
                numbers["gap_ms"] = float(result.time[stay.first] - result.time[before.last + 1])
            found.append(_event(result, "gap", stay.first, stay, **numbers))
    return found


def _reach(result: Result, sheet: int, at: int, way: Floats) -> tuple[float, float]:
    """Range of a sheet along a direction [mm]."""
    boxes = _boxes(result.model, sheet)
    turn = turns(result.rotation[at, boxes])
    half = (np.abs(np.einsum("nij,i->nj", turn, way)) * result.model.bodies.half[boxes]).sum(axis=1)
    center = result.position[at, boxes] @ way
    return float((center - half).min()), float((center + half).max())


def _double_feeds(result: Result, stays: list[Stay]) -> list[dict[str, Any]]:
    """Two sheets at one roller, or at two that face each other, at once and at one place along them, that
    both go on, by more than a thickness; one event for rollers that face each other.

    Two that creep below a third, as those of a high pile do while the upper one is fed, are held back.
    """
    nips = _nips(result.model)
    fastest = {nip: np.zeros(len(result.time)) for nip in nips.values()}
    for stay in stays:
        there = fastest[nips[stay.roller.name]]
        there[stay.at] = np.maximum(there[stay.at], np.linalg.norm(stay.line.sheet, axis=1))
    feeds: dict[tuple[int, int, int], tuple[Stay, Stay, Floats]] = {}
    for k, one in enumerate(stays):
        for other in stays[k + 1 :]:
            if one.sheet == other.sheet:
                continue
            if one.roller is not other.roller and not _faces(one.roller, other.roller):
                continue
            at, mine, theirs = np.intersect1d(one.at, other.at, return_indices=True)
            low = np.maximum(one.line.low[mine], other.line.low[theirs])
            high = np.minimum(one.line.high[mine], other.line.high[theirs])
            key = nips[one.roller.name], min(one.sheet, other.sheet), max(one.sheet, other.sheet)
            speed = feeds.setdefault(key, (one, other, np.zeros(len(result.time))))[2]
            go = _both_go(one.line.sheet[mine], other.line.sheet[theirs])
            speed[at] = np.maximum(speed[at], np.where(high > low, go, 0.0))
    found: list[dict[str, Any]] = []
    for (nip, _, _), (one, other, speed) in feeds.items():
        speed[speed <= HELD_PART * fastest[nip]] = 0.0
        for first, last in intervals(result.time, speed > 0.0, SHORT):
            both = slice(first, last + 1)
            way = float(np.trapezoid(speed[both], result.time[both]))
            if way < min(result.model.sheets[stay.sheet].thickness for stay in (one, other)):
                continue  # it trembles where it lies
            numbers = {
                "other": result.model.sheets[other.sheet].name,
                "duration_ms": float(result.time[last] - result.time[first]),
                "way_mm": way,
            }
            found.append(_event(result, "double_feed", first, one, **numbers))
    return found


def _both_go(one: Floats, other: Floats) -> Floats:
    """The speed [mm/ms] of the slower of two with velocities (t, 3), 0 where one stands or is held back while
    the other goes."""
    along = np.einsum("tk,tk->t", one, other)
    squares = np.maximum(np.einsum("tk,tk->t", one, one), np.einsum("tk,tk->t", other, other))
    least = np.minimum(np.linalg.norm(one, axis=1), np.linalg.norm(other, axis=1))
    return np.where((least > STANDS) & (along > HELD_PART * squares), least, 0.0)


def _nips(model: Model) -> dict[str, int]:
    """A number for each roller, the same for all that face each other."""
    nip = {roller.name: k for k, roller in enumerate(model.rollers)}
    for k, one in enumerate(model.rollers):
        for other in model.rollers[k + 1 :]:
            if _faces(one, other):
                old, new = nip[other.name], nip[one.name]
                nip = {name: new if number == old else number for name, number in nip.items()}
    return nip


def _boxes(model: Model, sheet: int) -> slice:
    part = model.sheets[sheet]
    return slice(part.first, part.first + part.count)
