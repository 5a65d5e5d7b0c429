"""Friction as it is measured: its laws against closed forms and scipy, and its random field."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import mdlgen
from mdlgen.backends.lattice.kernels.contact.slopes import Numbers, core_stretched
from mdlgen.mechanics.frame import Frame, Law
from mdlgen.mechanics.laws import coefficient, of_table
from mdlgen.mechanics.measured import BACK, FRONT, MANY, MEASURED, STRETCH, TABLE
from mdlgen.mechanics.point import DISSIPATED, FORCE, FORCE_A, MU_STATIC, OUT, POINT, SLIP, Load, push
from mdlgen.model.frictions import lower_frictions
from mdlgen.model.scatter import deviation_of_box, field
from mdlgen.model.tables import SheetPart
from mdlgen.spec.friction import Friction

EYE = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
LAW = Law(300.0, True, 0.0, 0.25, 0.25, 1e-2, 1e-2, 1e-2)
AT_REST = (0.0, 0.0, 0.0)
N = 2.0  # normal force of the point [N]
# Of the first boxes of a sheet in the test of seeds.
FIRST = (0.8138719896286535, 0.8307363441078452, 0.9218301590343924)

pytestmark = pytest.mark.usefixtures("as_python")


def measured(stretch=(0.0, 0.0, 0.0), front: float = 1.0, back: float = 1.0) -> np.ndarray:
    """What a law is given of measured friction."""
    out = np.zeros(OUT + 1 + POINT)
    out[MEASURED], out[FRONT], out[BACK] = 1.0, front, back
    out[STRETCH : STRETCH + 3] = stretch
    return out


def rubbed(out: np.ndarray, v, normal=(0.0, 0.0, 1.0)) -> np.ndarray:
    """Force on a body that moves at v over one at rest, with the axes of the scene."""
    a, b = Frame((0.0, 0.0, 1.0), EYE, v, AT_REST), Frame((0.0, 0.0, -1.0), EYE, AT_REST, AT_REST)
    push(out, (0.0, 0.0, 0.0), normal, Load(N, 0.01, 0.4 * N * 0.01), a, b, LAW)
    return out[FORCE_A : FORCE_A + 3]


def aslant(angle: float, speed: float) -> tuple[float, float, float]:
    return speed * math.cos(math.radians(angle)), speed * math.sin(math.radians(angle)), 0.0


@pytest.mark.parametrize("angle", [0.0, 20.0, 45.0, 90.0, 200.0])
def test_sliding_friction_is_on_the_ellipse_and_slip_is_square_to_it(angle: float) -> None:
    """mu 0.25 along MD, 0.4 along CD: f = -N (mu_MD^2 v_x, mu_CD^2 v_y)/|(mu_MD v_x, mu_CD v_y)|."""
    out, v = measured((0.0, math.sqrt(0.4 / 0.25 - 1.0), 0.0)), aslant(angle, 1.0)
    force = rubbed(out, v)
    squares = np.array([0.25, 0.4]) ** 2
    exact = -N * squares * v[:2] / math.sqrt(float(squares @ np.square(v[:2])))
    assert force[:2] == pytest.approx(exact, abs=1e-12)
    assert (force[0] / 0.25) ** 2 + (force[1] / 0.4) ** 2 == pytest.approx(N**2, rel=1e-12)
    assert force[2] == pytest.approx(N)
    assert out[DISSIPATED] == pytest.approx(-float(force[:2] @ v[:2]), rel=1e-12)


@pytest.mark.parametrize("angle", [10.0, 50.0, 130.0])
@pytest.mark.parametrize("speed", [2e-3, 8e-3, 0.3])
def test_friction_is_the_slope_of_a_potential(angle: float, speed: float) -> None:
    """So its derivative is symmetric, and never helps."""
    stretch, v, h = (0.0, math.sqrt(0.6), 0.0), np.array(aslant(angle, speed)), 1e-7
    slopes = np.array(
        [
            (rubbed(measured(stretch), v + h * e) - rubbed(measured(stretch), v - h * e)) / (2.0 * h)
            for e in np.eye(3)[:2]
        ]
    )[:, :2]
    assert slopes[0, 1] == pytest.approx(slopes[1, 0], abs=1e-6 * np.abs(slopes).max())
    assert np.linalg.eigvalsh(0.5 * (slopes + slopes.T)).max() < 1e-6 * np.abs(slopes).max()


@pytest.mark.parametrize("angle", [10.0, 50.0, 130.0])
def test_what_friction_loses_is_its_derivative(angle: float) -> None:
    """The matrix of core_stretched is minus the derivative, where the tangent is not softened."""
    stretch, v = (0.6, 0.5, 0.0), np.array(aslant(angle, 6e-3))
    out = measured(stretch)
    rubbed(out, v)
    at, n, d = OUT + 1, (0.0, 0.0, 1.0), 1e-8
    numbers = Numbers(
        N,
        0.0,
        out[at + FORCE],
        0.0,
        1e-2,
        0.0,
        out[at + MU_STATIC],
        out[at + MU_STATIC],
        1e-2,
        1e-2,
        0.0,
        True,
    )
    w = tuple(out[at + SLIP : at + SLIP + 3])
    t = np.reshape(core_stretched(numbers, n, n, w, stretch, 1.0, 0.0, True)[0], (3, 3))
    for k, e in enumerate(np.eye(3)[:2]):
        column = (rubbed(measured(stretch), v + d * e) - rubbed(measured(stretch), v - d * e)) / (2.0 * d)
        assert t[:, k] == pytest.approx(-column, abs=1e-6 * np.abs(t).max())


def test_each_face_has_its_own() -> None:
    below = rubbed(measured(front=1.5, back=1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    above = rubbed(measured(front=1.5, back=1.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    assert below[0] == pytest.approx(-0.25 * N), "it lies on its back"
    assert above[0] == pytest.approx(-0.375 * N)


def test_a_table_of_two_points_is_the_step() -> None:
    rows = np.array([0.01, 0.5, 0.0, 0.3, 0.2, 0.0])
    for v in (0.0, 0.01, 0.05, 0.17, 0.29, 0.3, 2.0):
        assert of_table(v, rows, 0, 2) == coefficient(v, 0.5, 0.2, 0.01, 0.3)


def test_a_table_is_the_monotone_cubic_through_its_points() -> None:
    given = [("1 mm/s", 0.5), ("50 mm/s", 0.42), ("300 mm/s", 0.4), ("1 m/s", 0.2), ("2 m/s", 0.3)]
    found = lower_frictions([Friction.model_validate({"speed": given})], np.array([1e-3]))
    assert found is not None
    v, mu, slope = found.speed[0, :5].T
    assert 0.5 * mu == pytest.approx([0.5, 0.42, 0.4, 0.2, 0.3])
    assert slope[[0, 3, 4]] == pytest.approx(0.0), "the ends, and where it turns"
    spline = CubicHermiteSpline(v, mu, slope)
    every = np.linspace(1e-3, 2.0, 400)
    values = np.array([of_table(x, found.speed[0].ravel(), 0, 5) for x in every])
    assert values == pytest.approx(spline(every), abs=1e-12)
    assert (np.diff(values[every < 1.0]) <= 1e-12).all() and values.max() <= 1.0


def test_a_stribeck_curve_is_met_within_a_thousandth() -> None:
    given = {"static": 0.5, "kinetic": 0.2, "stribeck_velocity": "100 mm/s"}
    found = lower_frictions([Friction.model_validate(given)], np.array([1e-3]))
    assert found is not None and found.points[0] == 8
    for v in np.linspace(1e-3, 0.6, 300):
        exact = 0.2 + 0.3 * math.exp(-(((v - 1e-3) / 0.1) ** 2))
        assert 0.5 * of_table(v, found.speed[0].ravel(), 0, 8) == pytest.approx(exact, abs=1e-3 * 0.3)


def test_a_point_reads_the_table_at_its_own_speed() -> None:
    out = measured()
    out[MANY] = 2.0
    out[TABLE : TABLE + 6] = [0.01, 1.0, 0.0, 0.3, 0.4, 0.0]
    assert rubbed(out, (0.5, 0.0, 0.0))[0] == pytest.approx(-0.4 * 0.25 * N)


def sheet(n_x: int, n_y: int, name: str = "note", size=(240.0, 160.0)) -> SheetPart:
    scene = mdlgen.load("samples/verify/slide.yaml")
    scene = scene.with_({"sheets.block.size": [f"{s} mm" for s in size], "sheets.block.boxes": [n_x, n_y]})
    part = mdlgen.lower(scene).sheets[0]
    object.__setattr__(part, "name", name)
    return part


def test_a_field_has_its_mean_its_deviation_and_its_correlation() -> None:
    """Over 30 fields of a sheet of 48 x 32 boxes of L/2, some 3e3 independent places: three standard
    deviations of the mean are 0.014, of a variance 8 %."""
    part, length = sheet(48, 32), 10.0
    fields = np.array([field(part, 0.25, length, seed).reshape(32, 48) for seed in range(30)])
    assert fields.mean() == pytest.approx(1.0, abs=0.014)
    wide = fields - fields.mean()
    variance = float((wide**2).mean())
    # the correlation of two boxes is that of their places, averaged along both sides
    assert variance == pytest.approx(0.25**2 * _of_boxes(0, length) ** 2, rel=0.08)
    assert deviation_of_box(5.0, 5.0, length) == pytest.approx(_of_boxes(0, length), rel=1e-4)
    for k in (1, 2, 3):
        found = float((wide[:, :, k:] * wide[:, :, :-k]).mean()) / variance
        exact = _of_boxes(k, length) / _of_boxes(0, length)
        assert found == pytest.approx(exact, abs=0.04)
        found = float((wide[:, k:] * wide[:, :-k]).mean()) / variance
        assert found == pytest.approx(exact, abs=0.04)


def _of_boxes(apart: int, length: float) -> float:
    """Mean of exp(-(d/L)^2) over two stretches of L/2 that are so many of them apart."""
    x = (np.arange(200) + 0.5) / 200 * 0.5 * length
    return float(np.exp(-(((x[:, None] - x + 0.5 * length * apart) / length) ** 2)).mean())


def test_a_field_is_the_same_on_any_grid() -> None:
    """Boxes have the mean of the finer ones in them, within 1 % of the deviation; one box that of all."""
    for n in (1, 4, 12):
        coarse = field(sheet(n, n), 0.2, 40.0, 3).reshape(n, n)
        fine = field(sheet(3 * n, 3 * n), 0.2, 40.0, 3).reshape(n, 3, n, 3).mean(axis=(1, 3))
        assert np.abs(fine - coarse).max() < 0.01 * 0.2


def test_a_field_is_that_of_its_seed_and_its_sheet() -> None:
    one = field(sheet(6, 4), 0.2, 30.0, 1)
    assert (one == field(sheet(6, 4), 0.2, 30.0, 1)).all()
    assert one[:3] == pytest.approx(FIRST, abs=1e-9), "PCG64, on any machine"
    assert np.abs(one - field(sheet(6, 4), 0.2, 30.0, 2)).max() > 0.05
    assert np.abs(one - field(sheet(6, 4, "other"), 0.2, 30.0, 1)).max() > 0.05
