"""The feeder: how far a note creeps as it waits, how deep rollers press, and what the whole way costs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.bench.case import BenchCase, Finding, Reference, Run
from mdlgen.registry import REFERENCE
from mdlgen.results.compare import compare
from mdlgen.results.result import Result
from mdlgen.results.summary import summary

SAMPLE, NOTE = "feeder_one", "note_1"
# Time from which the note stands at the rejection roller, and time at which the rubber comes.
STANDS, RUBBER = 40.0, 200.0  # [ms]
STAYS = 0.2  # mm that the note may creep in between
PIECE = 60.0  # [ms] that Exudyn runs
AGREE = 0.01  # of the travel
COARSE = (f"sheets.{NOTE}.boxes=[10,8]",)
GRIDS = {
    "c2c 200": (f"sheets.{NOTE}.boxes=[10,20]", f"sheets.{NOTE}.layout=center_to_center"),
    "e2e 200": (f"sheets.{NOTE}.boxes=[10,20]",),
    "e2e 600": (f"sheets.{NOTE}.boxes=[20,30]",),
    "e2e 224, graded": (
        f"sheets.{NOTE}.boxes=[14,16]",
        f"sheets.{NOTE}.grading={{x: [2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1]}}",
    ),
}
LIMIT = 1800.0  # [s]


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """A piece against the other solver for Exudyn; else the wait of each grid, and whole runs."""
    if solver == REFERENCE:
        sets = (*(COARSE if quick else GRIDS["e2e 200"]), f"run.duration={PIECE} ms")
        run = Run(SAMPLE, sets)
        return [
            BenchCase(
                "feeder", f"its first {PIECE:g} ms", run, agrees, Reference(run, reference), limit=LIMIT
            )
        ]
    if quick:
        sets = (*COARSE, f"run.duration={STANDS + 5.0} ms")
        return [BenchCase("feeder", "coarse, waits", Run(SAMPLE, sets), waits, limit=LIMIT)]
    waiting = [
        BenchCase(
            "feeder", f"{name}, waits", Run(SAMPLE, (*sets, f"run.duration={RUBBER} ms")), waits, limit=LIMIT
        )
        for name, sets in GRIDS.items()
    ]
    whole = [
        BenchCase("feeder", f"{name}, 600 ms", Run(SAMPLE, GRIDS[name]), itself, repeats=False, limit=LIMIT)
        for name in ("e2e 200", "e2e 600")
    ]
    two = BenchCase("feeder", "two of 80 and 40, 600 ms", Run("feeder"), itself, repeats=False, limit=LIMIT)
    return [*waiting, *whole, two]


def agrees(result: Result, reference: Result | None) -> list[Finding]:
    """The difference of positions to the other solver."""
    assert reference is not None
    found = compare(result, reference)
    details = {name.replace("note_1 / ", "force on "): off for name, off in found.nip_force.items()}
    return [Finding("RMS position, of the travel", found.relative, AGREE, details)]


def waits(result: Result, _: Result | None) -> list[Finding]:
    """How far the note goes as it waits [mm], as a part of how far it may."""
    along = result.sheet_motion(0)[0][:, 0]
    times = np.minimum([STANDS, RUBBER], result.time[-1])
    from_, to = np.interp(times, result.time, along)
    record: dict[str, Any] = summary(result)["rollers"]
    across, lengthways = _angles(result)
    details = {
        "advance_um": 1e3 * float(to - from_),
        "angle_x_mrad": 1e3 * lengthways,
        "angle_y_mrad": 1e3 * across,
        "feed_max_penetration_mm": record["feed"]["max_penetration_mm"],
        "reject_max_penetration_mm": record["reject"]["max_penetration_mm"],
    }
    return [Finding("advance in the wait, of 0.2 mm", abs(float(to - from_)) / STAYS, 1.0, details)]


def _angles(result: Result) -> tuple[float, float]:
    """The greatest angle between the normals of neighbours [rad] after the note stands, along y and x."""
    sheet = result.model.sheets[0]
    boxes = slice(sheet.first, sheet.first + sheet.count)
    w, x, y, z = np.moveaxis(result.rotation[result.time >= STANDS][:, boxes], -1, 0)
    normals = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1)
    grid = normals.reshape(len(normals), sheet.n_y, sheet.n_x, 3)

    def greatest(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
        return float(np.linalg.norm(np.cross(one, other), axis=-1).max())

    return greatest(grid[:, 1:], grid[:, :-1]), greatest(grid[:, :, 1:], grid[:, :, :-1])


def itself(result: Result, _: Result | None) -> list[Finding]:
    """The run's own estimate of its error, and where the note is."""
    lead = float(result.sheet_motion(0)[0][-1, 0])
    error = float("nan") if result.error_estimate is None else result.error_estimate
    details = {"steps": float(result.steps or 0), "iterations": float(result.iterations or 0), "x_mm": lead}
    return [Finding("own estimate of the position, of the travel", error, AGREE, details)]
