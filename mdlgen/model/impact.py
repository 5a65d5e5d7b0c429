"""Contact time of a body that strikes: it determines a solver's step."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.tables import Model, PlanePart, RollerPart, SheetPart

# A gap below this is none: a roller that is given where it touches [mm].
TOUCHING = 1e-6


def lasting(mass: float, stiffness: float, speed: float) -> float:
    """Duration of an undamped impact with F = k z^1.5, in one set of units:
    T = 3.21806546 (m^2 / (k^2 v))^(1/5)."""
    return 3.21806546 * (mass**2 / (stiffness**2 * speed)) ** 0.2


def impact_time(model: Model, row: int, mass: float) -> float:
    """Duration of an undamped impact of a rigid block [ms] at the greatest speed that the scene can give.
    Against a box of another sheet, or a pressed plate, the reduced mass counts."""
    sheet, part = _parts(model, row)
    assert isinstance(sheet, SheetPart), "the first part of all contacts but those of two rollers"
    gravity, start = math.hypot(*model.most_gravity), math.hypot(*sheet.velocity)
    if isinstance(part, SheetPart):
        mass = mass * part.derived["m"] / (mass + part.derived["m"])
        start += math.hypot(*part.velocity)
    if isinstance(part, PlanePart) and part.press is not None:
        mass = mass * part.sliding_mass / (mass + part.sliding_mass)
    fall = math.dist(part.center, sheet.center)
    speed = max(
        min(start + gravity * model.run.duration, math.hypot(start, math.sqrt(2 * gravity * fall))), 1e-6
    )
    return lasting(mass, float(model.contacts.stiffness[row]), speed)


def approach_time(model: Model, row: int) -> float:
    """Duration of the impact [ms] of what flies, falls or swings at its counterpart as the run begins: the
    boxes of a flexible sheet along the sheet's normal, those of one that nothing holds on a plane, a roller
    on an arm. inf where nothing does.

    A sheet that is driven in its own plane meets rollers with its edge, softly, and does not count.
    """
    first, second = _parts(model, row)
    stiffness, shortest = float(model.contacts.stiffness[row]), math.inf
    if isinstance(first, SheetPart) and first.count > 1:
        rate = np.array(first.velocity) - _velocity(second)
        speed = abs(float(rate @ first.rotation[:, 2]))
        mass = first.derived["m"]
        if isinstance(second, SheetPart):
            mass = mass * second.derived["m"] / (mass + second.derived["m"])
        if isinstance(second, PlanePart) and not _held(model, first):
            speed = math.hypot(speed, _falling(model, first, second))
        if speed > 0.0:
            shortest = lasting(mass, stiffness, speed)
    for roller, other in ((first, second), (second, first)):
        if not isinstance(roller, RollerPart):
            continue
        gap = _gap(roller, model.bodies.position[roller.body], other)
        found = _thrown(model, roller) if gap > TOUCHING else None
        if found is not None:
            mass, pull, speed = found
            shortest = min(
                shortest, lasting(mass, stiffness, math.hypot(speed, math.sqrt(2.0 * pull / mass * gap)))
            )
    return shortest


def _thrown(model: Model, roller: RollerPart) -> tuple[float, float, float] | None:
    """Mass, pull [N] and first speed [mm/ms] at which a roller on an arm, or one whose press begins off its
    balance, goes at its counterpart; None: it does not."""
    weight = float(np.linalg.norm(model.most_gravity))
    if roller.arm is not None:
        arm = roller.arm
        length = float(np.linalg.norm(roller.center - arm.pivot))
        mass = roller.swung_inertia / length**2
        pull = abs(arm.torque) / length + abs(arm.stiffness * arm.angle) / length + mass * weight
        speed = abs(arm.speed) * length
    elif roller.press is not None and (roller.press.off > 0.0 or roller.press.speed != 0.0):
        press = roller.press
        mass = roller.loaded_mass + press.carrier_mass
        pull = press.preload + press.stiffness * press.off + mass * weight
        speed = abs(press.speed)
    else:
        return None
    return (mass, pull, speed) if pull > 0.0 or speed > 0.0 else None


def _held(model: Model, sheet: SheetPart) -> bool:
    """True if a clamp, a roller or another sheet may keep a sheet from falling."""
    others = {part.name for part in (*model.rollers, *model.sheets)} - {sheet.name}
    pairs = zip(model.contacts.part_a, model.contacts.part_b, strict=True)
    return sheet.clamp is not None or any(sheet.name in pair and others & set(pair) for pair in pairs)


def _falling(model: Model, sheet: SheetPart, plane: PlanePart) -> float:
    """Speed along a plane's normal that a sheet over its face falls at it with [mm/ms]."""
    height = float((sheet.center - plane.center) @ plane.normal)
    height -= 0.5 * (plane.size[2] + float(sheet.thick.max()))
    pull = -float(model.most_gravity @ plane.normal)
    if height <= TOUCHING or pull <= 0.0:
        return 0.0
    return min(math.sqrt(2.0 * pull * height), pull * model.run.duration)


def _parts(model: Model, row: int):
    """The two parts of a row of the contacts."""
    parts = (*model.machine, *model.sheets)
    sheets = (*model.sheets, *model.rollers)
    names = model.contacts.part_a[row], model.contacts.part_b[row]
    first = next(p for p in sheets if p.name == names[0])
    return first, next(p for p in parts if p.name == names[1])


def _velocity(part) -> np.ndarray:
    return np.array(part.velocity) if isinstance(part, SheetPart) else np.zeros(3)


def _gap(roller: RollerPart, place: np.ndarray, other) -> float:
    """Distance of a roller at a place from a parallel one, or from the plane of a sheet; 0 from other
    parts."""
    way = place - other.center
    if isinstance(other, SheetPart):
        return abs(float(way @ other.rotation[:, 2])) - roller.reach - 0.5 * float(other.thick.max())
    if isinstance(other, RollerPart):
        way = way - roller.axis * float(way @ roller.axis)
        return float(np.linalg.norm(way)) - roller.reach - other.reach
    return 0.0
