"""The law of air between two faces against closed forms of Reynolds' equation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mdlgen.mechanics.film import CELL, FILM, NEVER, X_DOWN, X_UP, assemble, factor, solve, times

pytestmark = pytest.mark.usefixtures("as_python")

VISCOSITY = 18.2e-9  # [N ms/mm^2]
GAP = 0.02  # [mm]


def plate(boxes, size, gap=GAP, change=None):
    """A film of equal cells under a whole plate: its record, its cells, its matrix."""
    n_x, n_y = boxes
    film, cells = np.zeros(1, FILM), np.zeros(n_x * n_y, CELL)
    film["across"], film["width"], film["cells"] = n_x > n_y, min(boxes), n_x * n_y
    film["viscosity"] = VISCOSITY
    cells["inside"], cells["edge"], cells["gap"] = 1, NEVER, gap
    cells["size"] = size[0] / n_x, size[1] / n_y
    if change is not None:
        change(cells, *middles(boxes, size))
    flow = np.zeros((len(cells), min(boxes) + 1))
    assemble(film[0], cells, flow)
    return film[0], cells, flow


def middles(boxes, size):
    """Where the middles of the cells are, in their order [mm]."""
    x, y = ((np.arange(n) + 0.5) * s / n for n, s in zip(boxes, size, strict=True))
    y, x = np.meshgrid(y, x, indexing="ij")
    return (x.T.ravel(), y.T.ravel()) if boxes[0] > boxes[1] else (x.ravel(), y.ravel())


def force(film, cells, flow, speed=1.0):
    """What it pushes with where all of it closes at a speed."""
    band, x = flow.copy(), cells["area"] * speed
    factor(band, 0, len(cells), int(film["width"]))
    solve(film, band, x)
    return float(x @ cells["area"])


def rectangle(a, b, terms=60):
    """Force of a rectangular plate over mu V/h^3 [mm^4]: the series of Poisson's equation."""
    odd = np.arange(1, 2 * terms, 2)
    total = sum(math.tanh(n * math.pi * b / (2 * a)) / n**5 for n in odd)
    return a**3 * b * (1.0 - 192.0 * a / (math.pi**5 * b) * total)


def test_the_closed_form_of_a_square() -> None:
    # Hamrock, Fundamentals of Fluid Film Lubrication: 0.4217
    assert rectangle(1.0, 1.0) == pytest.approx(0.4217, abs=1e-4)


@pytest.mark.parametrize("boxes", [(4, 4), (8, 8), (10, 20), (20, 10), (24, 24)])
@pytest.mark.parametrize("size", [(67.0, 67.0), (67.0, 127.0), (127.0, 67.0)])
def test_a_whole_plate(boxes, size) -> None:
    found = force(*plate(boxes, size)) / (VISCOSITY / GAP**3)
    # straight pressures between few cells: 0.6 % at four of them
    assert found == pytest.approx(rectangle(*sorted(size)), rel=7e-3)


@pytest.mark.parametrize("n", [4, 8, 16])
def test_a_strip(n) -> None:
    found = force(*plate((n, 200), (10.0, 1e5))) / (VISCOSITY / GAP**3)
    # four cells across, and half of one of the 200 at either end
    assert found == pytest.approx(10.0**3 * 1e5, rel=4e-3)


@pytest.mark.parametrize("n", [16, 32])
@pytest.mark.parametrize("slope", [-0.8, 0.5, 3.0])
def test_a_wedge(slope, n) -> None:
    """A long strip whose gap grows along it: h = h0 (1 + s x/L). With Q = 12 mu V (c - x) through each place,
    p' = Q/h^3, and c is such that p is 0 at both edges."""
    length, wide = 10.0, 1e5

    def leaning(cells, x, _y):
        cells["gap"] = GAP * (1.0 + slope * x / length)

    film, cells, flow = plate((n, 200), (length, wide), change=leaning)
    x = np.linspace(0.0, length, 200_001)
    weight = (1.0 + slope * x / length) ** -3.0
    centre = np.trapezoid(x * weight, x) / np.trapezoid(weight, x)
    grows = (centre - x) * weight
    pressure = 12.0 * np.concatenate([[0.0], np.cumsum(0.5 * (grows[1:] + grows[:-1]) * np.diff(x))])
    exact = wide * np.trapezoid(pressure, x)
    # of second order in the cells, where the gap is five times as wide at one edge
    assert force(film, cells, flow) / (VISCOSITY / GAP**3) == pytest.approx(exact, rel=12.0 / n**2)


@pytest.mark.parametrize("boxes", [(8, 16), (13, 26)])
def test_an_edge_between_two_cells_is_where_it_is(boxes) -> None:
    size = (50.0, 100.0)
    before = 0.0
    for part in np.linspace(20.0, 30.0, 21):

        def cut(cells, x, _y, part=part):
            cells["inside"] = x <= part
            cells["edge"][:, X_UP] = np.where(x <= part, part - x, NEVER)
            cells["edge"][:, X_DOWN] = np.where(x > part, x - part, NEVER)

        found = force(*plate(boxes, size, change=cut)) / (VISCOSITY / GAP**3)
        # of eight cells three to five are covered
        assert found == pytest.approx(rectangle(part, size[1]), rel=5e-2)
        assert found > before
        before = found


def test_it_is_symmetric_and_takes_power_of_whatever_closes() -> None:
    rng = np.random.default_rng(3)

    def any_gap(cells, _x, _y):
        cells["gap"] = rng.uniform(0.001, 0.2, len(cells))
        cells["inside"] = rng.uniform(size=len(cells)) > 0.2
        cells["edge"] = rng.uniform(0.0, 10.0, (len(cells), 4))

    film, cells, flow = plate((5, 7), (50.0, 70.0), change=any_gap)
    whole = np.zeros((35, 35))
    for k in range(35):
        one, out = np.zeros(35), np.zeros(35)
        one[k] = 1.0
        times(film, flow, one, out)
        whole[k] = out
    assert np.abs(whole - whole.T).max() == 0.0
    assert np.linalg.eigvalsh(whole).min() > 0.0
    area = cells["area"]
    assert (area[cells["inside"] == 0] == 0.0).all() and (area >= 0.0).all()
    band = flow.copy()
    factor(band, 0, 35, 5)
    for _ in range(5):
        x = area * rng.normal(size=35)
        pressure = x.copy()
        solve(film, band, pressure)
        assert np.abs(whole @ pressure - x).max() < 1e-9 * np.abs(x).max()
        assert pressure @ x > 0.0


def test_faces_in_each_other_do_not_close() -> None:
    def pressed(cells, x, _y):
        cells["gap"] = np.where(x < 25.0, -1e-5, GAP)

    film, cells, flow = plate((8, 8), (50.0, 50.0), change=pressed)
    film["roughness"] = 0.01
    assert film["acts"] == 1 and (cells["area"][cells["gap"] < 0.0] == 0.0).all()
    cells["gap"] = -1e-5
    assemble(film, cells, flow)
    assert film["acts"] == 0
