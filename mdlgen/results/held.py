"""Sheets that a driven part slips on while something holds them: waits and jams."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mdlgen.model.tables import BOX_CYLINDER, Floats
from mdlgen.results.contact_line import of_row
from mdlgen.results.stays import SHORT, Stay, intervals

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A sheet is held where it is slower than this part of the surface of a driven part that it touches, and the
# surface is faster than this part of the drive's own speed.
JAM_PART = 0.1
# It is jammed where that lasts for so long at the end of a run, or for so long at any time; less is a wait,
# above the last of these [ms]. A sensor of a machine that counts a late sheet as a jam allows some 50 ms.
JAM_END, JAM_LONG, WAIT = 10.0, 50.0, 5.0
# A sheet is on its way if it is faster than CREEPS, as a part of the surface's speed, and speeds up. Either
# it is GAINS times as fast in the second half of such a time as in the first one (3 where it speeds up evenly
# from rest). Or it gains CREEPS in JAM_END: at that rate it reaches JAM_PART within ten times JAM_END.
GAINS, CREEPS = 1.5, 0.01


class Hold(NamedTuple):
    """A sheet that is held, from one stored state on."""

    first: int
    duration: float  # [ms]
    part: float  # its mean speed along the surface, as a part of that of the surface
    by: tuple[str, ...]  # other parts that it touches, the greatest normal force first
    jammed: bool


def holds(result: Result, stay: Stay, together: np.ndarray | None) -> list[Hold]:
    """Intervals in which a driven part slips on a held sheet, in one stay; `together`: see results.stacked.

    None of a sheet that the scene clamps or supports. A sheet under a moving one is held back, and one that
    touches a rim in its first turn may wait for another sector of it: both wait.
    """
    roller, line, time = stay.roller, stay.line, result.time
    if not roller.speed or is_fixed(result, stay.sheet):
        return []
    surface, fast = (np.linalg.norm(rate, axis=1) for rate in (line.roller, line.sheet))
    turns = surface > JAM_PART * abs(roller.speed) * roller.radius
    slow = turns & (fast < JAM_PART * surface) & (line.share > 0.0)
    held = np.zeros(len(time), bool)
    held[stay.at[slow]] = True
    goes, along = np.zeros(len(time)), np.zeros(len(time))
    squared = np.where(turns, surface, 1.0) ** 2
    along[stay.at] = np.einsum("tk,tk->t", line.sheet, line.roller) / squared
    goes[stay.at] = fast / np.sqrt(squared)
    found = []
    for first, last in intervals(time, held, SHORT):
        lasts = float(time[last] - time[first])
        at = np.flatnonzero(held[first : last + 1]) + first
        if lasts <= WAIT or _gains(time[at], goes[at]):
            continue
        long = lasts >= (JAM_LONG if last + 1 < len(time) else JAM_END)
        excused = long and (_below_another(result, stay, at, together) or _rim_to_come(result, stay, at))
        found.append(
            Hold(first, lasts, float(along[at].mean()), _held_by(result, stay, at), long and not excused)
        )
    return found


def is_fixed(result: Result, sheet: int) -> bool:
    """True if the scene itself holds a sheet."""
    model, part = result.model, result.model.sheets[sheet]
    return part.clamp is not None or any(anchor.sheet == sheet for anchor in model.supports)


def _gains(time: Floats, speed: Floats) -> bool:
    """True if the speed of a sheet, as a part of the surface's, grows, by the medians of both halves."""
    half = len(speed) // 2
    if half == 0:
        return False
    before, after = float(np.median(speed[:half])), float(np.median(speed[half:]))
    fast = (after - before) * JAM_END > CREEPS * 0.5 * float(time[-1] - time[0])
    return after > CREEPS and (fast or after > GAINS * before)


def _below_another(result: Result, stay: Stay, at: np.ndarray, together: np.ndarray | None) -> bool:
    """True if in more than half of some states the sheet lies on another one that moves on."""
    if together is None:
        return False
    limit = np.full(len(result.time), np.inf)
    limit[stay.at] = JAM_PART * np.linalg.norm(stay.line.roller, axis=1)
    goes = np.zeros(len(at), bool)
    for other in range(len(result.model.sheets)):
        if other != stay.sheet:
            fast = np.array([np.linalg.norm(result.sheet_velocity(other, int(t))) for t in at])
            goes |= together[at, stay.sheet, other] & (fast > limit[at])
    return bool(goes.mean() > 0.5)


def _rim_to_come(result: Result, stay: Stay, at: np.ndarray) -> bool:
    """True if the sheet touches a driven roller with a rim that turns less than once in some states."""
    time = result.time[at]
    for row, name in partners(result, stay.sheet):
        roller = next((r for r in result.model.rollers if r.name == name), None)
        if roller is None or roller.rim is None or not roller.speed:
            continue
        if (result.contact_force[at, row] > 0.0).any():
            rate = np.abs(result.spin[at, roller.body] @ roller.axis)
            if np.trapezoid(rate, time) < 2.0 * np.pi:
                return True
    return False


def _held_by(result: Result, stay: Stay, at: np.ndarray) -> tuple[str, ...]:
    """Parts that the sheet touches in most of some states, except those that drive it the same way."""
    ahead = stay.line.roller[np.isin(stay.at, at)].mean(axis=0)
    found: dict[str, float] = {}
    for row, name in partners(result, stay.sheet):
        force = result.contact_force[at, row]
        if name == stay.roller.name or np.count_nonzero(force > 0.0) < 0.5 * len(at):
            continue
        if result.model.contacts.kind[row] == BOX_CYLINDER and result.model.roller(name).speed:
            states, line = of_row(result, row)
            along = line.roller[np.isin(states, at)].mean(axis=0) @ ahead
            if along > JAM_PART * float(ahead @ ahead):
                continue
        found[name] = found.get(name, 0.0) + float(force.mean())
    return tuple(sorted(found, key=lambda name: (-found[name], name)))


def partners(result: Result, sheet: int) -> list[tuple[int, str]]:
    """Rows of the contacts of a sheet, and what each is with."""
    name, table = result.model.sheets[sheet].name, result.model.contacts
    ends = enumerate(zip(table.part_a, table.part_b, strict=True))
    return [(row, b if a == name else a) for row, (a, b) in ends if name in (a, b)]
