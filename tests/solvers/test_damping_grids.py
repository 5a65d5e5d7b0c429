"""The damping of the paper on plates, on boxes of different lengths and where a zone is thicker.

Closed forms: a Kelvin-Voigt beam, uniform or stepped, decays with zeta = omega tau/2 in each mode, since its
damping matrix is tau times that of its stiffness; omega of a stepped cantilever from the continuity of
deflection, slope, moment and shear at the step (Blevins, Formulas for Natural Frequency and Mode Shape, 8.1).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from asked import as_asked
from damped import AREA, LENGTH, WIDTH, decrement, strip
from scipy.optimize import brentq

import mdlgen
from mdlgen.model.tables import Model

D_CD = 0.242  # [N mm]
TAU = 0.15  # [ms]
RUN = "run={analysis: transient, duration: 90 ms, print_step: 0.3 ms, step: 0.05 ms}"


@dataclass(frozen=True)
class Beam:
    """A clamped beam, uniform up to `at` and from there on."""

    at: float  # [mm]
    stiffness: tuple[float, float]  # per width [N mm]
    mass: tuple[float, float]  # per area [g/mm^2]

    def _system(self, omega: float) -> tuple[np.ndarray, float, float]:
        """Conditions on (A, B; C, D, E, F) of w = A (cosh - cos) + B (sinh - sin) before the step, and of
        cosh, sinh, cos, sin after it, counted from the step."""
        p, q = ((m * omega**2 / d) ** 0.25 for d, m in zip(self.stiffness, self.mass, strict=True))
        x, y = p * self.at, q * (LENGTH - self.at)
        ch, sh, co, si = math.cosh(x), math.sinh(x), math.cos(x), math.sin(x)
        k, l = self.stiffness[0] * p**2, self.stiffness[1] * q**2
        rows = [
            [ch - co, sh - si, -1.0, 0.0, -1.0, 0.0],
            [p * (sh + si), p * (ch - co), 0.0, -q, 0.0, -q],
            [k * (ch + co), k * (sh + si), -l, 0.0, l, 0.0],
            [k * p * (sh - si), k * p * (ch + co), 0.0, -l * q, 0.0, l * q],
            [0.0, 0.0, math.cosh(y), math.sinh(y), -math.cos(y), -math.sin(y)],
            [0.0, 0.0, math.sinh(y), math.cosh(y), math.sin(y), -math.cos(y)],
        ]
        return np.array(rows), p, q

    @property
    def omega(self) -> float:
        """Lowest angular frequency [rad/ms]."""

        def miss(omega: float) -> float:
            matrix = self._system(omega)[0]
            return float(np.linalg.det(matrix / np.abs(matrix).max(axis=1, keepdims=True)))

        tried = np.linspace(0.02, 1.0, 400)
        values = [miss(omega) for omega in tried]
        first = next(k for k in range(len(tried)) if values[k] * values[k + 1] < 0)
        return float(brentq(miss, tried[first], tried[first + 1], xtol=1e-14))

    def mode(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Deflection and slope of the lowest mode."""
        matrix, p, q = self._system(self.omega)
        a, b, c, d, e, f = np.linalg.svd(matrix)[2][-1]
        y, z = p * x, q * (x - self.at)
        before = a * (np.cosh(y) - np.cos(y)) + b * (np.sinh(y) - np.sin(y))
        after = c * np.cosh(z) + d * np.sinh(z) + e * np.cos(z) + f * np.sin(z)
        s_before = p * (a * (np.sinh(y) + np.sin(y)) + b * (np.cosh(y) - np.cos(y)))
        s_after = q * (c * np.sinh(z) + d * np.cosh(z) - e * np.sin(z) + f * np.cos(z))
        return np.where(x < self.at, before, after), np.where(x < self.at, s_before, s_after)


UNIFORM = Beam(0.5 * LENGTH, (D_CD, D_CD), (AREA, AREA))


