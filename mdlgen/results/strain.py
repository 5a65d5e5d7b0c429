"""Loads of the joints of a sheet: membrane strain, curvature and twist, and their peaks over a run.

A joint is what connects two boxes, or a box and its clamp: in `edge_to_edge` the two bushings at the shared
corners together. It stands for the material between the two box centres (between line and centre at a clamp).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mdlgen.model.grid import local
from mdlgen.model.once import Once
from mdlgen.model.rotations import euler_parameters, matrices
from mdlgen.model.tables import CLAMP, GROUND, JOINT_X, SUPPORT, Floats, Frozen, Ints, Model
from mdlgen.results.result import Result

# States of joints worked on at a time: the arrays of so many stay in the cache.
_CHUNK = 10_000
# Numbers of a run that are cached: peaks, differences and curves are all of the same ones.
_KEPT = 4_000_000
# Peaks in the order that `_measure` gives them in.
_KINDS = ("stretch", "squeeze", "curvature", "twist")


@dataclass(frozen=True)
class SheetJoints(Frozen):
    """The joints of all sheets, in the order of the Model's bushings."""

    name: tuple[str, ...]  # of its bushing, without the letter of the corner
    bushing: Ints  # row of its bushing, the first of two, (n,)
    sheet: Ints  # index of the sheet
    axis: Ints  # which sheet axis it lies along, 0: x (MD), 1: y (CD)
    a: Ints  # body, or GROUND
    b: Ints  # body
    way: Floats  # 1 where b lies on the positive side along the axis, else -1
    length: Floats  # of material that it stands for [mm]
    spread: Floats  # half the distance of its two bushings [mm], 0 where it has one; half a plate's side
    origin: Floats  # middle [mm], (n, 3)
    axes: Floats  # of its bushings, (n, 3, 3)
    rest: Floats  # rotation of b against a without stress, bushing axes [rad], (n, 3)
    at: Floats  # middle in sheet axes from the sheet's centre [mm], (n, 2)

    def __len__(self) -> int:
        return len(self.name)


@dataclass(frozen=True)
class Peak(Frozen):
    """The extreme of one quantity over the stored times, with its sign, and when it was, (joints,) each."""

    value: Floats
    at: Floats  # [ms]


@dataclass(frozen=True)
class Strains:
    """Peaks over the stored times of a run, by joint.

    `stretch` and `squeeze` are the greatest and the least membrane strain: elongation over length, of the
    bushing of the joint where it is more extreme. `curvature` and `twist` [1/mm] are the greatest in
    magnitude. Curvature is positive where the sheet bends towards its normal. Twist is the rotation about the
    joint's own direction over its length.
    """

    joints: SheetJoints
    stretch: Peak
    squeeze: Peak
    curvature: Peak
    twist: Peak
    limit: Floats | None = None  # strain at the end of the material's curve, nan where it has none, (n,)

    @property
    def margin(self) -> Floats | None:
        """Reserve up to the limit, as a part of it: 1 unloaded, 0 at the curve's end, (n,).

        A curve holds for tension and, with its signs turned, for compression.
        """
        if self.limit is None:
            return None
        return 1.0 - np.maximum(self.stretch.value, -self.squeeze.value) / self.limit


