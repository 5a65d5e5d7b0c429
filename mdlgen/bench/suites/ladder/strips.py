"""Rungs of a flexible strip alone: steps, membrane, bending, a note round a roller, rotated worlds."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Reference, Run
from mdlgen.bench.oracles import chain
from mdlgen.bench.oracles.impact import share
from mdlgen.bench.suites.ladder import FORCED, STEPS, rung, within
from mdlgen.model.grid import rotation_matrix
from mdlgen.results.compare import compare, scale
from mdlgen.results.result import Result

STRIP = ("sheets.note.boxes=[2,20]",)
SWING = (*STRIP, "run.analysis=transient", "run.duration=30 ms")
FALL = ("sheets.note.clamp=null", "sheets.note.boxes=[4,6]", "run.analysis=transient")
MEMBRANE = (1.0, 1e2, 1e4, 1e6)
BENDING = (1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3)
E_MD, E_CD, D_MD, D_CD = 3530.0, 1113.0, 0.40, 0.242  # of the sample [MPa], [N mm]
WORLD = (30.0, 40.0, 50.0)  # about x, then y, then z [deg]
# Static: of the drop; the bushings give by less than 1e-4 of it where the ideal hinge does not.
STATIC, MOVING = 1e-3, 1e-3
WRAPPED = 2e-2
FINE = 0.00625  # ms


def rungs(reference: str) -> list[BenchCase]:
    """All of them; one is compared with a finer run of the solver `reference`, too."""
    return [*_steps(), *_stiffness(), *_world(), *_wrap(reference)]


def _steps() -> list[BenchCase]:
    return [
        rung(
            f"step {step * 1e-3:g} s: note in free fall",
            Run("cantilever", (*FALL, *within(step, 50)), step),
            fall,
        )
        for step in STEPS
    ]


def _stiffness() -> list[BenchCase]:
    made = []
    for factor in MEMBRANE:
        sets = (f"materials.eur10.E_md={E_MD * factor!r} MPa", f"materials.eur10.E_cd={E_CD * factor!r} MPa")
        made += _both(f"membrane x {factor:g}", sets)
    for factor in BENDING:
        sets = (
            f"materials.eur10.D_md={D_MD * factor!r} N*mm",
            f"materials.eur10.D_cd={D_CD * factor!r} N*mm",
        )
        made += _both(f"bending x {factor:g}", sets)
    return made


def _both(name: str, sets: tuple[str, ...]) -> list[BenchCase]:
    return [
        rung(f"{name}: static", Run("cantilever", (*STRIP, *sets)), hangs),
        rung(f"{name}: swinging", Run("cantilever", (*SWING, *sets)), swings, limit=60.0),
    ]


def _world() -> list[BenchCase]:
    a, b, c = (math.radians(angle) for angle in WORLD)
    x, y, z = (rotation_matrix((a, b, c)) @ [0.0, 0.0, -9.81]).tolist()
    sets = (
        f"gravity=[{x!r} m/s^2, {y!r} m/s^2, {z!r} m/s^2]",
        f"sheets.note.rotation=[{WORLD[0]} deg, {WORLD[1]} deg, {WORLD[2]} deg]",
    )
    return [
        rung("world rotated: static strip", Run("cantilever", (*STRIP, *sets)), hangs),
        rung("world rotated: swinging strip", Run("cantilever", (*SWING, *sets)), swings, limit=60.0),
    ]


def _wrap(reference: str) -> list[BenchCase]:
    """A soft strip, held at its middle on top of a roller, falls round it on both sides."""
    sets = (
        "sheets.note.boxes=[2,40]",
        "sheets.note.clamp=null",
        "materials.eur10.D_cd=0.001 N*mm",
        "rollers={post: {center: [0 mm, 0 mm, -15.05 mm], axis: x, radius: 15 mm, width: 60 mm, mass: 10 g}}",
        "contacts=[{between: [note, post], stiffness: 300 N/mm^1.5, restitution: 0.2, friction: 0,"
        " smoothing: 20 mm/s}]",
        "supports=[{sheet: note, at: [-33.5 mm, 0 mm], fix: [x, y, z]},"
        " {sheet: note, at: [33.5 mm, 0 mm], fix: [y, z]}]",
        "materials.eur10.damping.ratio=1",
        "run.analysis=transient",
        "run.duration=110 ms",
        "run.prune=false",
    )
    exact = Reference(Run("cantilever", sets, FINE), reference)
    return [rung("wrapped 180 deg round a roller", Run("cantilever", sets), wraps, 120.0, exact)]


def fall(result: Result, _: Result | None) -> list[Finding]:
    """Every box falls by g t^2/2, over max(fall, sheet length / 10)."""
    boxes = result.model.sheets[0].count
    moved = result.position[-1, :boxes] - result.model.bodies.position[:boxes]
    exact = 0.5 * result.model.gravity * result.time[-1] ** 2
    return [_worst("fall of every box, relative", moved - exact, scale(result), FORCED)]


def hangs(result: Result, _: Result | None) -> list[Finding]:
    """Every box against the exact chain, over the drop of the last one."""
    model = result.model
    link = chain.chain_of(model)
    exact = chain.centres(model, link, chain.hang(link))
    drop = float(np.linalg.norm(exact[-1] - model.bodies.position[len(exact) - 1]))
    return [_worst("every box, over the drop", result.position[-1, : len(exact)] - exact, drop, STATIC)]


def swings(result: Result, _: Result | None) -> list[Finding]:
    """Every box at every stored time against the exact chain, over max(travel, sheet length / 10)."""
    model = result.model
    link = chain.chain_of(model)
    slopes = chain.swing(link, result.time)
    exact = np.array([chain.centres(model, link, slope) for slope in slopes])
    gap = result.position[:, : exact.shape[1]] - exact
    rms = float(np.sqrt(np.mean(np.sum(gap**2, axis=2))))
    return [Finding("position, RMS over boxes and time, relative", rms / scale(result), MOVING)]


def wraps(result: Result, reference: Result | None) -> list[Finding]:
    """Half of the strip against the exact chain over the roller, and the angle between its two ends.

    The chain's shape is 9e-4 from that of the model at any step, so the step's own error, which a solver's
    estimate is of, is compared with a finer run.
    """
    model = result.model
    sheet, roller, contacts = model.sheets[0], model.rollers[0], model.contacts
    post = chain.Post(
        roller.radius,
        sheet.thickness / 2,
        float(contacts.stiffness[0]),
        share(float(contacts.restitution[0])),
        float(contacts.smoothing[0]),
    )
    half = chain.half_of(model)
    slopes = chain.swing(half, result.time, post)
    path = np.array([half.path(slope) for slope in slopes])
    first = sheet.first + sheet.count // 2
    boxes = result.position[:, first : sheet.first + sheet.count : sheet.n_x]
    gap = boxes[:, :, 1:] - path * (1.0, -1.0)
    rms = float(np.sqrt(np.mean(np.sum(gap**2, axis=2))))
    wrapped = {"angle_deg": 2 * math.degrees(float(slopes[-1, -1]))}
    found = [Finding("shape, RMS over boxes and time, relative", rms / scale(result), WRAPPED, wrapped)]
    if reference is not None:
        own = compare(reference, result).relative
        found.append(Finding("position, RMS over boxes and time, against a finer run", own, MOVING))
    return found


def _worst(quantity: str, gap: np.ndarray, length: float, tolerance: float) -> Finding:
    return Finding(quantity, float(np.linalg.norm(gap, axis=1).max()) / length, tolerance)
