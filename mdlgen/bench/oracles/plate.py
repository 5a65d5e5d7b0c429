"""Orthotropic plates: clamped at one end by Ritz, simply supported by Navier.

S. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed. 1959, sections 81 and 85: the energy
of bending and twist is 1/2 int (D_x w_xx^2 + 2 D_1 w_xx w_yy + D_y w_yy^2 + 4 D_66 w_xy^2), by Ritz of
polynomials that keep the clamp. D_1 is Poisson's effect: nu_md D_y = nu_cd D_x.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import Legendre, Polynomial

ALONG, ACROSS = 14, 7  # polynomials: two fewer each way change the results by less than 2e-3 for L > W
TERMS = 99  # half waves each way: the rest of the series is below 1e-6 of the deflection


def torsion(length: float, width: float, d_along: float, d_across: float, d_twist: float) -> float:
    """Rotation over torque [rad/(N mm)] at the end of a plate clamped at the other end, without Poisson's
    effect, from its deflections at both corners, where equal and opposite forces make the torque.

    Lengths in mm, stiffness per width in N mm. Far from the clamp it is Saint-Venant's, 1/(4 D_66 W) for each
    mm of length; the clamp keeps its end from warping and so makes it stiffer.
    """
    along, across = _shapes()
    end = np.array([a(1.0) * (b(1.0) - b(-1.0)) / width for a in along for b in across])
    return float(end @ np.linalg.solve(_stiffness(length, width, (d_along, d_across, 0.0, d_twist)), end))


def cantilever(length: float, width: float, stiffness: tuple[float, float, float, float]) -> float:
    """Mean deflection of the end over the force [mm/N] that is spread evenly along it, of a plate clamped at
    the other end with the stiffness (D_x, D_y, D_1, D_66) [N mm], x along its length [mm].

    Between L^3/(3 D W) of a narrow strip, D that of a beam, and of a wide one, D_x of the plate.
    """
    along, across = _shapes()
    y, weight = np.polynomial.legendre.leggauss(2 * ACROSS)
    end = np.array([a(1.0) * float(weight @ b(y)) / 2 for a in along for b in across])
    return float(end @ np.linalg.solve(_stiffness(length, width, stiffness), end))


def navier(
    length: float,
    width: float,
    stiffness: tuple[float, float, float, float],
    at: tuple[float, float] = (0.0, 0.0),
) -> float:
    """Deflection over the pressure [mm/MPa] of a plate with all edges simply supported (Timoshenko,
    Woinowsky-Krieger, section 85): sides [mm], stiffness (D_x, D_y, D_1, D_66) [N mm], at a place from the
    middle [mm]."""
    d_x, d_y, d_1, d_66 = stiffness
    m, n = (v.astype(float) for v in np.meshgrid(*[np.arange(1, 2 * TERMS, 2)] * 2, indexing="ij"))
    a, b = (m / length) ** 2, (n / width) ** 2
    waves = np.sin(m * math.pi * (0.5 + at[0] / length)) * np.sin(n * math.pi * (0.5 + at[1] / width))
    whole = d_x * a**2 + 2.0 * (d_1 + 2.0 * d_66) * a * b + d_y * b**2
    return float((16.0 * waves / (math.pi**6 * m * n * whole)).sum())


def _shapes() -> tuple[list[Polynomial], list[Polynomial]]:
    """Polynomials along, which keep the clamp, and across."""
    along = [
        Legendre.basis(k, domain=[0, 1]).convert(kind=Polynomial) * Polynomial([0.0, 0.0, 1.0])
        for k in range(ALONG)
    ]
    return along, [Legendre.basis(k).convert(kind=Polynomial) for k in range(ACROSS)]


def _stiffness(length: float, width: float, stiffness: tuple[float, float, float, float]) -> np.ndarray:
    """Stiffness matrix for products of polynomials along and across."""
    d_x, d_y, d_1, d_66 = stiffness
    x, weight_x = np.polynomial.legendre.leggauss(2 * ALONG)
    y, weight_y = np.polynomial.legendre.leggauss(2 * ACROSS)

    def products(
        shapes: list[Polynomial], one: int, two: int, at: np.ndarray, weight: np.ndarray
    ) -> np.ndarray:
        left, right = (np.array([s.deriv(order)(at) + 0.0 * at for s in shapes]) for order in (one, two))
        return np.einsum("ap,bp,p->ab", left, right, weight)

    along, across = _shapes()

    def of_x(one: int, two: int) -> np.ndarray:
        return products(along, one, two, (x + 1) / 2, weight_x / 2) * length ** (1 - one - two)

    def of_y(one: int, two: int) -> np.ndarray:
        return products(across, one, two, y, weight_y) * (width / 2) ** (1 - one - two)

    stiff = d_x * np.kron(of_x(2, 2), of_y(0, 0)) + d_y * np.kron(of_x(0, 0), of_y(2, 2))
    stiff += 4.0 * d_66 * np.kron(of_x(1, 1), of_y(1, 1))
    if d_1 != 0.0:
        mixed = np.kron(of_x(2, 0), of_y(0, 2))
        stiff += d_1 * (mixed + mixed.T)
    return stiff