@Once
def sheet_joints(model: Model) -> SheetJoints:
    """The joints of a Model's sheets."""
    bushings = model.bushings
    rows = np.flatnonzero(bushings.kind != SUPPORT)
    key = np.stack([bushings.sheet, bushings.kind, bushings.a, bushings.b])[:, rows]
    # the bushings of a joint follow each other
    new = np.ones(len(rows), bool)
    new[1:] = (key[:, 1:] != key[:, :-1]).any(axis=0)
    starts = np.flatnonzero(new)
    first, last = rows[starts], rows[np.append(starts, len(rows))[1:] - 1]
    sheet, kind, a, b = key[:, starts]
    held = [s.clamp is not None and s.clamp.edge[0] == "y" for s in model.sheets]
    axis = np.where(kind == CLAMP, np.array(held, dtype=np.int64)[sheet], np.where(kind == JOINT_X, 0, 1))
    origin = (bushings.origin[first] + bushings.origin[last]) / 2
    spread = np.linalg.norm(bushings.origin[last] - bushings.origin[first], axis=1) / 2
    # the one bushing of a plate turns in the plane as the strip of the whole side does
    whole = np.array([s.layout == "plate" for s in model.sheets])[sheet]
    spread = np.where(whole, model.bodies.half[b, 1 - axis], spread)
    axes = bushings.axes[first]
    position = model.bodies.position
    start = np.where((a == GROUND)[:, None], origin, position[a])
    along = np.einsum("ni,ni->n", position[b] - start, axes[np.arange(len(a)), :, axis])
    # of material: half of each box, which a bent sheet has at an angle to each other
    ends = (b, np.where(a == GROUND, b, a))
    halves = [model.bodies.half[end, axis] for end in ends]
    length = np.where(a == GROUND, halves[0], halves[0] + halves[1])
    nodes = (bushings.node[first] + bushings.node[last]) / 2
    at = np.zeros((len(nodes), 2))
    for k, one in enumerate(model.sheets):
        mine = sheet == k
        at[mine] = local(one, *nodes[mine].T)[:, :2]
    return SheetJoints(
        name=tuple(_name(bushings.name[i], i != j) for i, j in zip(first, last, strict=True)),
        bushing=first,
        sheet=sheet,
        axis=axis,
        a=a,
        b=b,
        way=np.sign(along),
        length=length,
        spread=spread,
        origin=origin,
        axes=axes,
        rest=bushings.rest[first],
        at=at,
    )


def _name(bushing: str, pair: bool) -> str:
    return bushing.rpartition("_")[0] if pair else bushing


def strains(result: Result, limit: Floats | None = None) -> Strains | None:
    """Peaks over the stored times of a result; None where it has no state or its sheets no joints.

    `limit` is the strain at the end of the curve that each bushing follows, nan where it follows none,
    (bushings,).
    """
    joints = sheet_joints(result.model)
    if not len(joints) or not len(result.time):
        return None
    value = np.zeros((len(_KINDS), len(joints)))
    at = np.zeros((len(_KINDS), len(joints)))
    for axis in (0, 1):
        along = np.flatnonzero(joints.axis == axis)
        for start in range(0, len(along), _CHUNK):
            mine = along[start : start + _CHUNK]
            value[:, mine], frame = _peaks(result, _Fixed(result.model, joints, mine), axis)
            at[:, mine] = result.time[frame]
    peaks = {kind: Peak(value[k], at[k]) for k, kind in enumerate(_KINDS)}
    return Strains(joints, **peaks, limit=None if limit is None else limit[joints.bushing])


