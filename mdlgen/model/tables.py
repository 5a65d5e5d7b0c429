"""The tables of a Model. Units: mm, N, g, ms, rad; rotations as 3x3 matrices, body axes in columns.

Bodies are numbered: the boxes of each sheet (row by row: index = i + j n_x), then rollers, planes, guides and
meshes.
GROUND (-1) stands for the fixed world.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints

GROUND = -1
# A contact that goes from touching to too deep in fewer than so many steps may be held by finer ones.
FEW_STEPS = 4
AXES = ("x", "y", "z")


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
    inertia: Floats  # principal, body axes [g mm^2], (n, 3)
    velocity: Floats  # [mm/ms], (n, 3)
    spin: Floats  # angular velocity, global axes [rad/ms], (n, 3)
    fixed: NDArray[np.bool_]  # held: clamped boxes; planes, guides and meshes that move with nothing, (n,)
    half: Floats  # half lengths of a box, body axes; zero for rollers, guides and meshes [mm], (n, 3)
    exposed: NDArray[np.bool_]  # side faces that no neighbour covers: x_min, x_max, y_min, y_max, (n, 4)
    friction: Floats  # friction of its contacts in times that of the contact, (n,)


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
    frames: Ints  # of the two sides, see Frames, (n, 2)

    def __len__(self) -> int:
        return len(self.name)


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
    energy: Floats  # of a unit volume, up to the point [N/mm^2]
    rise: Floats  # slope beyond the last point [MPa], (curves,)
    linear: NDArray[np.bool_]  # whether a joint may go there; else the run ends, (curves,)
    of: Ints  # curve of each bushing, -1: none, (bushings,)
    axis: Ints  # axis of the bushing that follows it, 0: x, 1: y, (bushings,)
    length: Floats  # [mm], (bushings,)
    area: Floats  # [mm^2], (bushings,)

    def __len__(self) -> int:
        return len(self.name)


@dataclass(frozen=True)
class Clamp:
    """A held edge: rows of boxes behind the line, and the half-cell hinges on it."""

    edge: str
    rows: int


@dataclass(frozen=True)
class ZonePart(Frozen):
    """A part of a sheet that is unlike the rest; see the spec for what the factors mean."""

    name: str
    share: Floats  # of each box that it covers, (boxes,)
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
    stiffness: float  # of its joints in bending, in times that of the sheet


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
    axis: int  # that is bent, 0: x, 1: y, -1: dog-ears
    radius: float  # of the curl [mm], inf: none
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
    lines_x: Floats  # where the lines between boxes are, from the sheet's centre [mm], (n_x + 1,)
    lines_y: Floats  # (n_y + 1,)
    graded: tuple[bool, bool]  # whether the lengths along x, along y are given box by box
    zones: tuple[ZonePart, ...]
    bend: Bend | None
    thickness: float
    size: tuple[float, float]
    layout: str
    grid: str
    center: Floats  # (3,)
    angles: tuple[float, float, float]  # about the global x, then y, then z axis [rad]
    rotation: Floats  # (3, 3)
    velocity: Floats
    spin: Floats
    surface: bool
    clamp: Clamp | None
    bending: tuple[str, str]  # which of (k_tx, D_cd) and of (k_ty, D_md) the user gave
    twist: bool  # whether joints have a twist of their own: D_twist was given, or layout plate
    in_plane: bool  # whether k_tz was given
    rotation_damping: str  # inertia or paper, with a ratio (Eq. 7); time: Kelvin and Voigt's
    derived: dict[str, float]
    damping_times: tuple[float, float] | None = None  # of MD and CD [ms]; None: by a ratio

    @property
    def count(self) -> int:
        return self.n_x * self.n_y

    @property
    def thick(self) -> Floats:
        """Thickness of each box [mm], (n_x n_y,)."""
        return thick_of(self.thickness, self.zones, self.count)

    @property
    def uniform(self) -> bool:
        """Whether all boxes, and all joints of one kind, are alike."""
        return not any(self.graded) and not self.zones and not (self.bend is not None and self.bend.creases)

    @property
    def outline(self) -> tuple[float, float]:
        """Lengths of all boxes along x and along y [mm]."""
        return float(self.lines_x[-1] - self.lines_x[0]), float(self.lines_y[-1] - self.lines_y[0])

    def body(self, i: int, j: int) -> int:
        """Body of the box in column i (along x) and row j (along y)."""
        return self.first + i + j * self.n_x


@dataclass(frozen=True)
class Press(Frozen):
    """Slide and spring of a pressed roller or plate; lengths along `direction` from the centre as given."""

    direction: Floats  # unit vector, (3,)
    stiffness: float  # [N/mm]
    damping: float  # [N ms/mm]
    damping_ratio: float
    preload: float  # spring force at the free length [N]
    free_length: float  # [mm]
    carrier_mass: float  # [g]
    touch: float  # where the spring has its free length [mm]
    start: float  # static equilibrium at the start [mm]


@dataclass(frozen=True)
class OneWay:
    """A clutch that lets a roller turn freely in one sense, against ground or the shaft that drives it."""

    direction: int  # sense about the axis that is free, 1 or -1
    torque: float  # which it takes at the creep [N mm]
    creep: float  # [rad/ms]


@dataclass(frozen=True)
class ArmPart(Frozen):
    """An arm that carries a roller, turning about an axis parallel to the roller's through the pivot."""

    pivot: Floats  # [mm], (3,)
    center: Floats  # of its mass as the run begins [mm], (3,)
    mass: float  # without the roller [g]
    inertia: float  # about its centre of mass, along the axis [g mm^2]
    torque: float  # of its spring as the run begins [N mm]
    stiffness: float  # [N mm/rad]
    damping: float  # [N mm ms/rad]
    sprung: bool  # whether it has a spring or damping


