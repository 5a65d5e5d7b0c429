"""Torques on a roller about its axis by its spin, its angle and the time: clutch, motor, limiter, bearing.

A body record has a clutch (mechanics.driven). If its sense is AXLE, a row of the table of axles acts in its
place; the number of the row is in its torque. Signs are those of a rotation about the roller's axis.

Every law is a torque T(e, w, t): w is the spin, v the prescribed or desired speed of the shaft, and e the
integral of v - w, the angle by which the roller lags. With e' = v - w this is one state for the integral of
speed control, for the load angle of a stepper, and for the slip of a limiter.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.mechanics.driven import SENSE, TORQUE, clutch, prescribed, turned
from mdlgen.mechanics.laws import sign_step
from mdlgen.model.limits import MOST_POINTS
from mdlgen.model.tables import Floats, Model
from mdlgen.model.tables.axle import CONTROLLED, LIMITER, OPEN, STEPPER, AxlePart
from mdlgen.program.kernel import njit

AXLE = 2.0  # value of a clutch's SENSE: a row of the table of axles acts
# Columns of a row: as in model.tables.axle.AxlePart, then points of its curve.
KIND, NO_LOAD, KP, KI, LIMIT, CREEP, POLES, DAMPING, FRICTION, DRAG, EASE, POINTS, CURVE = range(13)
WIDTH = CURVE + 2 * MOST_POINTS
NONE = np.zeros((0, WIDTH))
SMALL = 1e-9  # of the argument of a smooth sign: below, its secant is its slope


class Acting(NamedTuple):
    """Action of an axle at a spin. In order: the torque; its decrease per spin that iterations use, at least
    the slope; that slope without the part due to the angle; the part of it that pulls to the speed of the
    shaft; the power of the drive; the dissipated power."""

    torque: float
    growth: float
    damps: float
    pulls: float
    given: float
    lost: float


def axle_table(model: Model, time: float = 1.0, torque: float = 1.0) -> Floats:
    """Rows of all rollers that have an axle, in their order, (axles, WIDTH); `time` is a millisecond in the
    solver's units, `torque` a newton millimetre."""
    rows = [_row(part.axle, time, torque) for part in model.rollers if part.axle is not None]
    return np.array(rows) if rows else NONE


def _row(axle: AxlePart, time: float, torque: float) -> Floats:
    row = np.zeros(WIDTH)
    row[KIND], row[NO_LOAD], row[POLES] = axle.kind, axle.no_load / time, axle.poles
    row[KP], row[KI] = axle.proportional * torque * time, axle.integral * torque
    row[LIMIT], row[CREEP] = axle.limit * torque, axle.creep / time
    row[DAMPING] = axle.damping * torque * time
    row[FRICTION], row[DRAG], row[EASE] = (
        axle.friction * torque,
        axle.drag * torque * time,
        axle.ease / time,
    )
    row[POINTS] = len(axle.curve)
    row[CURVE : CURVE + axle.curve.size] = (axle.curve * (1.0 / time, torque)).ravel()
    return row


@njit(cache=True, error_model="numpy")
def of_curve(row, slow):
    """Torque of a motor that runs by `slow` below its no-load speed, and its slope. The curve is odd: above
    that speed the motor brakes. Beyond the last point, driven backwards, it is extrapolated."""
    size, last = abs(slow), CURVE + 2 * (int(row[POINTS]) - 1)
    at = CURVE
    while at + 2 < last and size > row[at + 2]:
        at += 2
    slope = (row[at + 3] - row[at + 1]) / (row[at + 2] - row[at])
    torque = row[at + 1] + slope * (size - row[at])
    return math.copysign(torque, slow), slope


@njit(cache=True, error_model="numpy")
def rubbing(torque, over, rate):
    """Friction against a rate by a smooth sign, its secant over the rate, and its slope. With the secant,
    iterations do not oscillate between both signs."""
    x = rate / over
    level = sign_step(x, 1.0)
    secant = 1.5 if abs(x) < SMALL else level / x
    return torque * level, torque * secant / over, torque * max(1.5 * (1.0 - x * x), 0.0) / over


