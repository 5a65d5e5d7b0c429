"""Rungs of the laws of paper and rubber, each at its ends: friction that sticks, friction as it is measured,
Poisson's effect, yield, covers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import rubbing
from mdlgen.bench.suites.ladder import FORCED, rung
from mdlgen.bench.suites.validation import yielding
from mdlgen.model.covers import speed_ratio
from mdlgen.results.result import Result
from mdlgen.results.strain import histories, sheet_joints

GRAVITY = 9.81e-3  # [mm/ms^2]
BLOCK, MU, LEAN = 10.0, 0.4, math.radians(8.0)  # of the block of verify/slide on a slope [g]
STIFFNESSES = (1e2, 1e4, 1e6)  # along the faces [N/mm]
STICKS = (2.0, 0.2, 0.02)  # [ms]
SPEED, ASLANT = 1.5, math.radians(45.0)  # of the block, to its MD [mm/ms]
LEAST, RATIOS = 0.05, (2.0, 20.0)  # mu along MD, and that of CD over it
EXPONENTS = (-0.9, 1.0)
POISSONS = (0.0, 0.3, 0.49)
HARDENINGS = (0.01, 0.5)  # the least that is allowed; higher ones yield in more than three turns
# Poisson's ratio of a cover, its thickness [mm], Young's modulus [MPa].
COVERS = ((0.0, 3.0, 1.0), (0.4999, 3.0, 1.0), (0.49, 0.3, 2.0))
SLID, HELD, STRETCHED, SWUNG, CARRIED = 5e-3, 1e-4, 1e-2, 5e-3, 2e-3


def rungs() -> list[BenchCase]:
    """All of them."""
    return [
        *(_sticks(k_t) for k_t in STIFFNESSES),
        *(_sticks(1e2, step) for step in STICKS),
        *(_aslant(ratio) for ratio in RATIOS),
        *(_pressed(exponent) for exponent in EXPONENTS),
        *(_pulled(poisson) for poisson in POISSONS),
        *(_yields(share) for share in HARDENINGS),
        *(_covered(*cover) for cover in COVERS),
    ]


def _sticks(k_t: float, step: float | None = None) -> BenchCase:
    along, down = GRAVITY * math.sin(LEAN), GRAVITY * math.cos(LEAN)
    sunk = (BLOCK * down / 1000.0) ** (2 / 3)
    sets = (
        f"gravity=[{1e3 * along!r} m/s^2, 0 m/s^2, {-1e3 * down!r} m/s^2]",
        "sheets.block.velocity=[0 m/s, 0 m/s, 0 m/s]",
        f"sheets.block.center=[-400 mm, 0 mm, {5.0 - sunk!r} mm]",
        f"contacts.0.friction={{static: {MU}, dynamic: {MU}, sticking: {k_t!r} N/mm}}",
        "run.duration=150 ms",
    )
    name = f"k_t {k_t:g} N/mm" if step is None else f"step {step * 1e-3:g} s"
    run = Run("verify/slide", sets, step)
    return rung(f"{name}: block stuck on a slope", run, partial(holds, k_t))


def _aslant(ratio: float) -> BenchCase:
    x, y = SPEED * math.cos(ASLANT), SPEED * math.sin(ASLANT)
    sets = (
        f"contacts.0.friction=[{LEAST}, {LEAST * ratio}]",
        f"sheets.block.velocity=[{x!r} m/s, {y!r} m/s, 0 m/s]",
        # so flat that friction does not tip it over
        *("sheets.block.thickness=1 mm", "sheets.block.center=[-400 mm, 0 mm, 0.4979 mm]"),
        "run.duration=40 ms",
    )
    return rung(f"mu along CD x {ratio:g}: block aslant", Run("verify/slide", sets), Turns(ratio))


def _pressed(exponent: float) -> BenchCase:
    """Under twice the pressure at which mu is 0.2."""
    at = BLOCK * GRAVITY / 400.0 / 2.0
    friction = f"{{mu: 0.2, pressure: {{at: {at!r} MPa, exponent: {exponent}}}}}"
    run = Run("verify/slide", (f"contacts.0.friction={friction}", "run.duration=40 ms"))
    name = f"mu with pressure to the power {exponent:g}: sliding block"
    return rung(name, run, partial(slows, 0.2 * 2.0**exponent))


def _pulled(poisson: float) -> BenchCase:
    """A free plate without weight, in static balance of two forces."""
    shear = 2000.0 / (2.0 * (1.0 + poisson))
    sets = (
        f"materials={{p: {{E_md: 2000 MPa, E_cd: 2000 MPa, G: {shear!r} MPa, D_md: 167 N*mm, D_cd: 167 N*mm,"
        f" poisson: {poisson}}}}}",
        "sheets={n: {material: p, size: [120 mm, 40 mm], thickness: 1 mm, mass: 1 g, boxes: [12, 4],"
        " layout: plate}}",
        "supports=[{sheet: n, at: [5 mm, 5 mm], fix: [x, y, z]}, {sheet: n, at: [45 mm, 5 mm], fix: [y, z]},"
        " {sheet: n, at: [5 mm, -15 mm], fix: [z]}]",
        "loads=[{sheet: n, edge: x_min, force: [-0.001 N, 0 N, 0 N]},"
        " {sheet: n, edge: x_max, force: [0.001 N, 0 N, 0 N]}]",
        "probes={}",
    )
    return rung(f"poisson {poisson:g}: pulled plate", Run("verify/rollup", sets), partial(contracts, poisson))


def _yields(share: float) -> BenchCase:
    run = Run("cantilever", yielding.swing_sets(share))
    return rung(f"hardening {share:g}: box that swings on its hinge", run, partial(swings, share))


def _covered(poisson: float, thickness: float, modulus: float) -> BenchCase:
    cover = f"{{thickness: {thickness} mm, modulus: {modulus} MPa, poisson: {poisson}}}"
    sets = (f"nips.feed.lower.cover={cover}", "nips.feed.force=2 N")
    name = f"cover of {thickness:g} mm with poisson {poisson:g}: note in its nip"
    return rung(name, Run("rubber_nip", sets), carries)


def holds(k_t: float, result: Result, _: Result | None) -> list[Finding]:
    """The way of the middle of the lower face is W sin(a)/k_t, and nothing creeps."""
    w, x, y, z = np.moveaxis(result.rotation[:, 0], -1, 0)
    face = result.position[:, 0, 0] - 10.0 * (x * z + w * y)
    late = result.time >= 0.5 * result.time[-1]
    exact = BLOCK * GRAVITY * math.sin(LEAN) / k_t
    # below a thousandth of a micrometre it is the tilt that is measured
    error = abs(float(face[-1] - face[0]) - exact) / max(exact, 1e-6)
    crept = float(np.ptp(result.position[late, 0, 0]))
    return [
        Finding("way that it gives, relative", error, FORCED),
        Finding("creep over the later half [mm]", crept, max(HELD, FORCED * exact)),
    ]


@dataclass(frozen=True)
class Turns:
    """Speeds along MD and CD at the end by a quadrature, over that at the start."""

    ratio: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        start = SPEED * math.cos(ASLANT), SPEED * math.sin(ASLANT)
        law = LEAST, LEAST * self.ratio
        exact = rubbing.aslant(start, law, GRAVITY, float(result.time[-1]))[1]
        error = float(np.abs(result.velocity[-1, 0, :2] - exact).max()) / SPEED
        return [Finding("velocity, over that at the start", error, SLID)]


def slows(mu: float, result: Result, _: Result | None) -> list[Finding]:
    """Speed that is lost: mu g t."""
    lost = float(result.velocity[0, 0, 0] - result.velocity[-1, 0, 0])
    exact = mu * GRAVITY * float(result.time[-1])
    return [Finding("speed lost, relative", abs(lost / exact - 1.0), SLID)]


def contracts(poisson: float, result: Result, _: Result | None) -> list[Finding]:
    """Strain across the pull over that along it, in the middle third."""
    joints, found = sheet_joints(result.model), histories(result, np.array([len(result.time) - 1]))
    assert found is not None, "a sheet of many boxes has joints"
    stretch, middle = found[1][0], np.abs(joints.at[:, 0]) < 20.0
    along, across = (float(stretch[middle & (joints.axis == axis)].mean()) for axis in (0, 1))
    return [Finding("strain across over that along", abs(across / along + poisson), STRETCHED)]


def swings(share: float, result: Result, _: Result | None) -> list[Finding]:
    """Turns, plastic rotation and energy against a quadrature; see the validation."""
    found = yielding.Swung(share)(result, None)
    worst = max(found, key=lambda one: one.error)
    return [Finding(f"{worst.quantity}, relative, the worst of {len(found)}", worst.error, SWUNG)]


def carries(result: Result, _: Result | None) -> list[Finding]:
    """Speed of the note over that of the core's surface; what the cover gives is not tested here."""
    roller = result.model.roller("feed_lower")
    assert roller.cover is not None and roller.speed is not None, "the sample's roller has both"
    late = result.time >= 0.8 * result.time[-1]
    count = result.model.sheets[0].count
    force = float(result.contact_force[late, 0].mean())
    surface = roller.radius * abs(float(roller.prescribed(float(result.time[-1]))))
    found = float(np.abs(result.velocity[late, :count, 0]).mean()) / surface
    exact = float(speed_ratio(roller.cover, force))
    return [Finding("speed ratio", abs(found - exact), CARRIED, {"exact": exact, "found": found})]
