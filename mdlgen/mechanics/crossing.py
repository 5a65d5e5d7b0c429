"""What a pair may cross: how deep its law holds, and how far it may move unseen.

A law of contact acts in a band behind a face: as thick as a plate, as deep as a roller's radius. Beyond it
there is no force, so a body that is fast or thin may be before the band at one state and behind it at the
next. States that are not further apart than `unseen` cannot miss the part of the band that is deeper than
`deepest`, where a run ends.
"""

from __future__ import annotations

import math

from mdlgen.mechanics.frame import ARC_ANGLE, ARC_MIDDLE, ARC_RADIUS, RADIUS
from mdlgen.mechanics.guide import BOTH, inward
from mdlgen.mechanics.mesh import LOST
from mdlgen.mechanics.pair import (
    BOX_BOX,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    DEEP_ROLLER,
    on_part,
    on_plate,
)
from mdlgen.mechanics.tree import THICK, depth_at
from mdlgen.mechanics.vector import add, back, dot, mat, matmul, nine, rotate, scale, sub, three, vec
from mdlgen.program.kernel import BORROWS, njit

# Of what is deepest.
UNSEEN = 0.8


@njit(cache=True, error_model="numpy", **BORROWS)
def deepest(bodies, pair):
    """Depth beyond which a pair is about to come out at the other side: half of a plate's thickness, of the
    thinner of two boxes', of what is round its radius, of two rollers the smaller one. A mesh has its own."""
    a, b, kind = pair.a, pair.b, pair.kind
    if on_plate(pair):
        return bodies[b].half[2]
    if kind == BOX_BOX:
        return min(bodies[a].half[2], bodies[b].half[2])
    if kind == CYLINDER_CYLINDER:
        return min(bodies[a].size[RADIUS], bodies[b].size[RADIUS])
    if on_part(pair):
        return DEEP_ROLLER * bodies[a].size[RADIUS]
    if kind == BOX_MESH:
        return LOST
    return 0.5 * bodies[b].size[RADIUS]


@njit(cache=True, error_model="numpy", **BORROWS)
def unseen(bodies, pair, shapes):
    """How far a pair may move towards each other from one state that is looked at to the next: a little less
    than the band beyond `deepest` is wide, which for each of these laws is as wide as that is deep."""
    if pair.kind == BOX_MESH:
        return shapes.meshes.heads[pair.mesh].unseen
    return UNSEEN * deepest(bodies, pair)


@njit(cache=True, error_model="numpy", forceinline=True)
def size(body):
    """Half of a box's diagonal."""
    return math.sqrt(body.half[0] * body.half[0] + body.half[1] * body.half[1] + body.half[2] * body.half[2])


@njit(cache=True, error_model="numpy", forceinline=True)
def fastest_place(body, rate, spin):
    """How fast any place of a box is at most, of its velocity and its angular velocity."""
    return math.sqrt(dot(rate, rate)) + math.sqrt(dot(spin, spin)) * size(body)


@njit(cache=True, error_model="numpy", **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """The greatest speed at which a pair may come closer along what it could cross, in the next `ahead`;
    along a plate or a roller's axis a sheet may be fast."""
    a, b, kind = pair.a, pair.b, pair.kind
    x, r, u, w = motion
    rate, spin = sub(vec(u, b), vec(u, a)), vec(w, a)
    turning = math.sqrt(dot(spin, spin)) * size(bodies[a])
    if kind == BOX_PLANE:
        return abs(dot(rate, (r[b, 2], r[b, 5], r[b, 8]))) + turning
    if kind == BOX_GUIDE:
        own = back(mat(r, b), rate)
        if bodies[b].arc[ARC_RADIUS] == 0.0:
            return abs(own[1]) + turning
        at = back(mat(r, b), sub(vec(x, a), vec(x, b)))
        away = max(math.sqrt(at[0] * at[0] + at[1] * at[1]), 1e-3 * bodies[b].arc[ARC_RADIUS])
        bent = ahead * (own[0] * own[0] + own[1] * own[1]) / away
        return abs(own[0] * at[0] + own[1] * at[1]) / away + bent + turning
    if kind == BOX_BOX:
        one = abs(dot(rate, (r[a, 2], r[a, 5], r[a, 8])))
        two = abs(dot(rate, (r[b, 2], r[b, 5], r[b, 8])))
        spin = vec(w, b)
        return max(one, two) + turning + math.sqrt(dot(spin, spin)) * size(bodies[b])
    if kind == BOX_MESH:
        spin, reach = vec(w, b), shapes.meshes.heads[pair.mesh].reach
        return math.sqrt(dot(rate, rate)) + turning + math.sqrt(dot(spin, spin)) * reach
    axis = bodies[b].axis
    along = rate[0] * axis[0] + rate[1] * axis[1] + rate[2] * axis[2]
    across = math.sqrt(max(dot(rate, rate) - along * along, 0.0))
    return across if kind == CYLINDER_CYLINDER else across + turning


@njit(cache=True, error_model="numpy", **BORROWS)
def above(bodies, pair, x, r):
    """The side of a plate with two faces that a box's centre is on: 1 or -1; 0 where the pair is another one,
    or the centre is not over the plate."""
    b = pair.b
    if pair.kind != BOX_GUIDE or bodies[b].side != BOTH:
        return 0
    at = back(mat(r, b), scale(-1.0, sub(vec(x, b), vec(x, pair.a))))
    if abs(at[2]) > bodies[b].half[1]:
        return 0
    radius, middle, angle = bodies[b].arc[ARC_RADIUS], bodies[b].arc[ARC_MIDDLE], bodies[b].arc[ARC_ANGLE]
    if radius == 0.0:
        if abs(at[0]) > bodies[b].half[0]:
            return 0
    else:
        to = at[0] * math.cos(middle) + at[1] * math.sin(middle)
        aside = at[1] * math.cos(middle) - at[0] * math.sin(middle)
        if abs(math.atan2(aside, to)) > angle:
            return 0
    height = inward(at, radius)
    # further away than that it comes round the guide's axis, or its end
    if abs(height) > 2.0 * bodies[b].half[2] + size(bodies[pair.a]):
        return 0
    return 1 if height >= 0.0 else -1


@njit(cache=True, error_model="numpy", **BORROWS)
def buried(bodies, pair, shapes, x, r):
    """Whether the centre of a box with a free side is deeper in a mesh than half of what counts there: the
    sides of a sheet do not know how deep they are."""
    if pair.kind != BOX_MESH or bodies[pair.a].exposed == 0:
        return False
    meshes = shapes.meshes
    head = meshes.heads[pair.mesh]
    turn = mat(r, pair.b)
    frame, place = matmul(turn, nine(head.axes)), add(vec(x, pair.b), rotate(turn, three(head.place)))
    at = back(frame, sub(vec(x, pair.a), place))
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    depth, t = depth_at(bounds, links, triangles, head.first, head.end, at, head.most)
    return depth > 0.5 * triangles[t, THICK]
