"""The law of a measured curve: its slopes, the compiled spring, and what of it each joint of a grid has."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import Akima1DInterpolator, CubicSpline, PchipInterpolator, make_interp_spline

from mdlgen.altair.curves import straight_points
from mdlgen.mechanics.curve import FOLLOWS, curve_points, curve_spring, follow
from mdlgen.model import curves as law
from mdlgen.model.lower import lower
from mdlgen.model.tables import CLAMP, JOINT_X, JOINT_Y, Curves, Model
from mdlgen.paths import samples
from mdlgen.spec.load import load, loads

PAPER = "[[0, 0 MPa], [0.2 %, 7 MPa], [0.5 %, 15.5 MPa], [1 %, 24 MPa], [1.6 %, 30 MPa], [2 %, 32 MPa]]"
TOE = "[[0, 0 MPa], [0.2 %, 1 MPa], [0.5 %, 9 MPa], [1 %, 24 MPa], [1.2 %, 24 MPa], [3 %, 25 MPa]]"
SCENE = """name: pull
materials:
  m: {{curve_md: {{points: {md}, extrapolate: {beyond}}}, curve_cd: {cd}, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  s: {{material: m, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 1 g, boxes: {boxes}, layout: {layout},
       clamp: {{edge: {edge}, length: 0 mm}}}}
"""


def made(md: str = PAPER, cd: str = TOE, beyond: str = "refuse", **given: str) -> Model:
    parts = {"boxes": "[3, 2]", "layout": "edge_to_edge", "edge": "x_min"} | given
    return lower(loads(SCENE.format(md=md, cd=cd, beyond=beyond, **parts)))


def mirrored(curves: Curves, number: int) -> PchipInterpolator:
    part = slice(curves.start[number], curves.start[number + 1])
    x, y = curves.strain[part], curves.stress[part]
    return PchipInterpolator(np.concatenate([-x[:0:-1], x]), np.concatenate([-y[:0:-1], y]))


def spring(model: Model, row: int):
    """Compiled (force, slope, energy) of one bushing."""
    joints = np.zeros(len(model.bushings), [*FOLLOWS, ("k", "f8", 6)])
    follow(joints, model.curves, np.arange(len(joints)))
    points = curve_points(model.curves)
    return lambda d: curve_spring(points, joints[row], d)


@pytest.mark.parametrize("number", [0, 1])
def test_the_curve_is_the_pchip_of_points_and_mirror_images(number: int) -> None:
    curves = made().curves
    known, end = mirrored(curves, number), law.limit(curves, number)
    strain = np.linspace(-end, end, 2001)
    greatest = float(known(end))
    assert np.abs(law.stress(curves, number, strain) - known(strain)).max() < 1e-13 * greatest
    part = slice(curves.start[number], curves.start[number + 1])
    x = curves.strain[part]
    assert curves.slope[part] == pytest.approx(known(x, 1), rel=1e-12, abs=1e-9)
    assert curves.energy[part] == pytest.approx(
        [float(known.integrate(0, e)) for e in x], rel=1e-12, abs=1e-15
    )


@pytest.mark.parametrize("size", [2, 3, 7, 101])
def test_slopes_of_any_points(size: int) -> None:
    rng = np.random.default_rng(size)
    x = np.concatenate([[0.0], np.cumsum(rng.random(size - 1) + 0.01)])
    y = np.concatenate([[0.0], np.cumsum(rng.random(size - 1) * rng.integers(0, 2, size - 1))])
    y[1:] += 0.1
    known = PchipInterpolator(np.concatenate([-x[:0:-1], x]), np.concatenate([-y[:0:-1], y]))
    assert law.monotone_slopes(x, y) == pytest.approx(known(x, 1), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("beyond", ["refuse", "linear"])
@pytest.mark.parametrize("kind", [JOINT_X, JOINT_Y, CLAMP])
def test_the_compiled_spring(kind: int, beyond: str) -> None:
    """The same curve as the tables', odd, monotone; its slope and energy are derivative and integral."""
    model = made(beyond=beyond)
    curves, row = model.curves, int(np.flatnonzero(model.bushings.kind == kind)[0])
    number = int(curves.of[row])
    length, area = curves.length[row], curves.area[row]
    one = spring(model, row)
    ends = np.linspace(-1.4, 1.4, 561) * law.limit(curves, number) * length
    forces = np.array([one(d)[0] for d in ends])
    greatest = np.abs(forces).max()
    assert forces == pytest.approx(area * law.stress(curves, number, ends / length), abs=1e-13 * greatest)
    assert all(one(-d)[0] == -one(d)[0] for d in ends)
    assert (np.diff(forces) >= -1e-13 * greatest).all()
    small = 1e-6 * ends[-1]
    for d in ends:
        _, slope, energy = one(d)
        # central differences; where two pieces meet, the slope is continuous but bends
        change = (one(d + small)[0] - one(d - small)[0]) / (2 * small)
        assert slope == pytest.approx(change, rel=1e-4, abs=1e-4 * greatest / ends[-1])
        knots = [
            k for k in length * curves.strain[curves.start[number] : curves.start[number + 1]] if k < abs(d)
        ]
        work = quad(lambda e: one(e)[0], 0, abs(d), points=knots, limit=200)[0] if d else 0.0
        assert energy == pytest.approx(work, rel=1e-10, abs=1e-12 * greatest * ends[-1])
    assert one(0.0)[1] == pytest.approx(model.bushings.k[row, curves.axis[row]], rel=1e-12)


def test_beyond_the_last_point() -> None:
    """Linear goes on with the last slope; a run that refuses has at least a part of the first one."""
    for beyond, least in (("linear", 0.0), ("refuse", law.LEAST_RISE)):
        curves = made(md=TOE, beyond=beyond).curves
        last = curves.start[1] - 1
        assert curves.rise[0] == max(curves.slope[last], least * curves.slope[0])
        strain = np.array([1.0, 2.0]) * curves.strain[last]
        one, two = law.stress(curves, 0, strain)
        assert two - one == pytest.approx(curves.rise[0] * curves.strain[last])


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
@pytest.mark.parametrize("boxes", ["[1, 1]", "[3, 2]", "[6, 8]"])
@pytest.mark.parametrize("edge", ["x_min", "y_max"])
def test_every_grid_has_the_same_curve(boxes: str, layout: str, edge: str) -> None:
    """Across a row of joints forces add up to stress times section; elongations to strain times length."""
    model = made(boxes=boxes, layout=layout, edge=edge)
    curves, table, sheet = model.curves, model.bushings, model.sheets[0]
    assert np.array_equal(curves.of >= 0, np.isin(table.kind, (JOINT_X, JOINT_Y, CLAMP)))
    parts = 2 if layout == "edge_to_edge" else 1
    for kind in (JOINT_X, JOINT_Y, CLAMP):
        rows = np.flatnonzero(table.kind == kind)
        way = 0 if kind == JOINT_X or (kind == CLAMP and edge[0] == "x") else 1
        if not len(rows):
            continue
        number = curves.name.index(f"s_{law.WAYS[way]}")
        assert (curves.axis[rows] == way).all() and (curves.of[rows] == number).all()
        across = (sheet.n_y, sheet.n_x)[way]
        in_one_line = across * parts
        section = sheet.size[1 - way] * sheet.thickness
        assert in_one_line * curves.area[rows] == pytest.approx(section, rel=1e-14)
        pitch = (sheet.d_x, sheet.d_y)[way]
        assert curves.length[rows] == pytest.approx(pitch / 2 if kind == CLAMP else pitch, rel=1e-14)
        # the first slope is the linear stiffness, from which the damping follows
        stiff = curves.area[rows] * curves.slope[curves.start[number]] / curves.length[rows]
        assert table.k[rows, way] == pytest.approx(stiff, rel=1e-12)


def test_a_curve_leaves_all_but_its_own_direction_as_it_was() -> None:
    bent = made()
    text = SCENE.format(md="X", cd="Y", beyond="refuse", boxes="[3, 2]", layout="edge_to_edge", edge="x_min")
    text = text.replace("curve_md: {points: X, extrapolate: refuse}", "E_md: 3500 MPa")
    plain = lower(loads(text.replace("curve_cd: Y", "E_cd: 500 MPa")))
    assert bent.bushings.k == pytest.approx(plain.bushings.k, rel=1e-12)
    assert bent.bushings.c == pytest.approx(plain.bushings.c, rel=1e-12)
    assert len(plain.curves) == 0 and (plain.curves.of == -1).all()
    given = {p.member: (p.value, p.path) for p in bent.parameters if p.data_set == "s"}
    assert given["E_md"] == (pytest.approx(3500.0), None)


def test_a_tension_strip_has_the_moduli_of_its_formula() -> None:
    """sigma = E eps (1 + a eps^2): the table's cubics are within its pitch of it."""
    curves = lower(load(samples() / "verify" / "tension.yaml")).curves
    strain = np.linspace(0, 0.05, 3001)
    formula = 1000 * strain * (1 - 50 * strain**2)
    assert np.abs(law.stress(curves, 0, strain) - formula).max() < 1e-6 * formula.max()
    assert len(curves.strain) >= 101 and law.limit(curves, 0) == 0.05


@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("beyond", ["refuse", "linear"])
def test_straight_points_are_the_curve_whatever_is_between(number: int, beyond: str) -> None:
    """Lines, Akima's, natural cubic and quintic splines: all within 1e-6 of the greatest stress."""
    curves = made(beyond=beyond).curves
    x, y = straight_points(curves, number)
    known, end = mirrored(curves, number), law.limit(curves, number)
    assert (np.diff(x) > 0).all() and (np.diff(y) >= 0).all()
    strain = np.linspace(-end, end, 200_001)
    exact = known(strain)
    greatest = exact.max()
    inner = np.abs(x) <= end
    x, y = x[inner], y[inner]
    assert np.abs(np.interp(strain, x, y) - exact).max() <= 1.001e-6 * greatest
    for method in (
        Akima1DInterpolator(x, y),
        CubicSpline(x, y, bc_type="natural"),
        make_interp_spline(x, y, k=5),
    ):
        assert np.abs(method(strain) - exact).max() <= 1e-6 * greatest
