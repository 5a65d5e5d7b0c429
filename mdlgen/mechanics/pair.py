"""One contact pair of a solver's tables: which law it has, and what that is given."""

from __future__ import annotations

import math

from mdlgen.mechanics.contact import box_cylinder, cylinder_cylinder
from mdlgen.mechanics.edge import stands
from mdlgen.mechanics.facing import box_box
from mdlgen.mechanics.guide import box_guide, upper
from mdlgen.mechanics.mesh import box_mesh
from mdlgen.mechanics.plate import STRAIGHT, as_guide, box_plane
from mdlgen.mechanics.point import resist_rolling
from mdlgen.mechanics.rim import box_rim, rim_rim
from mdlgen.mechanics.roller_mesh import roller_mesh, roller_mesh_near
from mdlgen.mechanics.roller_plate import guide_near, plate_near, roller_guide, roller_plane
from mdlgen.mechanics.vector import back, dot, mat, sub, three, vec
from mdlgen.program.kernel import BORROWS, njit

# As in mdlgen.model.tables.
BOX_CYLINDER, BOX_PLANE, CYLINDER_CYLINDER, BOX_GUIDE, BOX_BOX, BOX_MESH = 0, 1, 2, 4, 5, 6
CYLINDER_PLANE, CYLINDER_GUIDE, CYLINDER_MESH = 7, 8, 9
# How deep a roller may be in a plate, in times its radius: its axis is soon behind the face.
DEEP_ROLLER = 0.5


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
    return pair.kind >= CYLINDER_PLANE


@njit(cache=True, error_model="numpy", **BORROWS)
def roller_near(bodies, pair, meshes, x, r, more):
    """Whether a roller and the part that it may meet are closer than `more`, as far as their bounds tell."""
    rb = mat(r, pair.b)
    if pair.kind == CYLINDER_MESH:
        head = meshes.heads[pair.mesh]
        return roller_mesh_near(bodies[pair.a], vec(x, pair.a), vec(x, pair.b), rb, head, meshes, more)
    at = back(rb, sub(vec(x, pair.a), vec(x, pair.b)))
    if pair.kind == CYLINDER_PLANE:
        return plate_near(bodies[pair.a], at, rb, bodies[pair.b], more)
    return guide_near(bodies[pair.a], at, rb, bodies[pair.b], more)


