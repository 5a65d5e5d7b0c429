"""Measured stress-strain curves: points -> cubics, and what of them each bushing of a sheet follows.

Between points: the monotone cubic of Fritsch and Carlson (SIAM J. Numer. Anal. 17, 1980) with Butland's
weighted harmonic slopes, which other programs call PCHIP, through the points and their mirror images.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mdlgen.model.tables import (
    CLAMP,
    JOINT_X,
    JOINT_Y,
    Bushings,
    Curves,
    Floats,
    Ints,
    Model,
    SheetPart,
)
from mdlgen.spec.scene import Scene

WAYS = ("md", "cd")  # of the sheet's x and y axis
# A run that is refused beyond the last point ends at its next step; until then the joint is given at least
# this part of the first slope, so that a state is found to be reported.
LEAST_RISE = 0.01


def lower_curves(
    scene: Scene, sheets: Sequence[SheetPart], bushings: Bushings, long: Floats, wide: Floats
) -> Curves:
    """The curves that some bushing follows, by sheet, MD before CD.

    `long` [mm] is the length of each joint, `wide` [mm^2] the section of each of its bushings. In zones the
    section is scaled by their membrane stiffness. Both are (bushings,), with any value for supports.
    """
    count = len(bushings)
    of, axis = np.full(count, -1), np.zeros(count, dtype=np.int64)
    length, area = np.zeros(count), np.zeros(count)
    names: list[str] = []
    tables: list[tuple[Floats, Floats, Floats, Floats]] = []
    rise, linear = [], []
    for number, sheet in enumerate(sheets):
        material = scene.materials[scene.sheets[sheet.name].material]
        for way, curve in enumerate((material.curve_md, material.curve_cd)):
            rows = _following(sheet, number, bushings, way)
            if curve is None or not len(rows):
                continue
            of[rows], axis[rows] = len(names), way
            # a half-cell hinge has half the length
            length[rows] = np.where(bushings.kind[rows] == CLAMP, 0.5, 1.0) * long[rows]
            area[rows] = wide[rows]
            strain, stress = np.array(curve.points, dtype=float).T
            slope = monotone_slopes(strain, stress)
            names.append(f"{sheet.name}_{WAYS[way]}")
            tables.append((strain, stress, slope, _energies(strain, stress, slope)))
            linear.append(curve.extrapolate == "linear")
            rise.append(slope[-1] if linear[-1] else max(slope[-1], LEAST_RISE * slope[0]))
    strain, stress, slope, energy = (np.concatenate([np.zeros(0), *(t[k] for t in tables)]) for k in range(4))
    return Curves(
        tuple(names),
        np.cumsum([0, *(len(t[0]) for t in tables)]).astype(np.int64),
        strain,
        stress,
        slope,
        energy,
        np.array(rise, dtype=float),
        np.array(linear, dtype=bool),
        of.astype(np.int64),
        axis,
        length,
        area,
    )


def _following(sheet: SheetPart, number: int, bushings: Bushings, way: int) -> Ints:
    """Rows of the bushings that lengthen along x (way 0) or y (1) of a sheet."""
    kinds = [JOINT_X if way == 0 else JOINT_Y]
    if sheet.clamp is not None and sheet.clamp.edge[0] == "xy"[way]:
        kinds.append(CLAMP)
    return np.flatnonzero((bushings.sheet == number) & np.isin(bushings.kind, kinds))


def monotone_slopes(x: Floats, y: Floats) -> Floats:
    """Slopes at the points of an odd curve from (0, 0) on; no piece leaves the range of its points."""
    x, y = np.concatenate([[-x[1]], x]), np.concatenate([[-y[1]], y])
    h, rise = np.diff(x), np.diff(y) / np.diff(x)
    one, two = 2 * h[1:] + h[:-1], h[1:] + 2 * h[:-1]
    with np.errstate(divide="ignore"):
        inside = np.where(
            (rise[:-1] > 0) & (rise[1:] > 0), (one + two) / (one / rise[:-1] + two / rise[1:]), 0
        )
    # at the end the parabola through three points, kept as steep as is monotone
    last = ((2 * h[-1] + h[-2]) * rise[-1] - h[-1] * rise[-2]) / (h[-1] + h[-2])
    return np.append(inside, min(max(last, 0.0), 3 * rise[-1]))


def _energies(x: Floats, y: Floats, slope: Floats) -> Floats:
    """Exact integrals of the cubics from 0 to each point."""
    h = np.diff(x)
    pieces = h * (y[:-1] + y[1:]) / 2 + h**2 * (slope[:-1] - slope[1:]) / 12
    return np.concatenate([[0.0], np.cumsum(pieces)])


def stress(curves: Curves, number: int, strain: Floats) -> Floats:
    """Stress [MPa] of a curve at strains of either sign, (n,)."""
    part = slice(curves.start[number], curves.start[number + 1])
    x, y, m = curves.strain[part], curves.stress[part], curves.slope[part]
    size = np.abs(strain)
    i = np.clip(np.searchsorted(x, size, side="right") - 1, 0, len(x) - 2)
    h = x[i + 1] - x[i]
    t = (size - x[i]) / h
    one, two, up = h * m[i], h * m[i + 1], y[i + 1] - y[i]
    found = y[i] + t * (one + t * (3 * up - 2 * one - two + t * (one + two - 2 * up)))
    found = np.where(size >= x[-1], y[-1] + curves.rise[number] * (size - x[-1]), found)
    return np.copysign(found, strain)


def limit(curves: Curves, number: int) -> float:
    """Strain at the last point."""
    return float(curves.strain[curves.start[number + 1] - 1])


def limits(curves: Curves) -> Floats | None:
    """Strain at the last point of the curve that each bushing follows, nan: none, (bushings,); None without
    curves."""
    if not len(curves):
        return None
    last = np.append(curves.strain[curves.start[1:] - 1], np.nan)
    return last[curves.of]


def overstretched(model: Model, row: int, strain: float, time: float | None = None) -> str:
    """Why a run ends where a bushing is stretched beyond its curve; `time` [ms], None: at rest."""
    curves = model.curves
    number = int(curves.of[row])
    when = "at rest" if time is None else f"at {time:.6g} ms"
    return (
        f"joint {model.bushings.name[row]} has a strain of {strain:.6g} {when}, beyond the last point of its "
        f"curve {curves.name[number]} ({limit(curves, number):.6g}); measure further, or give it "
        "extrapolate: linear"
    )
