"""Friction as it is measured: a block that slides aslant, on either face, over a Stribeck curve, light and
heavy, and a large sheet whose friction scatters."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import rubbing
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result

GROUP = "Friction as it is measured"
GRAVITY = 9.81e-3  # [mm/ms^2]
SPEED = 1.5  # [mm/ms], of the block of verify/slide
MD, CD = 0.25, 0.45
FRONT, BACK = 0.42, 0.3
STRIBECK = (0.5, 0.2, 0.4)  # static, dynamic, Stribeck velocity [mm/ms]
LIGHT, HEAVY, EXPONENT = 10.0, 40.0, -0.25  # [g], [g]
MEAN, DEVIATION, LENGTH = 0.3, 0.2, 3.0  # [mm]
FIELD = (240.0, 160.0)  # of the sheet that scatters [mm]
BECAUSE = "friction over a smoothing of 1 mm/s, and run.tolerance of places"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the short ones."""
    short = [_aslant(45.0), _face(180.0), _stribeck()]
    if quick:
        return short
    return [_aslant(0.0), _aslant(90.0), *short, _face(0.0), _pressure(LIGHT), _pressure(HEAVY), _scatter()]


def _slide(name: str, friction: str, measure, *sets: str) -> BenchCase:
    start = (f"contacts.0.friction={friction}", *sets, "run.duration=40 ms")
    return row(GROUP, name, Run("verify/slide", start), measure)


def _aslant(angle: float) -> BenchCase:
    """The block stands turned by 30 deg, and moves at an angle [deg] to its MD."""
    way = math.radians(30.0 + angle)
    x, y = SPEED * math.cos(way), SPEED * math.sin(way)
    sets = ("sheets.block.turn=30 deg", f"sheets.block.velocity=[{x!r} m/s, {y!r} m/s, 0 m/s]")
    name = f"block of mu {MD:g} along MD and {CD:g} along CD, at {angle:g} deg to MD"
    return _slide(name, f"[{MD}, {CD}]", Aslant(angle), *sets)


def _face(turn: float) -> BenchCase:
    side = "back" if turn == 0.0 else "front"
    name = f"block on its {side}, front {FRONT:g}, back {BACK:g}"
    mu, friction = BACK if turn == 0.0 else FRONT, f"{{front: {FRONT}, back: {BACK}}}"
    return _slide(name, friction, Slowed(mu, "mu g t"), f"sheets.block.rotation=[{turn} deg, 0 deg, 0 deg]")


def _stribeck() -> BenchCase:
    static, dynamic, wide = STRIBECK
    friction = f"{{static: {static}, dynamic: {dynamic}, stribeck_velocity: {wide} m/s}}"
    return _slide("block that slows down over a Stribeck curve", friction, over_stribeck)


def _pressure(mass: float) -> BenchCase:
    friction = f"{{mu: 0.3, pressure: {{at: {_pressure_of(LIGHT)!r} MPa, exponent: {EXPONENT}}}}}"
    mu = 0.3 * (mass / LIGHT) ** EXPONENT
    sunk = (mass * GRAVITY / 1000) ** (2 / 3)
    sets = (f"sheets.block.mass={mass} g", f"sheets.block.center=[-400 mm, 0 mm, {5.0 - sunk!r} mm]")
    name = f"block of {mass:g} g, mu goes with p^{EXPONENT:g}"
    return _slide(name, friction, Slowed(mu, "mu_0 (p/p_0)^n g t"), *sets)


def _pressure_of(mass: float) -> float:
    """Pressure under the block of verify/slide [MPa]."""
    return mass * GRAVITY / 400.0


def _scatter() -> BenchCase:
    friction = f"{{mu: {MEAN}, scatter: {{deviation: {DEVIATION}, length: {LENGTH} mm, seed: 7}}}}"
    x, y = FIELD
    sets = (f"sheets.block.size=[{x} mm, {y} mm]",)
    return _slide("large block whose friction scatters", friction, scatters, *sets)


@dataclass(frozen=True)
class Aslant:
    """Speeds along MD and CD at the end."""

    angle: float  # [deg]

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        way = math.radians(self.angle)
        start = SPEED * math.cos(way), SPEED * math.sin(way)
        exact = rubbing.aslant(start, (MD, CD), GRAVITY, float(result.time[-1]))[1]
        found = result.velocity[-1, 0] @ result.model.sheets[0].rotation
        basis = Basis("a = -g M^2 v/|M v| by DOP853", BECAUSE)
        return [
            against(f"speed along {axis}", float(exact[k]), float(found[k]), 2e-3, "m/s", basis, SPEED)
            for k, axis in enumerate(("MD", "CD"))
        ]


@dataclass(frozen=True)
class Slowed:
    """Speed that a block has lost at the end under a constant coefficient."""

    mu: float
    source: str

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        lost = float(np.linalg.norm(result.velocity[0, 0]) - np.linalg.norm(result.velocity[-1, 0]))
        exact = self.mu * GRAVITY * float(result.time[-1])
        return [against("speed lost", exact, lost, 2e-3, "m/s", Basis(self.source, BECAUSE))]


def over_stribeck(result: Result, _: Result | None) -> list[Finding]:
    """Way and speed at the end."""
    static, dynamic, wide = STRIBECK

    def mu(v: float) -> float:
        return dynamic + (static - dynamic) * math.exp(-(((v - 1e-3) / wide) ** 2))

    way, speed = rubbing.over_speeds(SPEED, mu, GRAVITY, float(result.time[-1]))
    moved = float(result.position[-1, 0, 0] - result.model.bodies.position[0, 0])
    basis = Basis("dv/dt = -g mu(v) by DOP853", BECAUSE)
    return [
        against("way", way, moved, 2e-3, "mm", basis),
        against("speed", speed, float(result.velocity[-1, 0, 0]), 2e-3, "m/s", basis, SPEED),
    ]


def scatters(result: Result, _: Result | None) -> list[Finding]:
    """The mean of friction over many correlation lengths is that of the contact."""
    lost = SPEED - float(np.linalg.norm(result.velocity[-1, 0]))
    found = lost / (GRAVITY * float(result.time[-1]))
    # an area A has A/(pi L^2) independent places
    missed = DEVIATION * math.sqrt(math.pi * LENGTH**2 / (FIELD[0] * FIELD[1]))
    because = "three standard deviations of the mean over the sheet, c sqrt(pi L^2/A)"
    return [
        against("mean coefficient", MEAN, found, 3 * missed, "1", Basis("the mean that was given", because))
    ]
