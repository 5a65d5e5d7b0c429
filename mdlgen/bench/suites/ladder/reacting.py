"""Rungs of machines that react: motors, limiters, parts that move, sensors and rules, streams, starts.

Scenes and closed forms are those of the validation, at other steps and with other numbers.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Measure
from mdlgen.bench.suites.ladder import FORCED, rung
from mdlgen.bench.suites.validation import driving, moving, passing, sensing, starting
from mdlgen.results.result import RUBS, Result

# By the name of the validation's case, and steps at which it is run [ms].
STEPS = (2.0, 0.2, 0.02)
SHORT = (1.0, 0.1, 0.01)  # of a run of 10 ms
TORQUES = (0.5, 15.0)  # of a limiter [N mm]; friction in its nip takes 16 N mm
GEARS = (0.1, 20.0, 200.0)  # turns of a motor for one of its roller
HELD = 1e-2  # as of the validation


def rungs() -> list[BenchCase]:
    """All of them."""
    made = [
        *_at_steps(driving.cases(False)[0], STEPS),
        *_at_steps(driving.cases(True)[1], STEPS),
        *_at_steps(moving.cases(False)[1], STEPS),
        *_at_steps(sensing.cases(False)[0], STEPS),
        *_at_steps(passing.cases(False)[0], STEPS),
        *_at_steps(starting.cases(True)[0], SHORT),
    ]
    return [*made, *map(_limiter, TORQUES), *map(_gear, GEARS)]


def _at_steps(case: BenchCase, steps: tuple[float, ...]) -> list[BenchCase]:
    """A case of the validation at given steps, at which no error is promised."""
    made = []
    for step in steps:
        sets = (*case.run.overrides, f"run.print_step={max(step, 0.5)!r} ms")
        own = replace(case.run, overrides=sets, step=step)
        made.append(rung(f"step {step * 1e-3:g} s: {case.name}", own, partial(_forced, case.measure)))
    return made


def _forced(measure: Measure, result: Result, reference: Result | None) -> list[Finding]:
    return [Finding(f"{one.quantity}, relative", one.error, FORCED) for one in measure(result, reference)]


def _limiter(torque: float) -> BenchCase:
    case = driving.cases(True)[1]
    sets = (*case.run.overrides, f"rollers.retard.limiter.torque={torque!r} N*mm")
    return rung(f"limiter of {torque:g} N mm: retard roller", replace(case.run, overrides=sets), held)


def _gear(gear: float) -> BenchCase:
    case = driving.cases(True)[0]
    sets = (
        *case.run.overrides,
        f"rollers.feed.drive.motor.gear={gear!r}",
        "rollers.feed.bearing={torque: 0 N*mm}",
    )
    return rung(f"gear of {gear:g}: motor that spins a roller up", replace(case.run, overrides=sets), spun)


def held(result: Result, _: Result | None) -> list[Finding]:
    """Friction of a retard roller on the sheet once it turns along: torque of its limiter over its radius."""
    assert result.contact_friction is not None
    roller = result.model.roller("retard")
    assert roller.axle is not None, "it is on a limiter"
    at = result.model.contacts.part_b.index("retard")
    force = float(np.abs(result.contact_friction[result.time > 12.0, at, RUBS]).mean())
    error = abs(force * roller.radius / roller.axle.limit - 1.0)
    return [Finding("force that holds back, relative", error, HELD)]


def spun(result: Result, _: Result | None) -> list[Finding]:
    """Speed of a roller that a motor without load turns: w0 (1 - exp(-t T0/(J w0)))."""
    roller = result.model.roller("feed")
    axle = roller.axle
    assert axle is not None, "a motor turns it"
    inertia = 0.5 * roller.mass * roller.radius**2 + axle.inertia
    due = axle.no_load * -np.expm1(-float(result.time[-1]) * axle.stall / (inertia * axle.no_load))
    speed = float(result.spin[-1, roller.body] @ roller.axis)
    return [Finding("speed, relative", abs(speed / due - 1.0), FORCED)]