@dataclass(frozen=True)
class RimPart(Frozen):
    """The round of a roller in sectors, the gaps between the given ones included; angles [rad] about the
    axis from the x axis of its body, as the run begins. Each ends where the next begins, the last a whole
    turn after the first one's beginning."""

    name: tuple[str, ...]  # s0, ... those that are given; g0, ... what is behind the sector of that number
    begin: Floats  # increasing, (n,)
    end: Floats
    radius: Floats  # [mm]
    friction: Floats  # in times that of a contact
    stiffness: Floats
    restitution: Floats  # nan: that of a contact
    own: tuple[bool, ...]  # whether the radius is given, and not the roller's
    blend: float  # [rad]
    facets: tuple[int, ...]  # boxes by which a text shows each

    def __len__(self) -> int:
        return len(self.name)


@dataclass(frozen=True)
class RollerPart(Frozen):
    """A cylinder; `center` is as the user gave it, the body's position includes `press.start`."""

    name: str
    body: int
    center: Floats  # (3,)
    axis: Floats  # unit vector, (3,)
    radius: float
    width: float
    mass: float
    inertia_axial: float  # [g mm^2]
    inertia_transverse: float
    speed: float | None  # prescribed [rad/ms], of a profile the greatest in size; None: free to turn
    ramp: float  # [ms]
    profile: Floats | None  # corners as given: time [ms], speed [rad/ms], (n, 2); None: speed and ramp
    one_way: OneWay | None  # with a drive: the speed is that of the shaft, which the roller may overrun
    press: Press | None
    carried: tuple[float, float] = (0.0, 0.0)  # mass [g] and inertia about the axis [g mm^2] of what is on it
    rim: RimPart | None = None
    arm: ArmPart | None = None

    @property
    def swung_inertia(self) -> float:
        """Inertia of all that turns with its arm about the pivot [g mm^2]: a free roller does not turn."""
        assert self.arm is not None, "asked only of a roller on an arm"
        total = self.arm.inertia + (self.inertia_axial if self.speed is not None else 0.0)
        for mass, at in ((self.arm.mass, self.arm.center), (self.mass, self.center)):
            way = np.cross(self.axis, at - self.arm.pivot)
            total += mass * float(way @ way)
        return total

    @property
    def reach(self) -> float:
        """The greatest radius [mm]."""
        return self.radius if self.rim is None else float(self.rim.radius.max())

    @property
    def turns(self) -> bool:
        """Whether its spin is unknown: a free one, or one with a clutch."""
        return self.speed is None or self.one_way is not None

    @property
    def corners(self) -> Floats:
        """Corners of the prescribed speed, linear between and constant beyond, (n, 2); (0, 2) without one."""
        if self.profile is not None:
            return self.profile
        if self.speed is None:
            return np.zeros((0, 2))
        return np.array([[0.0, 0.0], [self.ramp, self.speed]][self.ramp <= 0.0 :])

    def prescribed(self, time: Floats | float) -> Floats:
        """Speed [rad/ms] at times [ms] of a driven roller."""
        corners = self.corners
        return np.asarray(np.interp(time, corners[:, 0], corners[:, 1]))

    def turned(self, time: Floats) -> Floats:
        """Angle [rad] by which a driven roller has turned at increasing times [ms] from 0 on."""
        grid = np.array(sorted({0.0, *time.tolist(), *self.corners[:, 0].tolist()}))
        speed = self.prescribed(grid)
        angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(grid))])
        return angle[np.searchsorted(grid, time)]


