"""The Model as arrays in SI units, in the order in which the solver numbers its coordinates.

A free box has seven coordinates (position, Euler parameters); a free roller one for its spin; a pressed
roller or plate one for its slide; a contact patch where friction sticks four for its stretch, see
bristles.py; a cell of air between sheets one for its pressure, see air.py. Everything else is prescribed. Row
-1 of the body arrays is the ground.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.exudyn_local.films import Film, film_of
from mdlgen.backends.exudyn_local.patches import FIELD, Sticking, sticking_of
from mdlgen.backends.exudyn_local.state import Tables
from mdlgen.errors import RefusedError
from mdlgen.mechanics.corner import corners_of
from mdlgen.mechanics.curve import curve_points
from mdlgen.mechanics.over_time import Changing, changing
from mdlgen.mechanics.pack import Units, gravity, number, pack_bodies, pack_bushings, pack_loads, pack_pairs
from mdlgen.mechanics.plastic import HINGE
from mdlgen.mechanics.records import (
    BODIES,
    CONSTANTS,
    CONTACT,
    CURVE,
    ENDS_OF_JOINT,
    FRAMES,
    OF_BODY,
)
from mdlgen.mechanics.shapes import Shapes, shape_tables
from mdlgen.mechanics.solved import refuse_unsolved
from mdlgen.model.meshes import check_balance
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Floats, Ints, Model

MM, G, MS = 1e-3, 1e-3, 1e-3
PER_MM = 1e3
SI = Units(mm=MM, per_mm=PER_MM, g=G, ms=MS, hertz=1e3**1.5, mpa=1e6)

# Distance of absent sheets from each other and from the machine [m]: no machine is as large.
FAR_AWAY = 1e3
# Where the Euler parameters are among the coordinates of a box, and in `reference`; before them its position.
EULER = 3
BODY = np.dtype(
    [
        ("first", "i8"),  # first of a box's 7 coordinates, -1: not free
        ("slide", "i8"),  # coordinate of the slide of a roller or a plate, -1: none
        ("spin", "i8"),  # coordinate of a roller's spin, -1: prescribed
        ("reference", "f8", 7),  # position [m], Euler parameters
        *OF_BODY,
    ]
)
# and the number of its hinge, -1: it is elastic
BUSHING = np.dtype([*ENDS_OF_JOINT, *FRAMES, *CONSTANTS, *CURVE, ("hinge", "i8")])
PAIR = np.dtype([*BODIES, *CONTACT])


class Elements(NamedTuple):
    """Elements of which the jacobian is the sum: blocks of bushings between bodies, corners, pairs, slides,
    clutches, loads, and patches."""

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
    shapes: Shapes  # [m]
    film: Film
    stick: Sticking
    hinges: np.ndarray  # mechanics.plastic.HINGE, in the order of Model.plastic [rad, N m]
    corners: np.ndarray  # mechanics.corner.CORNER
    given_up: Floats  # of the angle of each axle, see integrals.py [rad]
    changes: Changing

    @property
    def tables(self) -> Tables:
        """Records that every kernel takes first."""
        return Tables(
            bodies=self.bodies,
            bushings=self.bushings,
            points=self.points,
            pairs=self.pairs,
            shapes=self.shapes,
            loads=self.loads,
            gravity=self.gravity,
            film=self.film,
            stick=self.stick,
            hinges=self.hinges,
            corners=self.corners,
            given_up=self.given_up,
            changes=self.changes,
        )


class Pattern(NamedTuple):
    """Sparsity of the jacobian (CSR)."""

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]


def check(model: Model) -> None:
    """Raises RefusedError for what this backend cannot represent."""
    refuse_unsolved(model, "exudyn")
    check_balance(model)
    for roller in model.rollers:
        if roller.arm is not None and model.run.analysis == "static":
            raise RefusedError(
                f"exudyn: a static analysis with an arm ({roller.name}) is not there yet",
                ("rollers", roller.name, "arm"),
            )
        if roller.press is not None and abs(float(roller.press.direction @ roller.axis)) > 1e-9:
            raise RefusedError(f"roller {roller.name}: a press along its own axis is not modelled by exudyn")


def build(model: Model, gone: NDArray[np.bool_] | None = None) -> tuple[System, Pattern]:
    """Arrays and jacobian pattern of a Model; `gone` (sheets,): absent sheets, which are far away and have no
    coordinates."""
    check(model)
    moving = model.run.analysis == "transient"
    bodies, free = _bodies(model, moving, gone)
    pairs = pack_pairs(model, PAIR, np.arange(len(model.pairs)), SI)
    stick = sticking_of(model, bodies, pairs, free, SI)
    free += FIELD * len(stick.patches)
    film = film_of(model, free, SI)
    free += len(film.cells)
    bushings, blocks = _bushings(model, gone)
    loads, weight = pack_loads(model, SI), gravity(model, SI)
    changes = changing(model, loads, weight, MS)
    corners = corners_of(model, bushings["row"], SI)
    if gone is not None:
        corners = corners[~gone[corners["sheet"]]]
    couplings = _couplings(bodies, (bushings, blocks, corners), pairs, loads, stick)
    elements, pattern = _pattern(couplings, blocks, free)
    points = curve_points(model.curves, SI.mpa)
    shapes = shape_tables(model, SI)
    system = System(
        bodies=bodies,
        bushings=bushings,
        pairs=pairs,
        loads=loads,
        gravity=weight,
        elements=elements,
        free=free,
        points=points,
        shapes=shapes,
        film=film,
        stick=stick,
        hinges=_hinges(model, bushings),
        corners=corners,
        given_up=np.zeros(len(shapes.axles)),
        changes=changes,
    )
    return system, pattern


def _bodies(model: Model, moving: bool, gone: NDArray[np.bool_] | None = None) -> tuple[np.ndarray, int]:
    """Records of the bodies, and the number of coordinates; in a static analysis no roller turns."""
    table = model.bodies
    count = len(table.name)
    bodies = pack_bodies(model, BODY, SI, driven=moving)
    bodies["reference"][:, EULER] = 1.0
    bodies["reference"][:count, :EULER] = table.position * MM
    bodies["reference"][:count, EULER:] = euler_parameters(table.rotation)
    bodies["first"] = -1
    free = 0
    for k, sheet in enumerate(model.sheets):
        if gone is not None and gone[k]:
            bodies["reference"][sheet.first : sheet.first + sheet.count, :EULER] += (k + 1) * FAR_AWAY
            continue
        for body in range(sheet.first, sheet.first + sheet.count):
            if not table.fixed[body]:
                bodies["first"][body] = free
                free += 7
    return bodies, number(model, bodies, free, turning=moving)


def _bushings(model: Model, gone: NDArray[np.bool_] | None = None) -> tuple[np.ndarray, list[int]]:
    """Record array sorted so that the bushings of one pair of bodies stand together, and where they begin;
    without those of sheets that are `gone`."""
    table = model.bushings
    order = np.lexsort((np.arange(len(table)), table.b, table.a))
    if gone is not None:
        order = order[~gone[table.sheet[order]]]
    bushings = pack_bushings(model, BUSHING, order, SI)
    changed = (np.diff(bushings["a"]) != 0) | (np.diff(bushings["b"]) != 0)
    starts = [0, *(np.flatnonzero(changed) + 1).tolist()] if len(bushings) else []
    return bushings, [*starts, len(bushings)]


def _hinges(model: Model, bushings: np.ndarray) -> np.ndarray:
    """One for each bushing that yields, whose numbers are noted in these."""
    table = model.plastic
    hinges = np.zeros(len(table), HINGE)
    place = np.empty(len(model.bushings), np.int64)
    place[bushings["row"]] = np.arange(len(bushings))
    hinges["joint"], hinges["axis"] = place[table.bushing], table.axis
    bushings["hinge"] = -1
    bushings["hinge"][hinges["joint"]] = np.arange(len(hinges))
    hinges["k"] = bushings["k"][hinges["joint"], 3 + hinges["axis"]]
    hinges["moment"], hinges["hardening"] = table.moment * MM, table.hardening * MM
    return hinges


def _couplings(
    bodies: np.ndarray,
    sheets: tuple[np.ndarray, list[int], np.ndarray],
    pairs: np.ndarray,
    loads: np.ndarray,
    stick: Sticking,
) -> list[list[int]]:
    """Coordinates that each element couples; `sheets`: bushings, where blocks of them begin, and corners."""
    bushings, blocks, corners = sheets

    def of(body: int) -> list[int]:
        row = bodies[body]
        box = list(range(row["first"], row["first"] + 7)) if row["first"] >= 0 else []
        return box + [int(row[name]) for name in ("slide", "spin") if row[name] >= 0]

    def both(one: int, two: int) -> list[int]:
        """Two rollers of one shaft have the same coordinate."""
        return list(dict.fromkeys(of(one) + of(two)))

    def field(patch: int) -> list[int]:
        first = int(stick.first[0]) + FIELD * patch
        return list(range(first, first + FIELD)) if patch >= 0 else []

    elements = [of(bushings["a"][b]) + of(bushings["b"][b]) for b in blocks[:-1]]
    for corner in corners:
        own = bushings[corner["joint"][corner["joint"] >= 0]]
        there = np.unique([own["a"], own["b"]])
        elements.append([dof for body in there[there >= 0] for dof in of(body)])
    ends = zip(pairs["a"], pairs["b"], stick.patch_of.tolist(), strict=True)
    elements += [both(a, b) + field(patch) for a, b, patch in ends]
    elements += [[int(s)] for s in bodies["slide"] if s >= 0]
    elements += [[int(s)] for s in bodies["spin"][bodies["clutch"][:, 0] != 0.0]]
    elements += [of(body) for body in loads["body"]]
    return elements + [field(patch) for patch in range(len(stick.patches))]


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
