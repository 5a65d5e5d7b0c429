"""Nips of covers against rings of finite elements, with and without friction."""

from __future__ import annotations

import math

import pytest

from mdlgen.bench.oracles.annulus import Ring, nip
from mdlgen.bench.oracles.rolling import gain
from mdlgen.rubber.contact import loaded
from mdlgen.rubber.layer import Layer

E = 1.7  # [MPa]


@pytest.mark.parametrize(
    ("radius", "thickness", "nu", "other", "depth"),
    [(10.0, 3.0, 0.49, 8.0, 0.18), (10.0, 3.0, 0.3, math.inf, 0.1), (10.0, 5.0, 0.4999, 8.0, 0.2)],
)
def test_nip_is_that_of_finite_elements(radius, thickness, nu, other, depth):
    found = nip(Ring(radius, thickness, E, nu, 1.0, fine=14, deep=24), other, depth)
    curvature = 1.0 / radius + (0.0 if math.isinf(other) else 1.0 / other)
    formula = loaded((Layer(E, nu, thickness, radius),), curvature, found.load)
    assert formula is not None
    cover = formula.covers[0]
    # the parabola of the surfaces has 1 % at a/R of 0.1
    assert cover.depth == pytest.approx(depth, rel=0.02)
    assert formula.half == pytest.approx(found.half, abs=1.0 / 14)  # an element
    assert cover.gain == pytest.approx(
        found.gain, rel=0.06, abs=1e-4
    )  # of this mesh, which goes down with it


def test_little_friction_goes_to_the_mean_by_the_pressure_and_much_changes_little_on_thick_rubber():
    ring = Ring(10.0, 3.0, E, 0.49, 1.0, fine=14, deep=12)
    found = nip(ring, 8.0, 0.18)
    free, some, stuck = found.gain, gain(ring, found, 0.02), gain(ring, found, math.inf)
    assert free > 0.012
    assert some == pytest.approx(free, rel=0.05)  # a median in place of a mean
    assert stuck == pytest.approx(free, rel=0.05)


def test_friction_holds_foam_back():
    """On foam a sheet goes slower than the surface, and less so where all of the nip sticks."""
    ring = Ring(10.0, 3.0, E, 0.3, 1.0, fine=14, deep=12)
    found = nip(ring, 8.0, 0.2)
    assert found.gain < gain(ring, found, math.inf) < 0.5 * found.gain
