"""The patch of a box's face under a round: the ends, depths and energies of lines across its axis, and the
places along the axis where these have kinks. The forces are in nip.py."""

from __future__ import annotations

import math
from typing import NamedTuple

from mdlgen.mechanics.frame import Vector
from mdlgen.program.kernel import njit

GAUSS = 1.0 / math.sqrt(3.0)

NONE = 2.0  # outside of any part, which goes from -1 to 1.
# Displacement of an edge over a part, relative to the reach. Below the first value it counts as parallel to
# the axis. Above the second one it is oblique and needs three lines: the squared pressure is of the fourth
# degree.
_ALONG, _OBLIQUE = 0.0025, 0.025


class Seen(NamedTuple):
    """A round relative to a face. In order: its centre in box axes; its axis in the face, (up, ur) along p
    and r, whose length was `flat` before normalisation; its inclination out of the face, and the distance of
    its centre from it; the slopes at which its sector begins and ends; its radius, and that of the round that
    defines the pressure; `aside` and `turns` as in a Sector; `flush`: true if the face is deepest where the
    round ends or at a joint, and not at a free edge. Then the depth grows with motion perpendicular to the
    face, else with motion perpendicular to the axis."""

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
    flush: bool


class Span(NamedTuple):
    """Beginning and end of a line of the face across the axis; true for each that is a free edge."""

    first: float
    last: float
    open_first: bool
    open_last: bool


class Lie(NamedTuple):
    """A line of the face under the round. In order: its distance from the axis; the place nearest to the
    contact line; true if the pressure is spread over it; the radius of the round that defines the pressure,
    the distance from its axis, and its reach; beginning and end of the pressure; the greatest depth, 0: none;
    the factor by which pressure beyond a free edge is drawn in, 1: not."""

    e: float
    nearest: float
    spread: bool
    of: float
    off: float
    reach: float
    left: float
    right: float
    depth: float
    draw: float


@njit(cache=True, error_model="numpy", forceinline=True)
def _stored(t, reach):
    """Integral from 0 to t of the square of a pressure that falls as 1 - (t/reach)^2."""
    s = (t / reach) ** 2
    return t * (1.0 - s * (2.0 / 3.0 - 0.2 * s))


@njit(cache=True, error_model="numpy", forceinline=True)
def at_ends(left, right, reach):
    """Difference of the squared pressure at both ends, 0 beyond the reach."""
    return (1.0 - (right / reach) ** 2) ** 2 - (1.0 - (left / reach) ** 2) ** 2


@njit(cache=True, error_model="numpy", forceinline=True)
def span_of(seen, face, half, u):
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
def free_at(face, up, ur, high):
    """True if the edge at which the face ends along the axis, at the high end or the low one, is free."""
    on = ur if abs(ur) >= abs(up) else up
    bit = 1 if (on > 0.0) != high else 2
    _, _, _, _, free = face
    return free & (bit << 2 if abs(ur) >= abs(up) else bit) != 0


@njit(cache=True, error_model="numpy", forceinline=True)
def lie_of(seen, face, half, shared, u):
    """The Lie of the line of a face at u along the axis."""
    radius, wide = seen.radius, seen.wide
    e = seen.height * seen.flat + u * seen.lean
    none = Lie(e, 0.0, False, radius, e, 1.0, 0.0, 0.0, 0.0, 1.0)
    if e <= 0.0 or e >= radius:
        return none
    first, last, open_first, open_last = span_of(seen, face, half, u)
    if last <= first:
        return none
    nearest = min(max(0.0, first), last)
    edge = (first > 0.0 and open_first) or (last < 0.0 and open_last)
    spread = shared and not edge
    # the round that the pressure is of, as deep at the contact line
    of, off = radius, e
    if spread and wide > radius - e:
        of, off = wide, wide - (radius - e)
    depth = of - math.sqrt(nearest * nearest + off * off)
    if depth <= 0.0:
        return none
    reach = math.sqrt(of * of - off * off)
    left = -reach if open_first else max(first, -reach)
    right = reach if open_last else min(last, reach)
    # pressure beyond a free edge is drawn in to the contact line as the edge approaches it
    draw = 1.0
    if spread and open_first:
        draw = min(draw, -first / reach)
    if spread and open_last:
        draw = min(draw, last / reach)
    return Lie(e, nearest, spread, of, off, reach, left, right, depth, draw)


