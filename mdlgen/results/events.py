"""What happens to sheets: at rollers entering and leaving, slip, gaps, waits, jams, double feeds; at the ends
of plates stubs.

All of it is read from the stored states, so times are those of stored states (`run.print_step`).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.rotations import turns
from mdlgen.model.tables import BOX_CYLINDER, Floats, Ints, Model, RollerPart
from mdlgen.results.contact_line import ContactLine, chosen, contact_line, of_row
from mdlgen.results.stacked import stacked
from mdlgen.results.stubs import stops
from mdlgen.units import PER_SECOND

if TYPE_CHECKING:
    from mdlgen.results.result import Result

KINDS = ("enter", "leave", "slip", "gap", "wait", "jam", "double_feed", "stub")
# A force below this part of a contact's greatest is a graze, as in the solvers' account of nips.
GRAZE = 0.05
# A sheet that bounces off for a shorter time has not left [ms], and one that touches for a shorter time
# only grazes.
SHORT = 1.0
# A sheet that is slower than this part of the surface of a driven nip, for longer than this, waits; it is
# jammed where the run ends so.
JAM_PART, JAM_TIME = 0.1, 5.0
# A sheet that is slower than this [mm/ms] stands: smoothed friction lets what waits under a force creep.
# One that is slower than this part of another one is held back while that one is fed.
STANDS, HELD_PART = 0.01, 0.1


@dataclass(frozen=True)
class Stay:
    """A sheet at a roller, from one stored time to another."""

    sheet: int
    roller: RollerPart
    first: int  # stored states
    last: int
    leaves: bool  # before the end of the run
    at: Ints  # the stored states at which it touches
    line: ContactLine  # at these


def events(result: Result) -> list[dict[str, Any]]:
    """Every event as an object with `time_ms`, `kind`, `sheet`, `roller` (of a stub `part`) and numbers, by
    time.

    Kinds: `enter` and `leave`; `slip`, one for each stay of a sheet at a roller; `gap`, where a sheet enters
    a roller that another one was at before; `wait`; `jam`; `double_feed`; `stub`, where the end of a
    plate stops a sheet. A sheet that touches at the start
    enters at 0. docs/reference/events.md says what the numbers are.
    """
    if len(result.time) < 2:
        return []
    stays, together = _stays(result), stacked(result)
    found = [event for stay in stays for event in _stay_events(result, stay, together)]
    found += _gaps(result, stays)
    found += _double_feeds(result, [*stays, *_beyond(result, stays, together)])
    found += _stubs(result)
    order = {"leave": 0, "enter": 1}
    return sorted(found, key=lambda e: (e["time_ms"], order.get(e["kind"], 2), _place(e), e["sheet"]))


def _place(event: dict[str, Any]) -> str:
    return event["roller"] if "roller" in event else event["part"]


def _stubs(result: Result) -> list[dict[str, Any]]:
    """Where the end of a plate stops a sheet that comes to it below, or above, its face."""
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


def _stays(result: Result) -> list[Stay]:
    model, time = result.model, result.time
    sheets = {sheet.name: k for k, sheet in enumerate(model.sheets)}
    found = []
    for row in np.flatnonzero(model.contacts.kind == BOX_CYLINDER).tolist():
        force = result.contact_force[:, row]
        touching = force > GRAZE * force.max()
        sheet, roller = sheets[model.contacts.part_a[row]], model.roller(model.contacts.part_b[row])
        for first, last in intervals(time, touching, SHORT):
            at = np.flatnonzero(touching[first : last + 1]) + first
            states, lines = of_row(result, row)
            line = chosen(lines, np.searchsorted(states, at))
            found.append(Stay(sheet, roller, first, last, last + 1 < len(time), at, line))
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


def intervals(time: Floats, holds: np.ndarray, short: float) -> list[tuple[int, int]]:
    """First and last state of each time in which something holds, but for breaks shorter than `short` and
    what then lasts less than that, unless it is cut off by the start or the end."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    runs = [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
    joined: list[tuple[int, int]] = []
    for first, last in runs:
        if joined and time[first] - time[joined[-1][1]] <= short:
            joined[-1] = (joined[-1][0], last)
        else:
            joined.append((first, last))
    end = len(time) - 1
    step = float(time[-1] - time[0]) / end  # it holds from some time before the first to some after the last
    return [(a, b) for a, b in joined if time[b] - time[a] + step >= short or a == 0 or b == end]


def _event(result: Result, kind: str, at: int, stay: Stay, **numbers: Any) -> dict[str, Any]:
    name = result.model.sheets[stay.sheet].name
    record = {"time_ms": float(result.time[at]), "kind": kind, "sheet": name, "roller": stay.roller.name}
    return record | numbers