def _peaks(result: Result, fixed: _Fixed, axis: int) -> tuple[Floats, Ints]:
    """Extremes of some joints along `axis`, and the stored time of each, (4, joints) each."""
    count = len(fixed.a)
    frames = max(1, _CHUNK // count)
    found = np.zeros((len(_KINDS), count))
    most = np.full(found.shape, -np.inf)
    when = np.zeros(found.shape, dtype=np.int64)
    columns = np.arange(count)
    for start in range(0, len(result.time), frames):
        part = slice(start, start + frames)
        more, less, bend, twist = measured = _borne(result, part, fixed, axis)
        sizes = (more, -less, np.abs(bend), np.abs(twist))
        for k, (values, size) in enumerate(zip(measured, sizes, strict=True)):
            row = size.argmax(axis=0)
            larger = size[row, columns]
            better = larger > most[k]
            most[k, better] = larger[better]
            found[k, better] = values[row, columns][better]
            when[k, better] = start + row[better]
    return found, when


def histories(result: Result, at: Ints) -> tuple[SheetJoints, Floats, Floats] | None:
    """Membrane strain of the more stretched bushing and curvature [1/mm] of all joints at the stored states
    `at`, (t, joints) each; None where there is no joint."""
    joints = sheet_joints(result.model)
    if not len(joints) or not len(at):
        return None
    stretch, bend = np.zeros((2, len(at), len(joints)))
    for axis in (0, 1):
        along = np.flatnonzero(joints.axis == axis)
        if not len(along):
            continue
        fixed = _Fixed(result.model, joints, along)
        frames = max(1, _CHUNK // len(along))
        for start in range(0, len(at), frames):
            part = at[start : start + frames]
            more, _, curved, _ = _borne(result, part, fixed, axis)
            stretch[start : start + frames, along], bend[start : start + frames, along] = more, curved
    return joints, stretch, bend


def apart(one: Result, other: Result, at: Ints, there: Ints) -> tuple[SheetJoints, Floats] | None:
    """Greatest differences over the stored states `at` of one run and `there` of another of what each joint
    bears: strain of the more and of the less stretched bushing, curvature, twist [1/mm], (4, joints)."""
    joints = sheet_joints(one.model)
    if not len(joints) or not len(at):
        return None
    found = np.zeros((len(_KINDS), len(joints)))
    for axis in (0, 1):
        along = np.flatnonzero(joints.axis == axis)
        for start in range(0, len(along), _CHUNK):
            mine = along[start : start + _CHUNK]
            fixed, frames = _Fixed(one.model, joints, mine), max(1, _CHUNK // len(mine))
            for part in range(0, len(at), frames):
                states = zip(
                    (one, other), (at[part : part + frames], there[part : part + frames]), strict=True
                )
                measured = [_borne(run, now, fixed, axis) for run, now in states]
                for k, (a, b) in enumerate(zip(*measured, strict=True)):
                    found[k, mine] = np.maximum(found[k, mine], np.abs(a - b).max(axis=0))
    return joints, found


def all_borne(result: Result) -> Floats | None:
    """Strain of the more and of the less stretched bushing, curvature and twist [1/mm] of all joints at all
    stored states, (4, t, joints); None where that is much."""
    joints = sheet_joints(result.model)
    if len(_KINDS) * len(result.time) * len(joints) > _KEPT:
        return None
    found = np.empty((len(_KINDS), len(result.time), len(joints)))
    for axis in (0, 1):
        along = np.flatnonzero(joints.axis == axis)
        fixed, frames = _Fixed(result.model, joints, along), max(1, _CHUNK // max(len(along), 1))
        for start in range(0, len(result.time), frames):
            part = slice(start, start + frames)
            found[:, part, along] = _measure(result, part, fixed, axis)
    return found


def stretched(result: Result, part: slice, mine: Ints, axis: int) -> tuple[Floats, Floats]:
    """Strain of the more and of the less stretched bushing of the joints `mine`, which lie along `axis`, at
    some stored states, (t, n) each."""
    if result.borne is not None:
        more, less, *_ = result.borne
        return more[part].take(mine, axis=1), less[part].take(mine, axis=1)
    fixed = _Fixed(result.model, sheet_joints(result.model), mine)
    more, less, *_ = _measure(result, part, fixed, axis)
    return more, less


def _borne(result: Result, part: slice | Ints, fixed: _Fixed, axis: int) -> tuple[Floats, ...]:
    """As `all_borne`, of some joints along `axis` at some states."""
    known = result.borne
    if known is None:
        return _measure(result, part, fixed, axis)
    return tuple(known[:, part].take(fixed.mine, axis=2))


class _Fixed:
    """Data of some joints that do not change over a run; quaternions and vectors component by component."""

    def __init__(self, model: Model, joints: SheetJoints, mine: Ints):
        self.mine = mine
        self.a, self.b = joints.a[mine], joints.b[mine]
        self.way, self.length, self.spread = joints.way[mine], joints.length[mine], joints.spread[mine]
        self._model, self._joints = model, joints

    @cached_property
    def sides(self) -> list[tuple[Quaternion, Quaternion]]:
        """Bushing axes as seen from a and from b, and the arm to the middle as seen along these axes."""
        # the last row stands for the ground
        turned = np.concatenate([self._model.bodies.rotation, np.eye(3)[None]])
        placed = np.concatenate([self._model.bodies.position, np.zeros((1, 3))])
        axes, origin = self._joints.axes[self.mine], self._joints.origin[self.mine]
        # without stress the frame on b has turned onto the one on a
        own = (axes, axes @ matrices(-self._joints.rest[self.mine]))
        found = []
        for body, frame in zip((self.a, self.b), own, strict=True):
            seen = np.einsum("nki,nkj->nij", turned[body], frame)
            arm = np.einsum("nki,nk->in", axes, origin - placed[body])
            found.append((tuple(euler_parameters(seen).T), tuple(arm)))
        return found


def _states(result: Result, part: slice | Ints, bodies: Ints) -> tuple[Floats, Floats]:
    """Positions (3, t, n) and Euler parameters (4, t, n) of bodies, or of the ground."""
    ground = bodies == GROUND
    at = np.where(ground, 0, bodies)
    position = np.ascontiguousarray(np.moveaxis(result.position[part].take(at, axis=1), 2, 0))
    rotation = np.ascontiguousarray(np.moveaxis(result.rotation[part].take(at, axis=1), 2, 0))
    if ground.any():
        position[:, :, ground] = 0.0
        rotation[:, :, ground] = np.array([1.0, 0.0, 0.0, 0.0])[:, None, None]
    return position, rotation


def _measure(result: Result, part: slice | Ints, fixed: _Fixed, axis: int) -> tuple[Floats, ...]:
    """As `_borne`, (t, joints) each.

    As in `mechanics.bushing`: the gap is measured along the frame halfway between the two bodies.
    """
    side_a, side_b = _states(result, part, fixed.a), _states(result, part, fixed.b)
    (own_a, arm_a), (own_b, arm_b) = fixed.sides
    frame_a, frame_b = _product(tuple(side_a[1]), own_a), _product(tuple(side_b[1]), own_b)
    w, x, y, z = _product((frame_a[0], -frame_a[1], -frame_a[2], -frame_a[3]), frame_b)
    # of q and -q, which are the same rotation, the one of less than half a turn
    flip = np.where(w < 0.0, -1.0, 1.0)
    w, x, y, z = w * flip, x * flip, y * flip, z * flip
    across = x * x + y * y + z * z
    sine = np.sqrt(across)
    norm = np.sqrt(across + w * w)
    # half of the relative rotation, of unit length
    size = np.sqrt((w + norm) ** 2 + across)
    half = ((w + norm) / size, x / size, y / size, z / size)
    middle = _product(frame_a, half)
    gap = side_b[0] - side_a[0]
    apart = sum(m * g for m, g in zip(_column(middle, axis), gap, strict=True)) / sum(q * q for q in middle)
    back = (half[0], -half[1], -half[2], -half[3])
    # row k of a rotation is column k of its inverse
    apart = apart + sum(h * r for h, r in zip(_column(back, axis), arm_b, strict=True))
    apart = apart - sum(h * r for h, r in zip(_column(half, axis), arm_a, strict=True))
    # the two corners are apart by more and by less, where the joint turns in the plane (bushing_pair)
    corner = 2.0 * np.abs(z) / norm * fixed.spread
    stretch = apart * fixed.way
    # the angle over its sine; no turn, no angle
    angle = 2.0 * np.arctan2(sine, w) / np.where(sine > 0.0, sine, 1.0) * fixed.way
    bend = -y if axis == 0 else x
    return (
        (stretch + corner) / fixed.length,
        (stretch - corner) / fixed.length,
        angle * bend / fixed.length,
        angle * (x, y)[axis] / fixed.length,
    )


Quaternion = tuple[Floats, ...]


def _product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Rotation q, then p."""
    pw, px, py, pz = p
    qw, qx, qy, qz = q
    return (
        pw * qw - px * qx - py * qy - pz * qz,
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
    )


def _column(q: Quaternion, axis: int) -> Quaternion:
    """Column of the rotation matrix, times the square of the quaternion's length."""
    w, x, y, z = q
    if axis == 0:
        return w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)
    return 2.0 * (x * y - w * z), w * w + y * y - x * x - z * z, 2.0 * (y * z + w * x)
