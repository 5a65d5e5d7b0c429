"""Sheets whose boxes are not all alike: graded grids and zones, in the Model, the solvers and the text."""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import JOINT_X, JOINT_Y
from mdlgen.results.summary import summary
from mdlgen.spec.load import load
from mdlgen.verify.verification import verify

CANTILEVER, TRANSPORT = "samples/cantilever.yaml", "samples/transport_4x4.yaml"
ELASTICA = 76.5308  # mm, oracles.md
# on lines between boxes: columns of 6.7 mm, rows of 6.35 mm
STRIPE = (
    "sheets.note.zones.stripe="
    "{x: [-13.4 mm, 6.7 mm], y: [-63.5 mm, 12.7 mm], thickness: 0.13 mm, density: 1.7}"
)
FINE = "sheets.note.grading.y=[1,1,1,1,1,1,1,1,1,1,2,2,2,2,2]"


def model(path: str, *overrides: str):
    return lower(load(path, overrides))


def whole_inertia(m) -> np.ndarray:
    """Of all boxes about the sheet's centre, sheet axes along the global ones."""
    arms = m.bodies.position - m.sheets[0].center
    boxes = slice(0, m.sheets[0].count)
    mass, arms, own = m.bodies.mass[boxes], arms[boxes], m.bodies.inertia[boxes]
    squares = arms**2
    return (own + mass[:, None] * (squares.sum(axis=1)[:, None] - squares)).sum(axis=0)


@pytest.mark.parametrize("grid", ["boxes=[10,20]", "boxes=[20,40]"])
def test_mass_and_inertia_with_a_zone_are_those_of_the_two_rectangles(grid):
    m = model(TRANSPORT, f"sheets.note.{grid}", STRIPE)
    mass, (a, b) = 0.72, (67.0, 127.0)
    s, thick, dense = 0.1, 0.13, 1.7 * 1.3
    area = 20.1 * 76.2
    per_area = mass / (a * b + (dense - 1) * area)

    def rectangle(x, y, thickness, per):  # [from, to] about the origin
        weight = per * (x[1] - x[0]) * (y[1] - y[0])
        xx, yy = ((v[0] ** 2 + v[0] * v[1] + v[1] ** 2) / 3 for v in (x, y))
        zz = thickness**2 / 12
        return weight * np.array([yy + zz, xx + zz, xx + yy])

    stripe = [-13.4, 6.7], [-63.5, 12.7]
    exact = rectangle([-33.5, 33.5], [-63.5, 63.5], s, per_area) - rectangle(*stripe, s, per_area)
    exact += rectangle(*stripe, thick, per_area * dense)
    assert m.bodies.mass[: m.sheets[0].count].sum() == pytest.approx(mass, rel=1e-14)
    assert whole_inertia(m) == pytest.approx(exact, rel=1e-12)


def test_a_box_that_a_zone_covers_in_part_has_its_share():
    m = model(
        TRANSPORT, "sheets.note.zones.dot={x: [0 mm, 1.675 mm], y: [0 mm, 3.175 mm], density: 3, friction: 5}"
    )
    box = m.sheets[0].body(5, 10)
    heavy = m.bodies.mass[box] / m.bodies.mass[0]
    assert heavy == pytest.approx(1 + 2 * 0.25 * 0.5, rel=1e-12)
    assert m.bodies.friction[box] == pytest.approx(1 + 4 * 0.25 * 0.5, rel=1e-12)
    assert np.all(np.delete(m.bodies.friction, box) == 1.0)
    assert m.bodies.mass[:200].sum() == pytest.approx(0.72, rel=1e-14)


def test_joints_at_the_border_of_a_zone_are_its_two_halves_in_series():
    m = model(
        CANTILEVER, "sheets.note.zones.half={x: [-33.5 mm, 33.5 mm], y: [0 mm, 63.5 mm], thickness: 0.2 mm}"
    )
    rows = m.bushings
    along_y = rows.k[(rows.kind == JOINT_Y) & (rows.a % 10 == 4)]
    y = rows.origin[(rows.kind == JOINT_Y) & (rows.a % 10 == 4), 1]
    soft, hard, border = (along_y[np.argmin(np.abs(y - at))] for at in (-30, 30, 0))
    assert hard[1] == pytest.approx(2 * soft[1], rel=1e-12)
    assert hard[3] == pytest.approx(8 * soft[3], rel=1e-12)
    assert border[1] == pytest.approx(2 / (1 + 1 / 2) * soft[1], rel=1e-12)
    assert border[3] == pytest.approx(2 / (1 + 1 / 8) * soft[3], rel=1e-12)


def test_graded_lengths_add_up_and_joints_have_their_own():
    m = model(CANTILEVER, "sheets.note.boxes=[6,15]", FINE)
    sheet = m.sheets[0]
    assert sheet.outline == pytest.approx((67.0, 127.0), rel=1e-14)
    assert np.diff(sheet.lines_y) == pytest.approx([6.35] * 10 + [12.7] * 5, rel=1e-12)
    assert m.bodies.mass[:90].sum() == pytest.approx(0.72, rel=1e-14)
    rows = m.bushings
    k = rows.k[rows.kind == JOINT_X]
    wide = rows.origin[rows.kind == JOINT_X, 1] > 7.0
    assert k[wide, 0].max() == pytest.approx(2 * k[~wide, 0].min(), rel=1e-12)


