"""The outer sides of a sheet against a mesh.

An outer side of a sheet touches a triangle that is inclined to it: at the ends of the side, in the middle of
the thickness, with half of k z^1.5, z the depth below the nearest triangle. That law begins at 3 to 9 deg,
and that of the broad faces ends at 53 to 66 deg; both are blended. Where a side touches a triangle steeper
than 45 to 64 deg, the end of a plate, the broad faces of its box do not press. An edge between triangles is
sharp; a mesh with an `edge` has it rounded. The depth of a point that is less than the radius r below two
faces is then

    r - sqrt((r - z1)^2 + (r - z2)^2)        and the normal looks away from the round's axis.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Matrix, Vector
from mdlgen.mechanics.point import Load, push
from mdlgen.mechanics.tree import NORMAL, depth_at, next_at
from mdlgen.mechanics.vector import add, dot, rotate, scale, three
from mdlgen.program.kernel import njit

LEVEL, LEANING = 0.05, 0.15  # sines of the angles between which the law begins.
UPRIGHT, STANDING = 0.7, 0.9  # sines of the angles between which a box is in front of a plate, not over it.


class Placed(NamedTuple):
    """A box in the axes of the mesh's file: its middle and its axes; `frame` has the file's axes, global."""

    middle: Vector
    axes: Matrix
    frame: Matrix


@njit(cache=True, error_model="numpy", forceinline=True)
def ramp(x, low, high):
    """0 below a value, 1 above another, smooth between."""
    s = min(max((x - low) / (high - low), 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


@njit(cache=True, error_model="numpy")
def meet_sides(out, a, box, placed, head, meshes, b, law):
    """The outer sides of box a against the mesh; returns the factor of the law of broad faces."""
    half, exposed = box
    middle, axes, frame = placed
    bounds, links, triangles = meshes.bounds, meshes.links, meshes.triangles
    over = 1.0
    for side in range(4):
        if exposed & (1 << side) == 0:
            continue
        p, sign = side // 2, 1.0 if side % 2 == 1 else -1.0
        away = scale(sign, (axes[p], axes[3 + p], axes[6 + p]))
        for end in (-1.0, 1.0):
            x = sign * half[0] if p == 0 else end * half[0]
            y = sign * half[1] if p == 1 else end * half[1]
            at = add(middle, rotate(axes, (x, y, 0.0)))
            depth, t = depth_at(bounds, links, triangles, head.first, head.end, at, head.most)
            if depth <= 0.0:
                continue
            normal = three(triangles[t, NORMAL:])
            if depth < head.edge:
                second, other = next_at(bounds, links, triangles, head.first, head.end, at, head.edge, normal)
                if other >= 0:
                    one, two = head.edge - depth, head.edge - second
                    from_axis = math.sqrt(one * one + two * two)
                    depth = head.edge - from_axis
                    if depth <= 0.0:
                        continue
                    normal = add(scale(one, normal), scale(two, three(triangles[other, NORMAL:])))
                    normal = scale(1.0 / math.sqrt(dot(normal, normal)), normal)
            lean = -dot(away, normal)
            over = min(over, 1.0 - ramp(lean, UPRIGHT, STANDING))
            spring = 0.5 * ramp(lean, LEVEL, LEANING) * law.k * depth * math.sqrt(depth)
            if spring > 0.0:
                point, energy = add(a.x, rotate(a.r, (x, y, 0.0))), 0.4 * spring * depth
                way = rotate(frame, normal)
                push(out, point, way, Load(spring, depth, energy), a, b, law)
    return over