@njit(cache=True, error_model="numpy", forceinline=True)
def foundation(seen):
    """Stiffness of the foundation for a stiffness of 1 of the whole nip."""
    return 3.0 / (4.0 * math.sqrt(2.0 * seen.wide))


@njit(cache=True, error_model="numpy", forceinline=True)
def scale_of_energy(seen, lie):
    """Factor of `_stored` and `at_ends`; the round is z/(4R) narrower than its parabola."""
    z = seen.radius - lie.e
    return 0.5 * foundation(seen) * (1.0 + 0.25 * z / lie.of) * z * z


@njit(cache=True, error_model="numpy", forceinline=True)
def energy_of(seen, lie):
    """Energy that a line stores, for a stiffness of 1."""
    if lie.spread:
        whole = _stored(lie.right, lie.reach) - _stored(lie.left, lie.reach)
        return scale_of_energy(seen, lie) * whole
    return 0.4 * lie.depth * lie.depth * math.sqrt(lie.depth)


@njit(cache=True, error_model="numpy", forceinline=True)
def straight_edges(seen, deep, long):
    """True if all edges of the face are parallel or perpendicular to the axis, over a length, in a nip that
    is `deep` at its middle."""
    goes = long * min(abs(seen.up), abs(seen.ur)) / max(abs(seen.up), abs(seen.ur))
    return goes * goes <= 8.0 * _ALONG * _ALONG * seen.wide * deep


@njit(cache=True, error_model="numpy", forceinline=True)
def _crossings(m, s, rm, rs):
    """Values v at which a place m + s v crosses the bounds of a nip, whose reach squared is rm + rs v."""
    a, b, c = s * s, 2.0 * m * s - rs, m * m - rm
    under = b * b - 4.0 * a * c
    if under < 0.0:
        return NONE, NONE
    one = -0.5 * (b + math.copysign(math.sqrt(under), b))
    return one / a if a > 0.0 else NONE, c / one if one != 0.0 else NONE


@njit(cache=True, error_model="numpy")
def cuts_of(seen, face, half, middle, long):
    """Places where the pressure on a part of the face has a kink, measured from its middle along the axis and
    relative to half its length `long`. Also returns True if an edge is so oblique in the nip that each piece
    needs three lines."""
    down, on = middle - GAUSS * long, middle + GAUSS * long
    one, two = span_of(seen, face, half, down), span_of(seen, face, half, on)
    # the square of the reach is nearly linear along the axis
    deep_one = seen.radius - seen.height * seen.flat - down * seen.lean
    deep_two = seen.radius - seen.height * seen.flat - on * seen.lean
    reach_one, reach_two = deep_one * (2.0 * seen.wide - deep_one), deep_two * (2.0 * seen.wide - deep_two)
    rm, rs = 0.5 * (reach_one + reach_two), 0.5 * (reach_two - reach_one) / GAUSS
    fm, fs = 0.5 * (one.first + two.first), 0.5 * (two.first - one.first) / GAUSS
    lm, ls = 0.5 * (one.last + two.last), 0.5 * (two.last - one.last) / GAUSS
    slope = max(abs(fs), abs(ls))
    ends = -rm / rs if rs != 0.0 else NONE
    f1, f2 = _crossings(fm, fs, rm, rs)
    l1, l2 = _crossings(lm, ls, rm, rs)
    f0 = -fm / fs if one.open_first and fs != 0.0 else NONE
    l0 = -lm / ls if one.open_last and ls != 0.0 else NONE
    return (f1, f2, l1, l2, f0, l0, ends), abs(ends) < 1.0 or slope * slope > _OBLIQUE * _OBLIQUE * rm


@njit(cache=True, error_model="numpy", forceinline=True)
def next_of(v, cuts):
    """The next of the `cuts` after v, or the end of the part."""
    found = 1.0
    for cut in cuts:
        if v + 1e-9 < cut < found - 1e-9:
            found = cut
    return found
