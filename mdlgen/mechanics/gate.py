"""Plates and meshes that a law of time moves, or forces: they turn about a fixed axis or slide along a line.

A prescribed one has `swings` TURNS or SLIDES in its body record, no unknowns, and its law in `drive`: time,
place and rate of each of its `corners` in turn. Places are angles [rad] or displacements [mm] from the given
place of the body. Between two corners the law is the cubic with their places and rates, so place and velocity
are continuous. Without rates it covers the part 3 s^2 - 2 s^3 of the displacement, s the part of the time.
Before the first corner and after the last one the body is at rest.

A free one is like a pressed body or one on an arm (mechanics.arm): its place is the unknown of its `slide`.
Its `stops` are two places, beyond which a spring k z with the damping of Eq. 11 acts: 1 + beta s(rate), where
z is the distance beyond, and s the sign of the rate of z. The sign is smoothed over rates of BLUNT omega z,
where
omega^2 = k/inertia: so the restitution does not depend on the speed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.arm import AXIAL, INERTIA
from mdlgen.mechanics.laws import damping_share, sign_step
from mdlgen.mechanics.vector import add, cross, dot, exp_rotation, mat, matmul, rotate, scale, sub, three, vec
from mdlgen.model.limits import MOST_CORNERS, MOST_PLACES
from mdlgen.model.tables import Floats, MovingPart, StopsPart
from mdlgen.program.kernel import BORROWS, njit

# Values of `swings`: from GATE on a law of time moves the body.
GATE, TURNS, SLIDES = 3, 3, 4
WIDE = 3  # numbers of a corner
# Of a record's `stops`: places of both, stiffness (0: there are none), beta, and BLUNT omega [1/ms].
LOW, HIGH, STOP, SHARE, OVER = 0, 1, 2, 3, 4
STOPS = [("stops", "f8", 5)]
# Part of the speed of an impact over which the damping of a stop changes its sign. At 0.05 a restitution of
# 0.2 is 1 % too high; for greater ones the error is smaller.
BLUNT = 0.05

assert WIDE * MOST_PLACES <= 2 * MOST_CORNERS, "the corners of a gate fit in the array of a drive's"


class Course(NamedTuple):
    """Place and rate of a gate at a time."""

    place: float
    rate: float


class Stop(NamedTuple):
    """Action of a stop: its force along the motion, the decrease of that per place and per rate, its stored
    energy and its dissipated power."""

    force: float
    by_place: float
    by_rate: float
    stored: float
    lost: float


def gate(row: np.void, moving: MovingPart, length: float, mass: float, time: float) -> None:
    """Fills a body record of a part that moves; the factors are a millimetre, a gram and a millisecond in the
    solver's units, where a newton stays one."""
    row["pivot"] = moving.pivot * length
    row["turn" if moving.turns else "way"] = moving.axis
    if not moving.free:
        row["swings"] = TURNS if moving.turns else SLIDES
        unit = 1.0 if moving.turns else length
        write(row, moving.corners * (time, unit, unit / time))
        return
    # a spring of a pivot is in N mm/rad, one of a slide in N/mm
    unit = length if moving.turns else 1.0 / length
    push = length if moving.turns else 1.0
    inertia = moving.inertia * mass * (length**2 if moving.turns else 1.0)
    row["press"][:AXIAL] = (
        moving.stiffness * unit,
        moving.damping * unit * time,
        moving.force * push,
        inertia,
    )
    if moving.turns:  # like the arm of a driven roller, which turns with it
        row["swings"], row["carries"], row["axis"] = 2, 1, moving.axis
        row["mass"], row["hang"] = 0.0, moving.moment * mass * length
    if moving.stops is not None:
        put_stops(row, moving.stops, 1.0 if moving.turns else length, unit)


def put_stops(row: np.void, stops: StopsPart, along: float, stiff: float, start: float = 0.0) -> None:
    """Fills `stops` of a body record whose `press` is filled; `along` and `stiff` are a unit of a place and
    of a stiffness in the solver's units, `start` is the place as the run begins."""
    beta = damping_share.py_func(stops.restitution)
    stiffness = stops.stiffness * stiff
    omega = math.sqrt(stiffness / row["press"][INERTIA])
    low, high = ((end - start) * along for end in (stops.low, stops.high))
    row["stops"] = (low, high, stiffness, beta, BLUNT * omega)


def write(row: np.void, corners: Floats) -> None:
    """Writes the corners (n, 3) of a law, in the solver's units, into a body record."""
    row["corners"] = len(corners)
    row["drive"] = 0.0
    row["drive"][: corners.size] = np.asarray(corners).ravel()


def command(bodies: np.ndarray, row: int, t: float, value: float, duration: float) -> None:
    """Sends the gate of a body record to a place: rewrites its law from the time t on. In `duration` it moves
    from its place and its speed at t to `value`, where it stops. All in the solver's units. The law before t
    is lost: a step that is taken afterwards must not begin before t. Where sheets sleep, a run works on a
    copy of the records (lattice.integrate.awake), which needs the same command.

    Raises ValueError where the body is no gate or the duration is not above 0.
    """
    body = bodies[row]
    if body["swings"] < GATE:
        raise ValueError(f"body {row} has no law of its place that could be rewritten")
    if not duration > 0.0:
        raise ValueError(f"a gate cannot move within {duration:g}; allowed: a duration above 0")
    now = course.py_func(bodies.view(np.recarray)[row], t)
    write(body, np.array([[t, now.place, now.rate], [t + duration, value, 0.0]]))


