"""A box that swings on a hinge which yields; a crease that a moment opens, on several grids."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles.yielding import turns
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
BENDING = 0.242  # along y, of the sample cantilever [N mm]
# A box of 20 mm on the half-cell hinge of its clamp.
SIDE, MASS, THICK, SPEED = 20.0, 0.05, 0.1, 0.1  # [mm], [g], [mm], [rad/ms]
CURVATURE = 0.01  # at which it yields [1/mm]
SHARES = (0.05, 0.2, 0.5)  # slopes beyond, relative to the elastic one
ENERGY = "bilinear spring with kinematic hardening: work of trapezoids over each half swing"
MIDPOINT = "steps that begin and end to yield within them, of first order; 0.3 % at 0.05 ms"
# A strip with a crease in its middle, on several grids.
LENGTH, ROWS = 20.0, (4, 8, 16)  # [mm]
FOLD, CREASE, MOMENT = 20.0, 0.005, 0.002  # [deg], [N mm/rad per mm], per width [N]
SERIES = "crease in series with the sheet: fold + m/K_c + m L/D"
EXACT = "a chain of hinges under a moment has no error of the grid"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or one of each kind."""
    return [
        *(_swing(share) for share in (SHARES[1:2] if quick else SHARES)),
        *(_creased(rows) for rows in (() if quick else ROWS)),
    ]


def swing_sets(share: float) -> tuple[str, ...]:
    """The settings of the box that swings on its hinge."""
    return (
        NONE,
        f"materials.eur10.yield={{curvature: {CURVATURE} 1/mm, hardening: {share}}}",
        "materials.eur10.damping={ratio: 0}",
        f"sheets.note.size=[{SIDE} mm, {SIDE} mm]",
        f"sheets.note.mass={MASS} g",
        "sheets.note.boxes=[1,1]",
        f"sheets.note.velocity=[0 m/s, 0 m/s, {SPEED * SIDE / 2!r} m/s]",
        f"sheets.note.spin=[{1e3 * SPEED!r} rad/s, 0 rad/s, 0 rad/s]",
        *("run.analysis=transient", "run.duration=40 ms", "run.print_step=0.1 ms", "run.step=0.05 ms"),
        "run.tolerance=0.01",
    )


def _swing(share: float) -> BenchCase:
    name = f"box on a hinge, slope beyond {share:g} of the elastic one"
    return row("Yield", name, Run("cantilever", swing_sets(share)), Swung(share))


@dataclass(frozen=True)
class Swung:
    """The first three turns, the bend that is left, and the energy."""

    share: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        stiff = BENDING * 2.0  # of half a cell as wide as long [N mm/rad]
        inertia = MASS * (SIDE**2 / 3 + THICK**2 / 12)
        limit = BENDING * CURVATURE * SIDE
        want = turns(0.5 * inertia * SPEED**2, stiff, limit, self.share, 3)
        angle = 2.0 * np.arctan2(result.rotation[:, 0, 1], result.rotation[:, 0, 0])
        found = [float(angle.max())]
        after = angle[int(angle.argmax()) :]
        found.append(float(after.min()))
        found.append(float(after[int(after.argmin()) :].max()))
        basis = Basis(ENERGY, MIDPOINT)
        size = want[0].at
        assert result.plastic is not None and result.energy.plastic is not None, "the box yields"
        return [
            *(
                against(
                    f"turn {k}", math.degrees(w.at), math.degrees(f), 3e-3, "deg", basis, math.degrees(size)
                )
                for k, (w, f) in enumerate(zip(want, found, strict=True), 1)
            ),
            against(
                "plastic rotation", want[-1].plastic, float(result.plastic[-1, 0]), 3e-3, "rad", basis, size
            ),
            against("dissipated", want[-1].lost, result.energy.plastic, 3e-3, "N mm", basis),
        ]


def crease_sets(rows: int) -> tuple[str, ...]:
    """The settings of the strip with a crease in its middle."""
    return (
        NONE,
        f"sheets.note.size=[10 mm, {LENGTH} mm]",
        f"sheets.note.boxes=[1,{rows}]",
        "sheets.note.shape={start: flat, folds: "
        f"[{{along: y, at: 0 mm, angle: {FOLD} deg, crease: {CREASE} N/rad}}]}}",
        f"loads=[{{sheet: note, edge: y_max, moment: [{10 * MOMENT!r} N*mm, 0 N*mm, 0 N*mm]}}]",
    )


def _creased(rows: int) -> BenchCase:
    return row(
        "Yield", f"crease opened by a moment, {rows} rows", Run("cantilever", crease_sets(rows)), opens
    )


def opens(result: Result, _: Result | None) -> list[Finding]:
    """Angle of the crease: that of the last box, less what the sheet bends."""
    sheet = result.model.sheets[0]
    w, x = result.rotation[-1, sheet.count - 1, :2]
    angle = 2.0 * math.atan2(x, w) - MOMENT * (LENGTH - sheet.d_y / 2) / BENDING
    want = FOLD + math.degrees(MOMENT / CREASE)
    return [against("angle of the crease", want, math.degrees(angle), 1e-6, "deg", Basis(SERIES, EXACT))]
