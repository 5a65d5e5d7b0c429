"""A strip that is clamped at one end and swings freely: frequencies and damping of its first modes."""

from __future__ import annotations

import math

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles.swing import fit
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

LENGTH, WIDTH, BENDING, AREA = 50.0, 67.0, 0.242, 0.72 / (67.0 * 127.0)  # [mm], [mm], [N mm], [g/mm^2]
# Roots of cos(b) cosh(b) = -1.
ROOTS = (1.875104068711961, 4.694091132974174)
BEAM = "Euler and Bernoulli: (b/L)^2 sqrt(D/rhoA), cos(b) cosh(b) = -1"
TIME = 0.3  # of the damping [ms]
VOIGT = "Kelvin and Voigt: stress = E (strain + tau rate), so zeta = omega tau/2 in each mode"
# The lattice of 40 rows lies 0.03 % below the continuum in the first mode and six times that in the second,
# that of 20 rows four times as much; the fit of a swing of 1 % of the length to harmonics, 0.01 %.
LATTICE = {20: (4e-3, 1.2e-2), 40: (1e-3, 4e-3)}
HINGES = "hinges for the continuum, an error of second order in the wave's length"
DAMPED = "that of the frequency, and the fit: 1 %"
SETS = (
    f"sheets.note.size=[{WIDTH} mm, {LENGTH} mm]",
    f"sheets.note.mass={AREA * WIDTH * LENGTH!r} g",
    "gravity=[0 m/s^2, 0 m/s^2, -2 m/s^2]",
    f"materials.eur10.damping={{time: {TIME} ms}}",
    "run.analysis=transient",
    "run.duration=250 ms",
    "run.print_step=0.5 ms",
)


def cases(quick: bool) -> list[BenchCase]:
    """Frequencies and damping on two grids, or on the coarser one."""
    return [_swing(rows) for rows in (list(LATTICE)[:1] if quick else LATTICE)]


def _swing(rows: int) -> BenchCase:
    run = Run("cantilever", (f"sheets.note.boxes=[1,{rows}]", *SETS))
    return row("Vibration of a cantilever", f"strip released flat, {rows} rows", run, modes)


def modes(result: Result, _: Result | None) -> list[Finding]:
    """Frequency and damping of the first two modes of the end, by a fit of damped harmonics."""
    up = result.anchor_motion(0)[0][:, 2]
    guess = [(b / LENGTH) ** 2 * math.sqrt(BENDING / AREA) for b in ROOTS]
    found = fit(result.time, up - up[0], guess)
    near = LATTICE[result.model.sheets[0].n_y]
    per_hertz = 2 * math.pi * 1e-3
    made = []
    for k, (want, got, allowed) in enumerate(zip(guess, found, near, strict=True), 1):
        rate, ratio = got.rate / per_hertz, 0.5 * want * TIME
        made += [
            against(f"frequency {k}", want / per_hertz, rate, allowed, "Hz", Basis(BEAM, HINGES)),
            against(f"damping ratio {k}", ratio, got.ratio, 1e-2 + allowed, "", Basis(VOIGT, DAMPED)),
        ]
    return made
