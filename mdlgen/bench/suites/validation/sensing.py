"""Sensors and rules: when the edges of a sheet that falls along itself are seen, and when a rule acts."""

from __future__ import annotations

import math

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

PULL = 2e-3  # along the sheet [mm/ms^2]
LENGTH, AHEAD = 60.0, 10.3  # of the sheet, of the beam before its leading edge as it begins [mm]
DELAY, STEP, OFF = 3.0, 0.5, 0.01  # of the rule, of the run [ms]; hysteresis of a sensor [mm]
FALLS = "t = sqrt(2 s/a) of the way s of an edge"
FORESEEN = "a step ends where the edge is foreseen at its velocity: a h^2/2 over the speed"
MIDDLE = "the velocity is that in the middle of a step: a h/2"


def cases(quick: bool) -> list[BenchCase]:
    """One row, which is short."""
    at = 0.5 * LENGTH + AHEAD
    sets = (
        f"gravity=[{1e3 * PULL!r} m/s^2, 0 m/s^2, 0 m/s^2]",
        f"sheets.block.size=[{LENGTH} mm, 40 mm]",
        "sheets.block.thickness=1 mm",
        "sheets.block.spin=[0 rad/s, 0 rad/s, 0 rad/s]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        "sheets.block.center=[0 mm, 0 mm, 0 mm]",
        f"sensors={{eye: {{beam: [[{at} mm, 1 mm, -5 mm], [{at} mm, 1 mm, 5 mm]]}}}}",
        f"rules=[{{when: eye covered, after: {DELAY} ms, do: {{go: seen}}}}]",
        "run.duration=300 ms",
        f"run.step={STEP} ms",
        "run.print_step=2 ms",
    )
    return [row("Sensors and rules", "sheet that falls past a beam", Run("verify/flip", sets), sees)]


def sees(result: Result, _: Result | None) -> list[Finding]:
    """Times of both edges and of the rule, and the speed that the sensor has."""
    rows = {str(event["kind"]): event for event in result.reactions}
    begun = math.sqrt(2.0 * AHEAD / PULL)
    gone = math.sqrt(2.0 * (AHEAD + LENGTH + OFF) / PULL)
    edges, speed = Basis(FALLS, FORESEEN), Basis("v = a t", MIDDLE)
    return [
        against("leading edge", begun, rows["covered"]["time_ms"], 2e-5, "ms", edges),
        against("trailing edge", gone, rows["cleared"]["time_ms"], 2e-5, "ms", edges),
        against("rule", begun + DELAY, rows["rule"]["time_ms"], 2e-5, "ms", edges),
        against("speed", 1e3 * PULL * begun, rows["covered"]["speed_mm_per_s"], 5e-3, "mm/s", speed),
    ]
