"""Belts and webs: a band brake on a roller, a block in a hollow guide, a web between two nips."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import belt
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.model.rotations import turns
from mdlgen.results.result import Result

SAMPLE = "verify/slide"
NONE = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
# A band that lies on a roller, in the shape of its arc, so that nothing has to come to rest.
RADIUS, BAND, WIDE, BOXES = 20.0, 0.1, 12.0, 24  # [mm], [mm], [mm]
ENDS = 4  # boxes at either end that are left out, where clamp and load act
WRAPS = ((90.0, 0.25), (150.0, 0.35))  # [deg], friction
PULL = 0.3  # [N]
CAPSTAN = "Euler's capstan e^(mu phi R/r), r to the middle of the band, with n boxes for the arc"
# A block that slides through a hollow.
HOLLOW, BEAD, RUB = 30.0, 2.5, 0.2  # [mm], [mm/ms], friction
# A web between two nips.
SPAN, WEB, FIRST, DRAW = 60.0, 20.0, 0.5, 2e-3  # [mm], width [mm], speed [mm/ms], relative
FINER = 1
MODULUS, THICK, GRIP, NIP, SMOOTH = 1000.0, 0.1, 1.0, 3.0, 1e-4  # [MPa], [mm], friction, [N], [mm/ms]
ROUND = 8.0  # of the rollers [mm]
# Nips 46 and 2 um deep.
HARDNESS = (3e2, 3e4)  # [N/mm^1.5]


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the shortest."""
    brakes = [_brake(angle, mu) for angle, mu in WRAPS]
    return brakes[:1] if quick else [*brakes, _hollow(), *map(_web, HARDNESS)]


def _brake(degrees: float, mu: float) -> BenchCase:
    middle, angle = RADIUS + BAND / 2, math.radians(degrees)
    # a polygon whose links touch the drum with their middles; the clamp is at a corner, on top of it
    link = 0.5 * angle / BOXES
    length, top = BOXES * 2 * middle * math.tan(link), middle / math.cos(link)
    force = f"[{PULL * math.cos(angle)!r} N, 0 N, {-PULL * math.sin(angle)!r} N]"
    sheet = (
        f"{{band: {{material: p, size: [{length!r} mm, {WIDE} mm], thickness: {BAND} mm, mass: 30 mg,"
        f" boxes: [{BOXES}, 1], layout: plate, clamp: {{edge: x_min}},"
        f" center: [{length / 2!r} mm, 0 mm, {top!r} mm],"
        f" shape: {{curl: {{radius: {-length / angle!r} mm, along: x}}}}}}}}"
    )
    roller = (
        f"{{drum: {{center: [0 mm, 0 mm, 0 mm], axis: y, radius: {RADIUS} mm, width: 30 mm, mass: 50 g,"
        " drive: {speed: 50 rad/s}}}"
    )
    sets = (
        NONE,
        "materials={p: {E_md: 1500 MPa, E_cd: 1500 MPa, D_md: 0.01 N*mm, D_cd: 0.01 N*mm,"
        " damping: {ratio: 0.3}}}",
        *(f"sheets={sheet}", "planes={}", f"rollers={roller}"),
        f"contacts=[{{between: [band, drum], stiffness: 200 N/mm^1.5, friction: {mu}, smoothing: 5 mm/s}}]",
        f"loads=[{{sheet: band, edge: x_max, force: {force}}}]",
        *("run.duration=20 ms", "run.print_step=0.1 ms", "run.margin=20 mm"),
    )
    return row(
        "Belts and webs",
        f"band brake round {degrees:g} deg, mu {mu:g}",
        Run(SAMPLE, sets),
        Brake(degrees, mu),
    )


def _hollow() -> BenchCase:
    """A small block that slides through a hollow arc, from 110 deg before its lowest point on."""
    sheets = (
        "{bead: {material: solid, size: [0.6 mm, 0.6 mm], thickness: 0.4 mm, mass: 2 g, boxes: [1, 1],"
        f" center: [0 mm, 0 mm, 0.2014 mm], velocity: [{BEAD} m/s, 0 m/s, 0 m/s]}}}}"
    )
    arc = (
        f"{{way: {{arc: {{center: [0 mm, 0 mm, {HOLLOW} mm], axis: -y, radius: {HOLLOW} mm, from: -120 deg,"
        " to: 30 deg, side: inside}, width: 6 mm}}"
    )
    contact = "stiffness: 1e4 N/mm^1.5, restitution: 0"
    sets = (
        *(NONE, f"sheets={sheets}", "planes={}", f"guides={arc}"),
        f"contacts=[{{between: [bead, way], {contact}, friction: {RUB}, smoothing: 1 mm/s}}]",
        *("run.duration=22 ms", "run.print_step=0.1 ms", "run.tolerance=2e-4"),
    )
    return row("Belts and webs", f"block through a hollow, mu {RUB:g}", Run(SAMPLE, sets), follows)


