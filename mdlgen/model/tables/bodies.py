"""Tables of bodies, bushings and curves."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints


@dataclass(frozen=True)
class Frozen:
    """Makes the arrays of a frozen dataclass read-only."""

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)


@dataclass(frozen=True)
class Bodies(Frozen):
    """Rigid bodies at the start."""

    name: tuple[str, ...]  # identifier, unique without regard to case
    label: tuple[str, ...]
    position: Floats  # centre of mass [mm], (n, 3)
    rotation: Floats  # (n, 3, 3)
    mass: Floats  # [g], (n,)
    inertia: Floats  # principal inertia, body axes [g mm^2], (n, 3)
    velocity: Floats  # [mm/ms], (n, 3)
    spin: Floats  # angular velocity, global axes [rad/ms], (n, 3)
    fixed: NDArray[np.bool_]  # held: clamped boxes; planes, guides and meshes that move with nothing, (n,)
    half: Floats  # half lengths of a box, body axes; zero for rollers, guides and meshes [mm], (n, 3)
    exposed: NDArray[np.bool_]  # side faces that no neighbour covers: x_min, x_max, y_min, y_max, (n, 4)
    friction: Floats  # friction of its contacts relative to that of the contact, (n,)


# kinds of bushing
JOINT_X, JOINT_Y, CLAMP, SUPPORT = 0, 1, 2, 3


@dataclass(frozen=True)
class Bushings(Frozen):
    """Six springs and dampers between body `a` and body `b` at `origin`, stress-free at the start but for
    `rest`."""

    name: tuple[str, ...]
    label: tuple[str, ...]
    kind: Ints  # JOINT_X, JOINT_Y, CLAMP or SUPPORT, (n,)
    sheet: Ints  # index of the sheet, (n,)
    a: Ints  # body, or GROUND, (n,)
    b: Ints  # body, (n,)
    origin: Floats  # [mm], (n, 3)
    axes: Floats  # (n, 3, 3)
    rest: Floats  # rotation of b against a in which it is stress-free, bushing axes [rad], (n, 3)
    k: Floats  # k_x, k_y, k_z [N/mm], k_tx, k_ty, k_tz [N mm/rad], (n, 6)
    c: Floats  # the same order [N ms/mm], [N mm ms/rad], (n, 6)
    node: Ints  # twice the grid coordinates of the origin from the corner of box (0, 0), (n, 2)
    frames: Ints  # frames of the two sides, see Frames, (n, 2)

    def __len__(self) -> int:
        return len(self.name)


@dataclass(frozen=True)
class Plastic(Frozen):
    """Bushings that yield in bending, see mechanics.plastic: one row each."""

    bushing: Ints  # (n,)
    axis: Ints  # axis of its frame that the sheet bends about: 0: x (along CD), 1: y (along MD), (n,)
    moment: Floats  # moment up to which it is elastic [N mm], (n,)
    hardening: Floats  # growth of the moment with the plastic rotation [N mm/rad], (n,)

    def __len__(self) -> int:
        return len(self.bushing)


def no_plastic() -> Plastic:
    """The table of a Model in which nothing yields."""
    return Plastic(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0), np.zeros(0))


@dataclass(frozen=True)
class Corners(Frozen):
    """Poisson's effect: couplings of the bushings around corners where four boxes meet, or two and a clamp.

    Columns of coefficients are those of mechanics.corner.CORNER: of the first bushing along x with the first
    and the second one along y, then of the second one along x.
    """

    joint: Ints  # bushings: two along x, two along y, -1: none, (n, 4)
    bend: Floats  # [N mm/rad], (n, 4)
    stretch: Floats  # [N/mm], (n, 4)
    bend_damping: Floats  # [N mm ms/rad], (n, 4)
    stretch_damping: Floats  # [N ms/mm], (n, 4)
    sheet: Ints  # index of the sheet, (n,)

    def __len__(self) -> int:
        return len(self.joint)


def no_corners() -> Corners:
    """The table of a Model without Poisson's effect."""
    none = np.zeros((0, 4))
    return Corners(np.zeros((0, 4), np.int64), none, none, none, none, np.zeros(0, np.int64))


@dataclass(frozen=True)
class Curves(Frozen):
    """Measured stress-strain curves, and the bushings that follow one along an axis of their own.

    Curve i has the points start[i] ... start[i + 1] - 1, from (0, 0) on, and is odd: compression follows it
    with both signs turned. Between points it is a cubic with the slopes given, beyond the last one straight.
    The force of a bushing is `area` times the stress at its elongation over `length`.
    """

    name: tuple[str, ...]  # SHEET_md or SHEET_cd
    start: Ints  # (curves + 1,)
    strain: Floats  # (points,)
    stress: Floats  # [MPa]
    slope: Floats  # [MPa]
    energy: Floats  # energy of a unit volume, up to the point [N/mm^2]
    rise: Floats  # slope beyond the last point [MPa], (curves,)
    linear: NDArray[np.bool_]  # true if a joint may go beyond it; else the run ends, (curves,)
    of: Ints  # curve of each bushing, -1: none, (bushings,)
    axis: Ints  # axis of the bushing that follows it, 0: x, 1: y, (bushings,)
    length: Floats  # [mm], (bushings,)
    area: Floats  # [mm^2], (bushings,)

    def __len__(self) -> int:
        return len(self.name)
