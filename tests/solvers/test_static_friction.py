"""What friction holds of a sheet at rest: force and couple together, against closed forms and brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import linprog

import mdlgen
from mdlgen.backends.lattice.statics.limit import Grips, cone, limit
from mdlgen.model.lower import lower
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

Floats = np.ndarray
G = 9.81e-3  # mm/ms^2


def flat(place: Floats, most: Floats) -> Grips:
    """Contacts that lie flat, each holding `most` [N] in any direction."""
    place, most = np.asarray(place, float), np.asarray(most, float)
    return Grips(place, np.zeros_like(place), most[:, None, None] * np.eye(2))


def bar(boxes: int) -> Floats:
    """Middles of the parts of a bar of half length 1."""
    return np.stack([2.0 * (np.arange(boxes) + 0.5) / boxes - 1.0, np.zeros(boxes)], axis=1)


def brute(place: Floats, most: Floats, wrench: Floats, sides: int = 96) -> tuple[float, float]:
    """The part of a wrench that is held by contacts whose friction is a polygon of so many sides, inside of
    their circle and outside of it."""
    angle = 2.0 * math.pi * np.arange(sides) / sides
    ways = np.stack([np.cos(angle), np.sin(angle)])
    columns, bounds = [], np.zeros((len(place), sides * len(place) + 1))
    for k, (at, power) in enumerate(zip(place, most, strict=True)):
        columns.append(np.vstack([power * ways, power * (at[0] * ways[1] - at[1] * ways[0])]))
        bounds[k, sides * k : sides * (k + 1)] = 1.0
    equal = np.column_stack([*columns, -wrench])
    found = linprog(
        [0.0] * (sides * len(place)) + [-1.0], bounds, np.ones(len(place)), equal, np.zeros(3), method="highs"
    )
    assert found.success
    return float(found.x[-1]), float(found.x[-1]) / math.cos(math.pi / sides)


# -- the limit surface alone


@pytest.mark.parametrize("away", [0.0, 0.1, 0.5, 2 / 3, 1.0, 3.0])
def test_a_bar_pushed_across_turns_about_a_known_centre(away: float) -> None:
    """mu W (sqrt(a^2 + h^2) - a)/h at a place a from the middle of a bar of half length h; sqrt 2 - 1 at its
    end. 400 parts are off by less than 1e-5 (trapezoids of |x - c|)."""
    found = limit(flat(bar(400), np.full(400, 1 / 400)), np.array([0.0, 1.0, away]))
    assert found.part == pytest.approx(math.hypot(away, 1.0) - away, rel=1e-5)
    if away > 0.0:
        centre = -found.twist[1] / found.twist[2]
        assert centre == pytest.approx(away - math.hypot(away, 1.0), abs=3e-3)  # within its part


def test_a_disc_holds_two_thirds_of_its_radius() -> None:
    grid = np.linspace(-1.0, 1.0, 101)
    place = np.array([(x, y) for x in grid for y in grid if x * x + y * y <= 1.0])
    found = limit(flat(place, np.full(len(place), 1 / len(place))), np.array([0.0, 0.0, 1.0]))
    assert found.part == pytest.approx(2 / 3, rel=2e-3)  # the staircase of a grid of 101
    assert found.error < 1e-6


def test_a_force_through_the_middle_meets_all_friction() -> None:
    place = np.array([(x, y) for x in range(-3, 4) for y in range(-2, 3)], float)
    for angle in (0.0, 0.3, 2.0, 4.0):
        wrench = 2.0 * np.array([math.cos(angle), math.sin(angle), 0.0])
        assert limit(flat(place, np.full(35, 0.1)), wrench).part == pytest.approx(1.75, rel=1e-6)


def test_one_place_holds_no_couple_and_no_contact_nothing() -> None:
    assert limit(flat(np.zeros((1, 2)), np.ones(1)), np.array([0.1, 0.0, 1.0])).part == 0.0
    assert limit(flat(np.zeros((0, 2)), np.ones(0)), np.array([0.1, 0.0, 1.0])).part == 0.0


@pytest.mark.parametrize("seed", range(6))
def test_any_contacts_and_wrench_agree_with_brute_force(seed: int) -> None:
    """A linear program over 96 directions of friction for each contact bounds it from both sides."""
    rng = np.random.default_rng(seed)
    place, most = rng.normal(size=(12, 2)) * (20.0, 3.0), rng.uniform(0.0, 1.0, 12)
    wrench = rng.normal(size=3) * (1.0, 1.0, 20.0)
    low, high = brute(place, most, wrench)
    found = limit(flat(place, most), wrench)
    assert low * (1 - 1e-6) <= found.part <= high * (1 + 1e-6)
    # as all of it moved somewhere else: the couple goes with the origin
    off = np.array([300.0, -50.0])
    moved = wrench - [0.0, 0.0, off[0] * wrench[1] - off[1] * wrench[0]]
    assert limit(flat(place, most).at(off), moved).part == pytest.approx(found.part, rel=1e-5)


@pytest.mark.parametrize("lean, turn, friction", [(0.2, 0.0, 0.5), (0.4, 1.0, 0.6), (-0.3, 2.5, 1.0)])
def test_a_leaning_contact_holds_what_its_cone_does(lean: float, turn: float, friction: float) -> None:
    """All of the ellipse lies on the cone of friction, about a force within it."""
    out = np.array([math.cos(turn), math.sin(turn), 0.0])
    normal = math.sin(lean) * out + math.cos(lean) * np.array([0.0, 0.0, 1.0])
    force = np.array([0.03, -0.02, 2.0]) if friction > abs(math.tan(lean)) else 2.0 * normal
    centre, shape = cone(force, normal, friction)
    for angle in np.linspace(0.0, 2.0 * math.pi, 17):
        held = centre + shape @ [math.cos(angle), math.sin(angle)]
        whole = np.add(force, [*held, 0.0])
        pressing = whole @ normal
        assert np.linalg.norm(whole - pressing * normal) == pytest.approx(friction * pressing, rel=1e-9)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_leaning_contact_holds_less_downhill(way: float) -> None:
    """What friction turned to the vertical already holds a part: tan(atan mu - lean) one way, + the other."""
    lean, friction = 0.2, 0.5
    normal = np.array([math.sin(lean), 0.0, math.cos(lean)])
    centre, shape = cone(np.array([0.0, 0.0, 1.0]), normal, friction)
    found = limit(Grips(np.zeros((1, 2)), centre[None], shape[None]), np.array([way, 0.0, 0.0]))
    assert found.part == pytest.approx(math.tan(math.atan(friction) - way * lean), rel=1e-6)
    assert found.twist == pytest.approx([way, 0.0, 0.0], abs=1e-6)


# -- sheets on planes

STRIP = """
name: strip
gravity: [{gx!r} m/s^2, {gy!r} m/s^2, -9.81 m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 50 N*mm, D_cd: 30 N*mm}}}}
sheets: {{n: {{material: p, size: [200 mm, 20 mm], thickness: 0.1 mm, mass: 0.4 g, boxes: {boxes},
  layout: plate, center: [0 mm, 0 mm, 0.05 mm]}}}}