@njit(cache=True, error_model="numpy", **BORROWS)
def _rolling(bodies, pair, meshes, xa, xb, rb):
    """The axis about which one part of a pair rolls on the other, and the curvature of both together there;
    0 where none of them is a roller."""
    one, two = bodies[pair.a], bodies[pair.b]
    if pair.kind == CYLINDER_CYLINDER:
        return three(two.axis), 1.0 / one.size[0] + 1.0 / two.size[0]
    if pair.kind == CYLINDER_PLANE or pair.kind == CYLINDER_MESH:
        return three(one.axis), 1.0 / one.size[0]
    if pair.kind == CYLINDER_GUIDE:
        curved, arc = 1.0 / one.size[0], two.arc[0]
        if arc > 0.0:
            at = back(rb, sub(xa, xb))
            hollow = at[0] * at[0] + at[1] * at[1] < arc * arc
            curved += -1.0 / arc if hollow else 1.0 / arc
        return three(one.axis), curved
    rolls = pair.kind == BOX_CYLINDER or (pair.kind == BOX_MESH and meshes.heads[pair.mesh].basis > 0.0)
    return three(two.axis), 1.0 / two.size[0] if rolls else 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_force(bodies, pair, meshes, x, r, u, w, out):
    """One contact pair into `out`, which must be zero (OUT numbers, and the count of points if it has one).

    `bodies` are records with half, exposed, axis, size (radius, width), arc, side, ENDS and RIM, `pair` one
    with kind, a, b, k, shared, law, mesh and beside, `meshes` a mechanics.mesh.Meshes; x, r, u, w places,
    rotations and velocities of all bodies. Returns whether it touches.
    """
    a, b = pair.a, pair.b
    row = pair.law
    law = (row[0], row[1], row[2], row[3], row[4], row[5])
    if pair.kind == CYLINDER_CYLINDER and bodies[a].rims + bodies[b].rims > 0:
        rim_rim(
            out,
            bodies[a],
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            bodies[b],
            vec(x, b),
            mat(r, b),
            vec(u, b),
            vec(w, b),
            pair.k,
            law,
        )
    elif pair.kind == CYLINDER_CYLINDER:
        cylinder_cylinder(
            out,
            vec(x, a),
            vec(u, a),
            vec(w, a),
            bodies[a].size[0],
            bodies[a].size[1],
            vec(x, b),
            vec(u, b),
            vec(w, b),
            bodies[b].size[0],
            bodies[b].size[1],
            three(bodies[b].axis),
            pair.k,
            law,
        )
    elif pair.kind == BOX_PLANE:
        box_plane(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            vec(x, b),
            mat(r, b),
            three(bodies[b].half),
            pair.k,
            law,
            vec(u, b),
            bodies[a].exposed,
            bodies[b].ends,
            three(bodies[b].edge),
            pair.beside,
            pair.shared != 0,
        )
    elif pair.kind == BOX_GUIDE:
        box_guide(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            bodies[a].exposed,
            vec(x, b),
            mat(r, b),
            three(bodies[b].arc),
            three(bodies[b].half),
            bodies[b].side,
            pair.k,
            pair.shared != 0,
            law,
            bodies[b].ends,
            three(bodies[b].edge),
            pair.beside,
        )
    elif pair.kind == CYLINDER_PLANE:
        roller_plane(
            out,
            bodies[a],
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            vec(x, b),
            mat(r, b),
            vec(u, b),
            three(bodies[b].half),
            pair.k,
            law,
        )
    elif pair.kind == CYLINDER_GUIDE:
        roller_guide(
            out,
            bodies[a],
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            vec(x, b),
            mat(r, b),
            three(bodies[b].arc),
            three(bodies[b].half),
            bodies[b].side,
            pair.k,
            law,
        )
    elif pair.kind == CYLINDER_MESH:
        roller_mesh(
            out,
            bodies[a],
            vec(x, a),
            vec(u, a),
            vec(w, a),
            vec(x, b),
            mat(r, b),
            vec(u, b),
            vec(w, b),
            meshes.heads[pair.mesh],
            meshes,
            pair.k,
            law,
        )
    elif pair.kind == BOX_BOX:
        box_box(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            bodies[a].exposed,
            vec(x, b),
            mat(r, b),
            vec(u, b),
            vec(w, b),
            three(bodies[b].half),
            bodies[b].exposed,
            pair.k,
            pair.shared != 0,
            law,
        )
    elif pair.kind == BOX_MESH:
        box_mesh(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            bodies[a].exposed,
            vec(x, b),
            mat(r, b),
            three(bodies[b].axis),
            vec(u, b),
            vec(w, b),
            meshes.heads[pair.mesh],
            meshes,
            pair.k,
            law,
        )
    elif bodies[b].rims > 0:
        box_rim(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            bodies[a].exposed,
            bodies[b],
            vec(x, b),
            mat(r, b),
            three(bodies[b].axis),
            vec(u, b),
            vec(w, b),
            bodies[b].size[1],
            pair.k,
            pair.shared != 0,
            law,
        )
    else:
        box_cylinder(
            out,
            vec(x, a),
            mat(r, a),
            vec(u, a),
            vec(w, a),
            three(bodies[a].half),
            bodies[a].exposed,
            vec(x, b),
            three(bodies[b].axis),
            vec(u, b),
            vec(w, b),
            bodies[b].size[0],
            bodies[b].size[1],
            pair.k,
            pair.shared != 0,
            law,
        )
    if row[6] > 0.0 and out[12] > 0.0:
        axis, curved = _rolling(bodies, pair, meshes, vec(x, a), vec(x, b), mat(r, b))
        if curved > 0.0:
            resist_rolling(out, vec(w, a), vec(w, b), axis, 1.0 / curved, row[6], row[5])
    return out[12] != 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def remember(bodies, pairs, x, r):
    """Notes for all pairs of a box and a plate which outer sides of the box stand before which end of the
    plate, at places and rotations that a step, or a run, begins with (see mechanics.edge)."""
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
        shape, frame, top = STRAIGHT, mat(r, b), bodies[b].half[2]
        size = three(bodies[b].half)
        if kind == BOX_PLANE:
            frame = as_guide(frame)
        else:
            shape, top = three(bodies[b].arc), upper(bodies[b].side, 2.0 * top)
        if shape[0] == 0.0:
            at, half = back(frame, sub(vec(x, a), vec(x, b))), three(bodies[a].half)
            reach = math.sqrt(dot(half, half))
            if at[1] > top + reach or at[1] < top - 2.0 * size[2] - reach:
                pairs[p].beside = 0  # clear of the plate
                continue
            if pairs[p].beside == 0 and abs(at[0]) + reach < size[0] and abs(at[2]) + reach < size[1]:
                continue  # inside of all ends
        pairs[p].beside = stands(
            vec(x, a),
            mat(r, a),
            three(bodies[a].half),
            exposed,
            vec(x, b),
            frame,
            shape,
            size,
            top,
            ends,
            three(bodies[b].edge),
            pairs[p].beside,
        )
