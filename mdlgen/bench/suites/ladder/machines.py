"""Rungs of sheets in machines: fast rollers, heavy rollers, hard friction, steps of the transport."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Reference, Run
from mdlgen.bench.suites.ladder import FORCED, STEPS, rung, within
from mdlgen.bench.suites.transport import FINEST, OTHER_FINEST
from mdlgen.results.compare import compare, scale
from mdlgen.results.result import Result

SPEEDS = (1e2, 1e3, 1e4, 1e5)  # [rad/s]
HEAVY = (3.6e2, 3.6e3)  # a pressed roller [g]; a box of the note has 3.6 mg
TRANSPORT = "transport_4x4"
COUNTERS = ("counter_1_left", "counter_1_right", "counter_2_left", "counter_2_right")
CARRIED, SPUN, SAME = 5e-3, 1e-2, 5e-3


def rungs(reference: str) -> list[BenchCase]:
    """All of them; some are compared with a finer run of the solver `reference`."""
    return [*(_fast(speed) for speed in SPEEDS), *_heavy(), *_against_finer(reference)]


def _fast(speed: float) -> BenchCase:
    """A block on two driven rollers, which slip under it at any speed above a few rad/s."""
    roller = "axis: y, radius: 10 mm, width: 20 mm, mass: 10 g"
    drive = f"drive: {{speed: {speed!r} rad/s}}"
    sets = (
        "sheets.block.size=[80 mm, 20 mm]",
        "sheets.block.center=[0 mm, 0 mm, 14.9928 mm]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        "planes={}",
        f"rollers={{rear: {{center: [-25 mm, 0 mm, 0 mm], {roller}, {drive}}},"
        f" front: {{center: [25 mm, 0 mm, 0 mm], {roller}, {drive}}}}}",
        "contacts=[{between: [block, rear], stiffness: 80 N/mm^1.5, friction: 0.3, restitution: 1,"
        " smoothing: 1 mm/s},"
        " {between: [block, front], stiffness: 80 N/mm^1.5, friction: 0.3, restitution: 1,"
        " smoothing: 1 mm/s}]",
        "run.duration=50 ms",
        "run.prune=false",
    )
    return rung(f"roller at {speed:g} rad/s: block on it", Run("verify/slide", sets), carried)


def _heavy() -> list[BenchCase]:
    """Pressed rollers up to a million times as heavy as a box; without gravity, so that the nips stay."""
    made = []
    for mass in HEAVY:
        sets = (
            "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
            *(f"rollers.{name}.mass={mass!r} g" for name in COUNTERS),
            "run.duration=10 ms",
        )
        ratio = mass / 3.6e-3
        made.append(
            rung(
                f"roller {ratio:.2g} times a box's mass: spun up", Run(TRANSPORT, sets), spun_up, limit=120.0
            )
        )
    return made


def _against_finer(reference: str) -> list[BenchCase]:
    fine = FINEST.get(reference, OTHER_FINEST)
    made = []
    for step in STEPS:
        sets = within(step, 50)
        exact = Reference(Run(TRANSPORT, sets, min(fine, step / 4)), reference)
        made.append(
            rung(f"step {step * 1e-3:g} s: transport", Run(TRANSPORT, sets, step), forced, 120.0, exact)
        )
    hard = ("run.duration=10 ms", "sheets.note.boxes=[5,10]", *(f"contacts.{k}.friction=5" for k in range(7)))
    bouncy = (*hard[:2], *(f"contacts.{k}.restitution=1" for k in range(7)))
    damped = (*hard[:2], *(f"contacts.{k}.restitution=0" for k in range(7)))
    for name, sets in (("mu 5", hard), ("c_R 1", bouncy), ("c_R 0", damped)):
        exact = Reference(Run(TRANSPORT, sets, fine), reference)
        made.append(rung(f"{name}: transport", Run(TRANSPORT, sets), finer, 120.0, exact))
    return made


def carried(result: Result, _: Result | None) -> list[Finding]:
    """While the rollers slip, the block goes mu g t^2/2, whichever of them bears what."""
    model = result.model
    mu, gravity = float(model.contacts.mu_dynamic[0]), float(np.linalg.norm(model.gravity))
    exact = 0.5 * mu * gravity * float(result.time[-1]) ** 2
    found = float(result.position[-1, 0, 0] - model.bodies.position[0, 0])
    error = abs(found / exact - 1)
    return [Finding("way, relative", error, CARRIED, {"exact_mm": exact, "found_mm": found})]


def spun_up(result: Result, _: Result | None) -> list[Finding]:
    """The free rollers of row 1 slip on the note and are spun up by mu N R: omega = 2 mu N t / (M R).

    They are so heavy that they slip from the moment at which the note is faster than the smoothing speed,
    and that they do not give: N is what the note's squeeze makes of it, so the run's own mean is taken.
    """
    model = result.model
    errors = []
    for name in COUNTERS[:2]:
        roller = model.roller(name)
        row = next(
            k
            for k, (a, b) in enumerate(zip(model.contacts.part_a, model.contacts.part_b, strict=True))
            if b == name and a == "note"
        )
        half = len(result.time) // 2
        force = float(result.contact_force[half:, row].mean())
        spin = np.abs(result.spin[:, roller.body] @ roller.axis)
        rise = 2 * float(model.contacts.mu_dynamic[row]) * force / (roller.mass * roller.radius)
        found = float(spin[-1] - spin[half]) / float(result.time[-1] - result.time[half])
        errors.append(abs(found / rise - 1))
    return [Finding("rise of the rollers' speed, relative", max(errors), SPUN)]


def forced(result: Result, reference: Result | None) -> list[Finding]:
    """Against the finer run, at a given step."""
    return _against(result, reference, FORCED)


def finer(result: Result, reference: Result | None) -> list[Finding]:
    """Against the finer run, at the step that the solver chose."""
    return _against(result, reference, SAME)


def _against(result: Result, reference: Result | None, tolerance: float) -> list[Finding]:
    assert reference is not None, "these rungs have one"
    found = compare(result, reference)
    return [
        Finding(
            "position, RMS over boxes and time, relative",
            found.relative,
            tolerance,
            {"scale_mm": scale(result), "position_max_mm": found.position_max_mm},
        )
    ]