planes: {{{planes}}}
contacts: [{contacts}]
loads: [{loads}]
run: {{analysis: static}}
"""
TABLE = "{name}: {{center: [{at} mm, 0 mm, -5 mm], normal: z, size: [{long} mm, 100 mm, 10 mm]}}"
CONTACT = "{{between: [n, {name}], stiffness: 100 N/mm^1.5, friction: {mu}}}"
PUSH = "{{sheet: n, at: [{at!r} mm, 0 mm], force: [0 N, {force!r} N, 0 N]}}"
WEIGHT = 0.4 * G


def strip(
    boxes: str = "[4, 1]",
    lean: tuple[float, float] = (0.0, 0.0),
    mu: tuple[float, ...] = (0.5,),
    force: tuple[float, float] | None = None,
) -> Result:
    """A strip on a table, or over two that are 1 mm apart, each of its own friction; `lean`: parts of the
    weight along x and y; `force`: a place along it [mm], and what is pushed across it there, over its
    weight."""
    tables = [("t", 0.0, 400)] if len(mu) == 1 else [("t", -100.0, 199), ("o", 100.0, 199)]
    text = STRIP.format(
        gx=9.81 * lean[0],
        gy=9.81 * lean[1],
        boxes=boxes,
        planes=", ".join(TABLE.format(name=name, at=at, long=long) for name, at, long in tables),
        contacts=", ".join(
            CONTACT.format(name=name, mu=one) for (name, _, _), one in zip(tables, mu, strict=True)
        ),
        loads="" if force is None else PUSH.format(at=force[0], force=force[1] * WEIGHT),
    )
    return mdlgen.solve(lower(loads(text)), "lattice")


def patch(mu: tuple[float, float]) -> tuple[Floats, Floats]:
    """Places of the strip and what friction holds there, in parts of its weight."""
    x, y = (np.arange(100) + 0.5) * 2.0 - 100.0, (np.arange(10) + 0.5) * 2.0 - 10.0
    place = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return place, np.where(place[:, 0] < 0.0, *mu) / len(place)


@pytest.mark.parametrize("turn", [0.0, 30.0, 90.0, 200.0])
@pytest.mark.parametrize("boxes", ["[4, 1]", "[20, 4]"])
def test_a_slope_any_way_holds_up_to_its_friction(turn: float, boxes: str) -> None:
    """Uneven shares of boxes make no couple: the strip of `static_slope_strip` was refused at a fifth."""
    lean = 0.2 * math.cos(math.radians(turn)), 0.2 * math.sin(math.radians(turn))
    stands, slides = (strip(boxes, lean, (mu,)) for mu in (0.202, 0.198))
    assert stands.ok, stands.status
    assert slides.status.startswith("sheet n slides on plane")
    assert "0.000785 N pull it along" in slides.status
    assert "0.99 of it" in slides.status


@pytest.mark.parametrize("at", [0.0, -200 / 3, 70.0, -90.0])
@pytest.mark.parametrize("boxes", ["[3, 1]", "[10, 1]", "[20, 2]"])
def test_a_push_across_turns_a_strip(at: float, boxes: str) -> None:
    """The limit of 1000 places over the whole strip, by brute force; boxes spread what they press: 0.5 %."""
    place, most = patch((0.5, 0.5))
    held = limit(flat(place, most), np.array([0.0, 1.0, at])).part
    assert held == pytest.approx(0.5 * (math.hypot(at / 100, 1.0) - abs(at) / 100), rel=0.02)  # a thin bar
    stands, gives = (strip(boxes, force=(at, part * held)) for part in (0.995, 1.005))
    assert stands.ok, stands.status
    assert not gives.ok
    assert f"sheet n {'turns' if at else 'slides'} on plane" in gives.status
    assert "friction holds" in gives.status


def test_a_couple_is_named_with_what_holds_and_where_it_turns() -> None:
    """Half of a bar's weight at its end: sqrt 2 - 1 is held, about 0.414 of its half length beyond."""
    result = strip("[20, 1]", force=(95.0, 0.5))
    assert not result.ok
    assert "0.00196 N and 0.186 N mm about the middle of its contacts pull it along" in result.status
    where = float(result.status.split("about (")[1].split(",")[0])
    assert where == pytest.approx(-100 * (math.hypot(0.95, 1.0) - 0.95), abs=2.0)