def test_a_sheet_that_is_graded_evenly_is_the_plain_one():
    plain = model(CANTILEVER, "sheets.note.boxes=[4,5]")
    graded = model(
        CANTILEVER, "sheets.note.boxes=[4,5]", "sheets.note.grading={x: [2,2,2,2], y: [1,1,1,1,1]}"
    )
    for name in ("k", "c", "origin"):
        one, two = getattr(plain.bushings, name), getattr(graded.bushings, name)
        assert np.allclose(one, two, rtol=1e-12, atol=1e-12 * np.abs(one).max())
    assert np.allclose(plain.bodies.mass, graded.bodies.mass, rtol=1e-14)


def test_finer_near_a_place():
    m = model(
        CANTILEVER,
        "sheets.note.boxes=[6,15]",
        "sheets.note.grading.y={near: [-63.5 mm], width: 40 mm, ratio: 2}",
    )
    lengths = np.diff(m.sheets[0].lines_y)
    assert lengths.sum() == pytest.approx(127.0, rel=1e-12)
    assert lengths[-1] / lengths[0] == pytest.approx(2.0, rel=0.01)
    assert np.all(np.diff(lengths) > -1e-9)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize(
    ("overrides", "limit"),
    [
        (("sheets.note.boxes=[2,20]",), 0.25),
        (("sheets.note.boxes=[2,15]",), 0.4),
        (("sheets.note.boxes=[2,15]", FINE), 0.35),  # no better than 15 rows elsewhere, but fine at the clamp
    ],
)
def test_heavy_elastica_on_even_and_graded_grids(solver, overrides, limit):
    bending = ("materials.eur10.D_cd=0.242 N*mm", "materials.eur10.D_md=0.242 N*mm")
    result = mdlgen.solve(model(CANTILEVER, *bending, *overrides), solver)
    drop = -summary(result)["probes"]["tip"]["displacement_mm"][2]
    assert result.ok
    assert abs(drop / ELASTICA - 1) < limit / 100


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_stiff_half_hangs_less_and_both_solvers_agree(solver):
    zone = "sheets.note.zones.half={x: [-33.5 mm, 33.5 mm], y: [-63.5 mm, 0 mm], stiffness: 20}"
    plain = mdlgen.solve(model(CANTILEVER, "sheets.note.boxes=[2,20]"), "lattice")
    stiff = mdlgen.solve(model(CANTILEVER, "sheets.note.boxes=[2,20]", zone), solver)
    other = mdlgen.solve(model(CANTILEVER, "sheets.note.boxes=[2,20]", zone), "lattice")
    drop, bent, again = (-summary(r)["probes"]["tip"]["displacement_mm"][2] for r in (plain, stiff, other))
    assert bent < 0.3 * drop
    assert bent == pytest.approx(again, rel=1e-6)


def test_a_rougher_side_turns_the_note():
    # row 1 drives from rest at slipping contacts: the side of higher friction goes ahead
    slip = (
        "contacts.0.friction=0.05",
        "run.duration=8 ms",
        "run.step=0.1 ms",
    )
    rough = "sheets.note.zones.rough={x: [-33.5 mm, 33.5 mm], y: [%s], friction: 2}"
    turns = []
    for side in ("-63.5 mm, 0 mm", "0 mm, 63.5 mm"):
        m = model(TRANSPORT, *slip, rough % side)
        turns.append(summary(mdlgen.solve(m, "lattice"))["sheets"]["note"]["yaw_deg"])
    # travel is along +x; more pull at y < 0 turns the note to the left (positive about z)
    assert turns[0] > 0 > turns[1]
    assert turns[0] == pytest.approx(-turns[1], rel=0.02)


def test_the_text_says_the_same():
    scene = load(
        TRANSPORT,
        (
            "sheets.note.boxes=[4,6]",
            "sheets.note.grading={x: [1,2,1,1], y: {near: [-20 mm, 20 mm], width: 15 mm, ratio: 2}}",
            "sheets.note.zones={stripe: {x: [-33 mm, -20.1 mm], y: [-20 mm, 5 mm], thickness: 0.12 mm,"
            " friction: 2}, window: {x: [3 mm, 20 mm], y: [-20 mm, 5 mm], density: 0.7, stiffness: 1.5}}",
        ),
    )
    found = verify(scene, lower(scene))
    assert found.ok, found.differences
    assert found.perturbed is not None and found.perturbed.values > 150


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("sheets.note.grading.x=[1,2]", "has 2 lengths for 10 boxes"),
        ("sheets.note.grading.x=[1,1,1,1,1,1,1,1,1,0]", "relative length 9"),
        ("sheets.note.grading.x=3", "no grading"),
        ("sheets.note.grading.x={near: [0 mm]}", "give either"),
        ("sheets.note.grading.x={near: [90 mm], width: 2 mm, ratio: 2}", "off the sheet"),
        ("sheets.note.zones.a={x: [1 mm, 0 mm], y: [0 mm, 1 mm]}", "no range"),
        ("sheets.note.zones.a={x: [0 mm, 99 mm], y: [0 mm, 1 mm]}", "leaves the sheet"),
        (
            "sheets.note.zones="
            "{a: {x: [0 mm, 9 mm], y: [0 mm, 1 mm]}, b: {x: [5 mm, 7 mm], y: [0 mm, 1 mm]}}",
            "overlap",
        ),
    ],
)
def test_what_is_refused(override, words):
    with pytest.raises(SpecError, match=words):
        load(TRANSPORT, (override,))


def test_the_paper_grid_is_even():
    with pytest.raises(SpecError, match="equal boxes"):
        load(TRANSPORT, ("sheets.note.grid=paper", "sheets.note.grading.x=[1,1,1,1,1,1,1,1,1,2]"))
