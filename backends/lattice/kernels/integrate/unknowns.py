"""Unknowns of rollers and pressed plates that move a contact point, and the directions of that motion."""

from __future__ import annotations

from mdlgen.mechanics.arm import turn_of, way_of
from mdlgen.mechanics.vector import add, cross, dot, scale, three
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", forceinline=True, **BORROWS)
def moving(body, arm, x, sign, direction, index, count):
    """The unknowns of a roller or a pressed plate at x that move a contact point, each with the direction of
    its velocity there."""
    if body.slide >= 0:
        way = add(way_of(body, x), cross(turn_of(body), arm))
        for i in range(3):
            direction[count, i] = sign * way[i]
        index[count] = body.slide
        count += 1
    if body.spin >= 0:
        turn = cross(scale(body.ratio, three(body.axis)), arm)
        for i in range(3):
            direction[count, i] = sign * turn[i]
        index[count] = body.spin
        count += 1
    return count


@njit(cache=True, error_model="numpy", **BORROWS)
def turning_of(bodies, pair, which, axis):
    """Unknown number `which`, from 0 to 3, of a pair's rollers, -1: none; and the angular velocity about an
    axis that it gives the first body against the second."""
    body, sign = bodies[pair.a if which < 2 else pair.b], 1.0 if which < 2 else -1.0
    if which % 2 == 0:
        return body.spin, sign * body.ratio * dot(three(body.axis), axis)
    if body.swings != 2:
        return -1, 0.0
    return body.slide, sign * dot(turn_of(body), axis)
