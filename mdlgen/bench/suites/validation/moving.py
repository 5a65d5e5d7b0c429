"""Parts that move: what a plane lifts, and a flap that swings on its spring."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.gates import place
from mdlgen.results.result import Result

SAMPLE = "verify/slide"
WAY, SPAN, AT = 12.0, 60.0, 15.0  # of the lift [mm], [ms], a time at which its force is read [ms]
MASS, STIFF = 3.0, 50.0  # of the block [g], of its contact [N/mm^1.5]
INERTIA, SPRING, TORQUE = 900.0, 25.0, 1.5  # of the flap [g mm^2], [N mm/rad], [N mm]
G = 9.81e-3  # [mm/ms^2]
PARTS = "sheets.block.size=[30 mm, 30 mm]", "sheets.block.thickness=2 mm", f"sheets.block.mass={MASS} g"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, which are quick."""
    return [_lift(), _flap()]


def _lift() -> BenchCase:
    sunk = (MASS * G / STIFF) ** (2 / 3)
    sets = (
        *PARTS,
        f"sheets.block.center=[0 mm, 0 mm, {1.0 - sunk!r} mm]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        "planes={lift: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [99 mm, 99 mm, 10 mm],"
        f" slide: {{direction: z, profile: [[0 ms, 0 mm], [{SPAN} ms, {WAY} mm]]}}}}}}",
        f"contacts=[{{between: [block, lift], stiffness: {STIFF} N/mm^1.5, restitution: 0.3, friction: 0.3,"
        " smoothing: 1 mm/s}]",
        "run.duration=30 ms",
        "run.print_step=1 ms",
    )
    return row("Moving parts", "block on a plane that rises", Run(SAMPLE, sets), lifts)


def _flap() -> BenchCase:
    sets = (
        *PARTS,
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "sheets.block.center=[0 mm, 0 mm, 300 mm]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        "planes={flap: {center: [20 mm, 0 mm, -0.5 mm], normal: z, size: [40 mm, 20 mm, 1 mm],"
        " pivot: {at: [0 mm, 0 mm, 0 mm], axis: y,"
        f" inertia: {INERTIA} g*mm^2, stiffness: {SPRING} N*mm/rad, torque: {TORQUE} N*mm}}}}}}",
        f"contacts=[{{between: [block, flap], stiffness: {STIFF} N/mm^1.5, restitution: 0.3, friction: 0.3,"
        " smoothing: 1 mm/s}]",
        "run.duration=100 ms",
        "run.print_step=0.5 ms",
        "run.prune=false",
    )
    return row("Moving parts", "flap that swings on its spring", Run(SAMPLE, sets), swings)


def lifts(result: Result, _: Result | None) -> list[Finding]:
    """Force of the contact, and what the plane did."""
    k = int(np.abs(result.time - AT).argmin())
    rise = WAY / SPAN**2 * (6.0 - 12.0 * AT / SPAN)
    speed, height = (float(v[-1, 0, 2]) for v in (result.velocity, result.position - result.position[0]))
    force = Basis("m (g + a), a = way/span^2 (6 - 12 s)", "what still rings of the jump of a at the start")
    work = Basis("m g z + m v^2/2 of the block", "what its contact damps")
    return [
        against("force", MASS * (G + rise), float(result.contact_force[k, 0]), 5e-3, "N", force),
        against(
            "work of the plane",
            MASS * (G * height + 0.5 * speed * speed),
            result.energy.driven,
            5e-3,
            "N mm",
            work,
        ),
    ]


def swings(result: Result, _: Result | None) -> list[Finding]:
    """Period and amplitude of the turn."""
    (flap, _moving) = result.model.gates[0]
    turned = place(result, flap)
    assert turned is not None
    middle = turned - TORQUE / SPRING
    ups = np.flatnonzero((middle[:-1] < 0.0) & (middle[1:] >= 0.0))
    zeros = result.time[ups] - middle[ups] * np.diff(result.time)[ups] / np.diff(middle)[ups]
    period = float(np.diff(zeros).mean())
    basis = Basis("2 pi sqrt(I/k), and torque/k", "the step, of which the period has (omega dt)^2/24")
    return [
        against("period", 2.0 * math.pi * math.sqrt(INERTIA / SPRING), period, 2e-3, "ms", basis),
        against("amplitude", TORQUE / SPRING, float(np.ptp(turned)) / 2.0, 2e-3, "rad", basis),
    ]
