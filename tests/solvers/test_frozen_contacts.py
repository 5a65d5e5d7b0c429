"""Contact points of an iteration, their geometry frozen: forces, what these lose, the convex problem."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.work import arrays, control
from mdlgen.backends.lattice.kernels import forces, tuning
from mdlgen.backends.lattice.kernels.contact import between
from mdlgen.backends.lattice.kernels.contact.condensed import INSIDE
from mdlgen.backends.lattice.kernels.integrate import along, convex, points, points_matrix, step, tangent
from mdlgen.backends.lattice.kernels.state import (
    A_COUPLE,
    A_DAMPER,
    A_PRESSURE,
    ALONG,
    DIRECTION,
    KIND,
    MADE_FOR,
    NOW,
    OF_DIRECTION,
    RESIDUAL,
    SPRING,
    START,
    TOUGH,
    WHERE,
    Control,
    Workspace,
)
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

H, LAG = 0.05, 1e-3  # half of a step, and the numerical damping of joints [ms]

# Two notes between two rollers, one of which turns freely and slides, on a plate that slides: points of nips,
# corners of faces and plates, and a couple.
SCENE = """
name: nip
materials: {p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets:
  low: {material: p, size: [30 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [3, 2]}
  top: {material: p, size: [30 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [2, 2],
    center: [2 mm, 1 mm, 0.0996 mm], turn: 2 deg}
rollers:
  under: {center: [1 mm, 0 mm, -8.049 mm], axis: y, radius: 8 mm, width: 15 mm, mass: 8 g}
  over: {center: [1 mm, 0 mm, 6.149 mm], axis: y, radius: 6 mm, width: 15 mm, mass: 5 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 1 N}}
planes:
  plate: {center: [-10 mm, 0 mm, -1.049 mm], normal: z, size: [8 mm, 30 mm, 2 mm], mass: 3 g,
    press: {direction: z, stiffness: 0.3 N/mm, preload: 0.1 N}}
contacts:
  - {between: [low, under], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0.5, smoothing: 5 mm/s,
    rolling_resistance: 0.02}
  - {between: [top, over], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0.5, smoothing: 5 mm/s}
  - {between: [low, plate], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 5 mm/s}
  - {between: [low, top], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 5 mm/s}
run: {duration: 10 ms}
"""


class Case(NamedTuple):
    work: Workspace
    steering: Control
    counts: tuple[int, int]  # how many pairs touch, how many are near
    pressing: np.ndarray  # forces of contacts on all bodies


STICKS = "contacts.3.friction={static: 0.3, dynamic: 0.2, sticking: 50 N/mm}"


@pytest.fixture(params=[[], [STICKS]], ids=["slides", "sticks"])
def case(request: pytest.FixtureRequest) -> Case:
    """The scene as it begins, with random velocities, its contact forces evaluated. Friction of the notes is
    smoothed, or sticks."""
    model = lower(loads(SCENE, overrides=request.param))
    system = build(model)
    work = arrays(model, system)
    draw = np.random.default_rng(1)
    state, mid = work.state, work.mid
    state.u[:] = draw.normal(0.0, 2e-3, state.u.shape) * [1, 1, 1, 0.1, 0.1, 0.1]
    state.ub[:] = draw.normal(0.0, 1e-3, state.ub.shape)
    forces.place(work.tables, 0.0, 0.0, state, mid.motion)
    close = forces.near_pairs(work.tables, mid.motion, 0.05, 2 * H, mid.near)
    mid.forces[:] = 0.0
    count, _ = between.near_forces(work, close, 0.0)
    work.condensed.axes[:] = mid.motion.r
    assert count > 8
    return Case(work, control(work), (count, close), mid.forces.copy())


def in_global_axes(work: Workspace, vector: np.ndarray) -> np.ndarray:
    turned = vector.copy()
    tangent.turn_nodes(work.tables.nodes, work.condensed.axes, turned, False)
    return turned


def impulses(case: Case, change: np.ndarray, border: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the points lose, times h, where velocities change from those of the start (global axes)."""
    work = case.work
    points.gather(work, case.counts, H, False)
    work.frozen.vectors[OF_DIRECTION], work.frozen.border[DIRECTION] = change, border
    along.look_along(work, H)
    g, gb = np.zeros(change.shape), np.zeros(border.shape)
    along.pull(work, H, 1.0, g, gb)
    return g, gb


def test_all_points_go_by_the_same_part_of_a_direction(case: Case) -> None:
    """Those behind a couple of rolling resistance, too."""
    frozen, draw = case.work.frozen, np.random.default_rng(7)
    change, border = (draw.normal(0.0, 1e-3, x.shape) for x in (case.work.matrix.res, case.work.matrix.resb))
    impulses(case, change, border)
    rows = frozen.points[: int(frozen.many[0])]
    before = rows[:, NOW : NOW + 3].copy()
    g, gb = np.zeros(change.shape), np.zeros(border.shape)
    along.pull(case.work, H, 0.5, g, gb)
    couples = np.flatnonzero(rows[:, KIND] == A_COUPLE)
    assert 0 < couples.min() < len(rows) - 1
    assert rows[:, NOW : NOW + 3] - before == pytest.approx(0.5 * rows[:, ALONG : ALONG + 3], abs=1e-15)


def test_the_forces_of_the_points_are_those_of_the_laws(case: Case) -> None:
    """Added up on each box, where nothing has changed."""
    work = case.work
    points.gather(work, case.counts, H, False)
    many = int(work.frozen.many[0])
    assert {A_PRESSURE, A_DAMPER, A_COUPLE} == set(work.frozen.points[:many, KIND])
    work.frozen.points[:many, START : START + 3] = 0.0
    assert work.frozen.many[1] > 8
    work.frozen.patches["begun"] = 0.0
    along.slope(work, H, 0.0, False)
    g, gb = np.zeros(work.matrix.res.shape), np.zeros(work.matrix.resb.shape)
    along.pull(work, 1.0, 0.0, g, gb)
    expected = case.pressing[work.tables.nodes].ravel()
    # what damps in a nip is counted by its change alone
    rows = work.frozen.points[:many]
    damping = np.abs(rows[rows[:, KIND] == A_DAMPER, SPRING]).sum()
    assert -g == pytest.approx(expected, abs=1e-9 * np.abs(expected).max() + 2.0 * damping)
    assert np.abs(expected).max() > 0.1


@pytest.mark.parametrize("seed", range(3))
def test_the_matrix_of_the_points_is_what_their_forces_lose(seed: int, case: Case) -> None:
    """By differences, in random directions of all unknowns; it is symmetric."""
    work = case.work
    matrix, nodes = work.matrix, work.tables.nodes
    matrix.band[:] = matrix.border[:] = matrix.corner[:] = 0.0
    points.gather(work, case.counts, H, False)
    points_matrix.points_into(work, H, 0.0)
    size = 6 * nodes.size
    whole = np.zeros((size + matrix.resb.size,) * 2)
    for n in range(nodes.size):
        block = matrix.band[n, :, :6].T
        whole[6 * n : 6 * n + 6, 6 * n : 6 * n + 6] = block
    for k in range(int(matrix.couplings.many[0])):
        one, two = 6 * matrix.couplings.ends[k]
        whole[one : one + 6, two : two + 6] += matrix.couplings.blocks[k].T
        whole[two : two + 6, one : one + 6] += matrix.couplings.blocks[k]
    whole[size:, :size], whole[:size, size:] = matrix.border, matrix.border.T
    whole[size:, size:] = matrix.corner
    assert whole == pytest.approx(whole.T, abs=1e-12 * np.abs(whole).max())
    draw = np.random.default_rng(seed)
    way = draw.normal(0.0, 1.0, size + matrix.resb.size)
    step = 1e-7
    found = [
        np.concatenate(impulses(case, sign * step * way[:size], sign * step * way[size:]))
        for sign in (1.0, -1.0)
    ]
    slopes = (found[0] - found[1]) / (2.0 * step)
    assert slopes == pytest.approx(whole @ way, abs=2e-4 * np.abs(slopes).max())


def test_changes_make_the_function_least(case: Case) -> None:
    """Masses and bushings times the change, the residual, and what the points add come to nothing together,
    as what is left is the residual of the next change, and a factor of the first one serves all."""
    work, steering = case.work, case.steering
    matrix = work.matrix
    draw = np.random.default_rng(2)
    first, firstb = draw.normal(0, 1e-3, matrix.res.shape), draw.normal(0, 1e-3, matrix.resb.shape)
    whole, wholeb = np.zeros_like(first), np.zeros_like(firstb)
    left, leftb = first, firstb
    for _ in range(30):
        matrix.res[:], matrix.resb[:] = left, leftb
        assert convex.solve_convex(work, H, H, LAG, case.counts, 1e-9, steering, True, True) != 0
        whole, wholeb = whole - matrix.res, wholeb - matrix.resb
        g, gb = impulses(case, in_global_axes(work, whole), wholeb)
        tangent.turn_nodes(work.tables.nodes, work.condensed.axes, g, True)
        product = np.zeros_like(whole)
        convex.times(matrix.inner, matrix.offsets, whole, product)
        left, leftb = product + first + g, gb + firstb + matrix.own @ wholeb
        if (
            np.abs(left).max() < 1e-3 * np.abs(first).max()
            and np.abs(leftb).max() < 1e-3 * np.abs(firstb).max()
        ):
            break
    assert steering.factored[[MADE_FOR, WHERE]].tolist() == [2 * H, INSIDE]
    assert np.abs(left).max() < 1e-3 * np.abs(first).max()
    assert np.abs(leftb).max() < 1e-3 * np.abs(firstb).max()


@pytest.mark.parametrize("times", [0.01, 3.0, 1000.0])
def test_a_direction_is_gone_along_to_where_the_function_is_least(times: float, case: Case) -> None:
    """Along the slope itself, by so many times its length."""
    work = case.work
    matrix, frozen = work.matrix, work.frozen
    draw = np.random.default_rng(4)
    matrix.res[:], matrix.resb[:] = draw.normal(0, 1e-3, matrix.res.shape), 0.0
    for vectors in (frozen.vectors, frozen.border):
        vectors[:] = 0.0
    frozen.vectors[RESIDUAL] = matrix.res
    points.gather(work, case.counts, H, False)
    assert convex._make_matrix(work, H, LAG, True)
    frozen.vectors[DIRECTION] = -times * matrix.res
    linear, square = convex._direction(work, work.condensed.axes, H)
    begin = -times * float(matrix.res @ matrix.res)
    part = convex._how_far(work, H, begin, linear, square, tuning.SLOPE_WHOLE)
    slopes = [
        linear + at * square + along.slope(work, H, at, False) for at in (0.0, part, 0.9 * part, 1.1 * part)
    ]
    assert slopes[0] == pytest.approx(begin, rel=1e-9)
    allowed = tuning.SLOPE_WHOLE if part == 1.0 else tuning.SLOPE_FOUND
    assert (
        abs(slopes[1]) <= allowed * abs(begin)
        or slopes[2] < 0.0 < slopes[3]
        or part == 2.0**tuning.SEARCH_DOUBLED
    )
    assert slopes[2] < slopes[1] < slopes[3], "convex"


def test_a_product_with_a_band_is_that_of_the_whole_matrix() -> None:
    from mdlgen.backends.lattice.kernels.linear.band import empty
    from mdlgen.backends.lattice.kernels.linear.product import times

    draw = np.random.default_rng(3)
    nodes, reach = 5, 2
    band: Any = empty(nodes, reach)
    whole = np.zeros((6 * nodes, 6 * nodes))
    for n in range(nodes):
        for k in range(min(reach + 1, nodes - n)):
            block = draw.normal(size=(6, 6))
            block = block + block.T if k == 0 else block
            band[n, :, 6 * k : 6 * k + 6] = block.T
            whole[6 * (n + k) : 6 * (n + k) + 6, 6 * n : 6 * n + 6] = block
            whole[6 * n : 6 * n + 6, 6 * (n + k) : 6 * (n + k) + 6] = block.T
    x, y = draw.normal(size=6 * nodes), np.empty(6 * nodes)
    times(band, np.arange(reach + 1), x, y)
    assert y == pytest.approx(whole @ x, rel=1e-12)


def test_contacts_that_have_no_solution_apart_from_the_matrix_stand_in_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In the same step, which is not given up, and for some more. Sheets do not touch each other yet."""
    lifted = ["sheets.top.center=[2 mm, 1 mm, 0.12 mm]", "rollers.over.center=[1 mm, 0 mm, 6.17 mm]"]
    model = lower(loads(SCENE, overrides=lifted))
    work = arrays(model, build(model))
    steering = control(work)
    solve, calls = step.solve_contacts, []

    def fails(*args: Any) -> bool:
        calls.append(args)
        return len(calls) > 1 and solve(*args)

    monkeypatch.setattr(step, "solve_contacts", fails)
    assert step.midpoint(work, 0.0, 0.02, 1e-5, steering)
    assert len(calls) == 1
    assert steering.factored[WHERE] == INSIDE and steering.factored[TOUGH] > 0.0
    found = work.state.u.copy()
    # as with the condensed system, which has a solution here
    monkeypatch.setattr(step, "solve_contacts", solve)
    work = arrays(model, build(model))
    steering = control(work)
    assert step.midpoint(work, 0.0, 0.02, 1e-5, steering)
    assert steering.factored[WHERE] != INSIDE
    assert np.abs(work.state.u).max() > 1e-4
    assert work.state.u == pytest.approx(found, abs=2e-5)