@njit(cache=True, error_model="numpy", **BORROWS)
def course(body, t):
    """The Course of a gate at a time."""
    corners = body.drive
    last = WIDE * (body.corners - 1)
    if last < 0:
        return Course(0.0, 0.0)
    if t <= corners[0]:
        return Course(corners[1], corners[2] if t == corners[0] else 0.0)
    for i in range(0, last, WIDE):
        if t < corners[i + WIDE]:
            span = corners[i + WIDE] - corners[i]
            s = (t - corners[i]) / span
            way = corners[i + WIDE + 1] - corners[i + 1]
            begun, ended = span * corners[i + 2], span * corners[i + WIDE + 2]
            place = s * s * (3.0 - 2.0 * s) * way + s * (1.0 - s) * ((1.0 - s) * begun - s * ended)
            rate = 6.0 * s * (1.0 - s) * way
            rate += (1.0 - s) * (1.0 - 3.0 * s) * begun - s * (2.0 - 3.0 * s) * ended
            return Course(corners[i + 1] + place, rate / span)
    return Course(corners[last + 1], 0.0)


@njit(cache=True, error_model="numpy", **BORROWS)
def went(body, t, until):
    """Change of the place of a gate from t to `until`."""
    return course(body, until).place - course(body, t).place


@njit(cache=True, error_model="numpy", **BORROWS)
def shift_gate(body, b, way, x, r, xm, rm):
    """Moves body b by a change of its place, from places x and rotations r to xm and rm, which may be the
    same."""
    at = vec(x, b)
    m = mat(r, b)
    if body.swings == SLIDES:
        at = add(at, scale(way, three(body.way)))
    else:
        turn, pivot = exp_rotation(scale(way, three(body.turn))), three(body.pivot)
        at = add(pivot, rotate(turn, sub(at, pivot)))
        m = matmul(turn, m)
    for i in range(3):
        xm[b, i] = at[i]
    for i in range(9):
        rm[b, i] = m[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def rate_gate(body, b, rate, motion):
    """Sets velocity and angular velocity of body b at its place in a Motion, from the rate of its place."""
    way = three(body.way)
    spin = (0.0, 0.0, 0.0)
    if body.swings == TURNS:
        spin = scale(rate, three(body.turn))
        way = cross(three(body.turn), sub(vec(motion.x, b), three(body.pivot)))
    for i in range(3):
        motion.u[b, i], motion.w[b, i] = rate * way[i], spin[i]


@njit(cache=True, error_model="numpy", **BORROWS)
def middle_of_gate(body, b, h, t, x, r, motion):
    """Places body b in the middle t of a step of 2 h: halfway between both ends and at the mean rate, like
    the unknowns of the step."""
    way = went(body, t - h, t + h)
    shift_gate(body, b, 0.5 * way, x, r, motion.x, motion.r)
    rate_gate(body, b, 0.5 * way / h if h > 0.0 else course(body, t).rate, motion)


@njit(cache=True, error_model="numpy", **BORROWS)
def gate_at(body, b, t, until, x, r, motion):
    """Moves body b from its place x and r at the time t to that of its law at a later time."""
    shift_gate(body, b, went(body, t, until), x, r, motion.x, motion.r)
    rate_gate(body, b, course(body, until).rate, motion)


@njit(cache=True, error_model="numpy", **BORROWS)
def power_of(motion, b, force, torque):
    """Power of a force and a torque on body b due to its motion."""
    return dot(force, vec(motion.u, b)) + dot(torque, vec(motion.w, b))


@njit(cache=True, error_model="numpy", **BORROWS)
def fastest_of_gate(body, x, b, t):
    """Bound on the speed of any place of a plate."""
    rate = abs(course(body, t).rate)
    if body.swings == SLIDES:
        return rate
    way, half = cross(three(body.turn), sub(vec(x, b), three(body.pivot))), three(body.half)
    return rate * (math.sqrt(dot(way, way)) + math.sqrt(dot(half, half)))


@njit(cache=True, error_model="numpy", **BORROWS)
def stop(body, place, rate):
    """The Stop of a body at a place and a rate of it."""
    stops = body.stops
    if stops[STOP] == 0.0 or stops[LOW] <= place <= stops[HIGH]:
        return Stop(0.0, 0.0, 0.0, 0.0, 0.0)
    side = 1.0 if place > stops[HIGH] else -1.0
    z = place - stops[HIGH] if side > 0.0 else stops[LOW] - place
    over, k, beta = stops[OVER] * z, stops[STOP], stops[SHARE]
    x = min(max(side * rate / over, -1.0), 1.0)
    sign = sign_step(x, 1.0)
    by_rate = 1.5 * (1.0 - x * x) * k * beta / stops[OVER]
    # of k z (1 + beta s(x)), x falling as 1/z does
    by_place = k * (1.0 + beta * x * x * x)
    damps = k * z * beta * sign
    return Stop(-side * (k * z + damps), by_place, by_rate, 0.5 * k * z * z, damps * side * rate)
