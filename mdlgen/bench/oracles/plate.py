"""Torsion of a clamped orthotropic plate without Poisson's effect, by Ritz.

S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed. 1959, sections 81 and 85: the energy
of bending and twist is 1/2 int (D_1 w_xx^2 + D_2 w_yy^2 + 4 D_66 w_xy^2), here of polynomials that keep the
clamp.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Legendre, Polynomial

ALONG, ACROSS = 14, 7  # polynomials: two fewer each way change what follows by less than 2e-3 for L > W


def torsion(length: float, width: float, d_along: float, d_across: float, d_twist: float) -> float:
    """Rotation over torque [rad/(N mm)] at the end of a plate clamped at the other end, from its deflections
    at both corners, where equal and opposite forces make the torque.

    Lengths in mm, stiffness per width in N mm. Far from the clamp it is Saint-Venant's, 1/(4 D_66 W) for each
    mm of length; the clamp keeps its end from warping and so makes it stiffer.
    """
    x, weight_x = np.polynomial.legendre.leggauss(2 * ALONG)
    y, weight_y = np.polynomial.legendre.leggauss(2 * ACROSS)
    along = [
        Legendre.basis(k, domain=[0, 1]).convert(kind=Polynomial) * Polynomial([0.0, 0.0, 1.0])
        for k in range(ALONG)
    ]
    across = [Legendre.basis(k).convert(kind=Polynomial) for k in range(ACROSS)]

    def products(shapes: list[Polynomial], order: int, at: np.ndarray, weight: np.ndarray) -> np.ndarray:
        values = np.array([shape.deriv(order)(at) + 0.0 * at for shape in shapes])
        return np.einsum("ap,bp,p->ab", values, values, weight)

    first = [products(along, k, (x + 1) / 2, weight_x / 2) * length ** (1 - 2 * k) for k in range(3)]
    second = [products(across, k, y, weight_y) * (width / 2) ** (1 - 2 * k) for k in range(3)]
    stiff = d_along * np.kron(first[2], second[0]) + d_across * np.kron(first[0], second[2])
    stiff += 4.0 * d_twist * np.kron(first[1], second[1])
    end = np.array([a(1.0) * (b(1.0) - b(-1.0)) / width for a in along for b in across])
    return float(end @ np.linalg.solve(stiff, end))
