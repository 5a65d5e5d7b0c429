"""The laws of single pairs by the compiled code that runs have, which is shipped: as kernels of their own
they would be compiled for the tests alone, for a minute.

All take what the kernels of the same name take (see mdlgen.mechanics), and write as these do into `out`.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.arrays import BODY, IMAGE, JOINT, PAIR
from mdlgen.backends.lattice.kernels import entries
from mdlgen.backends.lattice.kernels.forces import WIDE
from mdlgen.backends.lattice.kernels.integrate.room import sticks
from mdlgen.backends.lattice.kernels.state import FACE, OWN, Drift, Midpoint, Tables
from mdlgen.backends.lattice.search import LISTED
from mdlgen.mechanics.bristle import BRISTLE, HELD
from mdlgen.mechanics.corner import CORNER
from mdlgen.mechanics.curve import POINT
from mdlgen.mechanics.frame import Box, Cylinder, Frame, Law, Motion, Plate, Vector
from mdlgen.mechanics.guide import BOTH, INSIDE, OUTSIDE, upper
from mdlgen.mechanics.mesh_tables import HEAD, Meshes
from mdlgen.mechanics.over_time import ACTS, LAW, Changing
from mdlgen.mechanics.overlap import OVERLAP
from mdlgen.mechanics.plastic import HINGE
from mdlgen.mechanics.records import LOAD
from mdlgen.mechanics.rim import PIECE
from mdlgen.mechanics.shapes import Shapes
from mdlgen.mechanics.tree import WIDTH
from mdlgen.model.tables.contacts import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    CYLINDER_CYLINDER,
)

NO_MESHES = Meshes(np.zeros(0, HEAD), np.zeros((0, 12)), np.zeros((0, 3), np.int64), np.zeros((0, WIDTH)))
NO_RIMS = np.zeros((0, PIECE))


def no_drift() -> Drift:
    """Of no sheets."""
    none, few = np.zeros(0), np.zeros(0, np.int64)
    return Drift(few.reshape(0, 2), none, none, none, few, few, none, np.zeros(3))


def pair_force(bodies: np.ndarray, pair: np.void, shapes: Shapes, motion: Motion, out: np.ndarray) -> bool:
    """A pair of the lattice's records. Of one that is not near, as in a run, `out` is zero."""
    tables = Tables(
        bodies=bodies,
        joints=np.zeros(0, JOINT),
        pairs=np.array([pair], PAIR),
        listed=np.zeros(0, LISTED),
        loads=np.zeros(0, LOAD),
        gravity=np.zeros(3),
        nodes=np.zeros(0, np.int64),
        boxes=np.zeros((0, OWN)),
        moving=np.zeros(0, np.int64),
        runs=np.zeros((0, 3), np.int64),
        thinnest=1e300,
        points=np.zeros(0, POINT),
        images=np.zeros(0, IMAGE),
        bristles=np.zeros(0, BRISTLE),
        held=np.zeros(0, HELD),
        hinges=np.zeros(0, HINGE),
        corners=np.zeros(0, CORNER),
        changes=Changing(np.zeros(0, LAW), np.zeros(0, ACTS)),
        shapes=shapes,
    )
    mid = Midpoint(
        motion=motion,
        forces=np.zeros((len(bodies), 6)),
        touched=np.zeros(1, np.int64),
        results=np.zeros((2, WIDE)),
        rows=np.zeros(1, np.int64),
        faces=np.zeros((1, FACE)),
        totals=np.zeros(2),
        spent=np.zeros((0, 2)),
        near=np.zeros(1, np.int64),
        overlaps=np.zeros(1, OVERLAP),
        spare=np.zeros(1, OVERLAP),
        does=np.zeros(1, np.int64),
        lies=np.zeros(1, np.bool_),
        fastest=np.zeros((2, len(bodies))),
        sticks=sticks(0, 0),
        drift=no_drift(),
    )
    touching = entries.contacts(tables, motion, mid)
    out[:] = mid.results[0, : len(out)]
    return touching == 1


