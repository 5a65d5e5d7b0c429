"""Rungs of a rigid block: steps, friction and restitution at their ends, overlap, rest, rotated worlds."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import impact as oracle
from mdlgen.bench.suites.friction import slid
from mdlgen.bench.suites.impact import HALF, MASS, STIFFNESS, thrown
from mdlgen.bench.suites.ladder import FORCED, STEPS, lasting, rung, within
from mdlgen.model.grid import rotation_matrix
from mdlgen.results.compare import scale
from mdlgen.results.result import Result

MU = (0.0, 0.3, 5.0)
# With c_R = 0 a block leaves below the smoothing speed: a small one would take long.
RESTITUTIONS = ((0.0, 0.1), (1.0, 1e-3))  # and the smoothing speed [mm/ms]
OVERLAPS = (0.1, 1.0, 10.0)  # over the thickness
MASSES = (1e-3, 1.0, 1e3)  # [g]: a ratio of 1e6 in one plane's contact
SLID, BOUNCED, THROWN_OUT = 5e-3, 5e-3, 5e-3
NO_GRAVITY = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
WORLD = (30.0, 40.0, 50.0)  # about x, then y, then z [deg]
REST = 60e3  # [ms]


def rungs() -> list[BenchCase]:
    """All of them."""
    return [*_sliding(), *_bouncing(), *_overlap(), *_rest()]


def _sliding() -> list[BenchCase]:
    steps = [
        rung(
            f"step {step * 1e-3:g} s: sliding block",
            Run("verify/slide", within(step, 600), step),
            slides,
        )
        for step in STEPS
    ]
    # so flat that friction does not tip it over, up to mu = 20
    flat = ("sheets.block.thickness=1 mm", "sheets.block.center=[-400 mm, 0 mm, 0.4979 mm]")
    ends = [
        rung(f"mu {mu:g}: sliding block", Run("verify/slide", (*flat, f"contacts.0.friction={mu}")), slides)
        for mu in MU
    ]
    return [*steps, *ends]


def _bouncing() -> list[BenchCase]:
    ends = [rung(f"c_R {c:g}: impact", thrown(1.0, c, smooth), bounces) for c, smooth in RESTITUTIONS]
    elastic = thrown(1.0, 1.0)
    whole = 1.5 * oracle.impact(MASS, STIFFNESS, 1.0, 1.0, 1e-3).time
    steps = [
        rung(
            f"step {step * 1e-3:g} s: elastic impact",
            Run("verify/drop", (*elastic.overrides[:5], *within(step, whole)), step),
            keeps_energy,
        )
        for step in STEPS
    ]
    masses = []
    for mass in MASSES:
        lasts = oracle.impact(mass, STIFFNESS, 1.0, 0.5, 1e-3).time + 0.1
        sets = (
            *thrown(1.0, 0.5).overrides[:5],
            f"sheets.block.mass={mass!r} g",
            "sheets.block.center=[0 mm, 0 mm, 5.05 mm]",
            *lasting(2 * lasts),
        )
        masses.append(rung(f"mass {mass:g} g: impact", Run("verify/drop", sets), bounces))
    return [*ends, *masses, *steps, _turned()]


def _turned() -> BenchCase:
    """The drop in a world that is rotated with its gravity."""
    a, b, c = (math.radians(angle) for angle in WORLD)
    turn = rotation_matrix((a, b, c))

    def vector(local: tuple[float, float, float], unit: str) -> str:
        return "[" + ", ".join(f"{v!r} {unit}" for v in (turn @ local).tolist()) + "]"

    sets = (
        f"gravity={vector((0, 0, -9.81), 'm/s^2')}",
        f"sheets.block.center={vector((0, 0, 55), 'mm')}",
        f"sheets.block.rotation=[{WORLD[0]} deg, {WORLD[1]} deg, {WORLD[2]} deg]",
        f"planes.floor.center={vector((0, 0, -5), 'mm')}",
        f"planes.floor.normal={(turn @ [0.0, 0.0, 1.0]).tolist()!r}",
        "contacts.0.restitution=1",
        "contacts.0.friction=0",
        "run.duration=200 ms",
    )
    return rung("world rotated: dropped block", Run("verify/drop", sets), keeps_energy)


def _overlap() -> list[BenchCase]:
    made = []
    for boxes, name in (((1, 1), "rigid note"), ((4, 6), "flexible note")):
        for part in OVERLAPS:
            thickness = 0.1
            depth = part * thickness
            sets = (
                NO_GRAVITY,
                f"sheets.block.boxes=[{boxes[0]},{boxes[1]}]",
                f"sheets.block.thickness={thickness} mm",
                "sheets.block.mass=0.1 g",
                f"sheets.block.center=[0 mm, 0 mm, {thickness / 2 - depth!r} mm]",
                "contacts.0.stiffness=100 N/mm^1.5",
                "contacts.0.restitution=0.5",
                *lasting(5.0),
                "run.prune=false",
            )
            made.append(
                rung(
                    f"overlap {part:g} thicknesses: {name}", Run("verify/drop", sets), thrown_out, limit=60.0
                )
            )
    return made


def _rest() -> list[BenchCase]:
    """A note at rest on a plane, for a minute."""
    weight, stiffness, boxes = 0.1 * 9.81e-3, 100.0, 24
    depth = (weight / boxes / stiffness) ** (2 / 3)
    sets = (
        "sheets.block.boxes=[4,6]",
        "sheets.block.thickness=0.1 mm",
        "sheets.block.mass=0.1 g",
        f"sheets.block.center=[0 mm, 0 mm, {0.05 - depth!r} mm]",
        f"contacts.0.stiffness={stiffness} N/mm^1.5",
        *lasting(REST),
    )
    return [rung("note at rest for 60 s", Run("verify/drop", sets), rests, limit=60.0)]


def slides(result: Result, _: Result | None) -> list[Finding]:
    """Way against the closed form, over max(way, block length / 10)."""
    exact, found = slid(result)
    tolerance = SLID if result.model.run.step is None else FORCED
    error = abs(found - exact) / scale(result)
    return [Finding("way, relative", error, tolerance, {"exact_mm": exact, "found_mm": found})]


def bounces(result: Result, _: Result | None) -> list[Finding]:
    """Rebound speed over that of the impact against the quadrature."""
    model = result.model
    speed = -float(model.bodies.velocity[0, 2])
    smoothing = float(model.contacts.smoothing[0]) / speed
    exact = oracle.restitution(float(model.contacts.restitution[0]), smoothing)
    found = float(result.velocity[-1, 0, 2]) / speed
    details = {"exact": exact, "found": found}
    return [Finding("restitution", abs(found - exact), BOUNCED, details)]


def keeps_energy(result: Result, _: Result | None) -> list[Finding]:
    """An elastic impact: at every stored time the block has the energy that it started with,
    m g z + m v^2/2 + (2/5) k depth^2.5, z over where it touches."""
    model = result.model
    plane = model.planes[0]
    face = plane.center + 0.5 * plane.size[2] * plane.normal
    height = (result.position[:, 0] - face) @ plane.normal - HALF
    gravity, mass = float(np.linalg.norm(model.gravity)), float(model.bodies.mass[0])
    squeezed = 0.4 * float(model.contacts.stiffness[0]) * np.maximum(-height, 0.0) ** 2.5 / mass
    total = gravity * height + 0.5 * np.sum(result.velocity[:, 0] ** 2, axis=1) + squeezed
    tolerance = SLID if model.run.step is None else FORCED
    error = float(np.abs(total / total[0] - 1).max())
    return [Finding("energy, greatest change over its start", error, tolerance)]


def thrown_out(result: Result, _: Result | None) -> list[Finding]:
    """Speed with which every box leaves the plane in which it started, against the quadrature."""
    model = result.model
    count = model.sheets[0].count
    depth = float(model.sheets[0].thickness / 2 - model.bodies.position[0, 2])
    into = 0.4 * float(model.contacts.stiffness[0]) * depth**2.5 / float(model.bodies.mass[0])
    exact = oracle.rebound(
        into, oracle.share(float(model.contacts.restitution[0])), float(model.contacts.smoothing[0])
    )
    gap = result.velocity[-1, :count] - [0.0, 0.0, exact]
    error = float(np.linalg.norm(gap, axis=1).max()) / exact
    return [Finding("speed of every box, relative", error, THROWN_OUT, {"exact_m_per_s": exact})]


def rests(result: Result, _: Result | None) -> list[Finding]:
    """Greatest way of any box from where it lay, over its penetration in equilibrium."""
    model = result.model
    boxes = model.sheets[0].count
    depth = float(model.sheets[0].thickness / 2 - model.bodies.position[0, 2])
    moved = np.linalg.norm(result.position[:, :boxes] - model.bodies.position[:boxes], axis=2)
    return [Finding("way of any box over its penetration", float(moved.max()) / depth, 1e-2)]
