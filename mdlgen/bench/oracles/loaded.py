"""The elastica under a dead load at its free end: Bisshopp and Drucker (1945), and post-buckling.

A strip of length 1 and bending stiffness 1 is clamped at s = 0 along x. Its end bears the force (-along,
across), in units of D W / L^2, so that it is pressed along x and bent towards z. With theta the slope,
    theta'' = -across cos(theta) - along sin(theta),  theta(0) = 0, theta'(1) = 0,
has the first integral theta'^2 / 2 = along (cos theta - cos alpha) + across (sin alpha - sin theta), alpha
the slope of the end: a quadrature gives the length, whose root is alpha.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class End:
    """Where the free end is, over the length, and its slope [rad]."""

    x: float
    z: float
    slope: float


def end(along: float, across: float) -> End:
    """The end of the strip on the branch that leads there from no load at all; to 1e-10."""
    from scipy.integrate import quad
    from scipy.optimize import root_scalar

    if across <= 0.0:
        raise ValueError("a force across is needed: without one the strip may stay straight")

    def integral(alpha: float, of: Callable[[float], float]) -> float:
        """Integral of `of(theta)` over the length, with theta = alpha - u^2, which takes the root of theta'
        at the end away."""

        def kernel(u: float) -> float:
            half, mean = 0.5 * u * u, alpha - 0.5 * u * u
            # differences of cosines and sines over u^2, without cancellation
            sinc = math.sin(half) / half if half > 0.0 else 1.0
            rate = math.sqrt(2.0 * sinc * (along * math.sin(mean) + across * math.cos(mean)))
            return 2.0 * of(alpha - u * u) / rate

        return quad(kernel, 0.0, math.sqrt(alpha), epsabs=1e-12, epsrel=1e-12, limit=200)[0]

    # the slope of the force itself is reached by an endless strip only
    last = math.pi - math.atan2(across, along)
    found = root_scalar(
        lambda a: integral(a, lambda _: 1.0) - 1.0, bracket=(1e-9, last * (1 - 1e-6)), xtol=1e-13
    )
    alpha = float(found.root)
    return End(integral(alpha, math.cos), integral(alpha, math.sin), alpha)


def column(across: float, along: float) -> float:
    """Deflection of the end over the length by small-deflection theory: a beam-column (Timoshenko and Gere,
    Theory of Elastic Stability, 1961, section 1.3): across/3 times 3 (tan u - u) / u^3, u = sqrt(along)."""
    u = math.sqrt(along)
    return across * (math.tan(u) - u) / u**3


def sheared(
    length: float, width: float, thickness: float, modulus: float, shear: float, force: float
) -> float:
    """Deflection of the end of a cantilever that is bent in its plane: P L^3/(3 E I) + 6/5 P L/(G A), the
    second being Timoshenko's, with the shear of a rectangle."""
    inertia = thickness * width**3 / 12.0
    return force * length**3 / (3.0 * modulus * inertia) + 1.2 * force * length / (shear * thickness * width)
