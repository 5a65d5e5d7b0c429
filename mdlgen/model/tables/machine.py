"""Parts of the machine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.axle import FREE, AxlePart
from mdlgen.model.tables.bodies import Frozen
from mdlgen.model.tables.moving import MovingPart, StopsPart


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
    touch: float  # place where the spring has its free length [mm]
    start: float  # place in static equilibrium at the start, or the user's start [mm]
    begins: float | None = None  # start from `touch`, if the user gave it [mm]; None: in balance
    speed: float = 0.0  # speed along `direction` as the run begins [mm/ms]
    balance: float | None = None  # place in static equilibrium, where the run does not begin there [mm]
    stops: StopsPart | None = None  # stops, from the centre as given

    @property
    def off(self) -> float:
        """Distance of its start from its balance [mm]."""
        return 0.0 if self.balance is None else abs(self.start - self.balance)


@dataclass(frozen=True)
class OneWay:
    """A clutch that lets a roller turn freely in one sense, against ground or the shaft that drives it."""

    direction: int  # sense about the axis that is free, 1 or -1
    torque: float  # torque that it takes at the creep [N mm]
    creep: float  # [rad/ms]


@dataclass(frozen=True)
class ArmPart(Frozen):
    """An arm that carries a roller, turning about an axis parallel to the roller's through the pivot."""

    pivot: Floats  # point of its axis [mm], (3,)
    center: Floats  # centre of its mass as the run begins [mm], (3,)
    mass: float  # mass without the roller [g]
    inertia: float  # inertia about its centre of mass, along the axis [g mm^2]
    torque: float  # torque of its spring as the run begins [N mm]
    stiffness: float  # [N mm/rad]
    damping: float  # [N mm ms/rad]
    sprung: bool  # true if it has a spring or damping
    angle: float = 0.0  # turn as the run begins, from the roller's centre as given [rad]
    speed: float = 0.0  # angular velocity as the run begins [rad/ms]
    stops: StopsPart | None = None  # stops, from the roller's centre as given


@dataclass(frozen=True)
class RimPart(Frozen):
    """The round of a roller in sectors, the gaps between the given ones included; angles [rad] about the
    axis from the x axis of its body, as the run begins. Each ends where the next begins, the last a whole
    turn after the first one's beginning."""

    name: tuple[str, ...]  # s0, ... those that are given; g0, ... the gap behind the sector of that number
    begin: Floats  # angles at which sectors begin, increasing, (n,)
    end: Floats
    radius: Floats  # [mm]
    friction: Floats  # friction relative to that of a contact
    stiffness: Floats
    restitution: Floats  # restitution; nan: that of a contact
    own: tuple[bool, ...]  # true if the radius is given, and not the roller's
    blend: float  # [rad]
    facets: tuple[int, ...]  # number of boxes by which a text shows each sector

    def __len__(self) -> int:
        return len(self.name)


@dataclass(frozen=True)
class CoverPart:
    """A cover of rubber or foam on a roller, and the nip that it makes under one force (see model.covers)."""

    thickness: float  # [mm]
    modulus: float  # Young's modulus [MPa]
    poisson: float
    hardness: float | None  # hardness in degrees of Shore A that the modulus follows from
    other: str  # name of the roller that faces it, "": a flat face
    force: float  # force of the nip [N]
    width: float  # width of the nip along the axis [mm]
    half: float  # half-width of the nip across it [mm]
    pressure: float  # greatest pressure [MPa]
    depth: float  # depth of the other surface in the cover [mm]
    gain: float  # gain v/(omega R) - 1 of a sheet on it
    bend: float  # of the gain that a run has, (gain - bend) u + bend u^2, u the depth over that at the force
    misfit: float  # error of the law k z^1.5 from half to twice the force, relative to the force of the layer
    gain_misfit: float  # greatest error of the law of the gain there


@dataclass(frozen=True)
class MachinePart(Frozen):
    """A part of the machine that has a body, of any kind."""

    kind: ClassVar[str]  # word for one in a sentence
    name: str
    body: int  # its row in Bodies
    center: Floats  # centre as the user gave it, before a spring moves it [mm], (3,)

    @property
    def round(self) -> tuple[float, float] | None:
        """Radius and width of what its contacts take for round [mm]; None: it is not."""
        return None


