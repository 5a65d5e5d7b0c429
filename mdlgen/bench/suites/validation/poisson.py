"""Poisson's effect of plates: bent across and held across, and pulled."""

from __future__ import annotations

from functools import partial

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.oracles import plate
from mdlgen.bench.suites.validation.rows import Basis, against, row
from mdlgen.results.result import Result
from mdlgen.results.strain import histories, sheet_joints

SAMPLE = "verify/rollup"
# Isotropic: of a strip D = E s^3/12, of the plate 1/(1 - nu^2) times that.
MODULUS, RATIO, THICK = 2000.0, 0.3, 1.0
STRIP = MODULUS * THICK**3 / 12
WHOLE = STRIP / (1 - RATIO**2)
PLATE = (WHOLE, WHOLE, RATIO * WHOLE, STRIP / (2 * (1 + RATIO)))
SIZE, GRID = (120.0, 80.0), (24, 16)
# The outer half of boxes at a loaded edge does not curve across: far from both ends is where it is measured.
LONG = (240.0, 80.0)
SMALL = 1e-3  # of the thickness is about what a plate is bent by: more stretches it
BOX = (SIZE[0] / GRID[0] / 2, SIZE[1] / GRID[1] / 2)  # centre of a box next to the middle [mm]
MASS, GRAVITY = 100.0, 1e-4  # [g], [m/s^2]: a pressure that bends it by so little
NAVIER = "Navier, all edges simply supported (Timoshenko, Woinowsky-Krieger, section 28)"
RITZ = "Ritz: polynomials for the energy of an orthotropic plate (Timoshenko, Woinowsky-Krieger)"
SADDLE = "kappa_y = -nu kappa_x, M = D kappa_x: pure bending (Timoshenko, Woinowsky-Krieger, section 10)"
PULLED = "eps_y = -nu eps_x, N = E s eps_x"


def cases(quick: bool) -> list[BenchCase]:
    """All rows, or the one that exudyn takes least time for."""
    shapes = {"narrow": (120.0, 10.0), "wide": (60.0, 240.0)}
    held = [_cantilever(name, size) for name, size in shapes.items()]
    return [_free("pulled")] if quick else [_supported(), *held, _free("bent"), _free("pulled")]


def _material() -> str:
    shear = MODULUS / (2 * (1 + RATIO))
    return (
        f"materials={{p: {{E_md: {MODULUS} MPa, E_cd: {MODULUS} MPa, G: {shear!r} MPa, D_md: {STRIP!r} N*mm,"
        f" D_cd: {STRIP!r} N*mm, D_twist: {PLATE[3]!r} N*mm, poisson: {RATIO}}}}}"
    )


def _sheet(size: tuple[float, float], more: str = "", mass: float = 1.0) -> str:
    return (
        f"sheets={{n: {{material: p, size: [{size[0]} mm, {size[1]} mm], thickness: {THICK} mm,"
        f" mass: {mass} g, boxes: [{GRID[0]}, {GRID[1]}], layout: plate{more}}}}}"
    )


def _at(x: float, y: float, fix: str) -> str:
    return f"{{sheet: n, at: [{x!r} mm, {y!r} mm], fix: [{fix}]}}"


def _supported() -> BenchCase:
    (a, b), (n_x, n_y) = SIZE, GRID
    places = [((i + 0.5) * a / n_x - a / 2, side * b / 2) for i in range(n_x) for side in (-1, 1)]
    places += [(side * a / 2, (j + 0.5) * b / n_y - b / 2) for j in range(n_y) for side in (-1, 1)]
    held = [_at(x, y, "z") for x, y in places] + [_at(0.0, 0.0, "x, y"), _at(a / 4, 0.0, "y")]
    run = Run(
        SAMPLE,
        (
            *(_material(), _sheet(SIZE, mass=MASS), f"supports=[{', '.join(held)}]", "loads=[]"),
            f"gravity=[0 m/s^2, 0 m/s^2, -{GRAVITY} m/s^2]",
            f"probes={{box: {{sheet: n, at: [{BOX[0]} mm, {BOX[1]} mm]}}}}",
        ),
    )
    return row("Poisson's effect", "plate with supported edges, 24 x 16 boxes", run, sags)


