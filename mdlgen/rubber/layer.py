"""An elastic cover bonded to a rigid core, in plane strain, under pressure alone (no shear on its surface).

A pressure p cos(k x) along the round presses the surface in by u cos(k x) and stretches it by e cos(k x):

    u = 2 (1 - nu^2)/E L p/k,    e = -(1 + nu)/E T p.

e is that of an element of the surface along the round, (dv/dx + u_r/R) with u_r = -u towards the outside. A
cover of radius R is a ring: with n = k R its displacements are those of Michell's functions r^(n + 2),
r^n, r^(2 - n), r^-n (Barber, Elasticity, Table 9.1), none at the core. n need not be whole: what a nip does
falls off within a few thicknesses, and does not come round. Hahn and Levinson (1974) solved the nip of two
rollers so.

For a flat layer, R infinite, with kappa = 3 - 4 nu and s = k t,

    L(s) = (2 kappa sinh 2s - 4 s)/D,    T(s) = (kappa (kappa - 1) (cosh 2s - 1) - 4 s^2)/D,
    D = 2 kappa cosh 2s + 4 s^2 + 1 + kappa^2.

s -> infinity is the half-space, L = 1 and T = 1 - 2 nu. s -> 0 is the thin layer: of Winkler's kind where it
is compressible (Johnson, Contact Mechanics, section 5.8), and u = t^3 k^2 p/E, e = 3/2 u/t at nu = 1/2, as of
a fluid film.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_SMALL = 0.02  # below this s the closed forms lose digits, and their series have an error of s^4
# Of the radius: a thinner cover is as good as flat, to this part, and the functions of a ring lose digits.
_FLAT = 1e-3
_OFF = 1e-6  # from n = 1: the responses there are smooth, to this part


class Layer(NamedTuple):
    """Modulus E [MPa], Poisson's ratio, thickness and outer radius [mm]."""

    modulus: float
    poisson: float
    thickness: float
    radius: float

    @property
    def soft(self) -> float:
        """2 (1 - nu^2)/E [1/MPa]."""
        return 2.0 * (1.0 - self.poisson**2) / self.modulus


def responses(layer: Layer, k: Floats) -> tuple[Floats, Floats]:
    """L and T at wave numbers k [1/mm], (n,) each."""
    if layer.thickness < _FLAT * layer.radius:
        s = k * layer.thickness
        return flat_sinks(s, layer.poisson), flat_stretches(s, layer.poisson)
    return _ring(layer.poisson, 1.0 - layer.thickness / layer.radius, k * layer.radius)


def _ring(poisson: float, inner: float, n: Floats) -> tuple[Floats, Floats]:
    """L and T of a ring with the radii `inner` and 1."""
    kappa = 3.0 - 4.0 * poisson
    n = np.where(np.abs(n - 1.0) < _OFF, 1.0 + _OFF, n)  # where two of the four functions are one
    # functions that decay inwards are 1 at the outside, those that decay outwards 1 at the core
    grows, fades = inner ** (n - 1.0), inner ** (n + 1.0)
    one, two = np.ones_like(n), inner * inner
    radial = np.stack([-n, kappa - n - 1.0, n, kappa + n - 1.0], axis=1)  # 2 G u_r
    around = np.stack([n, kappa + n + 1.0, n, n - kappa - 1.0], axis=1)  # 2 G u_theta
    core = np.stack([grows, grows * two, one, one * two], axis=1)
    top = np.stack([one, one, fades, fades], axis=1)
    # sigma_rr and sigma_rtheta at the outside
    pressing = np.stack(
        [-n * (n - 1.0), -(n + 1.0) * (n - 2.0), -n * (n + 1.0), -(n + 2.0) * (n - 1.0)], axis=1
    )
    shearing = np.stack([n * (n - 1.0), n * (n + 1.0), -n * (n + 1.0), -n * (n - 1.0)], axis=1)
    rows = np.stack([radial * core, around * core, pressing * top, shearing * top], axis=1)
    load = np.zeros((len(n), 4, 1))
    load[:, 2] = -1.0
    # equations of one size
    size = np.abs(rows).max(axis=2, keepdims=True)
    parts = np.linalg.solve(rows / size, load / size)[:, :, 0]
    out = np.einsum("ni,ni->n", parts, radial * top)
    along = np.einsum("ni,ni->n", parts, around * top)
    # 2 G = E/(1 + nu); u = -u_r, e = n u_theta + u_r
    return -0.5 * n * out / (1.0 - poisson), -(n * along + out)


def flat_sinks(s: Floats, poisson: float) -> Floats:
    """L(s) of a flat layer, (n,)."""
    kappa, two = 3.0 - 4.0 * poisson, 2.0 * s
    fade = np.exp(-two)  # all of the fraction times this
    below = kappa * (1.0 + fade * fade) + fade * (two * two + 1.0 + kappa * kappa)
    closed = (kappa * (1.0 - fade * fade) - 2.0 * two * fade) / below
    series = (4.0 * (kappa - 1.0) * s + 8.0 / 3.0 * kappa * s**3) / (
        (1.0 + kappa) ** 2 + 4.0 * (1.0 + kappa) * s * s
    )
    return np.where(s < _SMALL, series, closed)


def flat_stretches(s: Floats, poisson: float) -> Floats:
    """T(s) of a flat layer, (n,)."""
    kappa, two = 3.0 - 4.0 * poisson, 2.0 * s
    fade = np.exp(-two)
    below = kappa * (1.0 + fade * fade) + fade * (two * two + 1.0 + kappa * kappa)
    return (0.5 * kappa * (kappa - 1.0) * (1.0 - fade) ** 2 - fade * two * two) / below
