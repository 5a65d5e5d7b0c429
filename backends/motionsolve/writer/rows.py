"""Plain rows for the templates: names, labels, ids, and numbers as text in the units of the deck."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from mdlgen.altair import refinement
from mdlgen.backends.motionsolve.writer.units import Triple

Cosines = tuple[str, str, str, str, str, str]


class Marker(NamedTuple):
    """A place with axes on a body."""

    name: str
    label: str
    id: int
    body: int
    at: Triple | None  # None: the global origin
    axes: Cosines | None  # X, then Z; None: along the global axes


class Body(NamedTuple):
    """A rigid body; `cm` also gives the axes of its inertia."""

    name: str
    label: str
    id: int
    cm: int
    lprf: int
    mass: str
    inertia: Triple  # principal
    velocity: tuple[str, ...] | None  # vx, vy, vz, wx, wy, wz; None: not given


class Joint(NamedTuple):
    """A joint between two markers."""

    name: str
    label: str
    id: int
    type: str
    i: int
    j: int


class Motion(NamedTuple):
    """A prescribed velocity, or a displacement, of a joint."""

    name: str
    label: str
    id: int
    expression: str
    joint: int
    of: str = "V"  # velocity, D: displacement
    freedom: str = "R"  # rotation, T: translation


class Bushing(NamedTuple):
    """Six springs and dampers between two markers."""

    name: str
    label: str
    id: int
    i: int
    j: int


class BushingGroup(NamedTuple):
    """Bushings with the same values: (axis, stiffness, damping, preload) for x, y, z, tx, ty, tz."""

    values: tuple[tuple[str, str, str, str], ...]
    bushings: list[Bushing]


class Spline(NamedTuple):
    """A curve of force over elongation: (x, y)."""

    name: str
    label: str
    id: int
    points: list[tuple[str, str]]


class CurvedSpring(NamedTuple):
    """The force of a bushing that follows a curve: marker i, a floating one on the other body, axes of j."""

    name: str
    label: str
    id: int
    i: int
    floating: int
    j: int
    force: Triple


class Spring(NamedTuple):
    """A spring and damper along the line between two markers, which pushes with `force` at `length`."""

    name: str
    label: str
    id: int
    i: int
    j: int
    stiffness: str
    damping: str
    force: str
    length: str


class Load(NamedTuple):
    """A force and a moment in global axes on a marker."""

    name: str
    label: str
    id: int
    marker: int
    force: Triple
    moment: Triple


class Clutch(NamedTuple):
    """A torque on a body at a marker, about the z axis of another one, which lies along its joint; or a force
    along that."""

    name: str
    label: str
    id: int
    marker: int
    along: int
    torque: str
    force: str = "0"


class Solid(NamedTuple):
    """A solid on a marker, which is its centre or where it starts: the schema's word for it, and its sizes by
    their attributes."""

    name: str
    label: str
    id: int
    marker: int
    type: str
    sizes: dict[str, str]
    refinement: int


class Shell(NamedTuple):
    """Triangles on a marker: corners, and their numbers from 0 on for each."""

    name: str
    label: str
    id: int
    marker: int
    corners: list[Triple]
    triangles: list[list[int]]


class Law(NamedTuple):
    """The numbers of a contact; `friction` is None, or mu static, mu dynamic and their two slip speeds."""

    penalty: str
    restitution: str
    smoothing: str
    friction: tuple[str, str, str, str] | None


class ContactRow(NamedTuple):
    """A contact of two graphics."""

    name: str
    label: str
    id: int
    i: int
    j: tuple[int, ...]
    law: Law
    master: str  # I or J; empty: the solver chooses


class Surface(NamedTuple):
    """A surface through the origins of markers."""

    name: str
    label: str
    id: int
    graphic: int
    markers: list[list[int]]


class Request(NamedTuple):
    """Six solver expressions to be recorded."""

    name: str
    label: str
    id: int
    expressions: list[str]


class Run(NamedTuple):
    """The analysis; times in s."""

    static: bool
    method: str  # of a static analysis
    end: str
    print: str
    h_max: str
    h_min: str


@dataclass
class Deck:
    """Everything that the main template loops over."""

    gravity: Triple
    run: Run
    markers: list[Marker] = field(default_factory=list)
    bodies: list[Body] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    springs: list[Spring] = field(default_factory=list)
    bushing_groups: list[BushingGroup] = field(default_factory=list)
    splines: list[Spline] = field(default_factory=list)
    curved: list[CurvedSpring] = field(default_factory=list)
    loads: list[Load] = field(default_factory=list)
    clutches: list[Clutch] = field(default_factory=list)
    contacts: list[ContactRow] = field(default_factory=list)
    surfaces: list[Surface] = field(default_factory=list)
    requests: list[Request] = field(default_factory=list)
    solids: list[Solid] = field(default_factory=list)
    shells: list[Shell] = field(default_factory=list)

    def marker(self, name: str, label: str, body: int, at: Triple | None, axes: Cosines | None = None) -> int:
        """Adds a marker and returns its id."""
        id = len(self.markers) + 1
        self.markers.append(Marker(name, label, id, body, at, axes))
        return id

    def box(self, name: str, label: str, id: int, marker: int, lengths: Triple) -> None:
        """Adds a box round a marker."""
        sizes = {f"length_{axis}": length for axis, length in zip("xyz", lengths, strict=True)}
        self.solids.append(Solid(name, label, id, marker, "BoxDefinedFromCenter", sizes, refinement.BOX))

    def joint(self, name: str, label: str, type: str, i: int, j: int) -> int:
        """Adds a joint and returns its id."""
        id = len(self.joints) + 1
        self.joints.append(Joint(name, label, id, type, i, j))
        return id

    def request(self, name: str, label: str, expressions: list[str]) -> None:
        """Adds a request."""
        self.requests.append(Request(name, label, len(self.requests) + 1, expressions))
