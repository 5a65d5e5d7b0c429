"""The heavy elastica: a clamped strip under its own weight.

D theta'' = -rhoA g (L - s) cos theta, theta(0) = 0, theta'(L) = 0, theta the slope below the horizontal.
All depends on one group, Gamma = rhoA g L^3 / D.
"""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model

# Weak steps towards the wanted Gamma keep the branch that starts flat; others appear beyond 20.
GROWTH = 1.5


def gamma(model: Model) -> float:
    """Gamma of a sheet clamped at y_min under gravity along its normal, from what the Model runs."""
    sheet = model.sheets[0]
    length = sheet.size[1] * (1 - (sheet.clamp.rows if sheet.clamp else 0) / sheet.n_y)
    per_area = sheet.derived["m"] / (sheet.d_x * sheet.d_y)
    pairs = 2 if sheet.layout == "edge_to_edge" else 1
    bending = pairs * sheet.derived["k_tx"] * sheet.d_y / sheet.d_x
    return per_area * float(np.linalg.norm(model.gravity)) * length**3 / bending


def drop(group: float) -> float:
    """Drop of the free end over the length, for Gamma = `group`; by a boundary value solver, to 1e-9."""
    from scipy.integrate import solve_bvp

    place = np.linspace(0.0, 1.0, 101)
    guess = np.zeros((3, place.size))
    load = min(group, 1.0)
    while True:

        def slopes(s, y, load=load):
            return np.vstack([y[1], -load * (1.0 - s) * np.cos(y[0]), np.sin(y[0])])

        found = solve_bvp(slopes, _ends, place, guess, tol=1e-9, max_nodes=100_000)
        if not found.success:
            raise ArithmeticError(f"no elastica for Gamma = {load:g}: {found.message}")
        if load >= group:
            return float(found.y[2, -1])
        place, guess = found.x, found.y
        load = min(group, GROWTH * load)


def _ends(start, end):
    return np.array([start[0], end[1], start[2]])
