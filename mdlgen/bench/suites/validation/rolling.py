"""Sheets in nips: coast, pull limit, a roller that is spun up, skew."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

SAMPLE = "verify/slide"
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
PAPER = "materials={p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.2 N*mm}}"
RESTITUTIONS = (0.0, 0.5, 1.0)
COASTING, GRIP = 0.7, 0.4  # speed [mm/ms], friction of the motor
PRELOAD, SPRING, STIFF, THICK = 2.2, 0.25, 250.0, 0.12  # [N], [N/mm], [N/mm^1.5], [mm]
HEAVY = 150.0  # [g]
MOTOR, TOP = 8.0, 6.0  # radii [mm]
LOST = "0.1 % of the speed over the run: there is no loss in the law"
NIP = "a = mu N/m, N the spring's force on the note: preload + stiffness (thickness - depths), by bisection"
BLOCK, ROLLER, RUB = 50.0, 30.0, 0.2  # masses [g], friction
SLOW, FAST, APART = 0.6, 0.84, 44.0  # surface speeds [mm/ms], distance of two nips [mm]
# So narrow that what turns in a nip slips by less than the smoothing there, and so hard that it is shallow.
NARROW, HARD = 1.0, 1000.0  # [mm], [N/mm^1.5]


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or one of each kind."""
    values = RESTITUTIONS[1:2] if quick else RESTITUTIONS
    made = [*(_coast(c) for c in values), *(_pull(c) for c in values), _spin_up()]
    return made if quick else [*made, _skew()]


def nip(name: str, y: float, width: float, drive: str, stiffness: float) -> str:
    """Two rollers that face each other, the upper one pressed: a fragment of a map of rollers. The note
    begins in balance: the lower roller stands as deep in it as the spring presses the upper one."""
    low = -MOTOR - THICK / 2 + (force_in_nip(stiffness) / stiffness) ** (2 / 3)
    return (
        f"low_{name}: {{center: [0 mm, {y!r} mm, {low!r} mm], axis: y, radius: {MOTOR} mm,"
        f" width: {width} mm, mass: 10 g{drive}}},"
        f" top_{name}: {{center: [0 mm, {y!r} mm, {TOP + THICK / 2!r} mm], axis: y, radius: {TOP} mm,"
        f" width: {width} mm, mass: 4 g, press: {{direction: -z, stiffness: {SPRING} N/mm,"
        f" preload: {PRELOAD} N}}}}"
    )


def _in_nip(restitution: float, mass: float, velocity: float, low: float, drive: str, duration: int) -> Run:
    """A sheet in one nip; `low` is the friction of its lower roller, that of the upper one is none."""
    contact = f"stiffness: {STIFF} N/mm^1.5, restitution: {restitution!r}, smoothing: 2 mm/s"
    sheet = (
        f"{{n: {{material: p, size: [90 mm, 50 mm], thickness: {THICK} mm, mass: {mass} g, boxes: [15, 3],"
        f" layout: plate, velocity: [{velocity} m/s, 0 m/s, 0 m/s]}}}}"
    )
    contacts = (
        f"[{{between: [n, low_a], {contact}, friction: {low}}},"
        f" {{between: [n, top_a], {contact}, friction: 0}},"
        " {between: [low_a, top_a], stiffness: 30 N/mm^1.5, friction: 0, smoothing: 1 mm/s}]"
    )
    sets = (
        *(NONE, PAPER, f"sheets={sheet}", "planes={}", f"rollers={{{nip('a', 0.0, 40.0, drive, STIFF)}}}"),
        *(f"contacts={contacts}", f"run.duration={duration} ms", "run.print_step=0.5 ms", "run.margin=30 mm"),
    )
    return Run(SAMPLE, sets)


def _coast(restitution: float) -> BenchCase:
    run = _in_nip(restitution, HEAVY, COASTING, 0.0, "", 25)
    return row("Nips", f"sheet that coasts through a free nip, c_R {restitution:g}", run, coasts)


def _pull(restitution: float) -> BenchCase:
    run = _in_nip(restitution, HEAVY, 0.0, GRIP, ", drive: {speed: 90 rad/s}", 30)
    return row("Nips", f"sheet that a nip pulls while it slips, c_R {restitution:g}", run, pulls)


def _spin_up() -> BenchCase:
    roller = f"axis: y, radius: 10 mm, width: 30 mm, mass: {ROLLER} g"
    # the block covers 20 of 30 mm of each roller
    sunk = (0.5 * BLOCK * 9.81e-3 / (80 * 20 / 30)) ** (2 / 3)
    sets = (
        "sheets.block.size=[90 mm, 20 mm]",
        "sheets.block.thickness=4 mm",
        f"sheets.block.mass={BLOCK} g",
        f"sheets.block.center=[0 mm, 0 mm, {12.0 - sunk!r} mm]",
        "sheets.block.velocity=[0.9 m/s, 0 m/s, 0 m/s]",
        "planes={}",
        f"rollers={{rear: {{center: [-25 mm, 0 mm, 0 mm], {roller}}},"
        f" front: {{center: [25 mm, 0 mm, 0 mm], {roller}}}}}",
        f"contacts=[{{between: [block, '*r*'], stiffness: 80 N/mm^1.5, friction: {RUB}, restitution: 0.5,"
        " smoothing: 1 mm/s}]",
        "run.duration=20 ms",
        "run.prune=false",
    )
    return row("Nips", "free rollers that a block spins up", Run(SAMPLE, sets), spins_up)


