"""Many pairs of bodies at once by the compiled code that runs have, which is shipped: forces of 10,000 states
of one kind of contact in one call."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from laws import NO_MESHES, NO_RIMS, no_drift

from mdlgen.backends.lattice.arrays import BODY, IMAGE, JOINT, PAIR
from mdlgen.backends.lattice.kernels import entries
from mdlgen.backends.lattice.kernels.forces import WIDE
from mdlgen.backends.lattice.kernels.integrate.room import sticks
from mdlgen.backends.lattice.kernels.state import FACE, OWN, Midpoint, Tables
from mdlgen.backends.lattice.search import LISTED
from mdlgen.mechanics.bristle import BRISTLE, HELD
from mdlgen.mechanics.corner import CORNER
from mdlgen.mechanics.curve import POINT
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.over_time import ACTS, LAW, Changing
from mdlgen.mechanics.overlap import OVERLAP
from mdlgen.mechanics.plastic import HINGE
from mdlgen.mechanics.point import OUT
from mdlgen.mechanics.records import LOAD
from mdlgen.mechanics.shapes import Shapes
from mdlgen.model.tables import Floats

BATCH = 2000  # pairs of one call: what each does takes 12 kB
NOTHING = Shapes(NO_MESHES, NO_RIMS)


class States(NamedTuple):
    """Places (n, 3) [mm], rotations (n, 3, 3), velocities (n, 3) [mm/ms] and angular velocities (n, 3)
    [rad/ms] of one body of each pair."""

    x: Floats
    r: Floats
    u: Floats
    w: Floats


def rest(count: int) -> States:
    """Bodies at rest in the origin."""
    return States(
        np.zeros((count, 3)), np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3)), np.zeros((count, 3))
    )


def records(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Bodies (2 count + 1,), of which the pair i has 2i and 2i + 1, the last is the ground; and pairs."""
    bodies, pairs = np.zeros(2 * count + 1, BODY), np.zeros(count, PAIR)
    bodies["node"] = bodies["slide"] = bodies["spin"] = -1
    bodies["size"] = 1.0
    pairs["a"], pairs["b"] = 2 * np.arange(count), 2 * np.arange(count) + 1
    return bodies, pairs


def forces(bodies: np.ndarray, pairs: np.ndarray, shapes: Shapes, a: States, b: States) -> Floats:
    """What each pair does: force and torque on a and on b, its force along normals, energy, dissipated power
    and depth (n, OUT)."""
    count = len(pairs)
    motion = Motion(*(np.zeros((len(bodies), width)) for width in (3, 9, 3, 3)))
    motion.r[-1] = np.eye(3).ravel()
    for k, states in enumerate((a, b)):
        motion.x[k:-1:2], motion.u[k:-1:2], motion.w[k:-1:2] = states.x, states.u, states.w
        motion.r[k:-1:2] = states.r.reshape(-1, 9)
    found = np.zeros((count, OUT))
    for first in range(0, count, BATCH):
        some = pairs[first : first + BATCH]
        mid = _middle(len(bodies), len(some), motion)
        touching = entries.contacts(_tables(bodies, some, shapes), motion, mid)
        found[first + mid.touched[:touching]] = mid.results[:touching, :OUT]
    return found


def _tables(bodies: np.ndarray, pairs: np.ndarray, shapes: Shapes) -> Tables:
    return Tables(
        bodies=bodies,
        joints=np.zeros(0, JOINT),
        pairs=np.ascontiguousarray(pairs),
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


def _middle(bodies: int, pairs: int, motion: Motion) -> Midpoint:
    return Midpoint(
        motion=motion,
        forces=np.zeros((bodies, 6)),
        touched=np.zeros(pairs, np.int64),
        results=_room(pairs),
        rows=np.zeros(1, np.int64),
        faces=np.zeros((1, FACE)),
        totals=np.zeros(2),
        spent=np.zeros((0, 2)),
        near=np.zeros(pairs, np.int64),
        overlaps=np.zeros(1, OVERLAP),
        spare=np.zeros(1, OVERLAP),
        does=np.zeros(1, np.int64),
        lies=np.zeros(1, np.bool_),
        fastest=np.zeros((2, bodies)),
        sticks=sticks(0, 0),
        drift=no_drift(),
    )


_rooms: dict[int, Floats] = {}


def _room(pairs: int) -> Floats:
    """One for all calls of that many pairs: each fills what it reads."""
    return _rooms.setdefault(pairs, np.zeros((pairs + 1, WIDE)))
