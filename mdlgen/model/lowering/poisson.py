"""Poisson's effect of `layout: plate`: the coupling of joints along x with joints along y.

Moduli and bending stiffness that a user gives are those of strips, which are free across. A sheet that is not
free across has E/(1 - nu_md nu_cd) and D/(1 - nu_md nu_cd), and the energy of an area is

    1/2 D_x kx^2 + D_12 kx ky + 1/2 D_y ky^2    with D_12 = nu_md D_y = nu_cd D_x of the plate,

and the same of strains with E s. An area is a quarter of a box: one joint along x and one along y have its
curvatures. Quarters that both a joint along x and one along y reach, around a corner of four boxes or at a
clamp, are coupled. At a free edge nothing bends the outer half of a box across that edge. It is modelled as a
strip, which is a plate without moment across. So a state of uniform moment, or of uniform tension, is exact
where the edges along it are free. Each quarter has a positive energy for any state, as the material has.

Dampers are scaled from those of the strip in the same way. The coupling has the geometric mean of both
joints' damping times, with which no motion gains energy.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from mdlgen.model.tables import (
    CLAMP,
    JOINT_X,
    JOINT_Y,
    Bodies,
    Bushings,
    Corners,
    Floats,
    Ints,
    SheetPart,
    no_corners,
)
from mdlgen.spec.material import Material
from mdlgen.spec.scene import Scene
from mdlgen.spec.sheet import Sheet

# Columns of a bushing's k and c for stretching and for bending, along x and along y.
STRETCH, BEND = (0, 1), (4, 3)


def couple(
    scene: Scene, sheets: tuple[SheetPart, ...], bodies: Bodies, bushings: Bushings
) -> tuple[Bushings, Corners]:
    """Bushings as those of plates, and what couples them; as they are where no sheet has Poisson's effect."""
    found = []
    k, c = bushings.k.copy(), bushings.c.copy()
    for number, sheet in enumerate(sheets):
        spec = scene.sheets[sheet.name]
        material = scene.materials[spec.material]
        if material.poisson:
            quarters = _Quarters(sheet, number, bodies, bushings)
            found.append(quarters.corners(bushings, *ratios(spec, material)))
            quarters.stiffen(k, c, *ratios(spec, material))
    if not found:
        return bushings, no_corners()
    columns = [np.concatenate(column) for column in zip(*found, strict=True)]
    return replace(bushings, k=k, c=c), Corners(*columns)


def ratios(sheet: Sheet, material: Material) -> tuple[float, float]:
    """sqrt(nu_md nu_cd) in stretching and in bending, with the sign of nu_md."""
    assert material.poisson is not None, "asked for sheets with Poisson's effect alone"
    e_md, e_cd = material.moduli
    d_md, d_cd = material.strips(sheet.thickness, sheet.pitch[0] / sheet.pitch[1])
    return material.poisson * math.sqrt(e_cd / e_md), material.poisson * math.sqrt(d_cd / d_md)


