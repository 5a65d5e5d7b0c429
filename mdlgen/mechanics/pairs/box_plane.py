"""A box and a plane."""

from __future__ import annotations

from mdlgen.mechanics.bounds import gap_of, rate_of, size, swinging, turning
from mdlgen.mechanics.edge import TAKES, deepest_at
from mdlgen.mechanics.frame import Frame, Plate, box_of, frame_of, held_frame, law_of
from mdlgen.mechanics.plate import STRAIGHT, as_guide, box_plane
from mdlgen.mechanics.point import presses
from mdlgen.mechanics.vector import dot, sub, three, vec
from mdlgen.model.tables.contacts import BOX_PLANE
from mdlgen.program.kernel import BORROWS, njit

KIND, ON_PLATE = BOX_PLANE, True


@njit(cache=True, error_model="numpy", forceinline=True)
def _plate_of(body, beside):
    """Plate of a plane's record, in the axes of a guide."""
    half = three(body.half)
    return Plate(STRAIGHT, half, half[2], body.ends, three(body.edge), beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def force(bodies, pair, shapes, motion, out):
    """See mechanics.pairs; so are the others."""
    a, plane = frame_of(motion, pair.a), _plate_of(bodies[pair.b], pair.beside)
    box_plane(out, a, box_of(bodies[pair.a]), frame_of(motion, pair.b), plane, law_of(pair))
    return presses(out)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def plate(bodies, pair, motion):
    """As it stands."""
    at = held_frame(motion, pair.b)
    return Frame(at.x, as_guide(at.r), at.v, at.w), _plate_of(bodies[pair.b], pair.beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def near(bodies, pair, shapes, motion, margin, ahead):
    """By the extent of the box along the plane's normal; along the plane a sheet may be fast."""
    a, b, r, half = pair.a, pair.b, motion.r, bodies[pair.a].half
    gap, normal = gap_of(pair, motion.x), (r[b, 2], r[b, 5], r[b, 8])
    fast = abs(dot(rate_of(pair, motion), normal)) + turning(bodies[a], motion, a) + swinging(motion, b, gap)
    out = 0.0
    for i in range(3):
        out += half[i] * abs(normal[0] * r[a, i] + normal[1] * r[a, 3 + i] + normal[2] * r[a, 6 + i])
    out *= TAKES
    height = -(gap[0] * normal[0] + gap[1] * normal[1] + gap[2] * normal[2]) - bodies[b].half[2]
    return not height > out + margin + ahead * fast


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def apart(bodies, pair, shapes, x, r, way):
    """By the height above or below the plane."""
    a, b = pair.a, pair.b
    height = abs(dot(sub(vec(x, a), vec(x, b)), (r[b, 2], r[b, 5], r[b, 8])))
    return height > bodies[b].half[2] + size(bodies[a]) + way


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def deepest(bodies, pair):
    """Half of the plane's thickness, or more before an end."""
    return deepest_at(bodies[pair.b].half[2], bodies[pair.a].half, pair.beside)


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def closing(bodies, pair, shapes, motion, ahead):
    """Along the plane's normal."""
    b, r = pair.b, motion.r
    along = abs(dot(rate_of(pair, motion), (r[b, 2], r[b, 5], r[b, 8])))
    return along + turning(bodies[pair.a], motion, pair.a) + swinging(motion, b, gap_of(pair, motion.x))