def swung(m: Model, beam: Beam) -> tuple[float, float]:
    """zeta and omega that a strip has in the lowest mode of a beam."""
    count = m.sheets[0].count
    first = m.sheets[0].lines_y[0] + m.sheets[0].center[1]
    shape, slope = beam.mode(m.bodies.position[:count, 1] - first)
    scale = 1e-5 * LENGTH * beam.omega / abs(shape[-1])
    velocity, spin = m.bodies.velocity.copy(), m.bodies.spin.copy()
    velocity[:count, 2], spin[:count, 0] = scale * shape, scale * slope
    result = mdlgen.solve(replace(m, bodies=replace(m.bodies, velocity=velocity, spin=spin)), "lattice")
    assert as_asked(result), result.status
    lift = (result.position[:, :count, 2] - m.bodies.position[:count, 2]) @ (m.bodies.mass[:count] * shape)
    return decrement(result, lift)


def test_the_oracle_is_the_beam_of_one_piece() -> None:
    beam = 1.875104068711961**2 / LENGTH**2 * math.sqrt(D_CD / AREA)
    assert UNIFORM.omega == pytest.approx(beam, rel=1e-9)
    assert replace(UNIFORM, at=0.2 * LENGTH).omega == pytest.approx(beam, rel=1e-9)


def graded(count: int, ratio: float) -> str:
    """Lengths that grow from one end to the other by `ratio` in all."""
    return str([round(ratio ** (k / (count - 1)), 6) for k in range(count)])


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center", "plate"])
@pytest.mark.parametrize(
    ("rows", "sizes", "allowed"),
    [(8, None, 0.015), (24, None, 0.006), (12, 4.0, 0.03), (24, 4.0, 0.01), (24, 0.25, 0.01)],
)
def test_any_lengths_of_boxes_have_the_same_damping(
    layout: str, rows: int, sizes: float | None, allowed: float
) -> None:
    """zeta = omega tau/2 with omega of the beam, whose error on a lattice falls with the square of the
    longest box: by `allowed`; and with its own omega within 0.3 %."""
    more = () if sizes is None else (f"sheets.note.grading={{y: {{sizes: {graded(rows, sizes)}}}}}",)
    zeta, omega = swung(strip(rows, f"{{time: {TAU} ms}}", RUN, *more, layout=layout), UNIFORM)
    assert zeta == pytest.approx(0.5 * omega * TAU, rel=3e-3)
    assert zeta == pytest.approx(0.5 * UNIFORM.omega * TAU, rel=allowed)


@pytest.mark.parametrize("layout", ["edge_to_edge", "plate"])
@pytest.mark.parametrize("rows", [10, 20, 40])
@pytest.mark.parametrize(("thick", "stiffer"), [(0.15, 1.0), (0.07, 1.0), (0.1, 3.0)])
def test_a_zone_of_other_thickness_or_stiffness_has_the_same_time(
    layout: str, rows: int, thick: float, stiffer: float
) -> None:
    """The outer half is thicker, thinner or stiffer: a stepped beam, whose omega and so whose zeta differ."""
    half = 0.5 * WIDTH
    zone = (
        f"sheets.note.zones={{outer: {{x: [{-half} mm, {half} mm], y: [0 mm, {LENGTH / 2} mm], "
        f"thickness: {thick} mm, stiffness: {stiffer}}}}}"
    )
    part = thick / 0.1
    # the sheet's mass is shared out by thickness
    beam = Beam(
        0.5 * LENGTH,
        (D_CD, D_CD * stiffer * part**3),
        (2 * AREA / (1 + part), 2 * AREA * part / (1 + part)),
    )
    zeta, omega = swung(strip(rows, f"{{time: {TAU} ms}}", RUN, zone, layout=layout), beam)
    assert zeta == pytest.approx(0.5 * omega * TAU, rel=3e-3)
    # the lattice's error falls with the square of the pitch
    assert zeta == pytest.approx(0.5 * beam.omega * TAU, rel=0.004 + 0.02 * (10 / rows) ** 2)


def test_several_columns_and_a_pair_of_times_bend_by_that_of_cd() -> None:
    zeta, omega = swung(
        strip(16, f"{{time: [3 ms, {TAU} ms]}}", RUN, "sheets.note.boxes=[3,16]", layout="plate"), UNIFORM
    )
    assert zeta == pytest.approx(0.5 * omega * TAU, rel=3e-3)
