"""Sheets that friction holds at rest and that creep there, which the regularised law (Eq. 12) causes.

Friction holds a sheet at a part of the machine, or at another sheet, in a stored state if all of this holds:

- the two touch, with a force above GRAZE of the greatest one, and their friction does not stick;
- friction is below LOADED of its limit mu N: the sheet is not about to slide. Its slip on a roller, elsewhere
  its speed in its own plane, is below the stiction velocity: it does not slide with the dynamic coefficient;
- the surface is slower than the sheet slips on it. That of a stopped roller is, that of a nip that transports
  is not. Another sheet is slower than the stiction velocity, and in the mean slower than this one;
- no driven part moves the sheet along. One does that the sheet touches, whose surface is faster than MOVES of
  the sheet's speed, while the sheet is faster than JAM_PART of the surface;
- the slip is so fast that over the whole run it would be more than is allowed.

An event lasts for longer than WAIT and makes the sheet creep further than is allowed. That is `run.tolerance`
times its travel, or times a tenth of its length where that is more. Left out are sheets that come to rest
there, which lose more than BRAKES of the impulse of friction as momentum. Sheets that the scene clamps or
supports are left out too.

On a roller the creep is the displacement of the sheet against the surface, the mean over the contact line: a
turn about its middle is no part of it. Elsewhere it is the slip speed that Eq. 12 has for the stored
friction, integrated over time. It is at most the displacement of a box, of both sheets together where there
are two: friction that trembles, or acts both ways at once, moves nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mdlgen.model import meshes
from mdlgen.model.creep import judged_by, load_part, slip_part
from mdlgen.model.tables import BOX_BOX, BOX_CYLINDER, EXTERNAL, Floats, Model, RollerPart
from mdlgen.results.compare import travel
from mdlgen.results.contact_line import of_row
from mdlgen.results.held import JAM_PART, WAIT, is_fixed, partners
from mdlgen.results.result import GRIPS, RUBS
from mdlgen.results.stays import GRAZE, SHORT, intervals
from mdlgen.results.way import way_of

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Part of the limit mu N, above which a sheet is about to slide: the slip is 0.81 of the stiction velocity. A
# load beyond the limit takes a sheet from there to sliding within milliseconds.
LOADED = 0.95
# A driven surface moves a sheet along if it is faster than this part of the sheet's speed: the sheet slips
# against it by less than it goes.
MOVES = 0.5
# A sheet comes to rest if it loses more momentum than this part of the impulse of friction. Its inertia is
# all of the load on a level plane, and none of it where a sheet is held.
BRAKES = 0.5


class Creep(NamedTuple):
    """A sheet that is held and creeps, from one stored state to another."""

    sheet: int
    first: int
    last: int
    held_by: tuple[str, ...]  # other parts, in the order of the contacts
    distance: float  # the furthest [mm]
    row: int  # of the contacts: the one on which it is that


def creeps(result: Result) -> list[Creep]:
    """Each time that friction holds a sheet that creeps by more than `run.tolerance` allows; none where a
    result does not have friction."""
    model, found = result.model, []
    if result.contact_friction is None or len(result.time) < 2:
        return []
    speeds = [way_of(result, k).speed for k in range(len(model.sheets))]
    for k, sheet in enumerate(model.sheets):
        if is_fixed(result, k):
            continue
        length = float(np.linalg.norm(travel(result, k)))
        allowed = model.run.tolerance * judged_by(max(sheet.size), length)
        others = partners(result, k)
        moved = _moved_along(result, k, speeds[k])
        rows = [hold for at in others for hold in _at_row(result, k, at, speeds, moved, allowed)]
        for hold in _together(rows):
            found.append(hold._replace(held_by=tuple(name for _, name in others if name in hold.held_by)))
    return found


def _at_row(
    result: Result, sheet: int, at: tuple[int, str], speeds: list[Floats], moved: np.ndarray, allowed: float
) -> Iterator[Creep]:
    """Intervals in which friction holds a sheet in one contact, a row and the other part, and it creeps
    further than is allowed [mm]."""
    row, other = at
    contacts, time = result.model.contacts, result.time
    if contacts.kind[row] == EXTERNAL or contacts.sticking[row] > 0.0 or contacts.mu_static[row] <= 0.0:
        return
    if not (result.contact_force[:, row] > 0.0).any():
        return
    assert result.contact_friction is not None
    force, limit = result.contact_force[:, row], result.contact_friction[:, row, GRIPS]
    stiction = float(contacts.stiction_velocity[row])
    acts = (force > GRAZE * force.max()) & (limit > 0.0)
    used = np.abs(result.contact_friction[:, row, RUBS]) / np.where(acts, limit, np.inf)
    at_line = contacts.kind[row] == BOX_CYLINDER
    if at_line:
        slip, surface = _on_roller(result, row)
    else:
        slip, surface = (stiction * slip_part(used))[:, None], _surface(result, other, speeds)
    fast = np.linalg.norm(slip, axis=1)
    slides = (fast if at_line else speeds[sheet]) >= stiction
    between = contacts.kind[row] == BOX_BOX
    stands = surface < (stiction if between else fast)
    held = acts & stands & (used < LOADED) & ~slides & ~moved
    held &= fast > allowed / (time[-1] - time[0])
    for first, last in intervals(time, held, SHORT):
        inside = slice(first, last + 1)
        if between and not _faster(result, sheet, other, [speed[inside].mean() for speed in speeds]):
            continue
        friction = limit[inside] * load_part(fast[inside] / stiction)
        if _comes_to_rest(result, sheet, speeds[sheet][inside], float(np.trapezoid(friction, time[inside]))):
            continue
        far = float(np.linalg.norm(np.trapezoid(slip[inside], time[inside], axis=0)))
        if not at_line:
            far = min(far, _displaced(result, sheet, other, first, last))
        if time[last] - time[first] > WAIT and far > allowed:
            yield Creep(sheet, first, last, (other,), far, row)


def _on_roller(result: Result, row: int) -> tuple[Floats, Floats]:
    """Velocity of a sheet against a roller's surface, (t, 3), and how fast that is, (t,) [mm/ms]."""
    states, line = of_row(result, row)
    slip, surface = np.zeros((len(result.time), 3)), np.zeros(len(result.time))
    slip[states] = np.where(line.share[:, None] > 0.0, line.sheet - line.roller, 0.0)
    surface[states] = np.linalg.norm(line.roller, axis=1)
    return slip, surface