def _cantilever(name: str, size: tuple[float, float]) -> BenchCase:
    force = SMALL / plate.cantilever(*size, PLATE)
    run = Run(
        SAMPLE,
        (
            *(_material(), _sheet(size, ", clamp: {edge: x_min}")),
            f"loads=[{{sheet: n, edge: x_max, force: [0 N, 0 N, {force!r} N]}}]",
            "probes={end: {sheet: n, edge: x_max}}",
        ),
    )
    return row("Poisson's effect", f"{name} cantilever, 24 x 16 boxes", run, partial(lifts, size))


def _free(name: str) -> BenchCase:
    if name == "bent":
        first, last = (
            f"moment: [0 N*mm, {SMALL!r} N*mm, 0 N*mm]",
            f"moment: [0 N*mm, {-SMALL!r} N*mm, 0 N*mm]",
        )
    else:
        first, last = f"force: [{-SMALL!r} N, 0 N, 0 N]", f"force: [{SMALL!r} N, 0 N, 0 N]"
    a, b = LONG
    x, y = a / GRID[0] / 2, b / GRID[1] / 2
    # at centres of boxes: a place between some would hold all of them, and so how they turn
    held = [_at(x, y, "x, y, z"), *(_at(13 * x, n * y, fix) for n, fix in ((1, "y"), (9, "z"), (-7, "z")))]
    run = Run(
        SAMPLE,
        (
            *(_material(), _sheet(LONG), f"supports=[{', '.join(held)}]"),
            f"loads=[{{sheet: n, edge: x_min, {first}}}, {{sheet: n, edge: x_max, {last}}}]",
            "probes={middle: {sheet: n, at: [0 mm, 0 mm]}}",
        ),
    )
    return row("Poisson's effect", f"free plate, {name}, 24 x 16 boxes", run, partial(contracts, name))


def sags(result: Result, _: Result | None) -> list[Finding]:
    """Deflection of a box next to the middle under the plate's weight."""
    found = -float(result.anchor_motion(0)[0][-1, 2])
    expected = plate.navier(*SIZE, PLATE, BOX) * MASS * GRAVITY * 1e-3 / (SIZE[0] * SIZE[1])
    return [against("deflection", expected, found, 1e-2, "mm", Basis(NAVIER, "the grid, of second order"))]


def lifts(size: tuple[float, float], result: Result, _: Result | None) -> list[Finding]:
    """Mean deflection of the loaded end."""
    found = float(result.anchor_motion(0)[0][-1, 2])
    basis = Basis(RITZ, "the grid, of second order; shear is 0.1 % where it is wide")
    return [against("deflection", SMALL, found, 1e-2, "mm", basis)]


def contracts(name: str, result: Result, _: Result | None) -> list[Finding]:
    """Strain and bending of the middle third along x, and across it."""
    joints, measured = sheet_joints(result.model), histories(result, np.array([len(result.time) - 1]))
    assert measured is not None, "a sheet of many boxes has joints"
    stretch, bend = measured[1:]
    values = (bend if name == "bent" else stretch)[0]
    middle = np.abs(joints.at[:, 0]) < LONG[0] / 6
    along, across = (float(values[middle & (joints.axis == axis)].mean()) for axis in (0, 1))
    stiff = STRIP if name == "bent" else MODULUS * THICK
    basis = Basis(SADDLE if name == "bent" else PULLED, "the loaded ends, and the grid")
    return [
        against("nu", RATIO, -across / along, 1e-2, "", basis),
        against(
            "along x", SMALL / (SIZE[1] * stiff), abs(along), 1e-2, "1/mm" if name == "bent" else "", basis
        ),
    ]