def _stay_events(result: Result, stay: Stay, together: np.ndarray | None) -> list[dict[str, Any]]:
    """Entering, leaving, slip, waits and jams."""

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
    return found + _waits(result, stay, together)


def _waits(result: Result, stay: Stay, together: np.ndarray | None) -> list[dict[str, Any]]:
    """Where a driven roller presses a sheet on another one and the sheet does not follow: a jam where that
    lasts to the end of the run, or else a wait."""
    roller, line = stay.roller, stay.line
    if not roller.speed:
        return []
    surface = np.linalg.norm(line.roller, axis=1)
    fastest = abs(roller.speed) * roller.radius
    squared = np.maximum(surface, JAM_PART * fastest) ** 2
    along = np.einsum("tk,tk->t", line.sheet, line.roller) / squared
    slow = (surface > JAM_PART * fastest) & (along < JAM_PART) & (line.share > 0.0)
    slow &= _opposed(result, stay, together)
    held = np.zeros(len(result.time), bool)
    held[stay.at[slow]] = True
    part = np.zeros(len(result.time))
    part[stay.at] = along
    found = []
    for first, last in intervals(result.time, held, SHORT):
        lasts = float(result.time[last] - result.time[first])
        if lasts > JAM_TIME:
            inside = held[first : last + 1]
            numbers = {
                "duration_ms": lasts,
                "part_of_surface_speed": float(part[first : last + 1][inside].mean()),
            }
            kind = "wait" if last + 1 < len(result.time) else "jam"
            found.append(_event(result, kind, first, stay, **numbers))
    return found


def _opposed(result: Result, stay: Stay, together: np.ndarray | None) -> np.ndarray:
    """Whether the sheet, or one that it lies on, touches a roller that faces this one, at the states of a
    stay."""
    held = np.zeros(len(stay.at), bool)
    for other in result.model.rollers:
        if other is stay.roller or not _faces(stay.roller, other):
            continue
        for sheet in [stay.sheet] if together is None else range(len(result.model.sheets)):
            pressed = _force(result, sheet, other.name)[stay.at] > 0.0
            held |= pressed if together is None else pressed & together[stay.at, stay.sheet, sheet]
    return held


def _faces(roller: RollerPart, other: RollerPart) -> bool:
    """Whether two rollers are parallel, over each other, and clear each other by less than a radius."""
    away = other.center - roller.center
    along = abs(float(away @ roller.axis))
    across = float(np.linalg.norm(away - roller.axis * (away @ roller.axis)))
    parallel = abs(float(roller.axis @ other.axis)) > 1.0 - 1e-9
    near = across < roller.radius + other.radius + max(roller.radius, other.radius)
    return parallel and near and along < 0.5 * (roller.width + other.width)


def _force(result: Result, sheet: int, roller: str) -> Floats:
    """Normal force of a sheet on a roller [N], (t,)."""
    model, name = result.model, result.model.sheets[sheet].name
    sides = zip(model.contacts.part_a, model.contacts.part_b, strict=True)
    rows = [k for k, pair in enumerate(sides) if pair == (name, roller)]
    return result.contact_force[:, rows].sum(axis=1)


def _gaps(result: Result, stays: list[Stay]) -> list[dict[str, Any]]:
    """The distance along the way from the end of the sheet that went before to the start of the next."""
    found = []
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
            numbers: dict[str, Any] = {
                "before": result.model.sheets[before.sheet].name,
                "gap_mm": ahead[0] - behind[1],
                "gap_ms": None,
            }
            if before.leaves and before.last < stay.first:
                numbers["gap_ms"] = float(result.time[stay.first] - result.time[before.last + 1])
            found.append(_event(result, "gap", stay.first, stay, **numbers))
    return found


def _reach(result: Result, sheet: int, at: int, way: Floats) -> tuple[float, float]:
    """From where to where a sheet reaches along a direction [mm]."""
    boxes = _boxes(result.model, sheet)
    turn = turns(result.rotation[at, boxes])
    half = (np.abs(np.einsum("nij,i->nj", turn, way)) * result.model.bodies.half[boxes]).sum(axis=1)
    center = result.position[at, boxes] @ way
    return float((center - half).min()), float((center + half).max())


def _double_feeds(result: Result, stays: list[Stay]) -> list[dict[str, Any]]:
    """Two sheets at one roller, or at two that face each other, at once and at one place along them, that
    both go on, by more than a thickness; one event for rollers that face each other."""
    nips = _nips(result.model)
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
    for one, other, speed in feeds.values():
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