@dataclass(frozen=True)
class PlanePart(Frozen):
    """A plate, fixed or pressed; local axes in the columns of the body's rotation, z = normal. `center` is as
    the user gave it, the body's position includes `press.start`."""

    name: str
    body: int
    center: Floats
    normal: Floats
    size: tuple[float, float, float]
    mass: float
    press: Press | None = None
    edges: tuple[float, float] = (0.0, 0.0)  # radii of the edges of its upper and its lower face [mm]
    ends: int = 0  # its free ends as a bit mask, see model.ends

    @property
    def sliding_mass(self) -> float:
        """Mass of all that moves with it [g]."""
        return self.mass + (0.0 if self.press is None else self.press.carrier_mass)

    @property
    def travel(self) -> Floats:
        """How far it may go along each global axis, either way: by the length of its spring [mm], (3,)."""
        return np.zeros(3) if self.press is None else self.press.free_length * np.abs(self.press.direction)


@dataclass(frozen=True)
class GuidePart(Frozen):
    """A fixed plate, straight or bent to an arc. Of its axes z is along the width; x is along a line and y
    its normal, and the angles of an arc turn from x to y."""

    name: str
    body: int
    center: Floats  # middle of a line, or on the axis of an arc [mm], (3,)
    axes: Floats  # in columns; those of its body, too, (3, 3)
    radius: float  # of the face, or of the middle where both sides are touched; 0: a line [mm]
    middle: float  # angle of the middle of an arc [rad]
    half_angle: float
    length: float  # of a line [mm]
    width: float
    thickness: float
    sides: int  # that are touched: 1 left of a line or inside of an arc, 2 the other, 3 both
    side: str
    mass: float
    facets: int  # boxes by which a text shows it
    edges: tuple[float, float] = (0.0, 0.0)  # radii of the edges of its upper and its lower face [mm]
    ends: int = 0  # its free ends as a bit mask, see model.ends


@dataclass(frozen=True)
class MeshPart(Frozen):
    """A closed surface of triangles, fixed or on a roller. Its body has the axes of its inertia, and its
    centre is the middle of its mass."""

    name: str
    body: int
    file: str
    scale: float  # of the file's numbers to mm
    at: str  # nodes or centres
    on: int  # index of the roller that it moves with, -1: fixed
    center: Floats  # of the file's axes; with a pressed roller as given, before that slides [mm], (3,)
    angles: tuple[float, float, float]  # about the global x, then y, then z axis [rad]
    axes: Floats  # of the file, in columns, (3, 3)
    corners: Floats  # file axes, counter-clockwise as seen from outside [mm], (n, 3)
    triangles: Ints  # corners of each, (m, 3)
    flat: int  # triangles with two corners in one place, which are left out
    volume: float  # [mm^3]
    middle: Floats  # of the mass, file axes [mm], (3,)
    principal: Floats  # axes of the inertia, file axes, in columns, (3, 3)
    gyration: Floats  # inertia about them over mass [mm^2], (3,)
    mass: float
    density: float | None  # that the user gave in place of the mass [g/mm^3]
    edge_radius: float = 0.0  # that outer sides of sheets meet at its edges [mm]


@dataclass(frozen=True)
class ExternalPart:
    """A body of the user's own MotionView model. It has no row in Bodies, since its mass is not known."""

    name: str
    body: str  # variable there, or a path of variables
    graphics: tuple[str, ...]


# kinds of contact
BOX_CYLINDER, BOX_PLANE, CYLINDER_CYLINDER, EXTERNAL, BOX_GUIDE, BOX_BOX, BOX_MESH = 0, 1, 2, 3, 4, 5, 6
CYLINDER_PLANE, CYLINDER_GUIDE, CYLINDER_MESH = 7, 8, 9
# those of a roller with a part that it does not turn with, and all between parts of the machine
ON_PARTS = (CYLINDER_PLANE, CYLINDER_GUIDE, CYLINDER_MESH)
OF_MACHINE = (CYLINDER_CYLINDER, *ON_PARTS)
# those of a sheet with a plate that has ends
ON_PLATES = (BOX_PLANE, BOX_GUIDE)


