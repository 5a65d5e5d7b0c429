"""The Model as arrays in SI units, in the order in which the solver numbers its coordinates.

A free box has seven coordinates (position, Euler parameters); a free roller one for its spin; a pressed
roller or plate one for its slide. Everything else is prescribed. Row -1 of the body arrays is the ground.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.exudyn_local.state import Tables
from mdlgen.errors import RefusedError
from mdlgen.mechanics.arm import ARM, AXIAL, PRESS, arm
from mdlgen.mechanics.curve import FOLLOWS, curve_points, follow
from mdlgen.mechanics.driven import DRIVEN, drive
from mdlgen.mechanics.edge import ENDS
from mdlgen.mechanics.frame import LAW, LAW_DYNAMIC, LAW_STATIC
from mdlgen.mechanics.laws import damping_share
from mdlgen.mechanics.mesh import Meshes, mesh_numbers, mesh_tables
from mdlgen.mechanics.rim import RIM, rim
from mdlgen.model.meshes import check_balance
from mdlgen.model.rotations import euler_parameters, matrices
from mdlgen.model.tables import Floats, Ints, Model

MM, G, MS = 1e-3, 1e-3, 1e-3
PER_MM, PER_MS = 1e3, 1e3
# N/mm^1.5 in N/m^1.5
HERTZ = 1e3**1.5
PA = 1e6  # of 1 MPa


BODY = np.dtype(
    [
        ("reference", "f8", 7),  # position [m], Euler parameters
        ("mass", "f8"),  # [kg]
        ("inertia", "f8", 3),  # [kg m^2]
        ("half", "f8", 3),  # half lengths of a box, or of a guide's length, width and thickness [m]
        ("arc", "f8", 3),  # of a guide: radius [m] (0: straight), middle angle, half angle
        ("side", "i8"),  # of a guide, that may be touched: as in mechanics.guide
        *ENDS,
        ("axis", "f8", 3),  # of a roller
        ("way", "f8", 3),  # direction of a slide
        ("press", "f8", PRESS),  # columns as in mechanics.arm
        *DRIVEN,
        ("size", "f8", 2),  # radius, of a rim the greatest, and width of a roller [m]
        ("first", "i8"),  # first of a box's 7 coordinates, -1: not free
        ("slide", "i8"),  # coordinate of the slide of a roller or a plate, -1: none
        ("spin", "i8"),  # coordinate of a roller's spin, -1: prescribed
        ("exposed", "i8"),  # side faces of a box as a bit mask
        ("carries", "i8"),  # 1: a roller with a mesh on it, whose turn is followed
        *RIM,
        *ARM,
    ]
)
BUSHING = np.dtype(
    [
        ("a", "i8"),
        ("b", "i8"),
        ("ra", "f8", 3),  # arms in body axes [m]
        ("rb", "f8", 3),
        ("fa", "f8", 9),  # frames in body axes
        ("fb", "f8", 9),
        ("k", "f8", 6),  # [N/m], [N m/rad]
        ("c", "f8", 6),
        *FOLLOWS,
    ]
)
PAIR = np.dtype(
    [
        ("kind", "i8"),
        ("a", "i8"),
        ("b", "i8"),
        ("shared", "i8"),
        ("mesh", "i8"),  # number of it
        ("beside", "i8"),  # sides of the box that stand before ends of a plate, see mechanics.edge
        ("k", "f8"),  # [N/m^1.5]
        ("law", "f8", LAW),  # columns as in mechanics.frame
    ]
)
LOAD = np.dtype([("body", "i8"), ("local", "f8", 3), ("force", "f8", 3), ("moment", "f8", 3)])


class Elements(NamedTuple):
    """What the jacobian is a sum of: blocks of bushings between bodies, pairs, slides, clutches, loads."""

    block_start: Ints  # bushings of block i: block_start[i] ... block_start[i + 1] - 1
    dofs: Ints  # coordinates of each element, concatenated
    dof_start: Ints
    slots: Ints  # where each element's entries go in the sparse data, row by row
    slot_start: Ints


class System(NamedTuple):
    """Record arrays for compiled code."""

    bodies: np.ndarray  # BODY, (n + 1,), the last is the ground
    bushings: np.ndarray  # BUSHING, sorted by block
    pairs: np.ndarray  # PAIR
    loads: np.ndarray  # LOAD
    gravity: Floats  # [m/s^2]
    elements: Elements
    free: int  # number of coordinates
    points: np.ndarray  # of the curves that bushings follow, mechanics.curve.POINT [Pa]
    meshes: Meshes  # [m]

    @property
    def tables(self) -> Tables:
        """What every kernel starts with."""
        return Tables(
            bodies=self.bodies,
            bushings=self.bushings,
            points=self.points,
            pairs=self.pairs,
            meshes=self.meshes,
            loads=self.loads,
            gravity=self.gravity,
        )


class Pattern(NamedTuple):
    """Sparsity of the jacobian (CSR)."""

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]


def check(model: Model) -> None:
    """Raises RefusedError for what this backend cannot represent."""
    check_balance(model)
    for roller in model.rollers:
        if roller.arm is not None and model.run.analysis == "static":
            raise RefusedError(
                f"exudyn: a static analysis with an arm ({roller.name}) is not there yet",
                ("rollers", roller.name, "arm"),
            )
        if roller.press is not None and abs(float(roller.press.direction @ roller.axis)) > 1e-9:
            raise RefusedError(f"roller {roller.name}: a press along its own axis is not modelled by exudyn")


def build(model: Model) -> tuple[System, Pattern]:
    """Arrays and jacobian pattern of a Model."""
    check(model)
    moving = model.run.analysis == "transient"
    bodies, free = _bodies(model, moving)
    bushings, blocks = _bushings(model)
    pairs = _pairs(model)
    loads = np.zeros(len(model.loads.body), LOAD)
    loads["body"], loads["local"] = model.loads.body, model.loads.local * MM
    loads["force"], loads["moment"] = model.loads.force, model.loads.moment * MM
    elements, pattern = _pattern(_couplings(bodies, bushings, blocks, pairs, loads), blocks, free)
    gravity = model.gravity * MM / MS**2
    points = curve_points(model.curves, PA)
    meshes = mesh_tables(model, MM)
    return System(bodies, bushings, pairs, loads, gravity, elements, free, points, meshes), pattern


def _bodies(model: Model, moving: bool) -> tuple[np.ndarray, int]:
    """Record array of the bodies, and the number of coordinates."""
    table = model.bodies
    count = len(table.name)
    bodies = np.zeros(count + 1, BODY)
    bodies["reference"][:, 3] = 1.0
    bodies["reference"][:count, :3] = table.position * MM
    bodies["reference"][:count, 3:] = euler_parameters(table.rotation)
    bodies["mass"][:count] = table.mass * G
    bodies["inertia"][:count] = table.inertia * G * MM**2
    bodies["half"][:count] = table.half * MM
    bodies["exposed"][:count] = table.exposed @ np.array([1, 2, 4, 8])
    bodies["size"] = 1.0
    for name in ("first", "slide", "spin"):
        bodies[name] = -1
    free = 0
    for sheet in model.sheets:
        for body in range(sheet.first, sheet.first + sheet.count):
            if not table.fixed[body]:
                bodies["first"][body] = free
                free += 7
    for roller in model.rollers:
        row = bodies[roller.body]
        row["axis"], row["size"] = roller.axis, (roller.reach * MM, roller.width * MM)
        rim(row, roller, MM)
        row["press"][AXIAL] = (roller.inertia_axial + roller.carried[1]) * G * MM**2
        if roller.press is not None:
            spring = roller.press
            row["way"] = spring.direction
            force = spring.preload - spring.stiffness * (spring.start - spring.touch)
            mass = (roller.mass + roller.carried[0] + spring.carrier_mass) * G
            row["press"][:AXIAL] = (spring.stiffness * PER_MM, spring.damping * MS * PER_MM, force, mass)
            row["slide"], free = free, free + 1
        if roller.arm is not None:
            arm(row, roller, MM, G, MS)
            row["slide"], free = free, free + 1
        if moving:  # in a static analysis no roller turns
            drive(row, roller, MS, MM)
            if roller.turns:
                row["spin"], free = free, free + 1
    for plate, spring in model.plates:
        row = bodies[plate.body]
        row["way"] = spring.direction
        force = spring.preload - spring.stiffness * (spring.start - spring.touch)
        mass = plate.sliding_mass * G
        row["press"][:AXIAL] = (spring.stiffness * PER_MM, spring.damping * MS * PER_MM, force, mass)
        row["slide"], free = free, free + 1
    for mesh in model.meshes:
        if mesh.on >= 0:
            bodies["carries"][model.rollers[mesh.on].body] = 1
    for guide in model.guides:
        row = bodies[guide.body]
        row["half"] = [0.5 * MM * size for size in (guide.length, guide.width, guide.thickness)]
        row["arc"], row["side"] = (guide.radius * MM, guide.middle, guide.half_angle), guide.sides
    for part in (*model.planes, *model.guides):
        grip = 0.0 if moving else 1.0
        bodies["ends"][part.body], bodies["edge"][part.body] = (
            part.ends,
            (*(MM * r for r in part.edges), grip),
        )
    return bodies, free


def _bushings(model: Model) -> tuple[np.ndarray, list[int]]:
    """Record array sorted so that the bushings of one pair of bodies stand together, and where they begin."""
    table = model.bushings
    order = np.lexsort((np.arange(len(table)), table.b, table.a))
    bushings = np.zeros(len(table), BUSHING)
    position = np.concatenate([model.bodies.position, np.zeros((1, 3))])
    rotation = np.concatenate([model.bodies.rotation, np.eye(3)[None]])
    axes, origin = table.axes[order], table.origin[order]
    # at rest the frame on b has turned onto the one on a
    frames = {"a": axes, "b": axes @ matrices(-table.rest[order])}
    for end in "ab":
        body = getattr(table, end)[order]
        bushings[end] = body
        bushings["r" + end] = np.einsum("nji,nj->ni", rotation[body], origin - position[body]) * MM
        bushings["f" + end] = np.einsum("nji,njk->nik", rotation[body], frames[end]).reshape(-1, 9)
    scale = np.array([PER_MM] * 3 + [MM] * 3)
    bushings["k"] = table.k[order] * scale
    bushings["c"] = table.c[order] * scale * MS
    follow(bushings, model.curves, order, MM, PA)
    changed = (np.diff(bushings["a"]) != 0) | (np.diff(bushings["b"]) != 0)
    starts = [0, *(np.flatnonzero(changed) + 1).tolist()] if len(bushings) else []
    return bushings, [*starts, len(bushings)]


def _pairs(model: Model) -> np.ndarray:
    rows, chosen = model.contacts, model.pairs.contact
    pairs = np.zeros(len(chosen), PAIR)
    pairs["kind"] = rows.kind[chosen]
    pairs["a"] = model.pairs.a
    pairs["mesh"], pairs["b"] = mesh_numbers(model)
    pairs["shared"] = np.array([share == "width" for share in rows.share], dtype=int)[chosen]
    pairs["k"] = rows.stiffness[chosen] * HERTZ
    speed = MM / MS
    for column, values in enumerate(
        (
            damping_share.py_func(rows.restitution),  # compiled code would take longer to load
            rows.mu_static,
            rows.mu_dynamic,
            rows.stiction_velocity * speed,
            rows.friction_velocity * speed,
            rows.smoothing * speed,
            rows.rolling,
        )
    ):
        pairs["law"][:, column] = values[chosen]
    pairs["law"][:, [LAW_STATIC, LAW_DYNAMIC]] *= model.pair_friction[:, None]
    return pairs


def _couplings(
    bodies: np.ndarray, bushings: np.ndarray, blocks: list[int], pairs: np.ndarray, loads: np.ndarray
) -> list[list[int]]:
    """Coordinates that each element couples."""

    def of(body: int) -> list[int]:
        row = bodies[body]
        box = list(range(row["first"], row["first"] + 7)) if row["first"] >= 0 else []
        return box + [int(row[name]) for name in ("slide", "spin") if row[name] >= 0]

    elements = [of(bushings["a"][b]) + of(bushings["b"][b]) for b in blocks[:-1]]
    elements += [of(a) + of(b) for a, b in zip(pairs["a"], pairs["b"], strict=True)]
    elements += [[int(s)] for s in bodies["slide"] if s >= 0]
    elements += [[int(s)] for s in bodies["spin"][bodies["clutch"][:, 0] != 0.0]]
    return elements + [of(body) for body in loads["body"]]


def _pattern(couplings: list[list[int]], blocks: list[int], free: int) -> tuple[Elements, Pattern]:
    """CSR pattern of the sum of all elements, and where each element's entries go."""
    sizes = np.array([len(e) for e in couplings], dtype=np.int64)
    rows = np.concatenate([np.repeat(e, len(e)) for e in couplings] or [[]]).astype(np.int64)
    columns = np.concatenate([np.tile(e, len(e)) for e in couplings] or [[]]).astype(np.int64)
    diagonal = np.arange(free) * (free + 1)
    keys, slots = np.unique(np.concatenate([rows * free + columns, diagonal]), return_inverse=True)
    elements = Elements(
        block_start=np.array(blocks, dtype=np.int64),
        dofs=np.array([d for e in couplings for d in e], dtype=np.int64),
        dof_start=np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        slots=slots[: len(rows)].astype(np.int64),
        slot_start=np.concatenate([[0], np.cumsum(sizes**2)]).astype(np.int64),
    )
    indptr = np.searchsorted(keys, np.arange(free + 1) * free).astype(np.int32)
    return elements, Pattern(indptr, (keys % max(free, 1)).astype(np.int32))