def _web(hardness: float) -> BenchCase:
    """Two driven nips of driven rollers, the second one a little faster."""
    radius, step = ROUND, 0.05 if hardness < 1e4 else 0.01  # a hard one chatters as the web enters
    sheet = (
        f"{{web: {{material: p, size: [140 mm, {WEB} mm], thickness: {THICK} mm, mass: 0.25 g,"
        f" boxes: [{28 * FINER}, 1], layout: plate, center: [-20 mm, 0 mm, 0 mm],"
        f" velocity: [{FIRST} m/s, 0 m/s, 0 m/s]}}}}"
    )
    rollers = []
    for name, x, speed in (("in", -SPAN / 2, FIRST), ("out", SPAN / 2, FIRST * (1 + DRAW))):
        shape = f"axis: y, radius: {radius} mm, width: {WEB + 10} mm, mass: 10 g"
        press = f"press: {{direction: -z, stiffness: 0.2 N/mm, preload: {NIP} N}}"
        turn = 1e3 * speed / radius
        for side, place, more in (("low", -1, ""), ("top", 1, f", {press}")):
            center = f"[{x!r} mm, 0 mm, {place * (radius + THICK / 2)!r} mm]"
            drive = f"drive: {{speed: {-place * turn!r} rad/s}}"
            rollers.append(f"{side}_{name}: {{center: {center}, {shape}, {drive}{more}}}")
    contact = f"stiffness: {hardness} N/mm^1.5, friction: {GRIP}, smoothing: {1e3 * SMOOTH} mm/s"
    pairs = [
        f"{{between: [low_{n}, top_{n}], stiffness: 30 N/mm^1.5, friction: 0, smoothing: 1 mm/s}}"
        for n in ("in", "out")
    ]
    sets = (
        NONE,
        f"materials={{p: {{E_md: {MODULUS} MPa, E_cd: {MODULUS} MPa, D_md: 0.1 N*mm, D_cd: 0.1 N*mm}}}}",
        *(f"sheets={sheet}", "planes={}", f"rollers={{{', '.join(rollers)}}}"),
        f"contacts=[{{between: [web, '*'], {contact}}}, {', '.join(pairs)}]",
        *("run.duration=60 ms", "run.print_step=0.25 ms", "run.margin=20 mm", f"run.step={step} ms"),
    )
    name = f"web that is drawn between two nips of {hardness:g} N/mm^1.5"
    return row("Belts and webs", name, Run(SAMPLE, sets), draws)


def follows(result: Result, _: Result | None) -> list[Finding]:
    """Speed after an angle: the wall pushes with m v^2/r, its friction acts at the radius R."""
    place = result.position[:, 0] - [0.0, 0.0, HOLLOW]
    angle = np.unwrap(np.arctan2(place[:, 0], -place[:, 2]))
    speed = np.linalg.norm(result.velocity[:, 0], axis=1)
    begun, end = (int(np.searchsorted(angle, at)) for at in (0.1, 1.3))
    middle = float(np.linalg.norm(place[begun:end, [0, 2]], axis=1).mean())
    expected = math.exp(-RUB * float(angle[end] - angle[begun]) * HOLLOW / middle)
    basis = Basis(
        "v = v0 e^(-mu phi R/r), r to the block's middle", "that the block turns with its way, and its rattle"
    )
    return [against("speed out / in", expected, float(speed[end] / speed[begun]), 1e-3, "", basis)]


def draws(result: Result, _: Result | None) -> list[Finding]:
    """Tension of the web over the last 10 ms, in which one box after the other passes each nip."""
    late = result.time >= result.time[-1] - 10.0
    bodies = result.model.bodies
    size = 2.0 * float(bodies.half[0, 0])
    x = result.position[late][:, : 28 * FINER, 0]
    moved, between = np.diff(x, axis=1), 0.5 * (x[:, 1:] + x[:, :-1])
    inside = np.abs(between) < SPAN / 2 - size
    found = MODULUS * WEB * THICK * float((moved[inside] / size - 1.0).mean())
    # a nip holds the web all along what it presses on, sqrt(2 R z) before and behind its contact line
    depth = (NIP / float(result.model.contacts.stiffness[0])) ** (2 / 3)
    free = SPAN - 2.0 * math.sqrt(2.0 * ROUND * depth)
    strain = belt.web(result.time[late], free, FIRST, DRAW, MODULUS * WEB * THICK, 2 * GRIP * NIP, SMOOTH)
    basis = Basis(
        "L de/dt = v2 - v1 (1 + e), less the creep of both nips (Shelton 1986; solve_ivp); L between the"
        " places that they press on",
        "12 boxes stand between the nips: the tension goes in steps of their part as one passes",
    )
    return [against("tension", MODULUS * WEB * THICK * float(strain.mean()), found, 2e-2, "N", basis)]


@dataclass(frozen=True)
class Brake:
    """Tension near the clamp over that near the free end, from how far the joints there are open."""

    degrees: float
    mu: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        angle = math.radians(self.degrees) * (BOXES - 2 * ENDS) / BOXES
        expected = belt.polygon(self.mu * RADIUS / (RADIUS + BAND / 2), angle, BOXES - 2 * ENDS)
        found = _open(result, ENDS) / _open(result, BOXES - ENDS)
        basis = Basis(CAPSTAN, "the band's bending where it lies on the drum, a hundredth of the tension")
        return [against("ratio of tensions", expected, found, 5e-3, "", basis)]


def _open(result: Result, joint: int) -> float:
    """How far the joint before box `joint` is open at the end of the run [mm]."""
    half = result.model.bodies.half[:, 0]
    turned = turns(result.rotation[-1, [joint - 1, joint]])
    left = result.position[-1, joint - 1] + turned[0, :, 0] * half[joint - 1]
    right = result.position[-1, joint] - turned[1, :, 0] * half[joint]
    along = turned[:, :, 0].mean(axis=0)
    return float((right - left) @ along / np.linalg.norm(along))
