"""Rows of sheets, and of points of them: probes, supports and loads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from mdlgen.backends.motionview.writer.rows import Value


class Point(NamedTuple):
    """A point of a sheet at cell coordinates (i, j), counted from the corner of box (0, 0).

    Between the lines `x` and the lines `y`: one line, or the two that it is in the middle of.
    """

    name: str
    label: str
    i: str
    j: str
    x: tuple[int, ...]
    y: tuple[int, ...]
    frames: tuple[int, int] = (0, 0)


class FrameView(NamedTuple):
    """A frame of a bent sheet: the one it hangs on, or its crease."""

    number: int
    parent: int
    line: str  # coordinate of the line that it hangs at
    part: str  # of what the sheet turns there
    lengths: list[str]  # of the boxes before and after the line
    crease: str | None
    corner: tuple[int, int] | None  # signs of a dog-ear's corner
    pivot: tuple[str, str]  # what a dog-ear turns about


class EarView(NamedTuple):
    """A dog-ear's size, which is fixed in a text."""

    name: str
    a: str
    b: str


@dataclass(frozen=True)
class BendView:
    """The shape in which a sheet is free of stress."""

    given: list[Value]
    flat: bool  # begins flat
    axis: str  # x or y; empty with dog-ears
    curled: bool
    ears: list[EarView]
    frames: list[FrameView]
    halves: list[tuple[int, int]]  # pairs of frames with joints between them


class Lengths(NamedTuple):
    """References to what a box has of its own: lengths, and the members of its class."""

    d_x: str
    d_y: str
    s: str
    m: str
    inertia: tuple[str, str, str]


class GridView(NamedTuple):
    """Lengths along one side that are given one by one."""

    axis: str
    data_set: str
    given: list[Value]


class ZoneView(NamedTuple):
    """A zone; `thick`: it has a thickness of its own."""

    name: str
    given: list[Value]
    thick: bool


class CellView(NamedTuple):
    """Boxes that are alike: how many, and the share of each zone."""

    name: str
    d_x: str
    d_y: str
    many: int
    shares: list[tuple[str, str]]


class HingeView(NamedTuple):
    """Joints that are alike, between boxes of two classes."""

    name: str
    along_x: bool
    one: CellView
    two: CellView
    crease: str | None  # that makes them softer by a factor
    line: str | None  # that has a stiffness per length


class Bush(NamedTuple):
    """A bushing: its bodies and its point."""

    name: str
    label: str
    body_1: str
    body_2: str
    point: str


class JointGroup(NamedTuple):
    """Bushings of one sheet with the same values: `factor` times the members k_*, c_*, to which `own` makes
    the references."""

    factor: str
    own: str
    x: str  # suffix of the members of displacement along x: x or x_shear
    y: str
    tx: str  # of rotation about x: tx or tx_twist
    ty: str
    tz: str
    frames: tuple[int, int]  # of the two sides
    bushes: list[Bush]
    curves: tuple[str, str]  # that stand for k_x and k_y, empty: none
    twist: tuple[str, str]  # more that stands before the members of rotation about x and about y


class CurveView(NamedTuple):
    """A curve of force over elongation of one bushing along an axis: strains and stresses of its points."""

    name: str
    label: str
    axis: str  # x or y
    length: str  # reference to that of a joint
    area: str  # reference to the section of one bushing
    points: list[tuple[str, str]]


@dataclass(frozen=True)
class SheetView:
    """One sheet."""

    name: str
    given: list[Value]
    n_x: str
    n_y: str
    tiled: bool
    parts: int  # bushings per pair
    rotation: bool  # three angles in place of turn
    moving: bool  # has initial velocities
    bending: tuple[str, str]
    in_plane: bool
    twist: bool
    plate: bool
    ratio: str  # shear modulus over the mean of the moduli, and the same for twist, where they are not given.
    damping: str  # inertia, paper or time.
    own_times: bool  # true where MD and CD have damping times of their own.
    stiff: bool  # true where some value uses the sheet's stiffness.
    graded: tuple[bool, bool]
    grids: list[GridView]
    zones: list[ZoneView]
    cells: list[CellView]  # empty where all boxes are alike
    hinges: list[HingeView]
    bend: BendView | None
    boxes: list[Point]
    lengths: list[Lengths]  # of each box
    held: list[Point]
    free: list[Point]
    nodes: list[Point]
    joints: list[JointGroup]
    curves: list[CurveView]
    surface: list[list[str]]  # marker names row by row; empty: no surface


@dataclass(frozen=True)
class ProbeView:
    """A probe: an edge's middle, or a data set with x and y."""

    name: str
    sheet: str
    points: list[tuple[str, str]]  # (point, frame that its box lies in)
    edge: str | None
    given: list[Value]
    markers: list[tuple[str, str, str]]  # (marker, body, point)


@dataclass(frozen=True)
class SupportView:
    """A held material point or middle of an edge: bushings to ground on each box that it lies on."""

    name: str
    sheet: str
    points: list[tuple[str, str]]  # (point, frame that its box lies in)
    edge: str | None
    given: list[Value]
    count: int
    fixed: tuple[bool, bool, bool]
    bushes: list[Bush]


class LoadPart(NamedTuple):
    """Part of a load on one box: its place, and its three components."""

    name: str
    label: str
    body: str
    x: str
    y: str
    frame: str  # marker that its box lies in, without m_
    components: list[str]


class LoadView(NamedTuple):
    """One entry of the spec's list of loads."""

    name: str
    label: str
    sheet: str
    given: list[Value]
    moment: bool
    changes: bool  # its components are expressions of the solver
    parts: list[LoadPart]
