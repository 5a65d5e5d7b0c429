"""Contact of a box with a mesh: a closed surface of triangles, fixed or on a roller.

A box has a pressure inside, which grows with the depth h below its face and is 0 on it:

    fixed:       p = k/A h^1.5, A the area of the face: a box flat on a plate has k z^1.5, and one that a
                 plate covers in part has that part of it, as with a guide;
    on a roller: p = K h, K = 3 k/(4 w sqrt(2 R)), R and w of the roller: the elastic foundation that gives
                 k z^1.5 under a cylinder (mechanics.contact).

It acts on the triangles that are inside, along their normals: dF = p n dA, where they are. So force and
torque are the gradient of the stored energy, the integral of p over the part of the mesh that is in the box.
Neither the number of triangles nor that of boxes changes the force.

A block of one box has six faces. At each place the face with the least pressure is the one that acts, so that
the pressure is 0 on all of the surface and continuous inside: no edge or corner of a mesh that comes in, and
no edge of the block, begins with a force. So a flat face has less than k z^1.5 along its edges, by 0.6 of the
depth times the ratio of both faces' pressures there (`_side_of`). A box of a sheet is thin: its two broad
faces extend beyond its sides and its thickness, since its neighbours do, and act on triangles at an angle to
them of less than 53 to 66 deg; where a sheet ends, no neighbour takes over at its edge. A triangle that came
in through one broad face does not press on the other (mechanics.mesh_pressure). On a sharp edge a sheet may
be deeper than half of its thickness, where both faces look the same: so a pair stores the face that pressed
alone (`met_face`).

With `at: nodes` pressures are integrated over triangles, with `at: centres` they are those in their middles,
as the paper has both for contact between meshes (section 3.1). The pressure on a face acts as four equal
forces with its sum, its middle and its spread, and a couple that is the rest of the torque. On a roller these
forces are one nip (mechanics.point). Its contact line lies along the axis through the middle of the pressure
on the box; near another box it lies on the face as if the sheet continued flat.

The outer sides of a sheet touch triangles that are inclined to them (mechanics.mesh_side).
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.mesh_pressure import (
    DEEPEST,
    ENERGY,
    EVER,
    FIRST_U,
    FIRST_V,
    FORCE,
    IN_ALL,
    SECOND_U,
    SECOND_V,
    SUMS,
    TOO_DEEP,
    TORQUE,
    Side,
    gather,
)
from mdlgen.mechanics.mesh_side import Placed, meet_sides
from mdlgen.mechanics.point import PRESSING, Load, Nip, passing, push, push_in_nip, turn
from mdlgen.mechanics.tree import overlaps
from mdlgen.mechanics.vector import (
    add,
    back,
    cross,
    dot,
    local,
    matmul,
    nine,
    rotate,
    scale,
    sub,
    three,
    transpose_matmul,
)
from mdlgen.program.kernel import CALLED, OWNS, njit

_SPAN = 2.5  # bound on the reach of a pressure under a round, which is sqrt(5) times its spread.
LOST = 1e30  # depth above which a run ends.
BLOCK = 15  # all four sides of a box are outer ones.
# A box that is thinner than this part of its shorter side is a sheet of one box, not a block. A convention:
# the theory of thin plates holds up to there.
THIN = 0.1
# Broad face of its box that pressed alone, which a pair stores.
NEITHER, UPPER, LOWER = 0, 1, 2


@njit(cache=True, error_model="numpy")
def _nip(both, room, head, meshes, placed, half, side, exposed, stiff):
    """Pressure on a broad face that extends over the sides which are not exposed: its force along the file's
    axes and its middle in the face (force, u, v). The first of `both` sums has the pressure on the box
    itself, the second is scratch."""
    own, whole = both[0], both[1]
    u, v = own[FIRST_U] / own[IN_ALL], own[FIRST_V] / own[IN_ALL]
    du = math.sqrt(max(own[SECOND_U] / own[IN_ALL] - u * u, 0.0))
    dv = math.sqrt(max(own[SECOND_V] / own[IN_ALL] - v * v, 0.0))
    more = math.sqrt(2.0 * head.reach * head.most)  # half of what the deepest contact with a round one spans
    grown = (
        more if exposed & 1 == 0 and -u + _SPAN * du > half[0] else 0.0,
        more if exposed & 2 == 0 and u + _SPAN * du > half[0] else 0.0,
        more if exposed & 4 == 0 and -v + _SPAN * dv > half[1] else 0.0,
        more if exposed & 8 == 0 and v + _SPAN * dv > half[1] else 0.0,
    )
    if grown[0] + grown[1] + grown[2] + grown[3] == 0.0:
        return three(own[FORCE:]), u, v
    aside = (0.5 * (grown[1] - grown[0]), 0.5 * (grown[3] - grown[2]), 0.0)
    wide = (half[0] + 0.5 * (grown[0] + grown[1]), half[1] + 0.5 * (grown[2] + grown[3]), half[2])
    whole[:] = 0.0
    moved = Placed(add(placed.middle, rotate(placed.axes, aside)), placed.axes, placed.frame)
    gather(whole, room, head, meshes, moved, wide, side, stiff)
    force = three(whole[FORCE:])
    if dot(force, force) <= 0.0:  # the additional part is too deep
        return three(own[FORCE:]), u, v
    return force, whole[FIRST_U] / whole[IN_ALL] + aside[0], whole[FIRST_V] / whole[IN_ALL] + aside[1]


@njit(cache=True, error_model="numpy", forceinline=True)
def _is_block(box):
    """True for a block, all six faces of which press; a box of a sheet has two."""
    half = box.half
    return box.exposed == BLOCK and half[2] > THIN * min(half[0], half[1])


@njit(cache=True, error_model="numpy", forceinline=True)
def _broad(half, sign, met, deep):
    """A broad face as a Side. deep: the depth at the face that was `met`, -1 for that face itself."""
    if met == NEITHER:
        return Side(2, sign, 0.0, 0.0, EVER, half[2], False)
    through = -EVER if deep < 0.0 else max(half[2], deep)
    return Side(2, sign, 0.0, 0.0, EVER, through, deep >= 0.0)


@njit(cache=True, error_model="numpy", forceinline=True)
def _side_of(head, half, q, sign):
    """Region in which a face of a block is the one that presses, as a Side."""
    if head.basis > 0.0:
        return Side(q, sign, 1.0, 1.0, half[q], 0.0, False)
    # pressures of two faces are the same where depths go with the power 2/3 of the areas
    p, r = (q + 1) % 3, (q + 2) % 3
    of_p, of_r = (half[q] / half[p]) ** (2.0 / 3.0), (half[q] / half[r]) ** (2.0 / 3.0)
    return Side(q, sign, of_p, of_r, half[q], 0.0, False)


@njit(cache=True, error_model="numpy", forceinline=True)
def _placed(a, b, head):
    """A box in the axes of the mesh's file."""
    frame = matmul(b.r, nine(head.axes))
    place = add(b.x, rotate(b.r, three(head.place)))
    return Placed(back(frame, sub(a.x, place)), transpose_matmul(frame, a.r), frame)


