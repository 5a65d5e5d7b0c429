"""Contact with rollers whose rim is in sectors, each with its own radius, friction, stiffness, restitution.

Let phi be the angle of the rim that looks at a flat face, and h the support function (see model.rims). The
elastic energy is that of a roller of radius h(phi) and stiffness k(phi). So the force acts where a real rim
touches: at the distance h'(phi) from the point below the axis, which is the edge of a sector where that
touches. A stiffness that grows with phi causes a torque on the roller. The sectors return all stored energy.

A body record has `rims`, the number of pieces of its rim (0: it is round); `rim`, the row of the first one in
the table of all pieces; and `blend`, half of the angle over which one passes into the next. A row of the
table has PIECE numbers: angle where the piece begins; radius; angle of the edge that is touched (nan: the
arc); stiffness and friction relative to those of the contact; the share beta of damping (negative: that of
the contact).
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.contact import WHOLE, box_sector, cylinder_cylinder
from mdlgen.mechanics.frame import RADIUS, WIDTH, Cylinder, Sector, scaled
from mdlgen.mechanics.laws import damping_share
from mdlgen.mechanics.point import DEPTH, FORCE_A, FORCE_B, STORED, TORQUE_A, TORQUE_B
from mdlgen.mechanics.vector import back, cross, dot, rotate, scale, sub, three
from mdlgen.model.rims import TURN, pieces
from mdlgen.model.tables import Floats, Model, RimPart, RollerPart
from mdlgen.program.kernel import CALLED, njit

# Columns of a piece, as above.
_BEGIN, _RADIUS, _EDGE, _STIFFNESS, _FRICTION, _DAMPING, PIECE = 0, 1, 2, 3, 4, 5, 6
RIM = [("rims", "i8"), ("rim", "i8"), ("blend", "f8")]


def rim(row: np.void, roller: RollerPart, first: int) -> int:
    """Fills the fields of RIM of a body record for a roller whose pieces begin at the row `first` of the
    table; returns the row after them."""
    if roller.rim is None:
        return first
    row["rims"], row["rim"], row["blend"] = len(pieces(roller.rim)), first, 0.5 * roller.rim.blend
    return first + int(row["rims"])


def rim_table(model: Model, length: float = 1.0) -> Floats:
    """The pieces of all rims of a Model, in the order of its rollers, (n, PIECE); `length` is 1 mm in the
    solver's units."""
    rims = [_rows(roller.rim, length) for roller in model.rollers if roller.rim is not None]
    return np.concatenate([np.zeros((0, PIECE)), *rims])


def _rows(part: RimPart, length: float) -> Floats:
    beta = damping_share.py_func(part.restitution)  # compiled code is for the solver alone to load
    return np.array(
        [
            (
                piece.begin,
                part.radius[piece.sector] * length,
                piece.edge,
                part.stiffness[piece.sector],
                part.friction[piece.sector],
                beta[piece.sector] if np.isfinite(beta[piece.sector]) else -1.0,
            )
            for piece in pieces(part)
        ]
    )


@njit(cache=True, error_model="numpy")
def _piece(rims, at, angle, beta):
    """Values of the piece in a row, at an angle: (h, h', stiffness, friction, share of damping)."""
    radius, edge, own = rims[at, _RADIUS], rims[at, _EDGE], rims[at, _DAMPING]
    damping = own if own >= 0.0 else beta
    if math.isnan(edge):
        return radius, 0.0, rims[at, _STIFFNESS], rims[at, _FRICTION], damping
    away = angle - edge
    return (
        radius * math.cos(away),
        -radius * math.sin(away),
        rims[at, _STIFFNESS],
        rims[at, _FRICTION],
        damping,
    )


