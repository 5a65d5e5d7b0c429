"""Sheets: grid, zones, shape at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.bodies import Frozen


@dataclass(frozen=True)
class Clamp:
    """A held edge: rows of boxes behind the line, and the half-cell hinges on it."""

    edge: str
    rows: int


@dataclass(frozen=True)
class ZonePart(Frozen):
    """A part of a sheet that is unlike the rest; see the spec for what the factors mean."""

    name: str
    share: Floats  # part of each box that it covers, (boxes,)
    thickness: float | None  # None: as the sheet
    density: float
    stiffness: float
    friction: float


@dataclass(frozen=True)
class Crease:
    """A fold, or the crease of a dog-ear."""

    name: str
    corner: tuple[int, int] | None  # signs of the corner along x and y; None: a fold
    size: tuple[float, float]  # from the corner to the ends of the crease; of a fold zero [mm]
    line: tuple[int, int]  # a fold is on this line along its direction; an ear turns about where both cross
    angle: float  # [rad]
    stiffness: float  # bending stiffness of its joints, relative to that of the sheet
    per_length: float | None = None  # stiffness of the crease itself [N mm/rad per mm]; None: `stiffness`


@dataclass(frozen=True)
class Frames(Frozen):
    """Where the boxes of a bent sheet are: each lies in its frame as it lies in the flat sheet.

    Sheet axes, from the sheet's centre. Frame 0 is the flat sheet. A frame of a curl or of folds hangs on its
    parent at a line between boxes, and is turned there by `part` of what the sheet turns on that line: by the
    half lengths of `cells` over the curl's radius, and by a fold.
    """

    origin: Floats  # [mm], (frames, 3)
    rotation: Floats  # (frames, 3, 3)
    box: Ints  # frame of each box, (boxes,)
    parent: Ints  # (frames,)
    line: Ints
    part: Floats
    cells: Ints  # column or row before and after the line, -1: none, (frames, 2)
    crease: Ints  # -1: none, (frames,)


@dataclass(frozen=True)
class Bend(Frozen):
    """The stress-free shape of a sheet that is not flat."""

    start: str  # bent: it begins so; flat: it begins flat
    axis: int  # axis that is bent, 0: x, 1: y, -1: dog-ears
    radius: float  # radius of the curl [mm], inf: none
    creases: tuple[Crease, ...]
    frames: Frames


def thick_of(plain: float, zones: tuple[ZonePart, ...], count: int) -> Floats:
    """Thickness of each box of a sheet that is `plain` outside of its zones [mm], (count,)."""
    s = np.full(count, plain)
    for zone in zones:
        if zone.thickness is not None:
            s = s + zone.share * (zone.thickness - plain)
    return s


@dataclass(frozen=True)
class SheetPart(Frozen):
    """A sheet's grid; its boxes are the bodies first ... first + n_x n_y - 1."""

    name: str
    first: int
    n_x: int
    n_y: int
    d_x: float  # mean length of a box
    d_y: float
    lines_x: Floats  # coordinates of the lines between boxes, from the sheet's centre [mm], (n_x + 1,)
    lines_y: Floats  # (n_y + 1,)
    graded: tuple[bool, bool]  # true if the lengths along x, along y are given box by box
    zones: tuple[ZonePart, ...]
    bend: Bend | None
    thickness: float
    size: tuple[float, float]
    layout: str
    grid: str
    center: Floats  # (3,)
    angles: tuple[float, float, float]  # angles about the global x, then y, then z axis [rad]
    rotation: Floats  # (3, 3)
    velocity: Floats
    spin: Floats
    surface: bool
    clamp: Clamp | None
    bending: tuple[str, str]  # keys that the user gave: one of (k_tx, D_cd), one of (k_ty, D_md)
    twist: bool  # true if joints have a twist of their own: D_twist was given, or layout plate
    in_plane: bool  # true if k_tz was given
    rotation_damping: str  # inertia or paper, with a ratio (Eq. 7); time: Kelvin and Voigt's
    derived: dict[str, float]
    damping_times: tuple[float, float] | None = None  # damping times of MD and CD [ms]; None: by a ratio
    yields: tuple[float, float] | None = None  # curvatures along MD and CD [1/mm]; None: it is elastic
    enters: float = 0.0  # time at which it comes in [ms]; 0: present as the run begins; nan: by a rule
    # planes beyond which it has left, a tuple each: axis, place on it [mm], and the side that is beyond
    out: tuple[tuple[int, float, float], ...] = ()
    out_at_rest: bool = False  # true if it leaves when it is asleep

    @property
    def count(self) -> int:
        return self.n_x * self.n_y

    @property
    def passes(self) -> bool:
        """True if it may come in or leave during a run."""
        return self.enters != 0.0 or bool(self.out) or self.out_at_rest

    @property
    def thick(self) -> Floats:
        """Thickness of each box [mm], (n_x n_y,)."""
        return thick_of(self.thickness, self.zones, self.count)

    @property
    def uniform(self) -> bool:
        """True if all boxes, and all joints of one kind, are alike."""
        return not any(self.graded) and not self.zones and not (self.bend is not None and self.bend.creases)

    @property
    def outline(self) -> tuple[float, float]:
        """Lengths of all boxes along x and along y [mm]."""
        return float(self.lines_x[-1] - self.lines_x[0]), float(self.lines_y[-1] - self.lines_y[0])

    def body(self, i: int, j: int) -> int:
        """Body of the box in column i (along x) and row j (along y)."""
        return self.first + i + j * self.n_x