def box_cylinder(out: np.ndarray, a: Frame, box: Box, b: Frame, cylinder: Cylinder, law: Law) -> None:
    bodies = _bodies()
    _box(bodies[0], box)
    _cylinder(bodies[1], cylinder)
    _press(out, BOX_CYLINDER, bodies, a, b, law)


def cylinder_cylinder(out: np.ndarray, a: Frame, one: Cylinder, b: Frame, two: Cylinder, law: Law) -> None:
    bodies = _bodies()
    _cylinder(bodies[0], one)
    _cylinder(bodies[1], two)
    _press(out, CYLINDER_CYLINDER, bodies, a, b, law)


def box_box(out: np.ndarray, a: Frame, box: Box, b: Frame, other: Box, law: Law) -> None:
    bodies = _bodies()
    _box(bodies[0], box)
    _box(bodies[1], other)
    _press(out, BOX_BOX, bodies, a, b, law)


def box_plane(out: np.ndarray, a: Frame, box: Box, b: Frame, plate: Plate, law: Law) -> None:
    assert plate.top == plate.half[2]
    bodies = _bodies()
    _box(bodies[0], box)
    _plate(bodies[1], plate)
    _press(out, BOX_PLANE, bodies, a, b, law, beside=plate.beside)


def box_guide(out: np.ndarray, a: Frame, box: Box, b: Frame, plate: Plate, law: Law) -> None:
    bodies = _bodies()
    _box(bodies[0], box)
    _plate(bodies[1], plate)
    thick = 2.0 * plate.half[2]
    bodies[1]["side"] = next(s for s in (INSIDE, OUTSIDE, BOTH) if upper.py_func(s, thick) == plate.top)
    bodies[1]["arc"] = plate.shape
    _press(out, BOX_GUIDE, bodies, a, b, law, beside=plate.beside)


def box_mesh(
    out: np.ndarray,
    a: Frame,
    box: Box,
    b: Frame,
    axis: Vector,
    mesh: int,
    meshes: Meshes,
    law: Law,
    met: int = 0,
) -> None:
    """`mesh`: the number of it in the tables; met: what the pair remembers."""
    bodies = _bodies()
    _box(bodies[0], box)
    bodies[1]["axis"] = axis
    _press(out, BOX_MESH, bodies, a, b, law, meshes, mesh=mesh, beside=met)


def _bodies() -> np.ndarray:
    """Two, and the ground."""
    bodies = np.zeros(3, BODY)
    bodies["node"] = bodies["slide"] = bodies["spin"] = -1
    bodies["size"] = 1.0
    return bodies


def _box(body: np.void, box: Box) -> None:
    body["half"], body["exposed"] = box


def _cylinder(body: np.void, cylinder: Cylinder) -> None:
    body["axis"], body["size"] = cylinder.axis, (cylinder.radius, cylinder.width)


def _plate(body: np.void, plate: Plate) -> None:
    body["half"], body["ends"], body["edge"] = plate.half, plate.ends, plate.edge


def _press(
    out: np.ndarray,
    kind: int,
    bodies: np.ndarray,
    a: Frame,
    b: Frame,
    law: Law,
    meshes: Meshes = NO_MESHES,
    **more: int,
) -> None:
    pair = np.zeros(1, PAIR)[0]
    pair["kind"], pair["a"], pair["b"] = kind, 0, 1
    pair["k"], pair["shared"], pair["spread"] = law.k, law.shared, law.spread
    pair["law"] = (*law[2:8], 0.0, law.lever, law.bend)
    for name, value in more.items():
        pair[name] = value
    ground = Frame((0.0, 0.0, 0.0), tuple(np.eye(3).ravel()), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    motion = Motion(*(np.array(rows, float) for rows in zip(a, b, ground, strict=True)))
    pair_force(bodies, pair, Shapes(meshes, NO_RIMS), motion, out)