def _skew() -> BenchCase:
    contact = f"stiffness: {HARD} N/mm^1.5, restitution: 0.5, smoothing: 2 mm/s"
    sheet = (
        f"{{n: {{material: p, size: [64 mm, 70 mm], thickness: {THICK} mm, mass: 0.4 g, boxes: [8, 7],"
        f" layout: plate, center: [-6 mm, 0 mm, 0 mm], velocity: [{(SLOW + FAST) / 2} m/s, 0 m/s, 0 m/s]}}}}"
    )
    drives = [f", drive: {{speed: {1e3 * speed / MOTOR!r} rad/s}}" for speed in (SLOW, FAST)]
    rollers = ", ".join(
        nip(name, side * APART / 2, NARROW, drive, HARD)
        for name, side, drive in zip("ab", (-1, 1), drives, strict=True)
    )
    contacts = ", ".join(
        f"{{between: [n, {which}], {contact}, friction: {mu}}}"
        for which, mu in (("low*", 0.9), ("top*", 0.1))
    )
    pairs = ", ".join(
        f"{{between: [low_{name}, top_{name}], stiffness: 30 N/mm^1.5, friction: 0, smoothing: 1 mm/s}}"
        for name in "ab"
    )
    sets = (
        *(NONE, PAPER, f"sheets={sheet}", "planes={}", f"rollers={{{rollers}}}"),
        *(f"contacts=[{contacts}, {pairs}]", "run.duration=20 ms", "run.print_step=0.5 ms"),
        "run.margin=30 mm",
    )
    return row("Nips", "sheet that two nips at different speeds turn", Run(SAMPLE, sets), skews)


def force_in_nip(stiffness: float) -> float:
    """Force of the pressed roller on the note [N]: that of the spring where the forces agree."""
    from scipy.optimize import root_scalar

    def missing(force: float) -> float:
        depth = 2.0 * (force / stiffness) ** (2 / 3)
        return PRELOAD + SPRING * (THICK - depth) - force

    return float(root_scalar(missing, bracket=(0.5 * PRELOAD, 2.0 * PRELOAD)).root)


def coasts(result: Result, _: Result | None) -> list[Finding]:
    """Speed at the end: nothing brakes it."""
    rate = result.sheet_motion(0)[1]
    found = float(rate[-1, 0])
    source = "momentum: no friction, rollers free, so nothing acts along"
    return [against("speed at the end", COASTING, found, 1e-3, "m/s", Basis(source, LOST))]


def pulls(result: Result, _: Result | None) -> list[Finding]:
    """Pull from the speed that the sheet has gained."""
    rate = result.sheet_motion(0)[1]
    half = len(result.time) // 3
    gained = float(rate[-1, 0] - rate[half, 0]) / float(result.time[-1] - result.time[half])
    basis = Basis(NIP, "1 % of mu N, as promised; the nip's force itself to 0.1 %")
    return [against("pull", GRIP * force_in_nip(STIFF), HEAVY * gained, 1e-2, "N", basis)]


def spins_up(result: Result, _: Result | None) -> list[Finding]:
    """Rise of both rollers' speeds together, whichever bears what of the block's weight."""
    spins = np.abs(sum(result.spin[:, roller.body] @ roller.axis for roller in result.model.rollers))
    third = len(spins) // 3
    found = float(spins[-1] - spins[third]) / float(result.time[-1] - result.time[third])
    expected = 2 * RUB * BLOCK * 9.81e-3 / (ROLLER * 10.0)
    basis = Basis(
        "2 mu m g/(M R) of two solid cylinders that slip",
        "the block rocks as it comes to rest on the rollers",
    )
    return [against("rise of both speeds", 1e6 * expected, 1e6 * found, 5e-3, "rad/s^2", basis)]


def skews(result: Result, _: Result | None) -> list[Finding]:
    """Yaw rate once the sheet follows: the difference of the surface speeds over the nips' distance."""
    motion = result.sheet_motion(0)
    rate, yaw = motion[1], motion[2]
    third = len(yaw) // 3
    found = float(yaw[-1] - yaw[third]) / float(result.time[-1] - result.time[third])
    basis = Basis(
        "kinematics of rolling: (v2 - v1)/b and (v1 + v2)/2",
        "creep over a smoothing of 2 mm/s, and the way to the steady turn",
    )
    expected = -(FAST - SLOW) / APART
    mean = float((rate[third:, 0]).mean())
    return [
        against("yaw rate", 1e3 * expected, 1e3 * found, 5e-3, "rad/s", basis),
        against("mean speed along", (SLOW + FAST) / 2, mean, 2e-3, "m/s", basis),
    ]