@njit(cache=True, error_model="numpy")
def limits(row, spin):
    """Least and greatest torque of a motor with speed control: from its lines at full voltage of both signs,
    and from its current."""
    high, _ = of_curve(row, row[NO_LOAD] - spin)
    low, _ = of_curve(row, row[NO_LOAD] + spin)
    return max(-low, -row[LIMIT]), min(high, row[LIMIT])


@njit(cache=True, error_model="numpy")
def _motor(row, behind, rate, spin, shaft, h):
    """Torque of a motor, its growth with and without the angle; rate: speed of the shaft minus spin."""
    if row[KIND] == OPEN:
        torque, slope = of_curve(row, rate)
        return torque, max(slope, 0.0), max(slope, 0.0)
    if row[KIND] == CONTROLLED:
        asked = row[KP] * rate + row[KI] * behind
        low, high = limits(row, spin)
        torque = min(max(asked, low), high)
        if torque == asked:
            return torque, row[KP] + h * row[KI], row[KP]
        return torque, max(torque / asked, 0.0) * (row[KP] + h * row[KI]), 0.0
    hold = row[CURVE + 3]
    if row[NO_LOAD] > 0.0:
        hold, _ = of_curve(row, max(row[NO_LOAD] - abs(shaft), 0.0))
    angle = row[POLES] * behind
    torque = hold * math.sin(angle) + row[DAMPING] * rate
    return (
        torque,
        row[DAMPING] + h * max(row[POLES] * hold * math.cos(angle), 0.0),
        row[DAMPING],
    )


@njit(cache=True, error_model="numpy")
def _acting(axles, body, before, spin, t, h):
    row, shaft = axles[int(body.clutch[TORQUE])], prescribed(body, t)
    rate = shaft - spin
    torque = growth = damps = given = lost = 0.0
    if row[KIND] == LIMITER:
        torque, growth, damps = rubbing(row[LIMIT], row[CREEP], rate)
        given, lost = torque * shaft, torque * rate
    elif row[KIND] == OPEN or row[KIND] == CONTROLLED or row[KIND] == STEPPER:
        behind = before - h * spin
        if h > 0.0:
            behind += turned(body, t) - turned(body, t - h)
        torque, growth, damps = _motor(row, behind, rate, spin, shaft, h)
        given = torque * spin
    pulls = damps
    rubs, secant, slope = rubbing(row[FRICTION], row[EASE], spin)
    rubs += row[DRAG] * spin
    torque -= rubs
    growth += secant + row[DRAG]
    damps += slope + row[DRAG]
    lost += rubs * spin
    return Acting(torque, growth, damps, pulls / damps if damps > 0.0 else 0.0, given, lost)


@njit(cache=True, error_model="numpy", forceinline=True)
def acting(axles, body, before, spin, t, h):
    """Action on a roller at a spin and a time, h after a state in which it lagged its shaft by `before`."""
    if body.clutch[SENSE] == AXLE:
        return _acting(axles, body, before, spin, t, h)
    torque, growth, shaft = clutch(body, spin, t)
    return Acting(torque, growth, growth, 1.0, torque * shaft, torque * (shaft - spin))


@njit(cache=True, error_model="numpy")
def behind_at_end(axles, body, before, middle, spin, t, dt):
    """Angle by which a roller lags its shaft after a step of dt from t, from its spin in the middle and at
    the end. Where speed control exceeds the limits of its motor, it is the angle that yields these limits."""
    behind = before + turned(body, t + dt) - turned(body, t) - dt * middle
    row = axles[int(body.clutch[TORQUE])]
    if row[KIND] == CONTROLLED and row[KI] > 0.0:
        low, high = limits(row, spin)
        by_rate = row[KP] * (prescribed(body, t + dt) - spin)
        behind = min(max(behind, (low - by_rate) / row[KI]), (high - by_rate) / row[KI])
    return behind
