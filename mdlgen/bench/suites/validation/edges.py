"""Flexible sheets that meet a plate: dropped flat onto it, hung over its edge, and against its end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import impact, overhang
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.events import events
from mdlgen.results.result import Result

GRAVITY, STIFFNESS, SMOOTHING = 9.81e-3, 100.0, 1e-3  # [mm/ms^2], [N/mm^1.5], [mm/ms]
MASS, THICK = 0.72, 0.1  # of the note [g], [mm]
NOTE = "{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.24 N*mm}"
DROPS = ((1.0, 0.5), (3.0, 0.5), (10.0, 0.5), (3.0, 0.2), (3.0, 0.8))  # height [mm], restitution
OUT = ((40.0, 200.0), (60.0, 200.0), (80.0, 200.0), (110.0, 300.0))  # beyond the edge, length [mm]
WIDTH, AREAL, BENDING = 20.0, 80e-6, 0.4  # [mm], [g/mm^2], [N mm]
# Depth of the leading lower corner below the face [mm], friction, radius of the end [mm].
ENDS = (
    (0.2, 0.3, 0.5),
    (0.7, 0.3, 0.5),
    (0.2, 0.6, 0.5),
    (0.2, 0.1, 0.02),
    (0.5, 0.6, 0.02),
    (0.9, 0.1, 0.02),
)


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the short ones."""
    if quick:
        return [_drop(1.0, 0.5), _end(0.7, 0.3, 0.5)]
    return [*(_drop(*drop) for drop in DROPS), *(_hangs(*out) for out in OUT), *(_end(*end) for end in ENDS)]


def _drop(height: float, restitution: float) -> BenchCase:
    fall = math.sqrt(2.0 * height / GRAVITY)
    # a fiftieth of the rebound is a small part of a note of 144 mm, which the tolerance is of
    tolerance = min(1e-3, max(1e-4, 0.02 * height * restitution**2 / 144.0))
    note = (
        f"{{material: note, size: [67 mm, 127 mm], thickness: {THICK} mm, mass: {MASS} g, boxes: [3, 5],"
        f" layout: plate, center: [0 mm, 0 mm, {height + THICK / 2!r} mm]}}"
    )
    sets = (
        f"materials.note={NOTE}",
        f"sheets={{note: {note}}}",
        f"contacts=[{{between: [note, floor], stiffness: {STIFFNESS} N/mm^1.5, restitution: {restitution},"
        " friction: 0.3}]",
        f"run.duration={fall * (1.0 + 1.7 * restitution) + 0.5!r} ms",
        f"run.tolerance={tolerance:.2g}",
        "run.print_step=0.05 ms",
    )
    name = f"note dropped flat from {height:g} mm, c_R {restitution:g}"
    return row("Sheets on plates", name, Run("verify/slide", sets), Rebound(height, restitution))


def _hangs(out: float, length: float) -> BenchCase:
    strip = (
        f"{{material: note, size: [{length} mm, {WIDTH} mm], thickness: {THICK} mm,"
        f" mass: {AREAL * length * WIDTH!r} g, boxes: [{round(length / 5)}, 1], layout: plate,"
        f" center: [{out - length / 2!r} mm, 0 mm, {THICK / 2} mm]}}"
    )
    table = "{center: [-150 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm], mass: 100 g}"
    sets = (
        f"materials.note={NOTE}",
        f"materials.note.D_md={BENDING} N*mm",
        f"sheets={{strip: {strip}}}",
        f"planes={{table: {table}}}",
        f"contacts=[{{between: [strip, table], stiffness: {STIFFNESS} N/mm^1.5, friction: 0.5}}]",
        "run={analysis: static}",
        "probes={tip: {sheet: strip, edge: x_max}}",
    )
    name = f"strip of {length:g} mm that hangs over a table's edge by {out:g} mm"
    return row("Sheets on plates", name, Run("verify/slide", sets), Sag(out, length))


