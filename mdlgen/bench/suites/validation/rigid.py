"""Rigid bodies: a pendulum, a tumbling block, an oblique impact, two blocks on each other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import impact, rigid
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.model.rotations import turns
from mdlgen.results.result import Result

GRAVITY = 9.81e-3  # [mm/ms^2]
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
# A bar whose equivalent length 2 L/3 + s^2/(6 L) is 1 m, as the point mass of the benchmark has it.
BAR, THICK = 1499.9998333, 1.0  # [mm]
A01 = (275.087463, -961.419205)  # where the mass is after 10 s [mm]
MULTIBODY = "IFToMM benchmark library of multibody dynamics, A01 (simple pendulum, 1 m, released level)"
JACOBI = "sin(angle/2) = sin(start/2) cd(sqrt(g/l) t): Jacobi's functions"
SPIN = (0.037, 8e-4, 3e-4)  # of the tumbling block [rad/ms]
EULER = "Euler's equations by DOP853 to 1e-12"
OBLIQUE = (2.3, 1.1, 0.6, 0.22)  # speed along and towards the plane [mm/ms], restitution, friction
TOP, BASE, SPEED, MU = 12.0, 34.0, 0.9, 0.35  # [g], [g], [mm/ms]


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the short ones."""
    short = [_tumbling(), _oblique()]
    return short if quick else [_pendulum(90.0, 10.0), _pendulum(60.0, 4.0), *short, _two_blocks()]


def _pendulum(start: float, seconds: float) -> BenchCase:
    """A bar that is hinged at one end and released at an angle [deg] from the lowest point."""
    hinge = (
        f"[{{sheet: block, at: [{-BAR / 2!r} mm, -40 mm], fix: [x, y, z]}},"
        f" {{sheet: block, at: [{-BAR / 2!r} mm, 40 mm], fix: [x, z]}}]"
    )
    # a turn about y by 90 deg has the bar hang down
    turn = 90.0 - start
    x, z = BAR / 2 * math.cos(math.radians(turn)), -BAR / 2 * math.sin(math.radians(turn))
    sets = (
        "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]",
        f"sheets.block.size=[{BAR!r} mm, 100 mm]",
        f"sheets.block.thickness={THICK!r} mm",
        "sheets.block.mass=1 kg",
        "sheets.block.spin=[0 rad/s, 0 rad/s, 0 rad/s]",
        f"sheets.block.center=[{x!r} mm, 0 mm, {z!r} mm]",
        f"sheets.block.rotation=[0 deg, {turn!r} deg, 0 deg]",
        f"supports={hinge}",
        f"run.duration={seconds} s",
        "run.print_step=10 ms",
    )
    name = f"pendulum of 1 m, released at {start:g} deg"
    return row("Rigid bodies", name, Run("verify/flip", sets), Swung(start))


def _tumbling() -> BenchCase:
    spin = ", ".join(f"{1e3 * rate!r} rad/s" for rate in SPIN)
    sets = (f"sheets.block.spin=[{spin}]", "run.duration=400 ms", "run.print_step=0.5 ms")
    return row("Rigid bodies", "block spun about its middle axis", Run("verify/flip", sets), turns_over)


def _oblique() -> BenchCase:
    along, down, restitution, mu = OBLIQUE
    sets = (
        NONE,
        "sheets.block.size=[40 mm, 40 mm]",
        "sheets.block.thickness=0.2 mm",
        "sheets.block.center=[0 mm, 0 mm, 0.2 mm]",
        f"sheets.block.velocity=[{along} m/s, 0 m/s, {-down} m/s]",
        f"contacts.0.restitution={restitution}",
        f"contacts.0.friction={mu}",
        "run.duration=2 ms",
        "run.print_step=0.02 ms",
    )
    return row("Rigid bodies", "thin block thrown at a plane aslant", Run("verify/drop", sets), rebounds)


def _two_blocks() -> BenchCase:
    sunk = (((TOP + BASE) * GRAVITY / 1000) ** (2 / 3), (TOP * GRAVITY / 1000) ** (2 / 3))
    low = 4.0 - sunk[0]
    sheets = (
        f"{{block: {{material: solid, size: [20 mm, 20 mm], thickness: 10 mm, mass: {TOP} g, boxes: [1, 1],"
        f" center: [-100 mm, 0 mm, {low + 9.0 - sunk[1]!r} mm], velocity: [{SPEED} m/s, 0 m/s, 0 m/s]}},"
        f" base: {{material: solid, size: [300 mm, 60 mm], thickness: 8 mm, mass: {BASE} g, boxes: [1, 1],"
        f" center: [0 mm, 0 mm, {low!r} mm]}}}}"
    )
    contacts = (
        f"[{{between: [block, base], stiffness: 1000 N/mm^1.5, restitution: 0.3, friction: {MU}}},"
        " {between: [base, floor], stiffness: 1000 N/mm^1.5, restitution: 0.3, friction: 0,"
        " smoothing: 1 mm/s}]"
    )
    sets = (f"sheets={sheets}", f"contacts={contacts}", "run.duration=240 ms")
    return row("Rigid bodies", "block on a block that lies on ice", Run("verify/slide", sets), slides)


