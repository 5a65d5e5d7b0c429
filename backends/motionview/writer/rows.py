"""Plain rows for the templates: names, labels and numbers, already in MotionView's units.

What can be a formula is not here: it stands in the templates.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Value(NamedTuple):
    """A member of a data set that is a number."""

    member: str
    label: str
    number: str
    edit: str  # EDIT or NO_EDIT
    formula: str = ""  # that gives the number
    late: bool = False  # set behind all data sets, since it names values of others

    @property
    def said(self) -> str:
        """What the text sets it to."""
        return self.formula or self.number


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
    crease: str | None


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
    ratio: str  # shear modulus over the mean of the moduli, and so for twist, where they are not given
    damping: str  # inertia, paper or time
    own_times: bool  # MD and CD have damping times of their own
    stiff: bool  # anything uses the sheet's stiffness
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


class Axis(NamedTuple):
    """A direction: a global vector, or one of its own with components."""

    vector: str
    own: tuple[str, str, str] | None


class ArmView(NamedTuple):
    """An arm: its centre of mass, and whether it has a spring."""

    center: tuple[str, str, str]
    sprung: bool


class SectorView(NamedTuple):
    """A sector of a rim: its angles (deg) and radius as formulas, and how many boxes show it."""

    name: str
    begin: str
    radius: str
    facets: int


@dataclass(frozen=True)
class RollerView:
    """One roller."""

    name: str
    given: list[Value]
    axis: Axis
    guide: str  # global vector that fixes the x axis of the body
    driven: bool  # has a speed: of its axle, or of the shaft of its clutch
    free_sense: int  # of its clutch, 1 or -1; 0: it has none
    ramped: bool
    corners: int  # of its speed over time; 0: a ramp
    pressed: bool
    press: tuple[str, str, str]
    arm: ArmView | None
    rim: list[SectorView]
    derived: list[tuple[str, str, str]]


@dataclass(frozen=True)
class PlaneView:
    """One plane."""

    name: str
    given: list[Value]
    normal: Axis
    guide: str
    pressed: bool
    press: tuple[str, str, str]
    mass: str  # formula of all that slides


@dataclass(frozen=True)
class GuideView:
    """One guide."""

    name: str
    given: list[Value]
    derived: list[tuple[str, str, str]]
    straight: bool
    axis: Axis
    guide: str  # global vector that fixes where the angles of an arc are counted from
    off: str  # middle of a straight plate, along its normal
    facets: int


@dataclass(frozen=True)
class MeshView:
    """One mesh; its graphic is the file."""

    name: str
    given: list[Value]
    derived: list[tuple[str, str, str]]
    mass: str  # reference to it
    file: str
    ground: str  # body that its axes are fixed to
    on: str  # body that it is fixed to
    slides: str  # the pressed roller that it is on; empty: none
    z: tuple[str, str, str]  # axes of its inertia, those of the file
    x: tuple[str, str, str]


class ContactView(NamedTuple):
    """One entry of the spec's list."""

    data_set: str
    label: str
    given: list[Value]
    share: str


class Pair(NamedTuple):
    """One contact statement."""

    name: str
    label: str
    body_1: str
    graphic_1: str
    body_2: str
    graphics_2: list[str]
    friction: str  # ON or OFF
    data_set: str
    rough: str = ""  # friction of its boxes in times that of the contact, where that is not 1
    rougher: float = 1.0  # and its number
    stiff: str = ""  # the same of the stiffness
    stiffer: float = 1.0
    bouncy: str = ""  # reference to a restitution in place of the contact's
    restitution: float | None = None
    master: str = ""  # I or J: the side whose mesh is the finer one; empty: the solver chooses


class LawView(NamedTuple):
    """Contacts with the same numbers, as solver commands give them."""

    label: str
    master: str
    numbers: list[tuple[str, str, str]]  # variable of the template, attribute of the command, formula
    contacts: list[str]


class ForceView(NamedTuple):
    """What the contacts of two parts do to the second one, recorded as a sum over them."""

    name: str
    label: str
    terms: list[tuple[str, int]]  # contact, and its side that is the second part: 0 or 1


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
    """What of a load acts on one box: where, and its three components."""

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
    parts: list[LoadPart]


@dataclass(frozen=True)
class SceneView:
    """Everything that the main template loops over."""

    name: str
    static: bool
    static_settings: list[
        tuple[str, str]
    ]  # attributes of the command that says how to find the state of rest
    parameters: list[Value]
    run: list[Value]
    sheets: list[SheetView]
    supports: list[SupportView]
    loads: list[LoadView]
    rollers: list[RollerView]
    planes: list[PlaneView]
    guides: list[GuideView]
    meshes: list[MeshView]
    contacts: list[ContactView]
    pairs: list[Pair]
    laws: list[LawView]  # of contacts whose numbers stand in solver commands
    probes: list[ProbeView]
    set_contact: bool
    forces: list[ForceView] = field(default_factory=list)  # of contacts, where they are asked for
    target: str = "2021"  # version of MotionView whose form of Contact is written


class Attachment(NamedTuple):
    """An argument of a system definition: what an entity of the model around is called inside."""

    name: str
    label: str
    entity: str  # Body or Graphic
    given: str  # the entity's variable in the model around, as far as the scene says it


@dataclass(frozen=True)
class SystemView:
    """The sheets as one system definition; `scene` holds no machine."""

    name: str
    variable: str  # of an instance
    definition: str
    attachments: list[Attachment]
    scene: SceneView
