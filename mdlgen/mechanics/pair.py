"""One contact pair of a solver's tables: which law it has, and what that is given."""

from __future__ import annotations

import math

from mdlgen.mechanics.contact import box_cylinder, cylinder_cylinder
from mdlgen.mechanics.edge import stands
from mdlgen.mechanics.facing import box_box
from mdlgen.mechanics.frame import (
    ARC_RADIUS,
    LAW_ROLLING,
    RADIUS,
    Frame,
    Plate,
    box_of,
    cylinder_of,
    frame_of,
    held_frame,
    law_of,
    plate_frame,
)
from mdlgen.mechanics.guide import box_guide, upper
from mdlgen.mechanics.mesh import box_mesh
from mdlgen.mechanics.plate import STRAIGHT, as_guide, box_plane
from mdlgen.mechanics.point import FORCE_A, PRESSING, resist_rolling
from mdlgen.mechanics.rim import box_rim, rim_rim
from mdlgen.mechanics.roller_mesh import roller_mesh, roller_mesh_near
from mdlgen.mechanics.roller_plate import guide_near, plate_near, roller_guide, roller_plane
from mdlgen.mechanics.vector import back, dot, mat, sub, three, vec
from mdlgen.model.tables.contacts import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    CYLINDER_GUIDE,
    CYLINDER_MESH,
    CYLINDER_PLANE,
)
from mdlgen.program.kernel import BORROWS, njit

# Kinds of contacts that have a law: those that `pair_force` tells apart.
WITH_LAW = frozenset(
    (
        *(BOX_BOX, BOX_CYLINDER, BOX_GUIDE, BOX_MESH, BOX_PLANE),
        *(CYLINDER_CYLINDER, CYLINDER_GUIDE, CYLINDER_MESH, CYLINDER_PLANE),
    )
)
# How deep a roller may be in a plate, in times its radius: its axis is soon behind the face.
DEEP_ROLLER = 0.5


@njit(cache=True, error_model="numpy", forceinline=True)
def plane_of(body, beside):
    """Plate of a plane's record, in the axes of a guide."""
    half = three(body.half)
    return Plate(STRAIGHT, half, half[2], body.ends, three(body.edge), beside)


@njit(cache=True, error_model="numpy", forceinline=True)
def guide_of(body, beside):
    """Plate of a guide's record."""
    half = three(body.half)
    top = upper(body.side, 2.0 * half[2])
    return Plate(three(body.arc), half, top, body.ends, three(body.edge), beside)


@njit(cache=True, error_model="numpy", forceinline=True)
def on_plate(pair):
    """Whether the other part is a plate: a plane or a guide."""
    return pair.kind == BOX_PLANE or pair.kind == BOX_GUIDE


@njit(cache=True, error_model="numpy", forceinline=True)
def on_fixed_plate(pair, other):
    """Whether the other part, of that record, is a plate that does not move."""
    return on_plate(pair) and other.slide < 0


@njit(cache=True, error_model="numpy", forceinline=True)
def on_part(pair):
    """Whether a roller meets a plane, a guide or a mesh."""
    return pair.kind == CYLINDER_PLANE or pair.kind == CYLINDER_GUIDE or pair.kind == CYLINDER_MESH


@njit(cache=True, error_model="numpy", **BORROWS)
def roller_near(bodies, pair, shapes, x, r, more):
    """Whether a roller and the part that it may meet are closer than `more`, as far as their bounds tell."""
    rb = mat(r, pair.b)
    if pair.kind == CYLINDER_MESH:
        head = shapes.meshes.heads[pair.mesh]
        return roller_mesh_near(bodies[pair.a], vec(x, pair.a), vec(x, pair.b), rb, head, shapes.meshes, more)
    at = back(rb, sub(vec(x, pair.a), vec(x, pair.b)))
    if pair.kind == CYLINDER_PLANE:
        return plate_near(bodies[pair.a], at, rb, bodies[pair.b], more)
    return guide_near(bodies[pair.a], at, rb, bodies[pair.b], more)


