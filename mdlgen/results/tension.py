"""Tension of sheets along their way: the membrane force over each cross-section, by the bushings' laws.

A section is a row of joints across the way. Its tension is the sum of what springs and dampers of these
joints pull with along themselves, positive where they pull and negative where the sheet is pushed. The
springs follow stress-strain curves where the material has some.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.rotations import column, matrices
from mdlgen.model.tables import GROUND, SUPPORT, Curves, Floats, Frozen, Ints, Model, SheetPart
from mdlgen.results.result import Result
from mdlgen.results.strain import SheetJoints, sheet_joints, stretched

# States of joints worked on at a time: the arrays of so many stay in the cache.
_CHUNK = 10_000
# Stored times from which the way of a sheet is found.
_LOOKS = 50
# A sheet that goes less than this part of its length stands [1]: it has no way of its own.
_STANDS = 1e-3
# Rounding errors, in units of the last place, that positions and turns bring into an elongation.
_ROUNDINGS = 16.0
# A part of a unit vector or an arm below it is round-off [1], [mm].
_NONE = 1e-12


@dataclass(frozen=True)
class Tension(Frozen):
    """Tension of one sheet over the stored times."""

    axis: int  # sheet axis that it acts along, 0: x (MD), 1: y (CD)
    at: Floats  # place of each section along that axis, from the sheet's centre [mm], (sections,)
    force: Floats  # positive where the sheet is pulled [N], (t, sections)

    @property
    def greatest(self) -> Floats:
        """Greatest tension of all sections at each time [N], (t,)."""
        return self.force.max(axis=1)

    @property
    def least(self) -> Floats:
        """Least tension of all sections at each time [N], (t,): below 0 where one is pushed."""
        return self.force.min(axis=1)


def tension_of(result: Result, index: int) -> Tension | None:
    """Tension of a sheet along its way; None where it has no joints along it, or the run no state.

    That is the sheet axis away from its clamp, else the one that it goes along more. Where it stands, it is
    the one that bears more.
    """
    if not len(result.time):
        return None
    axis = _way(result, index)
    if axis is not None:
        return _along(result, index, axis)
    found = [one for one in (_along(result, index, k) for k in (0, 1)) if one is not None]
    return max(found, key=lambda one: float(np.abs(one.force).max()), default=None)


def _way(result: Result, index: int) -> int | None:
    """Sheet axis of its clamp or its way; None of a sheet that stands."""
    sheet = result.model.sheets[index]
    if sheet.clamp is not None:
        return int(sheet.clamp.edge[0] == "y")
    if len(result.time) < 2:
        return None
    looks = np.unique(np.linspace(0, len(result.time) - 1, _LOOKS).astype(int))
    boxes, share = slice(sheet.first, sheet.first + sheet.count), result.model.mass_share(index)
    rate, turned = result.velocity[looks, boxes], result.rotation[looks, boxes]
    speeds = [np.abs(np.einsum("tbi,tbi->tb", rate, column(turned, k)) @ share) for k in (0, 1)]
    ways = [float(np.trapezoid(speed, result.time[looks])) for speed in speeds]
    return int(ways[1] > ways[0]) if max(ways) > _STANDS * max(sheet.size) else None


def _along(result: Result, index: int, axis: int) -> Tension | None:
    model, sheet = result.model, result.model.sheets[index]
    joints = sheet_joints(model)
    mine = np.flatnonzero((joints.sheet == index) & (joints.axis == axis))
    if not len(mine):
        return None
    # sections follow each other along the axis
    line = model.bushings.node[joints.bushing[mine], axis]
    order = np.argsort(line, kind="stable")
    mine, line = mine[order], line[order]
    starts = np.flatnonzero(np.concatenate([[True], line[1:] != line[:-1]]))
    law = _Law(model, joints, mine, axis)
    moves = _Moves(model, sheet, joints, mine, axis)
    coupling = _Coupling(model, joints, index, mine, axis, starts) if index in model.corners.sheet else None
    force, before = np.empty((len(result.time), len(starts))), None
    frames = max(1, _CHUNK // len(mine))
    for start in range(0, len(result.time), frames):
        part = slice(start, start + frames)
        parting, way = moves.rates(result, part)
        more, less = stretched(result, part, mine, axis)
        if result.solver == "lattice":
            before, chord = way[:, -1:], _chords(result, part, before, way)
            more, less = more - chord, less - chord
        pull = law.springs(more, less) + law.damping * parting
        force[part] = np.add.reduceat(pull, starts, axis=1)
        if coupling is not None:
            force[part] += coupling.pull(result, part)
    far = float(np.abs(result.position[:, sheet.first : sheet.first + sheet.count]).max())
    least = _ROUNDINGS * np.finfo(float).eps * (far + max(sheet.size))
    force[np.abs(force) < least * np.add.reduceat(law.stiffness, starts)] = 0.0
    return Tension(axis, joints.at[mine[starts], axis], force)


def _chords(result: Result, part: slice, before: Floats | None, way: Floats) -> Floats:
    """Strain by which joints are longer at stored states than halfway through a step, where lattice has its
    forces, (t, n). A joint that rotates with w is a secant there, shorter by the part (w h)^2 / 8.

    `way` are directions at these states, `before` those at the one before them; w is what they turn by from
    one to the next. Spins of the states themselves are those of a flutter from step to step, too.
    """
    time = result.time[part]
    first = (way[:, :1], time[0] - 1.0) if before is None else (before, result.time[part.start - 1])
    turned = np.diff(np.concatenate([first[0], way], axis=1), axis=1)
    lasts = np.diff(np.concatenate([[first[1]], time]))
    return _dot(turned, turned) * (result.step**2 / 8.0 / lasts**2)[:, None]


class _Law:
    """Forces of joints along their own direction: (n,) each."""

    def __init__(self, model: Model, joints: SheetJoints, mine: Ints, axis: int):
        bushings = model.bushings
        rows = np.flatnonzero(bushings.kind != SUPPORT)
        # the bushings of a joint follow each other
        starts = np.searchsorted(rows, joints.bushing)
        count = np.diff(np.append(starts, len(rows)))
        self.stiffness = np.add.reduceat(bushings.k[rows, axis], starts)[mine]  # [N/mm]
        self.damping = np.add.reduceat(bushings.c[rows, axis], starts)[mine]  # [N ms/mm]
        self._two, self._length = count[mine] == 2, joints.length[mine]
        self._bushing, self._curves = joints.bushing[mine], model.curves

    def springs(self, more: Floats, less: Floats) -> Floats:
        """Spring forces by the strain of the more and the less stretched bushing of each joint, all (t,
        n)."""
        force = 0.5 * self.stiffness * self._length * (more + less)
        if not len(self._curves.of):
            return force
        of = self._curves.of[self._bushing]
        for number in np.unique(of[of >= 0]).tolist():
            own = np.flatnonzero(of == number)
            row = self._bushing[own]
            per = self._length[own] / self._curves.length[row]
            one, two = more[:, own], less[:, own]
            # the one bushing of a joint has the mean
            mean, two_of = 0.5 * (one + two), self._two[own]
            sides = (np.where(two_of, side, mean) for side in (one, two))
            stress = sum(curve_stress(self._curves, number, per * side) for side in sides)
            force[:, own] = self._curves.area[row] * np.where(two_of, 1.0, 0.5) * stress
        return force


class _Coupling:
    """Forces along the way of joints across it, by Poisson's effect (see mechanics.corner)."""

    def __init__(self, model: Model, joints: SheetJoints, index: int, mine: Ints, axis: int, starts: Ints):
        self._other = np.flatnonzero((joints.sheet == index) & (joints.axis == 1 - axis))
        self._axis, self._length = 1 - axis, joints.length[self._other]
        self._moves = _Moves(model, model.sheets[index], joints, self._other, 1 - axis)
        place, across = (np.full(len(model.bushings) + 1, -1) for _ in range(2))
        place[joints.bushing[mine]] = np.searchsorted(starts, np.arange(len(mine)), side="right") - 1
        across[joints.bushing[self._other]] = np.arange(len(self._other))
        way = np.zeros(len(model.bushings) + 1)
        way[joints.bushing] = joints.way
        corners = model.corners
        self._springs, self._dampers = np.zeros((2, len(starts), len(self._other)))
        for n in range(4):
            pair = (corners.joint[:, n // 2], corners.joint[:, 2 + n % 2])
            own, far = place[pair[axis]], across[pair[1 - axis]]
            met = (own >= 0) & (far >= 0)
            sign = way[pair[0]] * way[pair[1]]
            for table, values in ((self._springs, corners.stretch), (self._dampers, corners.stretch_damping)):
                np.add.at(table, (own[met], far[met]), (sign * values[:, n])[met])

    def pull(self, result: Result, part: slice) -> Floats:
        """At some stored states [N], (t, sections)."""
        more, less = stretched(result, part, self._other, self._axis)
        opens, _ = self._moves.rates(result, part)
        return 0.5 * self._length * (more + less) @ self._springs.T + opens @ self._dampers.T


def curve_stress(curves: Curves, number: int, strain: Floats) -> Floats:
    """Stress [MPa] of a curve at strains of any shape, as `mechanics.curve.curve_spring` has it."""
    points = slice(curves.start[number], curves.start[number + 1])
    x, y, slope = curves.strain[points], curves.stress[points], curves.slope[points]
    size = np.abs(strain)
    k = np.clip(np.searchsorted(x, size, side="right") - 1, 0, len(x) - 2)
    h = x[k + 1] - x[k]
    t, m, end, rise = (size - x[k]) / h, h * slope[k], h * slope[k + 1], y[k + 1] - y[k]
    inside = y[k] + t * (m + t * (3.0 * rise - 2.0 * m - end + t * (m + end - 2.0 * rise)))
    beyond = y[-1] + curves.rise[number] * (size - x[-1])
    return np.copysign(np.where(size < x[-1], inside, beyond), strain)


class _Moves:
    """Rate at which joints open along themselves, see `mechanics.bushing`."""

    def __init__(self, model: Model, sheet: SheetPart, joints: SheetJoints, mine: Ints, axis: int):
        self._boxes, self._way = slice(sheet.first, sheet.first + sheet.count), joints.way[mine]
        # the last row stands for the ground
        turned = np.concatenate([model.bodies.rotation, np.eye(3)[None]])
        placed = np.concatenate([model.bodies.position, np.zeros((1, 3))])
        axes, origin = joints.axes[mine], joints.origin[mine]
        own = (axes, axes @ matrices(-joints.rest[mine]))
        self._sides: list[tuple[Ints, Floats, Floats]] = []
        for body, frame in zip((joints.a[mine], joints.b[mine]), own, strict=True):
            at = np.where(body == GROUND, len(placed) - 1, body)
            # direction of the joint and arm to it, along the axes of the body
            local = [np.einsum("nki,nk->ni", turned[at], v) for v in (frame[:, :, axis], origin - placed[at])]
            along, arm = (np.where(np.abs(v) > _NONE, v, 0.0) for v in local)
            self._sides.append((np.where(body == GROUND, sheet.count, body - sheet.first), along, arm))
        self._held = bool((joints.a[mine] == GROUND).any())
        # most joints lie along an axis of their bodies: then there is one column to work out
        self._used = [k for k in range(3) if any(v[:, k].any() for side in self._sides for v in side[1:])]

    def rates(self, result: Result, part: slice) -> tuple[Floats, Floats]:
        """Rate of the elongation [mm/ms], (t, n), and the direction, (3, t, n)."""
        place, rate, spin = (
            self._of_boxes(values, part) for values in (result.position, result.velocity, result.spin)
        )
        turned = self._of_boxes(result.rotation, part)
        if self._held:
            turned[0, :, -1] = 1.0  # the ground
        columns = {k: np.moveaxis(column(np.moveaxis(turned, 0, -1), k), -1, 0) for k in self._used}
        ends = [_end(place, rate, spin, columns, *side) for side in self._sides]
        (from_, slow, swing, way), (to, fast, spun, other) = ends
        # the frame halfway between both: what it differs from their mean by is of the second order in twist
        middle = way + other
        middle /= np.sqrt(_dot(middle, middle))
        # of the gap as seen from that frame, which turns with the mean of both
        opens = _dot(fast - slow, middle) - 0.5 * _dot(swing + spun, _cross(to - from_, middle))
        return self._way * opens, middle

    def _of_boxes(self, values: Floats, part: slice) -> Floats:
        """Values of the sheet's boxes with components first, and of the ground behind them where it is
        held."""
        own = np.moveaxis(values[part, self._boxes], 2, 0)
        return np.pad(own, ((0, 0), (0, 0), (0, 1))) if self._held else np.ascontiguousarray(own)


def _end(
    place: Floats,
    rate: Floats,
    spin: Floats,
    columns: dict[int, Floats],
    body: Ints,
    along: Floats,
    arm: Floats,
) -> tuple[Floats, Floats, Floats, Floats]:
    """One end of joints: its place, its velocity, the spin of its body and its direction, (3, t, n)."""
    way = lever = np.zeros(1)
    for k, axes in columns.items():
        axis = axes.take(body, axis=2)
        way, lever = way + axis * along[:, k], lever + axis * arm[:, k]
    own = spin.take(body, axis=2)
    return place.take(body, axis=2) + lever, rate.take(body, axis=2) + _cross(own, lever), own, way


def _dot(a: Floats, b: Floats) -> Floats:
    """Dot product of vectors with their components first."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross product of vectors with their components first."""
    found = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[i] = a[j] * b[k] - a[k] * b[j]
    return found
