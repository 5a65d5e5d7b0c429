"""Lints of motors, torque limiters and shafts."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mdlgen.lints.lint import Lint
from mdlgen.model.nips import faced, nips
from mdlgen.model.tables import Model, RollerPart
from mdlgen.model.tables.axle import CONTROLLED, LIMITER, STEPPER, AxlePart
from mdlgen.units import PER_SECOND

_MORE_TORQUE = "give more torque, or less friction and drag"


def weak_motor(model: Model) -> Iterator[Lint]:
    """Motors that bearing friction, or the nip, can hold."""
    for roller, axle in _axles(model):
        if not axle.motor:
            continue
        where, most = _where(roller, "drive.motor"), axle.stall
        if axle.kind == CONTROLLED:
            most = min(most, axle.limit)
        if most <= axle.friction:
            yield Lint(
                "W160",
                where,
                f"its torque at rest, {most:.4g} N mm at {roller.name}, is not above the friction of its "
                f"bearing, {axle.friction:.4g} N mm: it never turns",
                "give a stronger motor, or less friction",
            )
            continue
        grip = sum(abs(part.ratio) * _grip(model, part) for part in _turned(model, roller))
        if 0.0 < most - axle.friction < grip:
            yield Lint(
                "W160",
                where,
                f"its torque at rest, {most:.4g} N mm at {roller.name}, is below the {grip:.4g} N mm that "
                "friction in its nips can take: a sheet that is held stalls the motor before it slips",
                "give a stronger motor where it has to pull a sheet until that slips",
            )


def strong_limiter(model: Model) -> Iterator[Lint]:
    """Limiters that no nip can make slip."""
    for roller, axle in _axles(model):
        grip = _grip(model, roller)
        if axle.kind == LIMITER and 0.0 < grip <= axle.limit:
            yield Lint(
                "W161",
                f"rollers.{roller.name}.limiter.torque",
                f"{axle.limit:.4g} N mm is not below the {grip:.4g} N mm that friction in its nip can take: "
                "it never slips, and the roller is as one that is fixed to its shaft",
                "give less torque, or press the roller harder",
            )


def weak_limiter(model: Model) -> Iterator[Lint]:
    """Limiters that do not turn their roller while nothing touches it, against its own bearing."""
    for roller, axle in _axles(model):
        if axle.kind != LIMITER or not roller.speed or roller.one_way:
            continue
        where, target = f"rollers.{roller.name}.limiter.torque", abs(roller.speed)
        left = axle.limit - axle.friction
        if left <= 0.0:
            message = (
                f"{axle.limit:.4g} N mm is not above the friction of its bearing, {axle.friction:.4g} N mm"
            )
            yield Lint("W188", where, f"{message}: the shaft never turns the roller", _MORE_TORQUE)
        elif axle.drag * target > left:
            yield Lint(
                "W188",
                where,
                f"{axle.limit:.4g} N mm turns the empty roller against the drag of its bearing at "
                f"{PER_SECOND * left / axle.drag:.4g} rad/s at most, and its shaft has "
                f"{PER_SECOND * target:.4g} rad/s: it always slips",
                _MORE_TORQUE,
            )


def fast_steps(model: Model) -> Iterator[Lint]:
    """Steppers whose steps begin faster than their inertia can follow: more than the kinetic energy that
    takes a magnet over the top of its torque, J v^2 / 2 > 2 T / p, without load and damping."""
    for roller, axle in _axles(model):
        if axle.kind != STEPPER or axle.damping > 0.0:
            continue
        begin = abs(float(roller.prescribed(0.0)))
        inertia = axle.inertia + sum(part.ratio**2 * part.loaded_inertia for part in _turned(model, roller))
        most = 2.0 * math.sqrt(axle.stall / (axle.poles * inertia))
        if begin > most:
            yield Lint(
                "W162",
                _where(roller, "drive"),
                f"its steps begin at {PER_SECOND * begin:.4g} rad/s, and its inertia of {inertia:.4g} g mm^2 "
                f"follows from rest up to {PER_SECOND * most:.4g} rad/s at most: it loses steps at once",
                "begin with a ramp, as ramp: 20 ms",
            )


def lone_shaft(model: Model) -> Iterator[Lint]:
    """Shafts of one roller."""
    for roller, axle in _axles(model):
        if axle.shaft and len(_turned(model, roller)) == 1:
            yield Lint(
                "W163",
                f"shafts.{axle.shaft}.rollers",
                f"it has one roller, {roller.name}, and couples nothing",
                "give it a second one, or give the roller itself the drive",
            )


def fast_target(model: Model) -> Iterator[Lint]:
    """Motors with speed control, or steppers, that aim beyond their no-load speed."""
    for roller, axle in _axles(model):
        aims = abs(roller.speed or 0.0)
        if axle.kind in (CONTROLLED, STEPPER) and 0.0 < axle.no_load <= aims:
            yield Lint(
                "W164",
                _where(roller, "drive"),
                f"it aims at {PER_SECOND * aims:.4g} rad/s, and the no-load speed of its motor is "
                f"{PER_SECOND * axle.no_load:.4g} rad/s there: it has no torque left",
                "aim lower, or give a faster motor or a smaller gear",
            )


def _axles(model: Model) -> Iterator[tuple[RollerPart, AxlePart]]:
    for roller in model.rollers:
        if roller.axle is not None:
            yield roller, roller.axle


def _turned(model: Model, leader: RollerPart) -> list[RollerPart]:
    """A roller and those that follow it."""
    return [leader, *(part for part in model.rollers if part.leader == leader.body)]


def _where(roller: RollerPart, key: str) -> str:
    assert roller.axle is not None, "asked only of a roller with an axle"
    return f"shafts.{roller.axle.shaft}.{key}" if roller.axle.shaft else f"rollers.{roller.name}.{key}"


def _grip(model: Model, roller: RollerPart) -> float:
    """Torque that friction between a roller and a sheet in its nip can take [N mm], by the preload of its
    spring or of one that faces it; 0 where no spring says it."""
    most = 0.0
    for row, sheet, part in nips(model):
        if part is not roller:
            continue
        springs = [
            other.press.preload for other in (roller, *faced(model, roller, sheet)) if other.press is not None
        ]
        mu = float(model.contacts.mu_static[row])
        most = max(most, mu * max(springs, default=0.0) * roller.radius)
    return most