def test_tables_of_unlike_friction_hold_a_slope_less_than_their_mean() -> None:
    """Across the slope the strip turns on the smoother table before all friction is used."""
    mu = (0.6, 0.2)
    along = strip("[20, 2]", (0.396, 0.0), mu), strip("[20, 2]", (0.404, 0.0), mu)
    assert along[0].ok, along[0].status
    assert not along[1].ok
    held = limit(flat(*patch(mu)), np.array([0.0, 1.0, 0.0])).part
    assert held < 0.35
    stands, gives = (strip("[20, 2]", (0.0, part * held), mu) for part in (0.99, 1.01))
    assert stands.ok, stands.status
    assert "turns on plane" in gives.status


BLOCK = """
name: block
gravity: [{lean!r} m/s^2, 0 m/s^2, -10 m/s^2]
materials: {{p: {{E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}}}
sheets: {{n: {{material: p, size: [{long} mm, 20 mm], thickness: 10 mm, mass: 5 g, boxes: [1, 1],
  center: [0 mm, 0 mm, 5 mm]}}}}
planes: {{t: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm]}}}}
contacts: [{{between: [n, t], stiffness: 1000 N/mm^1.5, friction: 0.9}}]
run: {{analysis: static}}
"""


@pytest.mark.parametrize(
    "long, lean, stands", [(10, 6, True), (5.4, 5, True), (4.6, 5, False), (4, 6, False)]
)
def test_a_high_block_on_a_slope_tips_over_its_edge(long: float, lean: float, stands: bool) -> None:
    """Friction acts at its base: it stands where its length over its height is above the slope."""
    result = mdlgen.solve(lower(loads(BLOCK.format(long=long, lean=float(lean)))), "lattice")
    assert result.ok == stands, result.status


NIPPED = """
name: nipped
gravity: [{gx!r} m/s^2, {gy!r} m/s^2, -9.81 m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 50 N*mm, D_cd: 30 N*mm}}}}
sheets: {{n: {{material: p, size: [40 mm, 40 mm], thickness: 1 mm, mass: 100 g, boxes: [1, 1],
  center: [0 mm, 0 mm, 0.5 mm]}}}}
planes: {{t: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 100 mm, 10 mm]}}}}
rollers: {{r: {{center: [0 mm, 0 mm, 6 mm], axis: y, radius: 5 mm, width: 60 mm, mass: 10 g,
  press: {{direction: -z, stiffness: 0.001 N/mm, preload: 1 N}}}}}}
contacts:
  - {{between: [n, t], stiffness: 100 N/mm^1.5, friction: 0.2}}
  - {{between: [n, r], stiffness: 100 N/mm^1.5, friction: 0.4}}
run: {{analysis: static}}
"""


@pytest.mark.parametrize(
    "part, across, stands", [(0.97, 0, True), (1.03, 0, False), (0.97, 1, True), (1.03, 1, False)]
)
def test_an_idle_roller_holds_along_its_axis_alone(part: float, stands: bool, across: int) -> None:
    """0.2 of the weight and of what presses; 0.4 of that along the axis, too."""
    weight, pressing = 0.1 * 9.81, 1.0 + 0.01 * 9.81
    holds = 0.2 * (weight + pressing) + (0.4 * pressing if across else 0.0)
    lean = [0.0, 0.0]
    lean[across] = part * holds / weight * 9.81
    result = mdlgen.solve(lower(loads(NIPPED.format(gx=lean[0], gy=lean[1]))), "lattice")
    assert result.ok == stands, result.status
