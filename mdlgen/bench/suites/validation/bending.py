"""Statics of a strip that is clamped at one end: Bisshopp and Drucker, the heavy elastica, columns."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import elastica, loaded
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

# Values of the sample cantilever: a note held at y_min.
LENGTH, WIDTH, MASS, BENDING = 127.0, 67.0, 0.72, 0.242  # [mm], [mm], [g], [N mm]
GRAVITY = 9.81e-3  # [mm/ms^2]
ROWS = 40
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
STRIP = f"sheets.note.boxes=[1,{ROWS}]"
# P L^2/(D W) and what the table has for it: deflection and shortening over the length.
TABLE = {1.0: (0.30172, 0.05643), 2.0: (0.49346, 0.16064), 5.0: (0.71379, 0.38763), 10.0: (0.81061, 0.55500)}
TABLED = "Bisshopp and Drucker, Q. Appl. Math. 3 (1945) 272; the digits as in Mattiasson, IJNME 17 (1981) 145"
HEAVY = "D theta'' = -rhoA g (L - s) cos theta by a boundary value solver"
LENGTHS = (50.0, 80.0, 110.0, 140.0, 165.0)  # [mm]; Gamma from 0.4 to 15.4
# P over Euler's load, and the slope of the end of the perfect column [deg].
BUCKLED = {1.152: 60.0, 1.518: 100.0, 1.884: 120.0}
PERFECT = "Timoshenko and Gere, Theory of Elastic Stability (1961), table 2-4; here with a small force across"
ASIDE = 2e-3  # force across, over D W / L^2
# Hinges in place of a continuum: 0.05 % of the drop at 40 rows for the heavy elastica, of second order
# (see the suite elastica); what bends more, and near its end most, is further off by a few times that.
HINGES = "40 hinges stand for the continuum, an error of second order: 0.05 to 0.15 %"
CHAIN = 2e-3
NEAR = "the same, divided by 1 - P/P_Euler, since the lattice's own critical load is 0.01 to 0.05 % off"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or one of each kind."""
    loads = list(TABLE)[-1:] if quick else list(TABLE)
    lengths = LENGTHS[-2:-1] if quick else LENGTHS
    pressed = () if quick else (0.5, 0.8)
    buckled = list(BUCKLED)[1:2] if quick else list(BUCKLED)
    return [
        *(_end_loaded(load) for load in loads),
        *(_heavy(length) for length in lengths),
        *(_column(part) for part in pressed),
        *(_buckled(times) for times in buckled),
    ]


def _force(along: float, across: float) -> str:
    """Override of the load at the free end, in units of D W / L^2; along presses it to the clamp."""
    unit = BENDING * WIDTH / LENGTH**2
    return f"loads=[{{sheet: note, edge: y_max, force: [0 N, {-along * unit!r} N, {-across * unit!r} N]}}]"


def _end_loaded(load: float) -> BenchCase:
    run = Run("cantilever", (NONE, STRIP, _force(0.0, load)))
    group = "Large deflection under a load at the end"
    return row(group, f"strip with P L^2/(D W) = {load:g}", run, Deflected(load))


def _heavy(length: float) -> BenchCase:
    sets = (
        STRIP,
        f"sheets.note.size=[67 mm, {length!r} mm]",
        f"sheets.note.mass={MASS * length / LENGTH!r} g",
    )
    return row("The heavy elastica", f"strip of {length:g} mm", Run("cantilever", sets), hangs)


def _column(part: float) -> BenchCase:
    run = Run("cantilever", (NONE, STRIP, _force(part * math.pi**2 / 4, ASIDE)))
    return row("Columns", f"strip at {part:g} of Euler's load", run, Column(part))


def _buckled(times: float) -> BenchCase:
    run = Run("cantilever", (NONE, STRIP, _force(times * math.pi**2 / 4, ASIDE)))
    return row("Columns", f"strip at {times:g} times Euler's load", run, Buckled(times))


def _tip(result: Result) -> np.ndarray:
    """By which the end has moved: along the strip outward, and up, over its length."""
    moved = result.anchor_motion(0)[0][-1] - np.array([0.0, result.model.sheets[0].size[1] / 2, 0.0])
    return moved[1:] / result.model.sheets[0].size[1]


@dataclass(frozen=True)
class Deflected:
    """Deflection and shortening against the table."""

    load: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        down, short = TABLE[self.load]
        along, up = _tip(result)
        basis = Basis(TABLED, HINGES)
        return [
            against("deflection / L", down, -up, CHAIN, "", basis),
            against("shortening / L", short, -along, 2 * CHAIN, "", basis),
        ]


def hangs(result: Result, _: Result | None) -> list[Finding]:
    """Drop of the end, from the paper's numbers and not from the Model's."""
    length = result.model.sheets[0].size[1]
    group = MASS / (LENGTH * WIDTH) * GRAVITY * length**3 / BENDING
    expected, found = elastica.drop(group) * length, -_tip(result)[1] * length
    return [against("drop", expected, found, CHAIN, "mm", Basis(HEAVY, HINGES))]


@dataclass(frozen=True)
class Column:
    """Deflection of a beam-column, whose small force across counts 1/(1 - P/P_Euler) times."""

    part: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        expected = loaded.column(ASIDE, self.part * math.pi**2 / 4)
        source = "Timoshenko and Gere, section 1.3: Q L^3/(D W) (tan u - u)/u^3, u^2 = P L^2/(D W)"
        allowed = CHAIN / (1 - self.part)
        found = -_tip(result)[1]
        return [against("deflection / L", expected, found, allowed, "", Basis(source, NEAR))]


@dataclass(frozen=True)
class Buckled:
    """Place of the end of a column beyond its critical load, by the quadrature of `loaded`."""

    times: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        exact = loaded.end(self.times * math.pi**2 / 4, ASIDE)
        along, up = _tip(result)
        basis = Basis(PERFECT, NEAR)
        allowed = CHAIN / (1 - 1 / self.times)
        return [
            against("end aside / L", exact.z, -up, allowed, "", basis),
            against("end above the clamp / L", exact.x, 1.0 + along, allowed, "", basis, 1.0),
        ]