@dataclass(frozen=True)
class Contacts(Frozen):
    """One row per pair of parts in contact."""

    entry: Ints  # index in the spec's list, (n,)
    part_a: tuple[str, ...]  # sheet or roller
    part_b: tuple[str, ...]  # sheet, roller, plane, guide, mesh or external part
    kind: Ints  # one of the kinds above, BOX_CYLINDER to CYLINDER_MESH
    stiffness: Floats  # k [N/mm^1.5]
    restitution: Floats  # c_R
    mu_static: Floats
    mu_dynamic: Floats
    stiction_velocity: Floats  # [mm/ms]
    friction_velocity: Floats
    smoothing: Floats  # [mm/ms]
    rolling: Floats  # coefficient of rolling resistance
    share: tuple[str, ...]  # width or pair
    name: tuple[str, ...] = ()  # of the entries that have one, "" of others; none where no entry has

    def __len__(self) -> int:
        return len(self.part_a)

    def called(self, row: int) -> str:
        """What a user calls the entry of a row: its name, or its index in the list."""
        return (self.name[row] if self.name else "") or str(self.entry[row])

    @property
    def of_machine(self) -> NDArray[np.bool_]:
        """Whether both parts are of the machine, (n,)."""
        return np.isin(self.kind, OF_MACHINE)


@dataclass(frozen=True)
class Pairs(Frozen):
    """Body pairs that may touch, and the bounds from which that was decided."""

    contact: Ints  # row of Contacts, (n,)
    a: Ints  # box or roller, (n,)
    b: Ints  # roller, plane, guide, mesh or box of another sheet, (n,)
    possible: int
    margin: float  # [mm]
    low: Floats  # bounds of the centres of boxes and what is pressed, -inf: not watched [mm], (bodies, 3)
    high: Floats
    searched: Ints  # rows of Contacts between two sheets that can meet in too many pairs to list, (rows,)

    def __len__(self) -> int:
        return len(self.a)


@dataclass(frozen=True)
class ExternalPairs(Frozen):
    """Boxes and the external parts that they may touch; all there are, since none can be left out."""

    contact: Ints  # row of Contacts, (n,)
    box: Ints  # body, (n,)
    part: Ints  # index in Model.externals, (n,)

    def __len__(self) -> int:
        return len(self.box)


@dataclass(frozen=True)
class Anchor(Frozen):
    """A material point of a sheet: the mean of points on one or more boxes."""

    name: str
    sheet: int
    body: Ints  # (n,)
    local: Floats  # box axes [mm], (n, 3)
    share: Floats  # sums to 1, (n,)
    node: Ints  # nearest grid node as in Bushings.node; for the text
    at: tuple[float, float]  # sheet axes, from the centre [mm]
    edge: str | None
    formulas: tuple[str, str] = ("", "")  # of `at`, as of a Parameter


@dataclass(frozen=True)
class Loads(Frozen):
    """Dead loads on bodies, global axes: a force at a point fixed in the body, and a moment."""

    body: Ints  # (n,)
    local: Floats  # (n, 3)
    force: Floats  # [N], (n, 3)
    moment: Floats  # [N mm], (n, 3)


@dataclass(frozen=True)
class Tension:
    """A clamped sheet that is pulled at the opposite edge."""

    sheet: int
    axis: int  # of the pull, 0: x, 1: y
    length: float  # sum of the joint lengths [mm]


@dataclass(frozen=True)
class Parameter:
    """A value that the user gave, by the name under which the text is written in it."""

    data_set: str  # identifier without the ds_ prefix
    member: str  # identifier without the real_ prefix
    label: str
    value: float  # internal units
    unit: str  # internal unit, as the user may write it
    path: tuple[str | int, ...] | None  # where it stands in the spec; None: computed
    formula: str = ""  # over the parameters of the scene, as the user wrote it; "": a number


@dataclass(frozen=True)
class RunSettings:
    """How the Model is run; times in ms."""

    duration: float
    analysis: str
    step: float | None
    tolerance: float
    print_step: float
    symmetry: bool  # a scene that is its own mirror image may be halved


