"""Overlaps of two boxes that are kept: the law of two boxes, and when they are found anew."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mdlgen.mechanics.facing import box_box
from mdlgen.mechanics.frame import Box, Frame, Law
from mdlgen.mechanics.impacts import stored_beyond, turning_back
from mdlgen.mechanics.laws import friction_over_speed
from mdlgen.mechanics.overlap import (
    APART,
    BY_SIDES,
    CLEAR,
    MOVED,
    OTHER,
    OVERLAP,
    OVERLAPS,
    PRESSES,
    find,
    holds,
    impact,
    press,
)
from mdlgen.mechanics.point import (
    AT,
    FORCE,
    GRIP,
    GROWTH,
    MOST_POINTS,
    NORMAL,
    OUT,
    POINT,
    POINTS,
    PRESSING,
    RATE,
    RUBBING,
    SLIP,
    SPRING,
    closing,
)

pytestmark = pytest.mark.usefixtures("as_python")

HALF, OTHER_HALF = (3.35, 3.175, 0.05), (2.0, 3.0, 0.04)
WIDE = OUT + 1 + POINT * MOST_POINTS


def law(shared: bool) -> Law:
    return Law(20000.0, shared, 0.6, 0.4, 0.3, 1e-3, 2e-3, 1e-3)


def frame(draw: np.random.Generator, place: Any, turn: Any) -> Frame:
    return Frame(
        _three(place),
        tuple(np.ravel(turn).tolist()),
        _three(draw.normal(0, 1, 3)),
        _three(draw.normal(0, 0.1, 3)),
    )


def _three(values: Any) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def two(seed: int) -> tuple[Frame, Box, Frame, Box, Law]:
    """Two boxes, one on or near the other, slightly askew, anywhere in space; some with free sides."""
    draw = np.random.default_rng(seed)
    other = OTHER_HALF if seed % 3 == 0 else HALF
    whole = Rotation.from_quat(draw.normal(0, 1, 4)).as_matrix()
    askew = [Rotation.from_rotvec(draw.normal(0, 2e-3, 3) * [1, 1, 30]).as_matrix() for _ in range(2)]
    flip = np.diag([1.0, -1.0, -1.0]) if seed % 5 == 0 else np.eye(3)
    up = draw.choice([-1, 1]) * (HALF[2] + other[2] - draw.uniform(-0.005, 0.02))
    place = draw.normal(0, 50, 3)
    far = place + whole @ np.array([draw.uniform(-7, 7), draw.uniform(-7, 7), up])
    exposed = 15 if seed % 4 == 0 else 0
    a, b = frame(draw, place, whole @ askew[0]), frame(draw, far, whole @ askew[1] @ flip)
    return a, Box(HALF, exposed), b, Box(other, exposed), law(seed % 7 > 0)


def found(case: tuple[Frame, Box, Frame, Box, Law]) -> np.ndarray:
    kept = np.zeros(1, OVERLAP).view(np.recarray)
    find.py_func(kept[0], *case)
    return kept


@pytest.fixture(scope="module")
def cases() -> list[tuple[Any, np.ndarray]]:
    made = [two(seed) for seed in range(300)]
    return [(case, found(case)) for case in made]


def test_the_law_is_that_of_two_boxes(cases: list[tuple[Any, np.ndarray]]) -> None:
    """What is kept gives the force, torques, energy and loss that the law itself gives."""
    touching = 0
    for case, kept in cases:
        a, _, b, _, numbers = case
        if kept[0]["state"] == OTHER:
            continue
        whole, pressed = np.zeros(WIDE), np.zeros(GRIP + 1)
        box_box.py_func(whole, *case)
        if kept[0]["count"]:
            does = press.py_func(pressed, kept[0], a, b, numbers)
            if does == BY_SIDES:
                continue
            assert does == (PRESSES if whole[POINTS] else CLEAR)
        scale = 1e-9 * np.abs(whole).max() + 1e-15
        assert pressed[:OUT] == pytest.approx(whole[:OUT], abs=scale)
        touching += bool(whole[POINTS])
    assert touching > 100


def test_friction_of_faces_is_that_of_their_points(cases: list[tuple[Any, np.ndarray]]) -> None:
    touching = 0
    for case, kept in cases:
        a, _, b, _, numbers = case
        pointwise, pressed = np.zeros(WIDE), np.zeros(GRIP + 1)
        if not kept[0]["count"] or not press.py_func(pressed, kept[0], a, b, numbers):
            continue
        box_box.py_func(pointwise, *case)
        rows = pointwise[OUT + 1 :].reshape(-1, POINT)[: int(pointwise[POINTS])]
        speed = np.linalg.norm(rows[:, SLIP : SLIP + 3], axis=1)
        law = (numbers.mu_static, numbers.mu_dynamic, numbers.stiction, numbers.sliding)
        grip = [friction_over_speed.py_func(v, *law) for v in speed]
        assert pressed[RUBBING] == pytest.approx((rows[:, FORCE] * grip * speed).sum(), rel=1e-9)
        assert pressed[GRIP] == pytest.approx(numbers.mu_static * pressed[PRESSING], rel=1e-12)
        touching += 1
    assert touching > 100


@pytest.mark.parametrize("dt", [1e-3, 0.1])
def test_impacts_of_faces_are_those_of_their_points(dt: float, cases: list[tuple[Any, np.ndarray]]) -> None:
    """By the rates and changes of rates at each point, which the law gives in global axes."""
    draw = np.random.default_rng(1)
    makes = misses = 0
    for case, kept in cases:
        a, _, b, _, numbers = case
        if not kept[0]["count"]:
            continue
        pointwise = np.zeros(WIDE)
        box_box.py_func(pointwise, *case)
        rows = pointwise[OUT + 1 :].reshape(-1, POINT)[: int(pointwise[POINTS])]
        faster = [(_three(draw.normal(0, 1, 3)), _three(draw.normal(0, 0.1, 3))) for _ in range(2)]
        quick = [frame._replace(v=v, w=w) for frame, (v, w) in zip((a, b), faster, strict=True)]
        made = missed = 0.0
        for row in rows:
            depth = 1.5 * row[SPRING] / row[GROWTH]
            made += stored_beyond.py_func(row[SPRING], depth, 0.4 * row[SPRING] * depth, 0.5 * dt * row[RATE])
            more = closing.py_func(row[AT : AT + 3], row[NORMAL : NORMAL + 3], *quick)
            back = turning_back.py_func(row[RATE], more, numbers.beta, numbers.smoothing)
            missed += row[SPRING] * dt * back
        assert impact.py_func(kept[0], a, b, tuple(faster), numbers, dt) == pytest.approx(
            (made, missed), rel=1e-7, abs=1e-12
        )
        makes, misses = makes + (made != 0.0), misses + (missed > 0.0)
    assert makes > 100 and misses > 50


def test_both_bodies_get_opposite_forces_at_one_place(cases: list[tuple[Any, np.ndarray]]) -> None:
    for (a, _, b, _, numbers), kept in cases:
        if not kept[0]["count"]:
            continue
        out = np.zeros(GRIP + 1)
        press.py_func(out, kept[0], a, b, numbers)
        force, torque, back, turned = out[:12].reshape(4, 3)
        assert (force == -back).all()
        moment = torque + np.cross(a.x, force) + turned + np.cross(b.x, back)
        assert np.abs(moment).max() <= 1e-9 * np.abs(force).max() * 100.0 + 1e-15


@pytest.mark.parametrize("along", [True, False])
def test_it_is_found_anew_where_a_box_moved_along_the_other(
    along: bool, cases: list[tuple[Any, np.ndarray]]
) -> None:
    for (a, _, b, _, _), kept in cases:
        if kept[0]["state"] not in (APART, OVERLAPS):
            continue
        assert holds.py_func(kept[0], a, b, 0.4 * MOVED * min(HALF[:2] + OTHER_HALF[:2]))
        owner = a if kept[0]["first"] else b
        way = np.reshape(owner.r, (3, 3))[:, 0 if along else 2] * 1.01 * kept[0]["allowed"]
        moved = b._replace(x=_three(np.add(b.x, way)))
        assert holds.py_func(kept[0], a, moved, 0.0) is not along


def test_sides_own_the_contact_where_they_overlap_less_than_faces() -> None:
    """Of boxes with free sides whose outlines overlap by little, at any depth: as the law of two boxes."""
    faces = sides = 0
    for seed in range(400):
        draw = np.random.default_rng(seed)
        deep, narrow = draw.uniform(1e-4, 0.03), draw.uniform(1e-4, 0.06)
        askew = [Rotation.from_rotvec(draw.normal(0, 1e-4, 3)).as_matrix() for _ in range(2)]
        place = [2.0 * HALF[0] - narrow, draw.uniform(-2, 2), 2.0 * HALF[2] - deep]
        a, b = frame(draw, np.zeros(3), askew[0]), frame(draw, np.array(place), askew[1])
        case = (a, Box(HALF, 15), b, Box(HALF, 15), law(True))
        kept, pressed, whole = found(case), np.zeros(GRIP + 1), np.zeros(WIDE)
        box_box.py_func(whole, *case)
        does = press.py_func(pressed, kept[0], a, b, case[-1]) if kept[0]["count"] else BY_SIDES
        normal = whole[OUT + 1 + NORMAL : OUT + 4 + NORMAL] @ np.reshape(a.r, (3, 3))
        if does == BY_SIDES:
            sides += abs(normal[0]) > 0.9
            assert deep > 0.8 * narrow  # else faces own it
        else:
            faces += 1
            assert pressed[:OUT] == pytest.approx(whole[:OUT], abs=1e-9 * np.abs(whole).max() + 1e-15)
    assert faces > 100 and sides > 50


def test_outlines_that_are_apart_are_so_while_it_is_said() -> None:
    """Of boxes at any angle to each other, long ones too, that slide and turn over each other: where what is
    kept still holds, the law of two boxes has nothing."""
    near = held = 0
    for seed in range(1500):
        draw = np.random.default_rng(seed)
        halves = [(*draw.uniform(0.5, 1.0 if seed % 2 else 8.0, 2), 0.05) for _ in range(2)]
        turn = Rotation.from_rotvec([0, 0, draw.uniform(-np.pi, np.pi)]).as_matrix()
        far = draw.normal(0, 1, 2)
        place = far / np.linalg.norm(far) * draw.uniform(1.0, 1.5) * sum(max(half[:2]) for half in halves)
        a, b = frame(draw, np.zeros(3), np.eye(3)), frame(draw, np.array([*place, 0.099]), turn)
        kept = found((a, Box(halves[0], 0), b, Box(halves[1], 0), law(True)))
        if kept[0]["state"] != APART:
            continue
        for _ in range(4):
            way, angle = draw.normal(0, 1, 2), draw.normal(0, 0.05)
            way *= draw.uniform(0.5, 1.5) * max(kept[0]["allowed"], 0.01) / np.linalg.norm(way)
            turned = Rotation.from_rotvec([0, 0, angle]).as_matrix() @ turn
            moved = frame(draw, np.array([*(place + way), 0.099]), turned)
            whole = np.zeros(WIDE)
            box_box.py_func(whole, a, Box(halves[0], 0), moved, Box(halves[1], 0), law(True))
            holding = holds.py_func(kept[0], a, moved, 0.0)
            held, near = held + holding, near + bool(whole[POINTS])
            assert not (holding and whole[POINTS])
    assert held > 500 and near > 100
