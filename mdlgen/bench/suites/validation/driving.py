"""Motors, torque limiters and shafts: spin-up, speed under load, force of a retard roller."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import RUBS, Result

SAMPLE = "verify/slide"
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
FAR = "sheets.block.center=[0 mm, 0 mm, 90 mm]"
RADIUS, MASS = 10.0, 20.0  # [mm], [g]
STALL, NO_LOAD, ROTOR, GEAR, BRAKE = 10.0, 0.3, 500.0, 2.0, 4.0  # [N mm], [rad/ms], [g mm^2], [N mm]
RATIO = 1.5
HOLD = 5.0  # of the limiter [N mm]
FORCES = (1.0, 2.0, 4.0)  # of the nip [N]
LINE = "w = w0 (1 - M/T0) (1 - exp(-t/tau)), tau = J w0/T0 (DC motor, rotor inertia times gear squared)"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or one of each kind."""
    forces = FORCES[1:2] if quick else FORCES
    made = [_spin_up(), *(_retard(force) for force in forces)]
    return made if quick else [*made, _shaft()]


def _alone(*more: str) -> Run:
    roller = f"axis: y, radius: {RADIUS} mm, width: 20 mm, mass: {MASS} g"
    rollers = (
        f"rollers={{feed: {{center: [0 mm, 0 mm, -30 mm], {roller}}},"
        f" other: {{center: [60 mm, 0 mm, -30 mm], {roller}}}}}"
    )
    sets = (NONE, FAR, "planes={}", "contacts=[]", rollers, *more)
    return Run(SAMPLE, (*sets, "run.duration=30 ms", "run.step=0.1 ms", "run.prune=false"))


def _motor() -> str:
    line = f"torque: {STALL} N*mm, speed: {1e3 * NO_LOAD} rad/s"
    return f"{{motor: {{{line}, inertia: {ROTOR} g*mm^2, gear: {GEAR}}}}}"


def _spin_up() -> BenchCase:
    bearing = f"rollers.feed.bearing={{torque: {BRAKE} N*mm}}"
    run = _alone(f"rollers.feed.drive={_motor()}", bearing)
    return row("Drives", "motor that spins a braked roller up", run, spins_up)


def _shaft() -> BenchCase:
    shaft = f"shafts={{main: {{rollers: {{feed: 1, other: {RATIO}}}, drive: {_motor()}}}}}"
    return row("Drives", "motor on a shaft with two rollers", _alone(shaft), shares)


def _retard(force: float) -> BenchCase:
    """A sheet between a roller that feeds and one on a limiter whose shaft stands."""
    roller = f"axis: y, radius: {RADIUS} mm, width: 16 mm, mass: 10 g"
    sheet = (
        "{n: {material: p, size: [60 mm, 20 mm], thickness: 0.1 mm, mass: 0.12 g, boxes: [6, 1],"
        " center: [-15 mm, 0 mm, 0 mm]}}"
    )
    rollers = (
        f"{{feed: {{center: [0 mm, 0 mm, 10.05 mm], {roller}, drive: {{speed: -20 rad/s, ramp: 4 ms}}}},"
        f" retard: {{center: [0 mm, 0 mm, -10.05 mm], {roller}, limiter: {{torque: {HOLD} N*mm}},"
        f" press: {{direction: z, stiffness: 0.1 N/mm, preload: {force} N}}}}}}"
    )
    paper = "materials={p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.2 N*mm}}"
    contact = "{between: [n, [feed, retard]], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 2 mm/s}"
    sets = (NONE, paper, f"sheets={sheet}", "planes={}", f"rollers={rollers}", f"contacts=[{contact}]")
    run = Run(SAMPLE, (*sets, "run.duration=20 ms", "run.print_step=0.5 ms"))
    return row("Drives", f"retard roller on a limiter, nip of {force:g} N", run, holds_back)


def _spin(result: Result, name: str) -> np.ndarray:
    roller = result.model.roller(name)
    return result.spin[:, roller.body] @ roller.axis


def spins_up(result: Result, _: Result | None) -> list[Finding]:
    """Speed at the end of the run."""
    inertia, torque, speed = 0.5 * MASS * RADIUS**2 + GEAR**2 * ROTOR, GEAR * STALL, NO_LOAD / GEAR
    t = float(result.time[-1])
    due = speed * (1.0 - BRAKE / torque) * (1.0 - np.exp(-t * torque / inertia / speed))
    basis = Basis(LINE, "a step of 0.1 ms, and friction of the bearing over its creep of 0.1 rad/s")
    return [against("speed", 1e3 * due, 1e3 * float(_spin(result, "feed")[-1]), 1e-3, "rad/s", basis)]


def shares(result: Result, _: Result | None) -> list[Finding]:
    """Speed of the one that is geared up, from the inertia of both."""
    inertia = 0.5 * MASS * RADIUS**2 * (1.0 + RATIO**2) + GEAR**2 * ROTOR
    torque, speed, t = GEAR * STALL, NO_LOAD / GEAR, float(result.time[-1])
    due = RATIO * speed * (1.0 - np.exp(-t * torque / inertia / speed))
    basis = Basis(LINE + ", J = J1 + r^2 J2", "a step of 0.1 ms")
    return [against("speed", 1e3 * due, 1e3 * float(_spin(result, "other")[-1]), 1e-3, "rad/s", basis)]


def holds_back(result: Result, _: Result | None) -> list[Finding]:
    """Friction of the retard roller on the sheet once it turns along."""
    assert result.contact_friction is not None
    at = result.model.contacts.part_b.index("retard")
    late = result.time > 12.0
    found = float(np.abs(result.contact_friction[late, at, RUBS]).mean())
    basis = Basis("torque over radius, as of reverse rollers", "1 %, as promised")
    return [against("force that holds back", HOLD / RADIUS, found, 1e-2, "N", basis)]
