"""A roller and a mesh."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import gap_of, rate_of, swinging
from mdlgen.mechanics.frame import RADIUS, frame_of, law_of
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.roller_mesh import roller_mesh, roller_mesh_near
from mdlgen.mechanics.roller_plate import DEEP_ROLLER
from mdlgen.mechanics.vector import dot, mat, three, vec
from mdlgen.model.tables.contacts import CYLINDER_MESH
from mdlgen.program.kernel import BORROWS, njit

KIND = CYLINDER_MESH


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, b, meshes = frame_of(motion, pair.a), frame_of(motion, pair.b), shapes.meshes
    roller_mesh(out, bodies[pair.a], a, b, meshes.heads[pair.mesh], meshes, law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """As on a flat face."""
    one = bodies[pair.a]
    return three(one.axis), 1.0 / one.size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """As far as their bounds tell."""
    rate = rate_of(pair, motion)
    fast = math.sqrt(dot(rate, rate)) + swinging(motion, pair.b, gap_of(pair, motion.x))
    return not apart(bodies, pair, shapes, motion.x, motion.r, margin + ahead * fast)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """As far as their bounds tell."""
    head, place, turn = shapes.meshes.heads[pair.mesh], vec(x, pair.b), mat(r, pair.b)
    return not roller_mesh_near(bodies[pair.a], vec(x, pair.a), place, turn, head, shapes.meshes, way)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the roller's radius: its axis is soon behind the face."""
    return DEEP_ROLLER * bodies[pair.a].size[RADIUS]


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Across the axis of the roller that the mesh is on, if it is on one."""
    rate, axis = rate_of(pair, motion), bodies[pair.b].axis
    along = rate[0] * axis[0] + rate[1] * axis[1] + rate[2] * axis[2]
    across = math.sqrt(max(dot(rate, rate) - along * along, 0.0))
    return (
        across
        if bodies[pair.b].swings == 0
        else math.sqrt(dot(rate, rate)) + swinging(motion, pair.b, gap_of(pair, motion.x))
    )