@dataclass(frozen=True)
class Swung:
    """Place at the end of the point of the bar that is 1 m from its hinge."""

    start: float  # [deg]

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        found = result.position[-1, 0] * (1000.0 / (0.5 * BAR))
        time = float(result.time[-1])
        angle = rigid.pendulum(time, 1000.0, GRAVITY, math.radians(self.start))
        exact, source = (1000.0 * math.sin(angle), -1000.0 * math.cos(angle)), JACOBI
        if self.start == 90.0:
            assert time == 1e4 and math.dist(exact, A01) < 1e-5, "the published digits"
            exact, source = A01, f"{MULTIBODY}; {JACOBI}"
        basis = Basis(source, "a thousandth of the length, as run.tolerance asks of positions")
        return [
            against(f"{axis} after {time / 1e3:g} s", want, float(got), 1e-3, "mm", basis, 1000.0)
            for axis, want, got in zip("xz", exact, found[[0, 2]], strict=True)
        ]


def turns_over(result: Result, _: Result | None) -> list[Finding]:
    """When the block has first turned over: its spin about the middle axis, in its own axes, is none."""
    own = np.einsum("tji,tj->ti", turns(result.rotation[:, 0]), result.spin[:, 0])
    inertia, start = result.model.bodies.inertia[0], np.array(SPIN)
    lengths = np.array([40.0, 60.0, 10.0]) ** 2
    exact_inertia = 20.0 / 12 * (lengths.sum() - lengths)
    assert np.allclose(inertia, exact_inertia), "a cuboid's"
    exact = rigid.tumble(exact_inertia, start, result.time)
    because = "interpolation between outputs of 0.5 ms, and a step's error that grows along the turn"
    expected = _crossing(result.time, exact[:, 0])
    basis = Basis(EULER, because)
    middle = "spin about the middle axis at the end"
    return [
        against("first turn-over", expected, _crossing(result.time, own[:, 0]), 2e-3, "ms", basis),
        against(middle, exact[-1, 0] * 1e3, own[-1, 0] * 1e3, 5e-3, "rad/s", basis),
    ]


def _crossing(time: np.ndarray, values: np.ndarray) -> float:
    at = int(np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))[0])
    return float(time[at] + values[at] / (values[at] - values[at + 1]) * (time[at + 1] - time[at]))


def rebounds(result: Result, _: Result | None) -> list[Finding]:
    """The block slides on through the impact: friction takes mu times what the plane gives."""
    along, down, restitution, mu = OBLIQUE
    smoothing = float(result.model.contacts.smoothing[0])
    up = impact.restitution(restitution, smoothing / down) * down
    vx, vz = float(result.velocity[-1, 0, 0]), float(result.velocity[-1, 0, 2])
    because = "the restitution is promised to 0.1 %; that friction turns the thin block counts less"
    taken = mu * (up + down)
    sharp = Basis("e = c_R for a sharp sign (quadrature)", because)
    coulomb = Basis("mu (1 + e) v: Coulomb's impulse while it slides", because)
    return [
        against("speed away", up, vz, 2e-3, "m/s", sharp),
        against("speed lost along", taken, along - vx, 2e-3, "m/s", coulomb),
    ]


def slides(result: Result, _: Result | None) -> list[Finding]:
    """Way of the block over the other, and the speed that both end with."""
    way, speed = rigid.slid_apart(SPEED, MU, GRAVITY, TOP, BASE)
    names = result.model.bodies.name
    top, base = names.index("block_0_0"), names.index("base_0_0")
    moved = (result.position[-1] - result.model.bodies.position)[:, 0]
    because = "friction over a smoothing of 1 mm/s, and the base's way to rest on its table"
    rubbed, kept = Basis("v^2/(2 mu g (1 + m/M))", because), Basis("momentum: v m/(m + M)", because)
    ends = [float(result.velocity[-1, body, 0]) for body in (top, base)]
    return [
        against("way over the other", way, float(moved[top] - moved[base]), 5e-3, "mm", rubbed),
        against("speed of the block at the end", speed, ends[0], 2e-3, "m/s", kept),
        against("speed of the base at the end", speed, ends[1], 2e-3, "m/s", kept),
    ]