@dataclass(frozen=True)
class RollerPart(MachinePart):
    """A cylinder; `center` is as the user gave it, the body's position includes `press.start`."""

    kind: ClassVar[str] = "roller"
    axis: Floats  # unit vector, (3,)
    radius: float
    width: float
    mass: float
    inertia_axial: float  # [g mm^2]
    inertia_transverse: float
    speed: float | None  # prescribed speed [rad/ms], of a profile the greatest in size; None: free to turn
    ramp: float  # [ms]
    profile: Floats | None  # corners as given: time [ms], speed [rad/ms], (n, 2); None: speed and ramp
    one_way: OneWay | None  # with a drive: the speed is that of the shaft, which the roller may overrun
    press: Press | None
    carried: tuple[float, float] = (0.0, 0.0)  # mass [g] and inertia about the axis [g mm^2] of meshes on it
    rim: RimPart | None = None
    arm: ArmPart | None = None
    cover: CoverPart | None = None
    axle: AxlePart | None = None  # with a motor, and behind it: the speed is the one that it aims at
    leader: int = -1  # body of the roller that leads its shaft, -1: it turns by itself, or leads
    ratio: float = 1.0  # number of its turns for one turn of the leader
    spin: float = 0.0  # initial spin of a roller without a drive [rad/ms]

    @property
    def loaded_mass(self) -> float:
        """Mass of the roller and of the meshes on it [g]."""
        mass, _ = self.carried
        return self.mass + mass

    @property
    def loaded_inertia(self) -> float:
        """Inertia about the axis of the roller and of the meshes on it [g mm^2]."""
        _, inertia = self.carried
        return self.inertia_axial + inertia

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
    def swung_length(self) -> float:
        """Distance of its axis from the pivot of its arm [mm]."""
        assert self.arm is not None, "asked only of a roller on an arm"
        return float(np.linalg.norm(np.cross(self.axis, self.center - self.arm.pivot)))

    @property
    def round(self) -> tuple[float, float]:
        return self.reach, self.width

    @property
    def reach(self) -> float:
        """The greatest radius [mm]."""
        return self.radius if self.rim is None else float(self.rim.radius.max())

    @property
    def turns(self) -> bool:
        """True if its spin is unknown: it is free, has a clutch, a motor or a limiter, or follows another one
        on its shaft."""
        coupled = self.one_way is not None or self.axle is not None or self.leader >= 0
        return self.speed is None or coupled

    @property
    def driven(self) -> bool:
        """True if a drive, a motor or a limiter exerts a torque on it. The torque of a roller that follows
        another one on a shaft counts at that one."""
        limited = self.axle is not None and self.axle.kind != FREE
        return self.leader < 0 and (self.speed is not None or limited)

    @property
    def begins_turning(self) -> bool:
        """True if it begins with the speed of the shaft that a clutch or a limiter couples it to."""
        return self.speed is not None and self.turns and not self.motor and self.leader < 0

    @property
    def first_spin(self) -> float:
        """Its spin as the run begins, where nothing prescribes it [rad/ms]: its own, or its shaft's."""
        return float(self.prescribed(0.0)) if self.begins_turning else self.spin

    @property
    def motor(self) -> bool:
        """True if a motor turns it, whose torque is limited."""
        return self.axle is not None and self.axle.motor

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
class PlanePart(MachinePart):
    """A plate, fixed, pressed or moved; local axes in the columns of the body's rotation, z = normal.
    `center` is as the user gave it, the body's position includes `press.start`."""

    kind: ClassVar[str] = "plane"
    normal: Floats
    size: tuple[float, float, float]
    mass: float
    press: Press | None = None
    edges: tuple[float, float] = (0.0, 0.0)  # radii of the edges of its upper and its lower face [mm]
    ends: int = 0  # its free ends as a bit mask, see model.ends
    moving: MovingPart | None = None

    @property
    def sliding_mass(self) -> float:
        """Mass of all that moves with it [g]."""
        return self.mass + (0.0 if self.press is None else self.press.carrier_mass)

    @property
    def travel(self) -> Floats:
        """Largest displacement along each global axis, either way: the length of its spring [mm], (3,)."""
        return np.zeros(3) if self.press is None else self.press.free_length * np.abs(self.press.direction)


@dataclass(frozen=True)
class GuidePart(MachinePart):
    """A plate, straight or bent to an arc; its centre is the middle of a line, or on an arc's axis. Its z
    axis is along the width. Along a line x points and y is its normal; the angles of an arc turn from x to
    y."""

    kind: ClassVar[str] = "guide"
    axes: Floats  # axes in columns; those of its body, too, (3, 3)
    radius: float  # radius of the face, or of the middle where both sides are touched; 0: a line [mm]
    middle: float  # angle of the middle of an arc [rad]
    half_angle: float
    length: float  # length of a line [mm]
    width: float
    thickness: float
    sides: int  # touched sides: 1 left of a line or inside of an arc, 2 the other, 3 both
    side: str
    mass: float
    facets: int  # number of boxes by which a text shows it
    edges: tuple[float, float] = (0.0, 0.0)  # radii of the edges of its upper and its lower face [mm]
    ends: int = 0  # its free ends as a bit mask, see model.ends
    moving: MovingPart | None = None


@dataclass(frozen=True)
class MeshPart(MachinePart):
    """A closed surface of triangles, fixed, moved or on a roller. Its body has the axes of its inertia, and
    stands at the middle of its mass; `center` is the origin of the file's axes."""

    kind: ClassVar[str] = "mesh"
    file: str
    scale: float  # factor from the file's numbers to mm
    at: str  # nodes or centres
    on: int  # index of the roller that it moves with, -1: fixed
    angles: tuple[float, float, float]  # angles about the global x, then y, then z axis [rad]
    axes: Floats  # axes of the file, in columns, (3, 3)
    corners: Floats  # corners in file axes, counter-clockwise as seen from outside [mm], (n, 3)
    triangles: Ints  # corners of each triangle, (m, 3)
    flat: int  # number of triangles with two corners in one place, which are left out
    volume: float  # [mm^3]
    middle: Floats  # centre of mass, file axes [mm], (3,)
    principal: Floats  # axes of the inertia, file axes, in columns, (3, 3)
    gyration: Floats  # inertia about them over mass [mm^2], (3,)
    mass: float
    density: float | None  # density that the user gave in place of the mass [g/mm^3]
    edge_radius: float = 0.0  # radius with which outer sides of sheets meet its edges [mm]
    moving: MovingPart | None = None


@dataclass(frozen=True)
class ExternalPart:
    """A body of the user's own MotionView model. It has no row in Bodies, since its mass is not known."""

    name: str
    body: str  # variable there, or a path of variables
    graphics: tuple[str, ...]
