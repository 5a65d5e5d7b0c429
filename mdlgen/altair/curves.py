"""Curves as texts write them: one for all bushings of a sheet that are alike."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.altair.classes import joint_classes
from mdlgen.model.curves import stress
from mdlgen.model.tables import (
    CLAMP,
    SUPPORT,
    Curves,
    Floats,
    Ints,
    Model,
)

# A text takes straight lines between points: as many as keep it within this part of the greatest stress.
TEXT_TOLERANCE = 1e-6
# An MDL file continues straight beyond the last point, up to this many times its strain.
TEXT_BEYOND = 10.0


def straight_points(curves: Curves, number: int) -> tuple[Floats, Floats]:
    """Strains and stresses [MPa], compression first, between which straight lines are the curve.

    They are as close as TEXT_TOLERANCE asks: a line of length h is off by h^2/8 times the second derivative.
    A curve that continues beyond its last point does so for TEXT_BEYOND times its strain.
    """
    part = slice(curves.start[number], curves.start[number + 1])
    x, y, m = curves.strain[part], curves.stress[part], curves.slope[part]
    h, rise = np.diff(x), np.diff(y) / np.diff(x)
    bends = np.abs([6 * rise - 4 * m[:-1] - 2 * m[1:], 6 * rise - 2 * m[:-1] - 4 * m[1:]]).max(axis=0)
    # no coarser than the neighbouring pieces: where the pitch jumps at a bend, splines oscillate
    sharp = np.concatenate([[0.0], bends / h, [0.0]])
    sharp = np.maximum(sharp[1:-1], np.maximum(sharp[:-2], sharp[2:]))
    pieces = np.ceil(h * np.sqrt(sharp / (8 * TEXT_TOLERANCE * y[-1]))).astype(int)
    stations = [
        a + (b - a) * np.arange(n) / n for a, b, n in zip(x[:-1], x[1:], np.maximum(pieces, 1), strict=True)
    ]
    beyond = [x[-1], TEXT_BEYOND * x[-1]] if curves.linear[number] else [x[-1]]
    strain = np.concatenate([*stations, beyond])
    strain = np.concatenate([-strain[:0:-1], strain])
    return strain, stress(curves, number, strain)


class Written(NamedTuple):
    """A curve as a text has it: force over elongation of one bushing of joints that are alike."""

    name: str
    sheet: int
    number: int
    joints: str  # class of the joints where a sheet has classes, else empty
    axis: str  # x or y
    length: float  # of a joint, half cells made whole [mm]
    area: float  # of one bushing [mm^2]


def written(model: Model) -> tuple[list[Written], Ints]:
    """The curves of a text, by sheet, and which of them each bushing follows, -1: none, (bushings,)."""
    curves, rows = model.curves, model.bushings
    found: list[Written] = []
    of = np.full(len(rows), -1)
    for number, name in enumerate(curves.name):
        mine = np.flatnonzero(curves.of == number)
        index = int(rows.sheet[mine[0]])
        sheet = model.sheets[index]
        groups: dict[str, list[int]] = {"": mine.tolist()} if sheet.uniform else {}
        if not sheet.uniform:
            own = np.flatnonzero((rows.sheet == index) & (rows.kind != SUPPORT))
            names = [classes[k].name for _, classes, which in joint_classes(sheet) for k in which.tolist()]
            for row, joints in zip(own.tolist(), names, strict=True):
                if curves.of[row] == number:
                    groups.setdefault(joints, []).append(row)
        for joints, members in groups.items():
            first = members[0]
            halves = 2.0 if rows.kind[first] == CLAMP else 1.0
            of[members] = len(found)
            length, area = halves * float(curves.length[first]), float(curves.area[first])
            axis, message = "xy"[int(curves.axis[first])], f"{name}_{joints}" if joints else name
            found.append(Written(message, index, number, joints, axis, length, area))
    return found, of
