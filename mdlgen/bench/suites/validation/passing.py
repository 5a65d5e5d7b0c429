"""Sheets that come in and leave: when blocks that fall have left, and with which energy."""

from __future__ import annotations

import math

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

GRAVITY = 9.81e-3  # [mm/ms^2]
MASS, SPEED = 3.0, 0.8  # [g], [mm/ms]
THICK, FALL = 1.0, 12.0  # [mm]
COMES = (0.0, 30.013, 61.7)  # [ms]
FALLS = Basis("t = sqrt(2 h/g) after a block comes in", "steps end there but for what one does not know of g")
BOOKED = Basis("m v^2/2 - m g z of what comes in", "round-off: the state at that time is the given one")


def cases(quick: bool) -> list[BenchCase]:
    """One row, which is short."""
    times = ", ".join(f"{time} ms" for time in COMES)
    sets = (
        f"gravity=[0 m/s^2, 0 m/s^2, {-1e3 * GRAVITY!r} m/s^2]",
        "sheets.block.size=[20 mm, 20 mm]",
        f"sheets.block.thickness={THICK} mm",
        f"sheets.block.mass={MASS} g",
        "sheets.block.spin=[0 rad/s, 0 rad/s, 0 rad/s]",
        "sheets.block.center=[0 mm, 0 mm, 0 mm]",
        f"sheets.block.velocity=[{SPEED} m/s, 0 m/s, 0 m/s]",
        f"streams={{shot: {{of: block, times: [{times}], out: beyond z = {-FALL} mm}}}}",
        "run.duration=125 ms",
        "run.step=0.1 ms",
        "run.print_step=1 ms",
    )
    return [row("Streams", "thrown blocks that leave as they have fallen", Run("verify/flip", sets), leaves)]


def leaves(result: Result, _: Result | None) -> list[Finding]:
    """How long the last block is there, and the energy with which two come in."""
    stays, energy = result.stays, result.energy
    assert stays is not None and energy.entered is not None, "sheets come in and leave"
    took = math.sqrt(2.0 * (FALL + 0.5 * THICK) / GRAVITY)
    kinetic = 2.0 * 0.5 * MASS * SPEED**2
    return [
        against("time of the last one", took, float(stays[-1, 1] - stays[-1, 0]), 1e-5, "ms", FALLS),
        against("energy that came in", kinetic, energy.entered, 1e-9, "N mm", BOOKED),
    ]