@dataclass(frozen=True)
class Model(Frozen):
    """A scene in plain tables."""

    name: str
    gravity: Floats  # [mm/ms^2], (3,)
    sheets: tuple[SheetPart, ...]
    rollers: tuple[RollerPart, ...]
    planes: tuple[PlanePart, ...]
    guides: tuple[GuidePart, ...]
    meshes: tuple[MeshPart, ...]
    externals: tuple[ExternalPart, ...]  # a Model that has one is not run here
    bodies: Bodies
    bushings: Bushings
    curves: Curves
    contacts: Contacts
    pairs: Pairs
    external_pairs: ExternalPairs
    loads: Loads
    probes: tuple[Anchor, ...]
    supports: tuple[Anchor, ...]  # named support_0, ... as the bushings that hold them
    tension: Tension | None
    parameters: tuple[Parameter, ...]
    run: RunSettings
    unfollowed: tuple[tuple[str, str], ...] = ()  # formulas of what is no Parameter: places, texts
    following: tuple[int, ...] = ()  # entries of the contacts whose smoothing follows from the speeds

    def __repr__(self) -> str:
        kinds = ("sheets", "rollers", "planes", "guides", "bushings", "contacts")
        message = ", ".join(
            f"{len(getattr(self, kind))} {kind}" for kind in kinds if len(getattr(self, kind))
        )
        return f"<Model {self.name}: {len(self.bodies.name)} bodies, {message}>"

    @property
    def machine(self) -> tuple[RollerPart | PlanePart | GuidePart | MeshPart, ...]:
        """All parts of the machine, as their bodies are numbered."""
        return (*self.rollers, *self.planes, *self.guides, *self.meshes)

    def roller(self, name: str) -> RollerPart:
        return next(r for r in self.rollers if r.name == name)

    @property
    def plates(self) -> list[tuple[PlanePart, Press]]:
        """The planes that springs press, and their presses."""
        return [(plane, plane.press) for plane in self.planes if plane.press is not None]

    @property
    def pair_friction(self) -> Floats:
        """Friction of each kept pair in times that of its contact, (pairs,)."""
        return self.bodies.friction[self.pairs.a] * self.bodies.friction[self.pairs.b]

    def mass_share(self, sheet: int) -> Floats:
        """Mass of each box of a sheet over that of the sheet, (boxes,): weights of its centre of mass."""
        part = self.sheets[sheet]
        mass = self.bodies.mass[part.first : part.first + part.count]
        return mass / mass.sum()

    def called(self, body: int) -> str:
        """What a roller, a plane, a guide, a mesh or a box is called in a sentence."""
        kinds = {g.body: "guide" for g in self.guides} | {m.body: "mesh" for m in self.meshes}
        kinds |= {r.body: "roller" for r in self.rollers}
        kind = "box" if self.sheet_of(body) else kinds.get(body, "plane")
        return f"{kind} {self.bodies.name[body]}"

    def too_deep(self, one: int, other: int) -> str:
        """What is said of a box or a roller that is too deep in another part."""
        rollers = {roller.body for roller in self.rollers}
        if {one, other} <= rollers:
            return f"{self.called(one)} and {self.called(other)} overlap by more than the smaller radius"
        size = "radius" if rollers & {one, other} else "thickness"
        return f"{self.called(one)} is more than half of its {size} into {self.called(other)}"

    def held_by(self, one: int, way: float) -> str:
        """What would hold a body that is too deep in another one and comes nearer by `way` [mm] in a step: a
        finer step only where a few of its steps are that deep."""
        sheet = self.sheet_of(one)
        finer = sheet is None or way > 0.5 * sheet.thickness / FEW_STEPS
        if finer:
            return "a stiffer contact or a smaller run.step would hold it"
        return "a stiffer contact would hold it, a smaller run.step would not"

    def bounds_of(self, body: int) -> tuple[str, str]:
        """What the bounds of a body are, and what to do where it has left them."""
        for plate, press in self.plates:
            if plate.body == body:
                return (
                    f"the length of its spring, {press.free_length:g} mm either way",
                    "give a stiffness, preload or free_length that hold it",
                )
        return (
            "the bounds from which its contacts were chosen",
            f"set run.prune: false, or a run.margin above {self.pairs.margin:g} mm",
        )

    def sheet_of(self, body: int) -> SheetPart | None:
        """The sheet that a body is a box of, or None."""
        return next((s for s in self.sheets if s.first <= body < s.first + s.count), None)