@njit(cache=True, error_model="numpy", **OWNS, **CALLED)
def met_face(a, box, b, head, meshes, met):
    """Broad face of a sheet's box that presses alone now, if `met` was the one before. A mesh that is thick
    everywhere needs no memory."""
    half, placed = box.half, _placed(a, b, head)
    if head.thin == 0 or _is_block(box):
        return NEITHER
    bounds, links = meshes.bounds, meshes.links
    if not overlaps(bounds, links, head.first, head.end, placed.middle, placed.axes, half):
        return NEITHER
    sums, room, deep, pressed = np.empty(SUMS), np.empty((2, 12, 3)), -1.0, NEITHER
    for turned in range(2):
        upper = (turned == 0) == (met != LOWER)
        sums[:] = 0.0
        gather(sums, room, head, meshes, placed, half, _broad(half, 1.0 if upper else -1.0, met, deep), 1.0)
        deep = sums[DEEPEST]
        if sums[IN_ALL] > 0.0:
            pressed += UPPER if upper else LOWER
    return pressed if pressed != UPPER + LOWER else NEITHER


@njit(cache=True, error_model="numpy", **OWNS, **CALLED)
def box_mesh(out, a, box, b, axis, head, meshes, law, met):
    """Box a on a mesh that moves with body b; axis: of the roller, where b is one; met: see met_face."""
    half, exposed = box
    ra, placed, block = a.r, _placed(a, b, head), _is_block(box)
    frame, bounds, links = placed.frame, meshes.bounds, meshes.links
    if not overlaps(bounds, links, head.first, head.end, placed.middle, placed.axes, half):
        return
    over, deep = 1.0, -1.0
    if exposed != 0 and not block:
        over = meet_sides(out, a, box, placed, head, meshes, b, law)
    both, room = np.zeros((2, SUMS)), np.empty((2, 12, 3))
    sums = both[0]  # of the box itself
    lost, spot, out_of = 0.0, a.x, (0.0, 0.0, 0.0)
    for face in range(6 if block else 2):
        q, sign = (2 + face // 2) % 3, 1.0 if face % 2 == 0 else -1.0
        if not block and met == LOWER:  # the face that pressed before comes first
            sign = -sign
        side = _side_of(head, half, q, sign) if block else _broad(half, sign, met, deep)
        p, r = (q + 1) % 3, (q + 2) % 3
        stiff = law.k / head.basis if head.basis > 0.0 else law.k / (4.0 * half[p] * half[r])
        sums[:] = 0.0
        gather(sums, room, head, meshes, placed, half, side, stiff)
        deep = sums[DEEPEST]
        fx, fy, fz = three(sums[FORCE:])
        force = math.sqrt(fx * fx + fy * fy + fz * fz)
        if sums[TOO_DEEP] > 0.0 and (lost == 0.0 or sums[TOO_DEEP] < lost):
            lost, spot = sums[TOO_DEEP], add(a.x, rotate(ra, local(p, r, q, 0.0, 0.0, sign * half[q])))
            out_of = rotate(ra, local(p, r, q, 0.0, 0.0, -sign))
        torque = rotate(frame, scale(over, three(sums[TORQUE:])))
        if force <= 0.0 or over <= 0.0:
            if block:
                turn(out, torque)
            continue
        normal = rotate(frame, (fx / force, fy / force, fz / force))
        u, v = sums[FIRST_U] / sums[IN_ALL], sums[FIRST_V] / sums[IN_ALL]
        du = math.sqrt(max(sums[SECOND_U] / sums[IN_ALL] - u * u, 0.0))
        dv = math.sqrt(max(sums[SECOND_V] / sums[IN_ALL] - v * v, 0.0))
        line, way, pressed = a.x, normal, 0.0
        middle = add(a.x, rotate(ra, local(p, r, q, u, v, sign * half[q])))
        if head.basis > 0.0:
            sides = exposed if q == 2 else BLOCK
            (fx, fy, fz), line_u, line_v = _nip(both, room, head, meshes, placed, half, side, sides, stiff)
            line = add(a.x, rotate(ra, local(p, r, q, line_u, line_v, sign * half[q])))
            way = rotate(frame, scale(1.0 / math.sqrt(fx * fx + fy * fy + fz * fz), (fx, fy, fz)))
            across = cross(axis, way)
            seen = back(ra, across)
            # a parabola of pressure with the deviation s along the way is 2 sqrt(5) s long
            wide = math.sqrt(5.0 * ((du * seen[p]) ** 2 + (dv * seen[r]) ** 2))
            if wide > 0.0:
                pressed = passing(line, across, 2.0 * sums[DEEPEST] / wide, a, b)
        # four forces along one direction have the whole force, but not its whole torque
        turn(out, sub(torque, cross(sub(middle, a.x), rotate(frame, scale(over, three(sums[FORCE:]))))))
        for corner in range(4):
            at_u = u + (du if corner % 2 == 0 else -du)
            at_v = v + (dv if corner < 2 else -dv)
            point = add(a.x, rotate(ra, local(p, r, q, at_u, at_v, sign * half[q])))
            spring, energy = 0.25 * over * force, 0.25 * over * sums[ENERGY]
            if head.basis > 0.0:
                under = add(line, scale(dot(sub(point, line), axis), axis))
                own = add(middle, scale(dot(sub(point, middle), axis), axis))
                # on the mesh's own surface, where that is deepest: see mechanics.point
                point = add(point, scale(sums[DEEPEST] / dot(normal, way), normal))
                nip = Nip(under, own, way, pressed)
                push_in_nip(out, point, normal, nip, Load(spring, sums[DEEPEST], energy), a, b, law)
            else:
                push(out, point, normal, Load(spring, sums[DEEPEST], energy), a, b, law)
    if lost > 0.0 and out[PRESSING] == 0.0:  # a part as near to the other side is in contact there
        push(out, spot, out_of, Load(lost, math.inf, 0.0), a, b, law)


@njit(cache=True, error_model="numpy", **CALLED)
def mesh_near(head, meshes, xa, ra, half, xb, rb, more):
    """True if a box that is larger by `more` on all sides may meet a leaf of the mesh's tree."""
    frame = matmul(rb, nine(head.axes))
    middle = back(frame, sub(xa, add(xb, rotate(rb, three(head.place)))))
    wide = (half[0] + more, half[1] + more, half[2] + more)
    axes = transpose_matmul(frame, ra)
    return overlaps(meshes.bounds, meshes.links, head.first, head.end, middle, axes, wide)
