"""Contact between a box and a cylinder or a part of one, and two parallel cylinders; see plate.py for a box
and a plate, facing.py for two boxes.

The force of one box under a roller is k z^1.5 (Eq. 10), z the depth of the point of its face nearest to the
roller's axis, times the part of the roller's width that the box covers. Where boxes lie side by side under
one roller (`share: width`), they also share k across it: each takes its part of the elastic foundation that
has the same law. A pressure K zeta per area, zeta the depth of each point, under a roller of radius R and
width w pressed z deep into a flat face, gives F = K w 4/3 sqrt(2R) z^1.5; with K = 3 k/(4 w sqrt(2 R)) that
is k z^1.5 again. So a roller that passes from box to box feels one sheet. Beyond a free edge nothing takes
over: there the box keeps the whole, about the contact line of the roller as if the sheet went on, and as an
edge comes to that line the pressure draws in to it, since force, moment and damping of both sides of that
place must be the same. `share: pair` gives every box the full k, as MotionSolve does.

Two rollers that face each other across a sheet must press alike on each of two boxes as a joint passes
between them: what one of them presses further along than the other would turn the boxes out of the sheet, by
a kink at every joint that passes, and fling a light sheet. With the pressure k z^1.5 of a round of radius R
each reaches sqrt(2 R z), and in balance z goes with k^(-2/3). So the pressure of rollers that face each other
is that of rounds whose radii go with k^(2/3) (`spread`, see mdlgen.model.nips); the force and its line are
those of the roller. Where the radius is not the roller's, the moment on a box that ends in the nip is not
that of the stored energy, but differs by (spread - R) times the energy per length at that end. What this
takes where a sheet leaves a nip with another curvature than it came with is counted with what is dissipated.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.frame import Sector
from mdlgen.mechanics.point import DISSIPATED, STORED, Load, Nip, passing, push, push_in_nip
from mdlgen.mechanics.vector import add, back, cross, dot, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, FUSED, OWNS, njit

WHOLE = 4.0  # no sector but the whole round: more than half a turn
_GAUSS = 1.0 / math.sqrt(3.0)
# Places and weights of Gauss' rule of four points.
_INNER, _OUTER = (
    math.sqrt(3.0 / 7.0 - 2.0 / 7.0 * math.sqrt(1.2)),
    math.sqrt(3.0 / 7.0 + 2.0 / 7.0 * math.sqrt(1.2)),
)
_WIDE, _NARROW = 0.5 + math.sqrt(30.0) / 36.0, 0.5 - math.sqrt(30.0) / 36.0


@njit(cache=True, error_model="numpy", forceinline=True)
def _stored(t, reach):
    """Integral from 0 to t of the square of a pressure that falls as 1 - (t/reach)^2."""
    s = (t / reach) ** 2
    return t * (1.0 - s * (2.0 / 3.0 - 0.2 * s))


@njit(cache=True, error_model="numpy", forceinline=True)
def _at_ends(left, right, reach):
    """The difference of what `_stored` adds up at both ends, 0 beyond the reach."""
    return (1.0 - (right / reach) ** 2) ** 2 - (1.0 - (left / reach) ** 2) ** 2


@njit(cache=True, error_model="numpy", forceinline=True)
def _at_two(middle, apart, of, off):
    """What presses across and along a face at two places of a round, beside the middle between them."""
    across = along = 0.0
    for side in (-1.0, 1.0):
        t = middle + side * apart
        distance = math.sqrt(t * t + off * off)
        across += (of / distance - 1.0) * off
        along += (of / distance - 1.0) * t
    return across, along


@njit(cache=True, error_model="numpy", forceinline=True)
def _over(left, right, of, off):
    """Integral from left to right of what a round presses across a face, half the length times that."""
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    inner, _ = _at_two(middle, _INNER * half, of, off)
    outer, _ = _at_two(middle, _OUTER * half, of, off)
    return half * (_WIDE * inner + _NARROW * outer)


@njit(cache=True, error_model="numpy", **BORROWS)
def _part_of_nip(left, right, reach, of, off):
    """Factor of the forces, and angle to turn the normals by, of two points for a part of a nip, so that all
    parts of it add up to what two points have of the whole, and push nothing along faces that go on as one.

    Along a face the pressure zeta of a round adds up to the difference of zeta^2/2 at both ends.
    """
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    across, along = _at_two(middle, _GAUSS * half, of, off)
    whole, _ = _at_two(0.0, _GAUSS * reach, of, off)
    share = reach * whole / _over(-reach, reach, of, off)
    factor = share * _over(left, right, of, off) / (half * across)
    low, high = of - math.sqrt(left * left + off * off), of - math.sqrt(right * right + off * off)
    ends = 0.5 * share * (low - high) * (low + high)
    return factor, (ends / (factor * half) - along) / across


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def _face(out, face, a, half, b, roller, sector, law):
    """One face of a box against a cylinder, whose centre, axis and sector are given in box axes.

    face: (p, r, q, sign, free), its in-plane axes and its normal axis, on which side it is, and which edges
    p_min, p_max, r_min, r_max have no neighbour, as a bit mask; roller: (centre, axis, radius, width).
    """
    p, r, q, sign, free = face
    l0, al, radius, width = roller
    to, angle, aside, turns = sector
    k, shared = law.k, law.shared
    ra = a.r
    na = math.sqrt(al[p] * al[p] + al[r] * al[r])
    if na < 0.2:  # the roller stands on its end
        return
    up, ur = al[p] / na, al[r] / na  # along the axis in the face; across it: (-ur, up)
    lean = sign * al[q]
    height = sign * l0[q] - half[q]
    # corners of the face along the axis
    c1, c2 = abs(up) * half[p], abs(ur) * half[r]
    base = -(l0[p] * up + l0[r] * ur)
    low = max(base - c1 - c2, (-0.5 * width + height * lean) / na)
    high = min(base + c1 + c2, (0.5 * width + height * lean) / na)
    if high <= low:
        return
    steep_low, steep_high, basis = -1e30, 1e30, width
    if angle < WHOLE:
        # directions from the axis to points of the face, against that to the contact line; 1.5 rad is far
        middle = math.atan2(to[r] * up - to[p] * ur, lean * (to[p] * up + to[r] * ur) - na * sign * to[q])
        low_angle, high_angle = max(middle - angle, -1.5), min(middle + angle, 1.5)
        if high_angle <= low_angle:
            return
        steep_low, steep_high = math.tan(low_angle), math.tan(high_angle)
        basis = 2.0 * (c1 + c2) * na
    inner = abs(c1 - c2)
    wide = law.spread if law.spread > 0.0 else radius
    foundation = 3.0 / (4.0 * math.sqrt(2.0 * wide))
    for part in range(3):
        # between two corners the face's edges are straight, so two points integrate along the axis
        begin = max(low, base - inner) if part == 1 else max(low, base + inner) if part == 2 else low
        end = min(high, base - inner) if part == 0 else min(high, base + inner) if part == 1 else high
        if not shared:
            if part > 0:
                break
            begin, end = low, high
        if end - begin <= 1e-12 * width:
            continue
        # the station's part of k
        weight = 0.5 * k * ((end - begin) * na / basis if shared else 1.0)
        for station in range(2):
            u = 0.5 * (begin + end) + (station - 0.5) * _GAUSS * (end - begin)
            e = height * na + u * lean  # distance of the axis from the face
            if e <= 0.0 or e >= radius:
                continue
            # span of the face across the axis at this station, and whether its ends are free edges
            first, last, open_first, open_last = -1e30, 1e30, False, False
            for axis in range(2):
                at = l0[p] + u * up if axis == 0 else l0[r] + u * ur
                step = -ur if axis == 0 else up
                h = half[p] if axis == 0 else half[r]
                if abs(step) < 1e-12:
                    if abs(at) > h:
                        last = first - 1.0
                    continue
                open_low, open_high = free & (1 << (2 * axis)) != 0, free & (2 << (2 * axis)) != 0
                t1, t2 = (-h - at) / step, (h - at) / step
                if t1 > t2:
                    t1, t2, open_low, open_high = t2, t1, open_high, open_low
                if t1 > first:
                    first, open_first = t1, open_low
                if t2 < last:
                    last, open_last = t2, open_high
            if e * steep_low > first:
                first, open_first = e * steep_low, False
            if e * steep_high < last:
                last, open_last = e * steep_high, False
            if last <= first:
                continue
            nearest = min(max(0.0, first), last)
            edge = (first > 0.0 and open_first) or (last < 0.0 and open_last)
            spread = shared and not edge
            # the round that the pressure is of, as deep at the contact line
            of, off = radius, e
            if spread and wide > radius - e:
                of, off = wide, wide - (radius - e)
            depth = of - math.sqrt(nearest * nearest + off * off)
            if depth <= 0.0:
                continue
            reach = math.sqrt(of * of - off * off)
            left = -reach if open_first else max(first, -reach)
            right = reach if open_last else min(last, reach)
            # what lies beyond a free edge draws in to the contact line as the edge comes to it
            draw = 1.0
            if spread and open_first:
                draw = min(draw, -first / reach)
            if spread and open_last:
                draw = min(draw, last / reach)
            # from the axis to the contact line: back along the face's normal, turned with the lean
            way = rotate(ra, local(p, r, q, lean * up, lean * ur, -na * sign))
            under = local(p, r, q, l0[p] + u * up, l0[r] + u * ur, sign * half[q])
            line = add(add(a.x, rotate(ra, under)), aside)
            across = rotate(ra, local(p, r, q, -ur, up, 0.0))
            # the 2-point rule costs 5/12 z/R of the force, the lean of the pressure 1/3 z/R
            lost = 5.0 / 12.0 + draw * draw / 3.0
            if spread:
                # energies of two points add up to it where they have all of the nip, and else do not; the
                # round is z/(4R) narrower than its parabola
                part = 0.5 * weight * foundation * (1.0 + 0.25 * (radius - e) / of)
                out[STORED] += part * (_stored(right, reach) - _stored(left, reach)) * (radius - e) ** 2
                if of != radius:
                    ends = part * _at_ends(left, right, reach) * (radius - e) ** 2
                    out[DISSIPATED] += (of - radius) * ends * dot(sub(a.w, b.w), cross(across, way))
            pressed = draw * passing(line, across, reach / of, a, b) if spread and turns else 0.0
            middle_t, apart = 0.5 * (left + right), 0.5 * _GAUSS * (right - left)
            low_zeta = of - math.sqrt((middle_t - apart) ** 2 + off * off)
            high_zeta = of - math.sqrt((middle_t + apart) ** 2 + off * off)
            factor, turned = 1.0, 0.0
            if spread and (left > -reach or right < reach):
                factor, turned = _part_of_nip(left, right, reach, of, off)
                turned *= draw
            # where what presses on this box has its middle
            center = draw * (middle_t + apart * (high_zeta - low_zeta) / (high_zeta + low_zeta))
            for point in range(2 if spread else 1):
                t = nearest
                if spread:
                    t = middle_t + (2.0 * point - 1.0) * apart
                zeta = of - math.sqrt(t * t + off * off)
                if spread:
                    length = 0.5 * (right - left) * (1.0 + lost * (radius - e) / of) * factor
                    spring = weight * foundation * length * zeta
                    energy = 0.6 * spring * zeta  # 2/5 F z: both points are 2/3 z deep
                    out[STORED] -= energy
                    t *= draw
                else:
                    spring = weight * zeta * math.sqrt(zeta)
                    energy = 0.4 * spring * zeta
                distance = math.sqrt(t * t + off * off)
                slant = distance * math.sqrt(1.0 + turned * turned)
                normal = add(
                    scale((t + turned * off) / slant, across), scale((off - turned * t) / slant, way)
                )
                # on the normal's line, as far from the axis as the roller's own surface: it rolls at omega R
                beyond = (radius - e) * distance / off if spread else radius - distance
                at = add(add(line, scale(t, across)), scale(beyond, normal))
                if spread:
                    nip = Nip(line, add(line, scale(center, across)), way, pressed)
                    push_in_nip(out, at, normal, nip, Load(spring, depth, energy), a, b, law)
                else:
                    push(out, at, normal, Load(spring, depth, energy), a, b, law)


@njit(cache=True, error_model="numpy")
def local(p, r, q, a, b, c):
    """The vector with components a, b, c on the axes p, r, q."""
    x = a if p == 0 else b if r == 0 else c
    y = a if p == 1 else b if r == 1 else c
    z = a if p == 2 else b if r == 2 else c
    return (x, y, z)


@njit(cache=True, error_model="numpy", **BORROWS)
def box_cylinder(out, a, box, b, roller, law):
    """Box a against a Cylinder b; out: see mechanics.point."""
    nowhere = (0.0, 0.0, 0.0)
    box_sector(out, a, box, b, roller, Sector(roller.axis, WHOLE, nowhere, True), law)


@njit(cache=True, error_model="numpy", **BORROWS)
def box_sector(out, a, box, b, roller, sector, law):
    """As box_cylinder for a Sector of the round.

    Boxes share k by what of the sector each covers, so that a box over it has k z^1.5.
    """
    half, exposed = box
    gap = sub(b.x, a.x)
    near = math.sqrt(dot(half, half)) + math.sqrt(
        roller.radius * roller.radius + 0.25 * roller.width * roller.width
    )
    if dot(gap, gap) > near * near:
        return
    l0, al = back(a.r, gap), back(a.r, roller.axis)
    seen, width = Sector(back(a.r, sector.middle), sector.angle, sector.aside, sector.turns), roller.width
    within = (l0, al, roller.radius, width)
    sign = 1.0 if l0[2] >= 0.0 else -1.0
    upright = abs(al[2]) > 0.98  # a roller that stands across the sheet meets its sides only
    if abs(l0[2]) > half[2] and not upright:
        _face(out, (0, 1, 2, sign, exposed), a, half, b, within, seen, law)
        return
    # the axis lies within the thickness, or crosses it: the roller meets a side
    if upright:
        along = min(max(-l0[2] / al[2], -0.5 * width), 0.5 * width)
        if abs(l0[2] + along * al[2]) > half[2]:
            return
    sign = 1.0 if l0[0] >= 0.0 else -1.0
    if exposed & (2 if sign > 0 else 1) and abs(l0[0]) > half[0]:
        free = ((exposed >> 2) & 3) + 12  # y_min, y_max, and both faces
        _face(out, (1, 2, 0, sign, free), a, half, b, within, seen, law)
    sign = 1.0 if l0[1] >= 0.0 else -1.0
    if exposed & (8 if sign > 0 else 4) and abs(l0[1]) > half[1]:
        free = 3 + ((exposed & 3) << 2)
        _face(out, (2, 0, 1, sign, free), a, half, b, within, seen, law)


@njit(cache=True, error_model="numpy", **OWNS)
def clip(points, count, way, limit):
    """Cuts a polygon by way . point <= limit, in place; returns its number of points."""
    kept = np.empty((12, 3))
    found = 0
    for i in range(count):
        one, two = points[i], points[(i + 1) % count]
        d1, d2 = limit - dot(way, one), limit - dot(way, two)
        if d1 >= 0.0:
            for c in range(3):
                kept[found, c] = one[c]
            found += 1
        if (d1 > 0.0 and d2 < 0.0) or (d1 < 0.0 and d2 > 0.0):
            for c in range(3):
                kept[found, c] = one[c] + (two[c] - one[c]) * (d1 / (d1 - d2))
            found += 1
    for k in range(found):
        for c in range(3):
            points[k, c] = kept[k, c]
    return found


@njit(cache=True, error_model="numpy", **BORROWS)
def face_corners(points, a, half, facing, b):
    """Corners of the face of box a that looks along -`facing` (box axes) into `points`, in the axes of b.

    Returns the area of the face.
    """
    q = looking(facing)
    for corner in range(4):
        at = face_corner(corner, a, half, facing, b)
        for i in range(3):
            points[corner, i] = at[i]
    return 4.0 * half[(q + 1) % 3] * half[(q + 2) % 3]


@njit(cache=True, error_model="numpy", forceinline=True)
def looking(facing):
    """The axis of a box that is closest to a direction in box axes."""
    if abs(facing[2]) >= max(abs(facing[0]), abs(facing[1])):
        return 2
    return 0 if abs(facing[0]) > abs(facing[1]) else 1


@njit(cache=True, error_model="numpy", forceinline=True)
def face_corner(corner, a, half, facing, b):
    """One of the four `face_corners`, in the axes of b."""
    q = looking(facing)
    p, r = (q + 1) % 3, (q + 2) % 3
    side = -half[q] if facing[q] > 0.0 else half[q]
    sp = half[p] if corner == 0 or corner == 3 else -half[p]
    sr = half[r] if corner < 2 else -half[r]
    return back(b.r, sub(add(a.x, rotate(a.r, local(p, r, q, sp, sr, side))), b.x))


@njit(cache=True, error_model="numpy", **BORROWS)
def cylinder_cylinder(out, a, one, b, two, law):
    """Two parallel Cylinders; k is shared by the part of the narrower one's width that they meet on."""
    gap = sub(a.x, b.x)
    offset = dot(gap, two.axis)
    across = sub(gap, scale(offset, two.axis))
    distance = math.sqrt(dot(across, across))
    depth = one.radius + two.radius - distance
    low = max(offset - 0.5 * one.width, -0.5 * two.width)
    high = min(offset + 0.5 * one.width, 0.5 * two.width)
    if depth <= 0.0 or distance <= 0.0 or high <= low:
        return
    share = (high - low) / min(one.width, two.width)
    normal = scale(1.0 / distance, across)
    spring = share * law.k * depth * math.sqrt(depth)
    point = add(b.x, add(scale(0.5 * (low + high), two.axis), scale(two.radius - 0.5 * depth, normal)))
    push(out, point, normal, Load(spring, depth, 0.4 * spring * depth), a, b, law)
