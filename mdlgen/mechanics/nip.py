"""The pressure of a round on a face of a box: of a roller, a part of one, or the edge of a plate.

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

Over a line of the face that is square to the axis, two points have what the round presses there (`_line`).
Along the axis such lines are added up by Gauss' rule. Where a joint stands oblique to the roller, the
pressure begins and ends at it, so that the sum is taken over pieces, from where an edge of the face comes
into the nip to where it leaves it. Boxes on both sides of that joint then add up to what one sheet has.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.mechanics.point import DISSIPATED, STORED, Load, Nip, passing, push, push_in_nip
from mdlgen.mechanics.vector import add, cross, dot, local, rotate, scale, sub
from mdlgen.program.kernel import BORROWS, FUSED, njit

WHOLE = 4.0  # no sector but the whole round: more than half a turn
_GAUSS = 1.0 / math.sqrt(3.0)
_THIRD = math.sqrt(0.6)
# Places and weights of Gauss' rule of four points.
_INNER, _OUTER = (
    math.sqrt(3.0 / 7.0 - 2.0 / 7.0 * math.sqrt(1.2)),
    math.sqrt(3.0 / 7.0 + 2.0 / 7.0 * math.sqrt(1.2)),
)
_WIDE, _NARROW = 0.5 + math.sqrt(30.0) / 36.0, 0.5 - math.sqrt(30.0) / 36.0


_NONE = 2.0  # no place of a part, which goes from -1 to 1
# An edge that goes by less than this share of the reach over a part is along the axis, and by more than the
# other so oblique that three lines are needed: the square of the pressure along it is of the fourth degree.
_ALONG, _OBLIQUE = 0.0025, 0.025


class Seen(NamedTuple):
    """A round as a face has it: its centre in box axes; its axis in the face, (up, ur) along p and r, of
    length `flat` before that was made 1; how far it leans out of the face, and how far its centre is from it;
    the slopes at which its sector begins and ends; its radius, and that of the round its pressure is of; the
    last two as of a Sector."""

    center: Vector
    up: float
    ur: float
    flat: float
    lean: float
    height: float
    low: float
    high: float
    radius: float
    wide: float
    aside: Vector
    turns: bool


class Span(NamedTuple):
    """Of a line of the face across the axis: where it begins and ends, and whether these are free edges."""

    first: float
    last: float
    open_first: bool
    open_last: bool


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


@njit(cache=True, error_model="numpy", forceinline=True)
def _span(seen, face, half, u):
    """The Span of the line at u along the axis."""
    p, r, _, _, free = face
    e = seen.height * seen.flat + u * seen.lean
    first, last, open_first, open_last = -1e30, 1e30, False, False
    for axis in range(2):
        at = seen.center[p] + u * seen.up if axis == 0 else seen.center[r] + u * seen.ur
        step = -seen.ur if axis == 0 else seen.up
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
    if e * seen.low > first:
        first, open_first = e * seen.low, False
    if e * seen.high < last:
        last, open_last = e * seen.high, False
    return Span(first, last, open_first, open_last)


@njit(cache=True, error_model="numpy", forceinline=True)
def _straight(seen, deep, long):
    """Whether all edges of the face go along the axis, or square to it, over a length, in a nip that is
    `deep` at its middle."""
    goes = long * min(abs(seen.up), abs(seen.ur)) / max(abs(seen.up), abs(seen.ur))
    return goes * goes <= 8.0 * _ALONG * _ALONG * seen.wide * deep


@njit(cache=True, error_model="numpy", forceinline=True)
def _crossings(m, s, rm, rs):
    """Where a place m + s v crosses the bounds of a nip, whose reach squared is rm + rs v."""
    a, b, c = s * s, 2.0 * m * s - rs, m * m - rm
    under = b * b - 4.0 * a * c
    if under < 0.0:
        return _NONE, _NONE
    one = -0.5 * (b + math.copysign(math.sqrt(under), b))
    return one / a if a > 0.0 else _NONE, c / one if one != 0.0 else _NONE


@njit(cache=True, error_model="numpy")
def _cuts(seen, face, half, middle, long):
    """Places where the pressure on a part of the face has a kink, in times half its length `long` from its
    middle along the axis; and whether an edge lies so oblique in the nip that three lines a piece are
    needed."""
    down, on = middle - _GAUSS * long, middle + _GAUSS * long
    one, two = _span(seen, face, half, down), _span(seen, face, half, on)
    # the square of the reach is nearly linear along the axis
    deep_one = seen.radius - seen.height * seen.flat - down * seen.lean
    deep_two = seen.radius - seen.height * seen.flat - on * seen.lean
    reach_one, reach_two = deep_one * (2.0 * seen.wide - deep_one), deep_two * (2.0 * seen.wide - deep_two)
    rm, rs = 0.5 * (reach_one + reach_two), 0.5 * (reach_two - reach_one) / _GAUSS
    fm, fs = 0.5 * (one.first + two.first), 0.5 * (two.first - one.first) / _GAUSS
    lm, ls = 0.5 * (one.last + two.last), 0.5 * (two.last - one.last) / _GAUSS
    slope = max(abs(fs), abs(ls))
    ends = -rm / rs if rs != 0.0 else _NONE
    f1, f2 = _crossings(fm, fs, rm, rs)
    l1, l2 = _crossings(lm, ls, rm, rs)
    f0 = -fm / fs if one.open_first and fs != 0.0 else _NONE
    l0 = -lm / ls if one.open_last and ls != 0.0 else _NONE
    return (f1, f2, l1, l2, f0, l0, ends), abs(ends) < 1.0 or slope * slope > _OBLIQUE * _OBLIQUE * rm


@njit(cache=True, error_model="numpy", forceinline=True)
def _next(v, cuts):
    """The next of the `cuts` after v, or the end of the part."""
    found = 1.0
    for cut in cuts:
        if v + 1e-9 < cut < found - 1e-9:
            found = cut
    return found


@njit(cache=True, error_model="numpy", **BORROWS, **FUSED)
def press(out, face, a, half, b, roller, sector, law):
    """One face of a box against a cylinder, whose centre, axis and sector are given in box axes.

    face: (p, r, q, sign, free), its in-plane axes and its normal axis, on which side it is, and which edges
    p_min, p_max, r_min, r_max have no neighbour, as a bit mask; roller: (centre, axis, radius, width).
    """
    p, r, q, sign, _ = face
    l0, al, radius, width = roller
    to, angle = sector.middle, sector.angle
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
    wide = law.spread if law.spread > 0.0 else radius
    seen = Seen(l0, up, ur, na, lean, height, steep_low, steep_high, radius, wide, sector.aside, sector.turns)
    deep_low, deep_high = radius - height * na - low * lean, radius - height * na - high * lean
    if deep_low <= 0.0 and deep_high <= 0.0:
        return
    straight = not law.shared or (
        deep_low > 0.0 and deep_high > 0.0 and _straight(seen, 0.5 * (deep_low + deep_high), high - low)
    )
    inner = abs(c1 - c2)
    for part in range(3 if law.shared else 1):
        # between two corners the face's edges are straight
        begin, end = low, high
        if law.shared:
            begin = max(low, base - inner) if part == 1 else max(low, base + inner) if part == 2 else low
            end = min(high, base - inner) if part == 0 else min(high, base + inner) if part == 1 else high
        if end - begin <= 1e-12 * width:
            continue
        middle, long = 0.5 * (begin + end), 0.5 * (end - begin)
        cuts, oblique = (_NONE, _NONE, _NONE, _NONE, _NONE, _NONE, _NONE), False
        if not straight:
            cuts, oblique = _cuts(seen, face, half, middle, long)
        v = -1.0
        while v < 1.0:
            to_v = _next(v, cuts)
            center, half_piece = middle + 0.5 * (v + to_v) * long, 0.5 * (to_v - v) * long
            # the piece's part of k
            weight = law.k * (2.0 * half_piece * na / basis if law.shared else 1.0)
            apart = half_piece * (_THIRD if oblique else _GAUSS)
            for side in range(3 if oblique else 2):
                part_of = 0.5 if not oblique else 4.0 / 9.0 if side == 2 else 5.0 / 18.0
                u = center + (apart if side == 1 else -apart if side == 0 else 0.0)
                _line(out, face, a, half, b, seen, law, u, part_of * weight)
            v = to_v


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS, **FUSED)
def _line(out, face, a, half, b, seen, law, u, weight):
    """What a round presses on the line of a face at u along its axis, which has `weight` of the stiffness."""
    p, r, q, sign, _ = face
    l0, up, ur, na, lean, radius, wide = (
        seen.center,
        seen.up,
        seen.ur,
        seen.flat,
        seen.lean,
        seen.radius,
        seen.wide,
    )
    e = seen.height * na + u * lean  # distance of the axis from the face
    if e <= 0.0 or e >= radius:
        return
    first, last, open_first, open_last = _span(seen, face, half, u)
    if last <= first:
        return
    nearest = min(max(0.0, first), last)
    edge = (first > 0.0 and open_first) or (last < 0.0 and open_last)
    spread = law.shared and not edge
    # the round that the pressure is of, as deep at the contact line
    of, off = radius, e
    if spread and wide > radius - e:
        of, off = wide, wide - (radius - e)
    depth = of - math.sqrt(nearest * nearest + off * off)
    if depth <= 0.0:
        return
    foundation = 3.0 / (4.0 * math.sqrt(2.0 * wide))
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
    way = rotate(a.r, local(p, r, q, lean * up, lean * ur, -na * sign))
    under = local(p, r, q, l0[p] + u * up, l0[r] + u * ur, sign * half[q])
    line = add(add(a.x, rotate(a.r, under)), seen.aside)
    across = rotate(a.r, local(p, r, q, -ur, up, 0.0))
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
    pressed = draw * passing(line, across, reach / of, a, b) if spread and seen.turns else 0.0
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
        normal = add(scale((t + turned * off) / slant, across), scale((off - turned * t) / slant, way))
        # on the normal's line, as far from the axis as the roller's own surface: it rolls at omega R
        beyond = (radius - e) * distance / off if spread else radius - distance
        at = add(add(line, scale(t, across)), scale(beyond, normal))
        if spread:
            nip = Nip(line, add(line, scale(center, across)), way, pressed)
            push_in_nip(out, at, normal, nip, Load(spring, depth, energy), a, b, law)
        else:
            push(out, at, normal, Load(spring, depth, energy), a, b, law)