@njit(cache=True, error_model="numpy", **BORROWS)
def _rolling(bodies, pair, shapes, xa, xb, rb):
    """The axis about which one part of a pair rolls on the other, and the curvature of both together there;
    0 where none of them is a roller."""
    one, two = bodies[pair.a], bodies[pair.b]
    if pair.kind == CYLINDER_CYLINDER:
        return three(two.axis), 1.0 / one.size[RADIUS] + 1.0 / two.size[RADIUS]
    if pair.kind == CYLINDER_PLANE or pair.kind == CYLINDER_MESH:
        return three(one.axis), 1.0 / one.size[RADIUS]
    if pair.kind == CYLINDER_GUIDE:
        curved, arc = 1.0 / one.size[RADIUS], two.arc[ARC_RADIUS]
        if arc > 0.0:
            at = back(rb, sub(xa, xb))
            hollow = at[0] * at[0] + at[1] * at[1] < arc * arc
            curved += -1.0 / arc if hollow else 1.0 / arc
        return three(one.axis), curved
    rolls = pair.kind == BOX_CYLINDER or (
        pair.kind == BOX_MESH and shapes.meshes.heads[pair.mesh].basis > 0.0
    )
    return three(two.axis), 1.0 / two.size[RADIUS] if rolls else 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_force(bodies, pair, shapes, motion, out):
    """One contact pair into `out`, which must be zero (see mechanics.point for its columns).

    `bodies` are records with half, exposed, axis, size (radius, width), arc, side, ENDS and RIM, `pair` one
    with kind, a, b, k, shared, law, mesh and beside, `shapes` a mechanics.shapes.Shapes, `motion` the Motion
    of all bodies. Returns whether it touches.
    """
    one, two, kind = bodies[pair.a], bodies[pair.b], pair.kind
    a, b = frame_of(motion, pair.a), frame_of(motion, pair.b)
    law = law_of(pair)
    if kind == CYLINDER_CYLINDER and one.rims + two.rims > 0:
        rim_rim(out, a, one, b, two, shapes.rims, law)
    elif kind == CYLINDER_CYLINDER:
        cylinder_cylinder(out, a, cylinder_of(one), b, cylinder_of(two), law)
    elif kind == BOX_PLANE:
        box_plane(out, a, box_of(one), plate_frame(motion, pair.b), plane_of(two, pair.beside), law)
    elif kind == BOX_GUIDE:
        box_guide(out, a, box_of(one), held_frame(motion, pair.b), guide_of(two, pair.beside), law)
    elif kind == CYLINDER_PLANE:
        roller_plane(out, one, shapes.rims, a, plate_frame(motion, pair.b), three(two.half), law)
    elif kind == CYLINDER_GUIDE:
        held = held_frame(motion, pair.b)
        roller_guide(out, one, shapes.rims, a, held, three(two.arc), three(two.half), two.side, law)
    elif kind == CYLINDER_MESH:
        roller_mesh(out, one, a, b, shapes.meshes.heads[pair.mesh], shapes.meshes, law)
    elif kind == BOX_BOX:
        box_box(out, a, box_of(one), b, box_of(two), law)
    elif kind == BOX_MESH:
        box_mesh(out, a, box_of(one), b, three(two.axis), shapes.meshes.heads[pair.mesh], shapes.meshes, law)
    elif two.rims > 0:
        box_rim(out, a, box_of(one), b, two, shapes.rims, law)
    else:
        box_cylinder(out, a, box_of(one), b, cylinder_of(two), law)
    if pair.law[LAW_ROLLING] > 0.0 and out[PRESSING] > 0.0:
        axis, curved = _rolling(bodies, pair, shapes, a.x, b.x, b.r)
        if curved > 0.0:
            resist_rolling(out, a.w, b.w, axis, 1.0 / curved, pair.law[LAW_ROLLING], law.smoothing)
    if out[PRESSING] != 0.0:
        return True
    # a box just beyond the end of a roller has a part of what that does, and nothing presses on it
    return kind == BOX_CYLINDER and (
        out[FORCE_A] != 0.0 or out[FORCE_A + 1] != 0.0 or out[FORCE_A + 2] != 0.0
    )


@njit(cache=True, error_model="numpy", **BORROWS)
def remember(bodies, pairs, motion):
    """Notes for all pairs of a box and a plate which outer sides of the box stand before which end of the
    plate, at the places that a step, or a run, begins with (see mechanics.edge)."""
    for p in range(pairs.size):
        kind = pairs[p].kind
        if kind < 0:  # from here on there is room only
            break
        if kind != BOX_PLANE and kind != BOX_GUIDE:
            continue
        a, b = pairs[p].a, pairs[p].b
        exposed, ends = bodies[a].exposed, bodies[b].ends
        if exposed == 0 or ends == 0:
            continue
        one, two = held_frame(motion, a), held_frame(motion, b)
        plate = guide_of(bodies[b], pairs[p].beside)
        if kind == BOX_PLANE:
            two = Frame(two.x, as_guide(two.r), two.v, two.w)
            plate = plane_of(bodies[b], pairs[p].beside)
        if plate.shape[ARC_RADIUS] == 0.0:
            at, half, size = back(two.r, sub(one.x, two.x)), three(bodies[a].half), plate.half
            reach = math.sqrt(dot(half, half))
            if at[1] > plate.top + reach or at[1] < plate.top - 2.0 * size[2] - reach:
                pairs[p].beside = 0  # clear of the plate
                continue
            if pairs[p].beside == 0 and abs(at[0]) + reach < size[0] and abs(at[2]) + reach < size[1]:
                continue  # inside of all ends
        pairs[p].beside = stands(one, box_of(bodies[a]), two, plate)