class _Quarters:
    """The quarters of boxes that joints along x and along y share: row by row of `joint` (n, 4), two along x
    and two along y (-1: none), and `area` (n, 4) of quarters, which are in the columns of CORNER."""

    def __init__(self, sheet: SheetPart, number: int, bodies: Bodies, bushings: Bushings):
        n_x, n_y, first = sheet.n_x, sheet.n_y, sheet.first
        self._number = number
        box = first + np.arange(sheet.count).reshape(n_y, n_x)
        along_x, along_y, hinge = (np.full((n_y, n_x), -1) for _ in range(3))
        for kind, table in ((JOINT_X, along_x), (JOINT_Y, along_y), (CLAMP, hinge)):
            rows = np.flatnonzero((bushings.sheet == number) & (bushings.kind == kind))
            one = bushings.b[rows] if kind == CLAMP else bushings.a[rows]
            table.ravel()[one - first] = rows
        quarter = bodies.half[box, 0] * bodies.half[box, 1]
        joints, areas = [], []

        def add(rows: list[Ints], quarters: list[Floats]) -> None:
            chosen = np.stack([row.ravel() for row in rows], axis=1)
            joints.append(chosen)
            areas.append(np.stack([area.ravel() for area in quarters], axis=1))

        low, high = slice(None, -1), slice(1, None)
        none_x, none_y = np.zeros((1, n_x - 1)), np.zeros((n_y - 1, 1))
        add(
            [along_x[low, low], along_x[high, low], along_y[low, low], along_y[low, high]],
            [quarter[low, low], quarter[low, high], quarter[high, low], quarter[high, high]],
        )
        if sheet.clamp is not None:
            across_x, from_min, held = (
                sheet.clamp.edge[0] == "x",
                sheet.clamp.edge.endswith("min"),
                sheet.clamp.rows,
            )
            if across_x:
                at = held if from_min else n_x - 1 - held
                line = slice(at, at + 1)
                absent = np.full((n_y - 1, 1), -1)
                add(
                    [hinge[low, line], hinge[high, line], along_y[low, line], absent],
                    [quarter[low, line], none_y, quarter[high, line], none_y],
                )
            else:
                at = held if from_min else n_y - 1 - held
                line = slice(at, at + 1)
                absent = np.full((1, n_x - 1), -1)
                add(
                    [along_x[line, low], absent, hinge[line, low], hinge[line, high]],
                    [quarter[line, low], quarter[line, high], none_x, none_x],
                )
        self.joint, self.area = np.concatenate(joints), np.concatenate(areas)
        # a corner of which a clamp holds a box couples nothing
        whole = ((self.joint >= 0) | (self._pairs_of(self.area) == 0.0)).all(axis=1)
        self.joint, self.area = self.joint[whole], self.area[whole]
        self._shape(bodies, bushings)

    @staticmethod
    def _pairs_of(area: Floats) -> Floats:
        """Area that each of the four joints has, (n, 4)."""
        a, b, c, d = area.T
        return np.stack([a + b, c + d, a + c, b + d], axis=1)

    def _shape(self, bodies: Bodies, bushings: Bushings) -> None:
        """Length, width and sign of each joint: -1 of one whose body b is on the negative side."""
        a, b = bushings.a, bushings.b
        axis = np.where(self._along_y(bushings), 1, 0)
        rows = np.arange(len(bushings))
        held = bushings.kind == CLAMP
        half_a, half_b = bodies.half[np.where(held, b, a)], bodies.half[b]
        self.length = np.where(held, 0.0, half_a[rows, axis]) + half_b[rows, axis]
        self.width = 2.0 * half_b[rows, 1 - axis]
        start = np.where(held[:, None], bushings.origin, bodies.position[a])
        way = np.einsum("ni,ni->n", bodies.position[b] - start, bushings.axes[rows, :, axis])
        self.sign = np.where(way < 0.0, -1.0, 1.0)

    def _along_y(self, bushings: Bushings) -> np.ndarray:
        found = bushings.kind == JOINT_Y
        found[self.joint[:, 2:][self.joint[:, 2:] >= 0]] = True
        return found

    def corners(self, bushings: Bushings, stretching: float, bending: float) -> list[np.ndarray]:
        """Columns of the table of corners."""
        columns = []
        for ratio, part, turned in ((bending, BEND, -1.0), (stretching, STRETCH, 1.0)):
            springs, dampers = np.zeros(self.area.shape), np.zeros(self.area.shape)
            for n in range(4):
                x, y = self.joint[:, n // 2], self.joint[:, 2 + n % 2]
                # of a unit width and length
                stiff = [
                    bushings.k[r, p] * self.length[r] / self.width[r]
                    for r, p in zip((x, y), part, strict=True)
                ]
                times = [
                    np.divide(
                        bushings.c[r, p], bushings.k[r, p], out=np.zeros(len(r)), where=bushings.k[r, p] > 0.0
                    )
                    for r, p in zip((x, y), part, strict=True)
                ]
                per = self.sign[x] * self.sign[y] * self.area[:, n] / (self.length[x] * self.length[y])
                springs[:, n] = turned * ratio / (1.0 - ratio**2) * per * np.sqrt(stiff[0] * stiff[1])
                dampers[:, n] = springs[:, n] * np.sqrt(times[0] * times[1])
            columns.append((springs, dampers))
        (bend, bend_damping), (stretch, stretch_damping) = columns
        sheet = np.full(len(self.joint), self._number)
        return [self.joint, bend, stretch, bend_damping, stretch_damping, sheet]

    def stiffen(self, k: Floats, c: Floats, stretching: float, bending: float) -> None:
        """Makes the bushings' k and c, (bushings, 6), those of the plate for the part that is coupled."""
        areas = self._pairs_of(self.area)
        for along in (0, 1):
            rows, own = self.joint[:, 2 * along : 2 * along + 2], areas[:, 2 * along : 2 * along + 2]
            covered = np.zeros(len(k))
            np.add.at(covered, rows[rows >= 0], own[rows >= 0])
            share = covered / (self.length * self.width)
            for ratio, column in ((stretching, STRETCH[along]), (bending, BEND[along])):
                factor = 1.0 + share * ratio**2 / (1.0 - ratio**2)
                k[:, column] *= factor
                c[:, column] *= factor
