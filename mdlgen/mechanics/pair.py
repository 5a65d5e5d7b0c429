"""One contact pair of a solver's tables: which law it has, and what that is given."""

from __future__ import annotations

from numba import njit

from mdlgen.mechanics.compiling import BORROWS
from mdlgen.mechanics.contact import box_cylinder, box_plane, cylinder_cylinder
from mdlgen.mechanics.facing import box_box
from mdlgen.mechanics.guide import box_guide
from mdlgen.mechanics.mesh import box_mesh
from mdlgen.mechanics.rim import box_rim, rim_rim
from mdlgen.mechanics.vector import mat, three, vec

# As in mdlgen.model.tables.
BOX_PLANE, CYLINDER_CYLINDER, BOX_GUIDE, BOX_BOX, BOX_MESH = 1, 2, 4, 5, 6


@njit(cache=True, error_model="numpy", forceinline=True)
def on_plate(pair):
    """Whether the other part is a plate: a plane or a guide."""
    return pair.kind == BOX_PLANE or pair.kind == BOX_GUIDE


@njit(cache=True, error_model="numpy", forceinline=True)
def on_fixed_plate(pair, other):
    """Whether the other part, of that record, is a plate that does not move."""
    return on_plate(pair) and other.slide < 0


@njit(cache=True, error_model="numpy", **BORROWS)
def pair_force(bodies, pair, meshes, x, r, u, w, out):
    """One contact pair into `out`, which must be zero (OUT numbers, and the count of points if it has one).

    `bodies` are records with half, exposed, axis, size (radius, width), arc, side and RIM, `pair` one with
    kind, a, b, k, shared, law and mesh, `meshes` a mechanics.mesh.Meshes; x, r, u, w places, rotations and
    velocities of all bodies. Returns whether it touches.
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
    return out[12] != 0.0
