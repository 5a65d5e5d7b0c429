"""Which triangles of a mesh a broad face of a sheet's box meets, and what it does at the side of one beyond
which it meets less: at an edge of the mesh."""

from __future__ import annotations

import math

from mdlgen.mechanics.mesh_side import ramp
from mdlgen.mechanics.tree import NEXT, NORMAL
from mdlgen.mechanics.vector import add, cross, dot, scale, three
from mdlgen.program.kernel import njit

STEEP, GENTLE = 0.4, 0.6  # cosines of the angles between which the law of broad faces ends
# Gauss' rule of degree 5 on a line: its outer points, from the middle in half lengths, and weights.
_OUTER, _OUTER_WEIGHT, _MIDDLE_WEIGHT = 0.774596669241483, 0.277777777777778, 0.444444444444444


@njit(cache=True, error_model="numpy", forceinline=True)
def part_of(cosine):
    """How much of the broad faces' law acts on a triangle at an angle to them."""
    return ramp(cosine, STEEP, GENTLE)


@njit(cache=True, error_model="numpy", forceinline=True)
def turning(cosine):
    """Growth of `part_of` with the cosine, over `part_of`."""
    s = (cosine - STEEP) / (GENTLE - STEEP)
    return 6.0 * (1.0 - s) / (s * (3.0 - 2.0 * s) * (GENTLE - STEEP)) if 0.0 < s < 1.0 else 0.0


@njit(cache=True, error_model="numpy", forceinline=True)
def _per_area(element, depth):
    """Energy of a place of a broad face on a fixed mesh, over its area in the face."""
    if depth <= 0.0 or depth > element.deepest:
        return 0.0
    return 0.4 * element.stiffness * depth * depth * math.sqrt(depth)


@njit(cache=True, error_model="numpy")
def beyond(meshes, t, face, element, part, u, v, z):
    """Force on a box, and torque about its middle, at the sides of triangle t beyond which another triangle
    has another part of the law of a broad face; t itself has `part`. u, v, z: places of its corners in the
    face, from its middle, and depths.

    What is stored is the integral of P(z) over the triangle as the face sees it. Its slope along the face is
    the pressure along the triangle's normal, and P times the way out of the triangle, over all of its sides.
    The latter cancels where the next triangle has the same part. At an edge beyond which a mesh is too steep
    for the face nothing cancels it, and the face is pressed along its own normal there. A mesh on a roller is
    left out, of which a nip has one direction for all that presses.
    """
    triangles, force, torque = meshes.triangles, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for i in range(3):
        other = int(triangles[t, NEXT + i])
        if other < 0 or part_of(-dot(face.way, three(triangles[other, NORMAL:]))) == part:
            continue
        j, k = (i + 1) % 3, (i + 2) % 3
        du, dv, dz = u[j] - u[i], v[j] - v[i], z[j] - z[i]
        first, last = 0.0, 1.0
        for plane in range(5):
            # what is left of a limit at the begin of the side, and how that grows along it
            left, more = z[i], dz
            if plane == 1 or plane == 2:
                sign = 1.0 if plane == 1 else -1.0
                left, more = face.half_along - sign * u[i], -sign * du
            elif plane > 2:
                sign = 1.0 if plane == 3 else -1.0
                left, more = face.half_across - sign * v[i], -sign * dv
            if more > 0.0:
                first = max(first, -left / more)
            elif more < 0.0:
                last = min(last, -left / more)
            elif left < 0.0:
                last = -1.0
        if last <= first:
            continue
        # square to the side, away from the third corner, as long as what of the side is over the face
        out_u, out_v = (last - first) * dv, -(last - first) * du
        if out_u * (u[k] - u[i]) + out_v * (v[k] - v[i]) > 0.0:
            out_u, out_v = -out_u, -out_v
        way = add(scale(out_u, face.along), scale(out_v, face.across))
        for point in range(3):
            weight = _MIDDLE_WEIGHT if point == 1 else _OUTER_WEIGHT
            s = 0.5 * (first + last) + 0.5 * (point - 1.0) * _OUTER * (last - first)
            pushed = scale(weight * _per_area(element, z[i] + s * dz), way)
            at = add(scale(u[i] + s * du, face.along), scale(v[i] + s * dv, face.across))
            at = add(at, scale(face.half - z[i] - s * dz, face.way))
            force, torque = add(force, pushed), add(torque, cross(at, pushed))
    return force, torque
