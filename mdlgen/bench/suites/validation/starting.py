"""Cases with an initial speed or a change over time: a spinning roller, a ramp of force, gravity cut off."""

from __future__ import annotations

import math

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

GROUP = "Starts, and forces over time"
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
# Values of verify/spun: mass of roller and block [g], speed of the roller's surface [mm/ms].
ROLLER, BLOCK, SURFACE = 4.0, 1.0, 0.5
SPUN = "momentum and spin: omega R M/(M + 2 m)"
RUBS = "smoothed friction has equal speeds at the end only, to e^(-t/tau): less than 0.1 %"
# A ramp of force on the block of verify/flip, from 0 to it in the time [N], [ms].
FORCE, RISE = 3.0, 10.0
CUBE = "a t^3/6, a the rate at which the acceleration rises"
SECOND = "second order in the step: (h/t)^2/2 of the way, for h = t/100"
# Gravity falls to nothing between two times [ms].
FULL, GONE, PULL = 4.0, 6.0, 9.81e-3
LEFT = "the impulse of a weight that falls linearly, then straight motion"
EXACT = "steps have the mean of the factor; exudyn is of second order in the step"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, which are short."""
    block = (NONE, "sheets.block.spin=[0 rad/s, 0 rad/s, 0 rad/s]", "run.duration=10 ms")
    load = f"loads=[{{sheet: block, at: [0 mm, 0 mm], force: [{FORCE} N, 0 N, 0 N], profile: %s}}]"
    ramp = Run("verify/flip", (*block, load % f"[[0 ms, 0], [{RISE} ms, 1]]", "run.step=0.1 ms"))
    fades = f"gravity_profile=[[0 ms, 1], [{FULL} ms, 1], [{GONE} ms, 0]]"
    weight = "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"
    cut = Run("verify/flip", (*block, weight, fades, "run.step=0.1 ms"))
    found = [row(GROUP, "block under a ramp of force", ramp, cube)]
    more = [
        row(GROUP, "block whose weight is cut off", cut, straight),
        row(GROUP, "spinning roller let down on a block", Run("verify/spun"), spun),
    ]
    return found if quick else found + more


def cube(result: Result, _: Result | None) -> list[Finding]:
    """Way of the block."""
    mass, time = float(result.model.bodies.mass[0]), float(result.time[-1])
    want = FORCE / RISE / mass * time**3 / 6.0
    way = math.dist(result.position[-1, 0], result.position[0, 0])
    return [against("way", want, way, 2e-3, "mm", Basis(CUBE, SECOND))]


def straight(result: Result, _: Result | None) -> list[Finding]:
    """Speed and place of the block after its weight is gone."""
    speed, ramp = PULL * 0.5 * (FULL + GONE), GONE - FULL
    fallen = PULL * (0.5 * FULL**2 + FULL * ramp + ramp**2 / 3.0)
    want = fallen + speed * (float(result.time[-1]) - GONE)
    way = math.dist(result.position[-1, 0], result.position[0, 0])
    return [
        against("speed", speed, -float(result.velocity[-1, 0, 2]), 1e-4, "mm/ms", Basis(LEFT, EXACT)),
        against("way", want, way, 1e-4, "mm", Basis(LEFT, EXACT)),
    ]


def spun(result: Result, _: Result | None) -> list[Finding]:
    """Speed of the block, and of the roller's surface."""
    want = SURFACE * ROLLER / (ROLLER + 2.0 * BLOCK)
    wheel = result.model.roller("wheel")
    surface = -wheel.radius * float(result.spin[-1, wheel.body] @ wheel.axis)
    basis = Basis(SPUN, RUBS)
    return [
        against("speed of the block", want, float(result.velocity[-1, 0, 0]), 1e-3, "mm/ms", basis),
        against("speed of the surface", want, surface, 1e-3, "mm/ms", basis),
    ]
