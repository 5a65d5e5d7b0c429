"""A box and a mesh, fixed or on a roller."""

from __future__ import annotations

import math

from mdlgen.mechanics.bounds import fastest_place, gap_of, rate_of, size, turning
from mdlgen.mechanics.frame import RADIUS, box_of, frame_of, held_frame, law_of
from mdlgen.mechanics.mesh import LOST, box_mesh, mesh_near, met_face
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.tree import THICK, depth_at
from mdlgen.mechanics.vector import add, back, dot, mat, matmul, nine, rotate, sub, three, vec
from mdlgen.model.tables.contacts import BOX_MESH
from mdlgen.program.kernel import BORROWS, njit

KIND, SOLID, NOTES = BOX_MESH, True, True


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, b, meshes = frame_of(motion, pair.a), frame_of(motion, pair.b), shapes.meshes
    axis, head = three(bodies[pair.b].axis), meshes.heads[pair.mesh]
    box_mesh(out, a, box_of(bodies[pair.a]), b, axis, head, meshes, law_of(pair), pair.beside)
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def noted(bodies, pair, shapes, motion):
    """The broad face that presses alone."""
    head, box = shapes.meshes.heads[pair.mesh], box_of(bodies[pair.a])
    return met_face(
        held_frame(motion, pair.a), box, held_frame(motion, pair.b), head, shapes.meshes, pair.beside
    )


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def rolling(bodies, pair, shapes, motion):
    """A mesh that is on a roller rolls as that does."""
    two, rolls = bodies[pair.b], shapes.meshes.heads[pair.mesh].basis > 0.0
    return three(two.axis), 1.0 / two.size[RADIUS] if rolls else 0.0


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """By their bounding spheres, which decide most cases, then by the tree of the mesh."""
    a, b, x, r, own = pair.a, pair.b, motion.x, motion.r, bodies[pair.a]
    head, gap, spin = shapes.meshes.heads[pair.mesh], gap_of(pair, motion.x), vec(motion.w, pair.b)
    fast = fastest_place(size(own), rate_of(pair, motion), vec(motion.w, a))
    reached = margin + ahead * (fast + math.sqrt(dot(spin, spin)) * head.reach)
    wide = size(own) + reached + head.reach
    if dot(gap, gap) > wide * wide:
        return False
    return mesh_near(
        head, shapes.meshes, vec(x, a), mat(r, a), three(own.half), vec(x, b), mat(r, b), reached
    )


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By their bounding spheres."""
    gap = sub(vec(x, pair.a), vec(x, pair.b))
    return math.sqrt(dot(gap, gap)) > size(bodies[pair.a]) + shapes.meshes.heads[pair.mesh].reach + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """The same of all meshes."""
    return LOST


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def unseen(bodies, pair, shapes):
    """By how thin the part is."""
    return shapes.meshes.heads[pair.mesh].unseen


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """In any direction."""
    rate, spin, reach = rate_of(pair, motion), vec(motion.w, pair.b), shapes.meshes.heads[pair.mesh].reach
    fast = math.sqrt(dot(rate, rate)) + turning(bodies[pair.a], motion, pair.a)
    return fast + math.sqrt(dot(spin, spin)) * reach


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def buried(bodies, pair, shapes, x, r):
    """True if the centre is deeper than half of the greatest depth there: the sides of a sheet have no bound
    on their depth."""
    meshes = shapes.meshes
    head = meshes.heads[pair.mesh]
    turn = mat(r, pair.b)
    frame, place = matmul(turn, nine(head.axes)), add(vec(x, pair.b), rotate(turn, three(head.place)))
    at = back(frame, sub(vec(x, pair.a), place))
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    depth, t = depth_at(bounds, links, triangles, head.first, head.end, at, head.most)
    return depth > 0.5 * triangles[t, THICK]
