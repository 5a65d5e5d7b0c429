"""Covers under pressure: against the equations of elasticity, and against limits of layers in textbooks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm

from mdlgen.rubber.contact import loaded, squeezed
from mdlgen.rubber.hardness import modulus
from mdlgen.rubber.layer import Layer, flat_sinks, flat_stretches, responses

FLAT = 1e6  # radius of a cover whose curvature is nothing against its thickness [mm]


def integrated(s: float, nu: float) -> tuple[float, float]:
    """L and T of a flat layer with k = 1: displacements and stresses carried from the base to the surface."""
    shear, lame = 1.0, 2.0 * nu / (1.0 - 2.0 * nu)
    stiff = lame + 2.0 * shear
    rates = np.array(
        [
            [0.0, 1.0, 1.0 / shear, 0.0],
            [-lame / stiff, 0.0, 0.0, 1.0 / stiff],
            [stiff - lame**2 / stiff, 0.0, 0.0, lame / stiff],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )
    through = expm(rates * s)[:, 2:]
    top = through @ np.linalg.solve(through[2:], [0.0, -1.0])
    young = 2.0 * shear * (1.0 + nu)
    return -top[1] * young / (2.0 * (1.0 - nu**2)), -top[0] * young / (1.0 + nu)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("s", [0.1, 0.5, 1.0, 3.0, 8.0])
def test_flat_layer_obeys_the_equations_of_elasticity(nu, s):
    sinks, stretches = integrated(s, nu)
    assert flat_sinks(np.array([s]), nu)[0] == pytest.approx(sinks, rel=1e-9)  # round-off of the exponential
    assert flat_stretches(np.array([s]), nu)[0] == pytest.approx(stretches, rel=1e-7, abs=1e-9)


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.5])
def test_thin_ring_on_a_wide_core_is_flat_and_a_short_wave_sees_a_disc(nu):
    k = np.array([0.3, 1.0, 3.0])
    sinks, stretches = responses(Layer(1.0, nu, 1.0, 500.0), k)
    assert sinks == pytest.approx(flat_sinks(k, nu), rel=4e-3)  # t/R is 2e-3
    # what the outside loses in length as it comes nearer to the axis, u/R, is of that size
    assert stretches == pytest.approx(flat_stretches(k, nu), abs=4e-3)
    # a disc: u = p R/(4 G) (1/(n - 1) + kappa/(n + 1)) for a pressure p cos(n theta)
    n, kappa = 40.0, 3.0 - 4.0 * nu
    disc = n / (1.0 + kappa) * (1.0 / (n - 1.0) + kappa / (n + 1.0))
    assert responses(Layer(1.0, nu, 5.0, 10.0), np.array([n / 10.0]))[0][0] == pytest.approx(disc, rel=1e-6)


def test_thick_cover_is_a_half_space():
    """Hertz: P = pi a^2 E*/(4 R)."""
    found = squeezed((Layer(2.0, 0.3, 400.0, FLAT),), 0.1, 1.0)
    assert found.load == pytest.approx(math.pi * 0.1 * 2.0 / (1.0 - 0.3**2) / 4.0, rel=1e-4)  # (a/t)^2
    assert found.pressure == pytest.approx(2.0 * found.load / math.pi, rel=1e-4)


def test_thin_compressible_cover_is_a_foundation_of_springs():
    """Johnson, section 5.8: P = 2/3 M a^3/(R t), depth a^2/(2R), M = E(1 - nu)/((1 + nu)(1 - 2nu)); a sheet
    on it goes slower by what the surface comes nearer to the axis."""
    errors = []
    for thin in (0.04, 0.02):
        found = squeezed((Layer(2.0, 0.3, thin, 200.0),), 0.1, 1.0)
        stiff = 2.0 * 0.7 / (1.3 * 0.4)
        errors.append(found.load / (2.0 / 3.0 * stiff * 0.1 / thin) - 1.0)
        assert found.covers[0].depth == pytest.approx(0.05, rel=2e-2)
        assert abs(found.covers[0].gain) < 2e-3  # of 1 % depth over radius
    assert abs(errors[1]) < 0.01  # of the order of t/a
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.2)


def test_thin_incompressible_cover_is_a_film():
    """Johnson, section 5.8: P = 2 E a^5/(45 R t^3) and depth a^2/(6R). The stretch of the surface is 3/2 of
    the depth over t, whose mean by the pressure is a^2/(7 R t). Edges are of the order of t/a."""
    thins = np.array([0.04, 0.02, 0.01])
    found = [squeezed((Layer(2.0, 0.5, t, FLAT),), 0.1, 1.0) for t in thins]
    ratios = {
        "load": [nip.load / (2.0 * 2.0 * 0.1 / (45.0 * t**3)) for nip, t in zip(found, thins, strict=True)],
        "depth": [nip.covers[0].depth / (0.1 / 6.0) for nip in found],
        "gain": [nip.covers[0].gain / (0.1 / (7.0 * t)) for nip, t in zip(found, thins, strict=True)],
    }
    for name, values in ratios.items():
        limit = np.polyfit(thins, values, 2)[2]
        assert limit == pytest.approx(1.0, abs=5e-3), name


def test_two_covers_alike_share_the_depth():
    one = Layer(1.7, 0.49, 3.0, 10.0)
    both = loaded((one, one), 0.2, 0.4)
    assert both is not None
    # as one cover under twice the load on twice the curvature
    alone = loaded((one,), 0.1, 0.4)
    assert alone is not None
    assert both.half == pytest.approx(alone.half, rel=1e-7)
    assert both.covers[0].depth == pytest.approx(alone.covers[0].depth, rel=1e-6)
    assert both.covers[0].gain == pytest.approx(both.covers[1].gain, rel=1e-9)


def test_a_nip_too_wide_is_none():
    assert loaded((Layer(0.1, 0.49, 3.0, 10.0),), 0.2, 100.0) is None


def test_modulus_is_that_of_a_durometer_on_a_half_space():
    """Gent: the spring of ASTM D2240, 0.55 N to 8.05 N, on a flat punch of the mean radius of the cone, into
    an incompressible half-space: F = 8/3 E c d."""
    for shore in (20.0, 40.0, 60.0, 80.0):
        force, way, radius = 0.55 + 0.075 * shore, 0.0254 * (100.0 - shore), 0.5 * (0.79 + 1.27) / 2.0
        assert modulus(shore) == pytest.approx(
            force / (8.0 / 3.0 * radius * way), rel=5e-3
        )  # of rounded sizes