@njit(cache=True, error_model="numpy")
def profile(body, rims, angle, beta):
    """Values at an angle of a body's rim, whose pieces are in the table `rims`: (h, h', stiffness and
    friction relative to the contact's, growth of the former per rad, share of damping); `beta` is the
    contact's."""
    count, first = body.rims, body.rim
    angle = angle - TURN * math.floor(angle / TURN)
    i = count - 1
    while i > 0 and rims[first + i, _BEGIN] > angle:
        i -= 1
    begin = rims[first + i, _BEGIN]
    end = rims[first + i + 1, _BEGIN] if i + 1 < count else TURN
    h, lever, stiff, rough, damping = _piece(rims, first + i, angle, beta)
    behind = angle - begin < end - angle
    j = (i - 1 if behind else i + 1) % count
    wide = (rims[first + j + 1, _BEGIN] if j + 1 < count else TURN) - rims[first + j, _BEGIN]
    # a piece may be narrower than the angles over which its ends are blended
    half = min(body.blend, 0.5 * (end - begin), 0.5 * wide)
    away = angle - begin if behind else end - angle
    if away >= half:
        return h, lever, stiff, rough, 0.0, damping
    s = 0.5 * (1.0 + away / half)
    own, growth = s * s * (3.0 - 2.0 * s), 3.0 * s * (1.0 - s) / half
    if not behind:
        growth = -growth
    h2, lever2, stiff2, rough2, damping2 = _piece(rims, first + j, angle, beta)
    return (
        own * h + (1.0 - own) * h2,
        own * lever + (1.0 - own) * lever2 + growth * (h - h2),
        own * stiff + (1.0 - own) * stiff2,
        own * rough + (1.0 - own) * rough2,
        growth * (stiff - stiff2),
        own * damping + (1.0 - own) * damping2,
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def _angle(rb, way):
    """Angle of the rim that looks along a direction; rb: the roller's rotation."""
    own = back(rb, way)
    return math.atan2(own[1], own[0])


@njit(cache=True, error_model="numpy", forceinline=True)
def _facing(l0, al, half, exposed):
    """Direction from the axis to the face that it touches by `box_sector`, in box axes; l0, al: the roller's
    centre and axis."""
    if abs(l0[2]) > half[2] and abs(al[2]) <= 0.98:
        return (0.0, 0.0, -math.copysign(1.0, l0[2]))
    if exposed & (2 if l0[0] >= 0.0 else 1) and abs(l0[0]) > half[0]:
        return (-math.copysign(1.0, l0[0]), 0.0, 0.0)
    return (0.0, -math.copysign(1.0, l0[1]), 0.0)


@njit(cache=True, error_model="numpy", **CALLED)
def box_rim(out, a, box, b, body, rims, law):
    """As `contact.box_cylinder` for a roller b whose record `body` has a rim, in the table `rims`."""
    axis = three(body.axis)
    l0, al = back(a.r, sub(b.x, a.x)), back(a.r, axis)
    face = rotate(a.r, _facing(l0, al, box.half, box.exposed))
    h, lever, stiff, rough, growth, damping = profile(body, rims, _angle(b.r, face), law.beta)
    aside = scale(lever, cross(axis, face))
    roller, own = Cylinder(axis, h, body.size[WIDTH]), scaled(law, stiff, rough, damping)
    box_sector(out, a, box, b, roller, Sector(axis, WHOLE, aside, True), own)
    # a stiffness that grows with the angle turns the roller forwards, and the box backwards
    torque = out[STORED] * growth / stiff
    for i in range(3):
        out[TORQUE_A + i] -= torque * axis[i]
        out[TORQUE_B + i] += torque * axis[i]


@njit(cache=True, error_model="numpy")
def _towards(body, rims, r, way, beta):
    """Values of `profile` for a roller along a direction; a round one has its radius, and factors of 1."""
    if body.rims == 0:
        return body.size[RADIUS], 0.0, 1.0, 1.0, 0.0, beta
    return profile(body, rims, _angle(r, way), beta)


@njit(cache=True, error_model="numpy", **CALLED)
def rim_rim(out, a, one, b, two, rims, law):
    """As `contact.cylinder_cylinder` for two rollers with records `one` and `two`, of which one has a rim, in
    the table `rims`.

    An edge acts as on a flat face, so it touches a little earlier than it would on the other's round.
    """
    axis, other = three(one.axis), three(two.axis)
    gap = sub(b.x, a.x)
    across = sub(gap, scale(dot(gap, axis), axis))
    distance = math.sqrt(dot(across, across))
    if distance <= 0.0:
        return
    way = scale(1.0 / distance, across)
    h1, lever1, stiff1, rough1, growth1, beta1 = _towards(one, rims, a.r, way, law.beta)
    h2, lever2, stiff2, rough2, growth2, beta2 = _towards(two, rims, b.r, scale(-1.0, way), law.beta)
    own = scaled(law, stiff1 * stiff2, rough1 * rough2, beta1 if one.rims > 0 else beta2)
    rollers = Cylinder(axis, h1, one.size[WIDTH]), Cylinder(other, h2, two.size[WIDTH])
    cylinder_cylinder(out, a, rollers[0], b, rollers[1], own)
    if out[DEPTH] <= 0.0:
        return
    # the energy is 2/5 F z; it changes with the angles of both, which change with the line between the axes
    spring = 2.5 * out[STORED] / out[DEPTH]
    torque1 = spring * lever1 + out[STORED] * growth1 / stiff1
    torque2 = spring * lever2 + out[STORED] * growth2 / stiff2
    swing = (torque1 + torque2 * dot(axis, other)) / distance
    aside = scale(swing, cross(axis, way))
    for i in range(3):
        out[FORCE_A + i] += aside[i]
        out[FORCE_B + i] -= aside[i]
        out[TORQUE_A + i] += torque1 * axis[i]
        out[TORQUE_B + i] += torque2 * other[i]
