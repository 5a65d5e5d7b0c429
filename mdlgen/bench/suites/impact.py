"""A block thrown flat at a plane, without gravity, against the closed forms of one impact."""

from __future__ import annotations

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import impact as oracle
from mdlgen.results.result import Result

SAMPLE = "verify/drop"
MASS, STIFFNESS = 10.0, 1000.0  # of the sample [g], [N/mm^1.5]
SPEEDS = (0.1, 1.0, 5.0)  # [mm/ms], the same in m/s
RESTITUTIONS = (0.2, 0.5, 0.7, 0.9)
HALF = 5.0  # half the block's thickness [mm]
# Restitution within 1e-3; undamped, time and force within 0.1 %. Damped, the force drops within the smoothing
# speed at the greatest depth, and a step that holds the drop may shift the way out by itself: 1 %.
WANTED, DAMPED = 1e-3, 1e-2


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """Four restitutions and the undamped impact at three speeds."""
    speeds = SPEEDS[1:2] if quick else SPEEDS
    values = (0.5, 1.0) if quick else (*RESTITUTIONS, 1.0)
    return [_case(value, speed) for value in values for speed in speeds]


def thrown(speed: float, restitution: float, smoothing: float = 1e-3) -> Run:
    """The block a moment before it meets the plane, for one and a half impacts (all speeds in mm/ms)."""
    lasts = oracle.impact(MASS, STIFFNESS, speed, restitution, smoothing).time
    gap = 0.2 * lasts * speed
    sets = (
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        f"sheets.block.center=[0 mm, 0 mm, {HALF + gap!r} mm]",
        f"sheets.block.velocity=[0 m/s, 0 m/s, {-speed!r} m/s]",
        f"contacts.0.restitution={restitution!r}",
        f"contacts.0.smoothing={1e3 * smoothing!r} mm/s",
        f"run.duration={round(1.5 * lasts, 9)!r} ms",
        f"run.print_step={round(1.5 * lasts / 100, 9)!r} ms",
    )
    return Run(SAMPLE, sets)


def _case(restitution: float, speed: float) -> BenchCase:
    return BenchCase("impact", f"c_R = {restitution:g} at {speed:g} m/s", thrown(speed, restitution), bounce)


def bounce(result: Result, _: Result | None) -> list[Finding]:
    """Restitution, time in contact, greatest depth and force against the closed forms."""
    model = result.model
    speed = -float(model.bodies.velocity[0, 2])
    restitution = float(model.contacts.restitution[0])
    exact = oracle.impact(
        float(model.bodies.mass[0]),
        float(model.contacts.stiffness[0]),
        speed,
        restitution,
        float(model.contacts.smoothing[0]),
    )
    out = float(result.velocity[-1, 0, 2])
    gap = [float(z) - HALF for z in (model.bodies.position[0, 2], result.position[-1, 0, 2])]
    # free flight before and after: the ends of the contact follow from the first and the last state
    time = float(result.time[-1]) - gap[1] / out - gap[0] / speed if out > 0 else float("inf")
    near = WANTED if restitution == 1.0 else DAMPED
    statistics = result.statistics
    return [
        Finding("restitution", abs(out / speed - exact.restitution), WANTED, {"exact": exact.restitution}),
        Finding("time in contact, relative", abs(time / exact.time - 1), near, {"exact_ms": exact.time}),
        Finding(
            "greatest depth, relative",
            abs(float(statistics.max_depth[0]) / exact.depth - 1),
            near,
            {"exact_mm": exact.depth},
        ),
        Finding(
            "greatest force, relative",
            abs(float(statistics.max_force[0]) / exact.force - 1),
            near,
            {"exact_n": exact.force},
        ),
    ]