def _comes_to_rest(result: Result, sheet: int, speed: Floats, impulse: float) -> bool:
    """Tests whether the momentum that a sheet loses, by its speeds [mm/ms], is most of the impulse of
    friction [N ms]."""
    part = result.model.sheets[sheet]
    mass = float(result.model.bodies.mass[part.first : part.first + part.count].sum())
    return mass * float(speed[0] - speed[-1]) > BRAKES * impulse


def _together(rows: list[Creep]) -> list[Creep]:
    """One for all that hold a sheet at the same time."""
    found: list[Creep] = []
    for hold in sorted(rows, key=lambda hold: (hold.first, hold.last)):
        if not found or hold.first > found[-1].last:
            found.append(hold)
            continue
        before = found.pop()
        most = before if before.distance >= hold.distance else hold
        names, last = (*before.held_by, *hold.held_by), max(before.last, hold.last)
        found.append(most._replace(first=before.first, last=last, held_by=names))
    return found


def _moved_along(result: Result, sheet: int, speed: Floats) -> np.ndarray:
    """Tests at each stored time whether a driven surface that a sheet touches moves it along, (t,)."""
    moved = np.zeros(len(result.time), bool)
    for row, other in partners(result, sheet):
        roller = _carrier(result.model, other)
        touches = result.contact_force[:, row] > 0.0
        if roller is not None and roller.speed and touches.any():
            surface = _surface(result, other, [])
            moved |= touches & (surface > MOVES * speed) & (speed > JAM_PART * surface)
    return moved


def _carrier(model: Model, name: str) -> RollerPart | None:
    """The roller of that name, or that a mesh of that name is on."""
    rollers = {roller.name: roller for roller in model.rollers}
    rollers |= {mesh.name: model.rollers[mesh.on] for mesh in model.meshes if mesh.on >= 0}
    return rollers.get(name)


def _surface(result: Result, name: str, speeds: list[Floats]) -> Floats:
    """Surface speed of a part [mm/ms], (t,): of a sheet in its own plane, of a roller and meshes on it at its
    rim, of other moving parts at their centre; fixed planes, guides and meshes have 0."""
    model = result.model
    for k, sheet in enumerate(model.sheets):
        if sheet.name == name:
            return speeds[k]
    roller = _carrier(model, name)
    if roller is None:
        moving = next((part for part, _ in model.gates if part.name == name), None)
        if moving is None:
            return np.zeros(len(result.time))
        return np.linalg.norm(result.velocity[:, moving.body], axis=1)
    mesh = next((mesh for mesh in model.meshes if mesh.name == name), None)
    reach = roller.reach if mesh is None else meshes.reach(mesh, roller)
    return np.abs(result.spin[:, roller.body] @ roller.axis) * reach


def _faster(result: Result, sheet: int, other: str, means: list[float]) -> bool:
    """Tests whether a sheet is faster than another one, which then holds it."""
    return all(means[sheet] > means[k] for k, part in enumerate(result.model.sheets) if part.name == other)


def _displaced(result: Result, sheet: int, other: str, first: int, last: int) -> float:
    """The greatest displacement of a box of a sheet between two states, and of one of another sheet [mm]."""
    total = 0.0
    for k, part in enumerate(result.model.sheets):
        if k == sheet or part.name == other:
            boxes = slice(part.first, part.first + part.count)
            gap = result.position[last, boxes] - result.position[first, boxes]
            total += float(np.linalg.norm(gap, axis=1).max())
    return total
