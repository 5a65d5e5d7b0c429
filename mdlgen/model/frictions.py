"""Friction as it is measured: from what a user gives to factors of the coefficients of a contact.

A Stribeck curve becomes a table of points with its own slopes. The cubics between them miss the curve by less
than 0.1 % of what static friction is above the dynamic one.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.tables import MOST_SPEEDS, Floats, Frictions, Model
from mdlgen.spec.friction import Friction

# Where a Stribeck curve exp(-x^2) has its points. Beyond the last it is below 1e-4, and counts as 0.
_STRIBECK = (0.0, 0.35, 0.7, 1.05, 1.4, 1.8, 2.3, 3.1)


def lower_frictions(given: Sequence[Friction], slow: Floats) -> Frictions | None:
    """The row of each contact, from its friction and its stiction velocity [mm/ms]; None where none is
    measured."""
    if not any(friction.measured for friction in given):
        return None
    tables = [_table(friction, v) for friction, v in zip(given, slow.tolist(), strict=True)]
    speed = np.zeros((len(given), MOST_SPEEDS, 3))
    for row, table in enumerate(tables):
        speed[row, : len(table)] = table
    return Frictions(
        direction=np.array([_over_least(f.md, f.cd) for f in given]),
        face=np.array([_over_least(f.front, f.back) for f in given]),
        points=np.array([len(table) for table in tables], dtype=np.int64),
        speed=speed,
        pressure=np.array([(p.at, p.exponent) if (p := f.pressure) else (1.0, 0.0) for f in given]),
        scatter=np.array([(s.deviation, s.length) if (s := f.scatter) else (0.0, 1.0) for f in given]),
        seed=np.array([f.scatter.seed if f.scatter else 0 for f in given], dtype=np.int64),
    )


def refuse_measured(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a contact whose friction is more than two coefficients and
    their speeds: `who` does not have it."""
    frictions, table = model.contacts.frictions, model.contacts
    if frictions is None:
        return
    for row in range(len(table)):
        what = measured(frictions, row)
        if what is not None:
            raise RefusedError(
                f"{who}: the contact of {table.part_a[row]} and {table.part_b[row]} has {what}, which "
                "it does not have; run it with lattice or exudyn, or give static and dynamic",
                ("contacts", int(table.entry[row]), "friction"),
            )


def measured(frictions: Frictions, row: int) -> str | None:
    """The reason why a contact, a row, needs more than two coefficients and their speeds; None: it does
    not."""
    found = (
        (frictions.direction[row].max() > 1.0, "friction by direction"),
        (frictions.face[row].max() > 1.0, "friction by face"),
        (frictions.points[row] > 0, "friction by a curve over the slip speed"),
        (frictions.pressure[row, 1] != 0.0, "friction by pressure"),
        (frictions.scatter[row, 0] > 0.0, "scatter of friction"),
    )
    return next((what for has, what in found if has), None)


def _over_least(one: float | None, two: float | None) -> tuple[float, float]:
    if one is None or two is None or one == two:
        return 1.0, 1.0
    least = min(one, two)
    return one / least, two / least


def _table(friction: Friction, slow: float) -> Floats:
    """Rows (speed, coefficient over the first one, slope), none where both coefficients say it."""
    if friction.stribeck_velocity is not None and friction.static > 0.0:
        x, wide = np.array(_STRIBECK), friction.stribeck_velocity
        low = friction.dynamic / friction.static
        part = np.exp(-(x**2))
        slope = -2.0 * x * part / wide
        part[-1] = slope[-1] = 0.0
        return np.stack([slow + x * wide, low + (1.0 - low) * part, (1.0 - low) * slope], axis=1)
    shaped = friction.md is not None or friction.front is not None
    if friction.speed is not None and (shaped or len(friction.speed) > 2):
        v, mu = np.array(friction.speed, dtype=float).T
        return np.stack([v, mu / mu[0], _slopes(v, mu / mu[0])], axis=1)
    return np.zeros((0, 3))


def _slopes(x: Floats, y: Floats) -> Floats:
    """Slopes of the monotone cubic through points (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984),
    0 at both ends: beyond them the curve is constant, and two points are joined by the cubic STEP."""
    h, rise = np.diff(x), np.diff(y) / np.diff(x)
    found = np.zeros(len(x))
    for k in range(1, len(x) - 1):
        if rise[k - 1] * rise[k] > 0.0:
            one, two = 2 * h[k] + h[k - 1], h[k] + 2 * h[k - 1]
            found[k] = (one + two) / (one / rise[k - 1] + two / rise[k])
    return found