def _end(below: float, friction: float, radius: float) -> BenchCase:
    note = (
        "{material: note, size: [67 mm, 60 mm], thickness: 0.1 mm, mass: 0.3216 g, boxes: [20, 6],"
        " center: [-35.5 mm, 0 mm, 0 mm], velocity: [1.4 m/s, 0 m/s, 0 m/s]}"
    )
    motor = (
        "{center: [-10 mm, 0 mm, -7.504 mm], axis: y, radius: 7.5 mm, width: 50 mm, mass: 10 g,"
        " drive: {speed: 186.667 rad/s}}"
    )
    idler = (
        "{center: [-10 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, width: 50 mm, mass: 5 g,"
        " press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}"
    )
    z = round(below - THICK / 2, 9)
    guide = (
        f"{{line: {{from: [0 mm, 0 mm, {z} mm], to: [200 mm, 0 mm, {z} mm], axis: -y, side: left}},"
        f" width: 300 mm, thickness: 1 mm, edge_radius: {radius} mm}}"
    )
    nip = "friction: 0.8, smoothing: 20 mm/s"
    contacts = (
        f"{{between: [note, motor], stiffness: 300 N/mm^1.5, {nip}}}",
        f"{{between: [note, idler], stiffness: 300 N/mm^1.5, {nip}}}",
        "{between: [motor, idler], stiffness: 30 N/mm^1.5, friction: 0.5, smoothing: 20 mm/s}",
        f"{{between: [note, guide], stiffness: 100 N/mm^1.5, friction: {friction}, smoothing: 20 mm/s}}",
    )
    sets = (
        f"materials.note={NOTE}",
        f"sheets={{note: {note}}}",
        f"rollers={{motor: {motor}, idler: {idler}}}",
        "planes={}",
        f"guides={{guide: {guide}}}",
        f"contacts=[{', '.join(contacts)}]",
        "run.duration=5 ms",
    )
    name = f"leading edge {below:g} mm below a guide's face, mu {friction:g}, edge radius {radius:g} mm"
    return row("Sheets on plates", name, Run("verify/slide", sets), Met(below, friction, radius))


@dataclass(frozen=True)
class Rebound:
    """Height to which a note rises that falls flat: each box is a ball of its own mass."""

    height: float  # [mm]
    restitution: float

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        count = result.model.sheets[0].count
        mass = MASS / count
        speed = math.sqrt(2.0 * GRAVITY * self.height)
        hit = impact.impact(mass, STIFFNESS, speed, self.restitution, SMOOTHING)
        # its weight works on over the depth on the way in and out
        sunk = 2.0 * GRAVITY * hit.depth
        up = math.sqrt(hit.restitution**2 * (speed**2 + sunk) - sunk)
        z = result.position[:, :count, 2].mean(axis=1) - THICK / 2
        lowest = int(z[: int(np.searchsorted(result.time, speed / GRAVITY + 2 * hit.time))].argmin())
        basis = Basis(
            "v0^2 e^2/(2 g), e of Eq. 11 (quadrature), with the weight over the greatest depth",
            "an impact of a flexible note has some 50 steps; its boxes may leave a step apart",
        )
        return [
            against(
                "height of the first rebound", up**2 / (2.0 * GRAVITY), z[lowest:].max(), 0.02, "mm", basis
            )
        ]


@dataclass(frozen=True)
class Sag:
    """How far the end of a strip hangs below the table that it lies on."""

    out: float  # [mm]
    length: float  # [mm]

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        # the round of the edge is touched a radius before the end of the plate
        beyond = self.out + result.model.planes[0].edges[0]
        exact = overhang.overhang(AREAL * WIDTH * GRAVITY, BENDING * WIDTH, self.length, beyond)
        tip = result.anchor_motion(0)[0][-1]
        basis = Basis(
            "the heavy elastica from where the strip leaves the table (boundary value problem)",
            "boxes of 5 mm",
        )
        return [against("sag of the end", exact.sag, THICK / 2 - float(tip[2]), 0.02, "mm", basis)]


@dataclass(frozen=True)
class Met:
    """Checks if a leading edge stubs: it climbs a round up to a depth of r (1 - cos(90 deg - atan mu))."""

    below: float  # [mm]
    friction: float
    radius: float  # [mm]

    def __call__(self, result: Result, _: Result | None) -> list[Finding]:
        climbs = self.below < self.radius * (1.0 - math.cos(math.pi / 2 - math.atan(self.friction)))
        stubs = [event for event in events(result) if event["kind"] == "stub"]
        basis = Basis(
            "a wedge with Coulomb friction: it climbs where h < r (1 - cos(90 deg - atan mu))",
            "it does or does not",
        )
        return [
            against("stubs, 1, or climbs, 0", 0.0 if climbs else 1.0, float(bool(stubs)), 0.0, "", basis, 1.0)
        ]
