"""Two rounds that are pressed together, with a cover on one or both: width, indentation and speed of the nip.

Plane strain, small strains, no friction: the covers of `layer.py` under the pressure that makes a parabola of
their surfaces, x^2/(2R) with 1/R = 1/R1 + 1/R2 (Johnson, Contact Mechanics, section 5.8; Meijers, Applied
Scientific Research 18, 1968, 353, of flat layers). With x = a cos(theta) the pressure is a sum of
c_n sin(n theta), n odd, whose transform is a Bessel function, pi n c_n (-1)^((n-1)/2) J_n(k a)/k. L of each
is split into that of a half-space, which is summed in closed form, and a rest.

As many elements of the surface pass each place of the nip as pass the undeformed rim, omega R of its length
in a time. Where the surface is stretched by e it moves at

    v = omega R (1 + e).

A sheet that slides on all of the nip without a pull goes at the mean of that by the pressure: the friction
of our law is that of one nip, and adds up to 0 there. That is `gain`, v/(omega R) - 1.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from mdlgen.rubber.layer import Floats, Layer, responses

_TERMS = 24  # of the pressure: 1e-6 of the load where the nip is ten times as wide as its cover is thick
_FADED = 16.0  # of k t: exp(-2 k t) has decayed to 1e-14 there
# Of k a: beyond, a round cover differs from a half-space by 1/(k R), of which the pressure has 1e-4.
_NEAR = 60.0
_FAR = 100.0  # of k a: the square of the pressure's transform beyond is 1e-6 of all
_ORDER = np.arange(1, 2 * _TERMS, 2)
_SIGN = 1.0 - 2.0 * (_ORDER % 4 == 3)
_GAUSS = 64  # places of each panel of an integral
WIDEST = 0.5  # of the radius: half-width of a nip, at which a parabola is 6 % off its round


class Pressed(NamedTuple):
    """Deformation of one cover in a nip: greatest indentation [mm], and gain in speed of the sheet."""

    depth: float
    gain: float


class Squeezed(NamedTuple):
    """A nip: half-width [mm], line load [N/mm], greatest pressure [MPa], and each of its covers."""

    half: float
    load: float
    pressure: float
    covers: tuple[Pressed, ...]


def squeezed(covers: tuple[Layer, ...], curvature: float, half: float) -> Squeezed:
    """The nip of a half-width [mm]; `curvature` is 1/R1 + 1/R2 [1/mm]."""
    found = _pressure(covers, curvature, half)
    pressure, load = float(found @ np.sin(0.5 * math.pi * _ORDER)), _load(found, half)
    return Squeezed(half, load, pressure, tuple(_pressed(c, found, half, load) for c in covers))


def _load(found: Floats, half: float) -> float:
    """Line load [N/mm] of the parts of a pressure."""
    return 0.5 * math.pi * half * float(found[0])


def _pressure(covers: tuple[Layer, ...], curvature: float, half: float) -> Floats:
    """The parts c_n of the pressure [MPa], (_TERMS,)."""
    thin = min(cover.thickness for cover in covers)
    q, weight, bessel = _nodes(max(_FADED * half / thin, _NEAR))
    theta = (np.arange(2 * _TERMS) + 0.5) * 0.25 * math.pi / _TERMS
    place = np.cos(theta)
    # the slope of the surface, x/R: closed part and rest
    rest = sum(cover.soft * (responses(cover, q / half)[0] - 1.0) for cover in covers)
    slope = sum(cover.soft for cover in covers) * np.cos(np.outer(theta, _ORDER))
    slope += np.sin(np.outer(place, q)) @ (weight * rest / q * bessel).T * (_ORDER * _SIGN)
    return np.linalg.lstsq(slope, half * curvature * place, rcond=None)[0]


def _pressed(layer: Layer, found: Floats, half: float, load: float) -> Pressed:
    thin = layer.thickness / half
    q, weight, bessel = _nodes(max(2.0 * _FADED / thin, _FAR))
    # at the middle: 1 - exp(-q t/a) in closed form, and the rest
    turned = math.asinh(thin)
    with np.errstate(divide="ignore", invalid="ignore"):
        down = -np.expm1(-(_ORDER - 1) * turned) / (_ORDER - 1)
    down[0] = turned
    closed = 0.5 * (down - np.expm1(-(_ORDER + 1) * turned) / (_ORDER + 1)) / _ORDER
    sinks, stretches = responses(layer, q / half)
    rest = sinks + np.expm1(-q * thin)
    middle = closed + bessel @ (weight * rest / q**2)
    depth = half * layer.soft * float((found * _ORDER * _SIGN) @ middle)
    # means by the pressure, by Parseval
    wave = math.pi * half * ((found * _ORDER * _SIGN) @ bessel) / q
    squares = weight * wave**2 / (math.pi * half)
    theta = (np.arange(8 * _TERMS) + 0.5) * math.pi / (8 * _TERMS)
    own = np.sin(np.outer(theta, _ORDER)) @ found
    even = 1.0 - 2.0 * layer.poisson
    whole = even * half * float(own**2 @ np.sin(theta)) * math.pi / (8 * _TERMS)
    whole += float(squares @ (stretches - even))
    return Pressed(depth, -(1.0 + layer.poisson) / layer.modulus * whole / load)


def _nodes(end: float) -> tuple[Floats, Floats, Floats]:
    """Places (n,) and weights (n,) of Gauss' rule from 0 to an end or somewhat further, and the Bessel
    functions of the pressure there, (_TERMS, n)."""
    return _panels(math.ceil((1.5 * end + 4.0 * _TERMS) / _GAUSS))


@lru_cache(maxsize=8)
def _panels(count: int) -> tuple[Floats, Floats, Floats]:
    from scipy.special import jv

    node, weight = np.polynomial.legendre.leggauss(_GAUSS)
    size = (_GAUSS * count - 4.0 * _TERMS) / (1.5 * count)
    place = ((np.arange(count)[:, None] + 0.5 * (node + 1.0)) * size).ravel()
    return place, np.tile(0.5 * size * weight, count), jv(_ORDER[:, None], place)


@lru_cache(maxsize=256)
def loaded(covers: tuple[Layer, ...], curvature: float, load: float) -> Squeezed | None:
    """The nip under a line load [N/mm]; None: it would be wider than WIDEST allows."""
    from scipy.optimize import brentq

    own = 1.0 / covers[0].radius
    widest = WIDEST / max(own, curvature - own)  # of the smaller radius

    def short(log: float) -> float:
        half = math.exp(log)
        return math.log(_load(_pressure(covers, curvature, half), half) / load)

    if short(math.log(widest)) < 0.0:
        return None
    # of half-spaces: less than this is never enough
    least = math.sqrt(2.0 * load * sum(cover.soft for cover in covers) / (math.pi * curvature))
    low = min(least, widest) * 1e-3
    log: Any = brentq(short, math.log(low), math.log(widest), xtol=1e-9)
    return squeezed(covers, curvature, math.exp(log))
