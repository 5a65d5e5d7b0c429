"""Two sheets in contact: the law of two boxes, the search, both solvers, the text."""

from __future__ import annotations

import numpy as np
import pytest
from laws import box_box
from papers import on_paper
from scipy.spatial.transform import Rotation
from stacks import ran, stack

import mdlgen
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.bench.oracles import impact as oracle
from mdlgen.mechanics.frame import Box, Frame, Law
from mdlgen.mechanics.point import OUT
from mdlgen.model import sheet_pairs
from mdlgen.model.lower import lower
from mdlgen.model.tables import BOX_BOX
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

SOLVERS = ["lattice", "exudyn"]
ZERO = (0.0, 0.0, 0.0)
FLAT = (0.0, 1.0, 1.0, 1.0, 1.0, 1.0)  # no damping, no friction
K = 100.0

BLOCKS = """
name: blocks
gravity: [0 m/s^2, 0 m/s^2, {gravity} m/s^2]
materials:
  solid: {{E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  low: {{material: solid, size: [60 mm, 60 mm], thickness: 10 mm, mass: 20 g, boxes: [1, 1],
         center: [0 mm, 0 mm, {low!r} mm]}}
  top: {{material: solid, size: [20 mm, 20 mm], thickness: 10 mm, mass: 10 g, boxes: [1, 1],
         center: [{x!r} mm, 0 mm, {top!r} mm], velocity: [{vx!r} m/s, 0 m/s, {vz!r} m/s]}}
planes:
  floor: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [400 mm, 400 mm, 10 mm], mass: 100 g}}
contacts:
  - {{between: [low, top], stiffness: 1000 N/mm^1.5, restitution: {restitution}, friction: {friction}}}
  - {{between: [low, floor], stiffness: 1000 N/mm^1.5, restitution: 0.2, friction: 0}}
run: {run}
"""


def blocks(
    gravity=0.0, low=100.0, top=110.02, x=0.0, vx=0.0, vz=0.0, restitution=0.5, friction=0.0, run="{}"
):
    """A block of 10 g over one of 20 g."""
    text = BLOCKS.format(**locals())
    return lower(loads(text))


def momenta(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum of all boxes at each time, (t, 3) each."""
    model, count = result.model, sum(s.count for s in result.model.sheets)
    mass, inertia = model.bodies.mass[:count], model.bodies.inertia[:count]
    x, v, w = result.position[:, :count], result.velocity[:, :count], result.spin[:, :count]
    turned = Rotation.from_quat(np.roll(result.rotation[:, :count].reshape(-1, 4), -1, axis=1))
    own = turned.inv().apply(w.reshape(-1, 3)) * np.tile(inertia, (len(x), 1))
    spun = turned.apply(own).reshape(w.shape)
    linear = np.einsum("b,tbi->ti", mass, v)
    return linear, (np.cross(x, mass[:, None] * v) + spun).sum(axis=1)


# -- the law


def pushed(
    place, turn=ZERO, half_a=(10.0, 10.0, 5.0), half_b=(10.0, 10.0, 5.0), shared=True, law=FLAT, **given
):
    """What box b (at `place`, turned) and box a (at zero) do to each other."""
    out = np.zeros(OUT)
    free = given.get("free", 15)
    rotation = tuple(Rotation.from_rotvec(turn).as_matrix().ravel())
    rates = given.get("rates", (ZERO, ZERO, ZERO, ZERO))
    eye = tuple(np.eye(3).ravel())
    a, b = Frame(ZERO, eye, *rates[:2]), Frame(place, rotation, *rates[2:])
    box_box(out, a, Box(half_a, free), b, Box(half_b, free), Law(K, shared, *law))
    return out


def test_a_box_that_lies_flat_on_another_is_pushed_with_k_z_1_5_times_its_share():
    whole = K * 0.01**1.5
    assert pushed((0.0, 0.0, 9.99))[8] == pytest.approx(whole, rel=1e-9)
    assert pushed((10.0, 0.0, 9.99))[8] == pytest.approx(0.5 * whole, rel=1e-9)
    assert pushed((10.0, 5.0, -9.99))[8] == pytest.approx(-0.375 * whole, rel=1e-9)
    # the smaller face counts, and `share: pair` does not share
    assert pushed((3.0, 0.0, 9.99), half_b=(4.0, 4.0, 5.0))[8] == pytest.approx(whole, rel=1e-9)
    assert pushed((10.0, 5.0, 9.99), shared=False)[8] == pytest.approx(whole, rel=1e-9)


@pytest.mark.parametrize("yaw", [0.0, 1e-6, 0.1, 0.7])
@pytest.mark.parametrize("x, y", [(0.0, 0.0), (4.0, -3.0), (5.7, 1.3)])
def test_boxes_side_by_side_carry_what_lies_on_them_as_one(x, y, yaw):
    total = np.zeros(OUT)
    for i in (-10.0, 10.0):
        for j in (-10.0, 10.0):
            out = pushed((x - i, y - j, 9.99), (0.0, 0.0, yaw), half_b=(5.0, 5.0, 5.0))
            total[6:12] += out[6:12]
    assert total[8] == pytest.approx(K * 0.01**1.5, rel=1e-9)
    assert total[9:11] == pytest.approx([0.0, 0.0], abs=1e-9 * total[8])


def test_two_boxes_get_opposite_forces_at_one_point_whichever_comes_first():
    rng = np.random.default_rng(7)
    law = (0.6, 1.0, 0.5, 0.01, 0.02, 0.01)
    touched = 0
    for _ in range(200):
        place, turn = rng.uniform(-12, 12, 3), rng.uniform(-1, 1, 3)
        rates = tuple(tuple(v) for v in rng.uniform(-0.02, 0.02, (4, 3)))
        out = pushed(tuple(place), tuple(turn), rates=rates, law=law)
        touched += out[12] > 0
        size = np.abs(out[:12]).max() + 1e-300
        assert np.abs(out[:3] + out[6:9]).max() <= 1e-12 * size
        assert np.abs(out[3:6] + out[9:12] + np.cross(place, out[6:9])).max() <= 1e-12 * size * 20
        assert out[14] >= 0.0, "contact never gives energy"
        swapped, eye = np.zeros(OUT), tuple(np.eye(3).ravel())
        rotation = tuple(Rotation.from_rotvec(turn).as_matrix().ravel())
        half = (10.0, 10.0, 5.0)
        box = Box(half, 15)
        a, b = Frame(tuple(place), rotation, *rates[2:]), Frame(ZERO, eye, *rates[:2])
        box_box(swapped, a, box, b, box, Law(K, True, *law))
        assert swapped[:6] == pytest.approx(out[6:12], rel=1e-9, abs=1e-9 * size)
    assert touched > 50


def test_the_force_of_two_boxes_is_the_gradient_of_their_energy():
    turn = (0.02, -0.03, 0.4)  # b owns nothing: its corner is in the face of a
    energies = [pushed((2.0, 1.0, 10.3 + d), turn)[13] for d in (-1e-5, 1e-5)]
    out = pushed((2.0, 1.0, 10.3), turn)
    assert out[12] > 0
    assert -(energies[1] - energies[0]) / 2e-5 == pytest.approx(out[8], rel=2e-3)


def test_a_side_that_a_neighbour_covers_owns_no_contact():
    beside = (19.99, 0.0, 0.0)
    assert pushed(beside)[6] == pytest.approx(K * 0.01**1.5, rel=1e-9)
    assert abs(pushed(beside, free=0)[6]) == 0.0


# -- the search


def test_the_search_finds_the_pairs_that_are_near_and_no_other():
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.kernels.contact import search
    from mdlgen.backends.lattice.search import many_searched

    model = lower(loads(stack(3, "[4, 6]"), overrides=["run.prune=false"]))
    system = build(model)
    rng = np.random.default_rng(2)
    for shift in (0.0, 9.0, 80.0):
        x = np.zeros((len(system.bodies), 3))
        x[:-1] = model.bodies.position
        x += rng.normal(0, 1.0, x.shape)
        x[24:48, 0] += shift
        assert search.look(system.pairs, system.search, x)
        spare = system.pairs[system.search.first :][: many_searched(system.search)]
        assert (spare["kind"] == BOX_BOX).all()
        found = {(int(p["a"]), int(p["b"])) for p in spare}
        own = [(0, 24), (24, 48)]
        radius = np.linalg.norm(model.bodies.half, axis=1)
        near = {
            (a, b)
            for i, j in own
            for a in range(i, i + 24)
            for b in range(j, j + 24)
            if np.linalg.norm(x[a] - x[b]) < radius[a] + radius[b] + tuning.SKIN
        }
        assert found == near
        assert len(set(spare["mark"])) == len(found) == len(spare)


def test_a_sheet_may_be_moved_by_what_moves_one_that_it_touches():
    contacts = lower(loads(stack(3, "[1, 1]"))).contacts
    names = ["note_0", "note_1", "note_2"]
    assert {k: set(v) for k, v in sheet_pairs.linked([*names, "far"], contacts).items()} == {
        **{name: set(names) for name in names},
        "far": {"far"},
    }
    still = blocks()
    thrown = blocks(vx=1.0, run="{duration: 20 ms}")
    assert still.pairs.high[0, 0] == pytest.approx(5.0)
    assert thrown.pairs.high[0, 0] == pytest.approx(2 * 20.0 + 5.0)  # low is thrown by top


# -- the solvers


@pytest.mark.parametrize("solver", SOLVERS)
def test_two_blocks_part_with_the_restitution_and_keep_their_momentum(solver):
    result = ran(blocks(vz=-1.0, run="{duration: 1 ms, print_step: 0.01 ms}"), solver)
    exact = oracle.impact(20.0 / 3.0, 1000.0, 1.0, 0.5, 1e-3)
    parting = result.velocity[-1, 1, 2] - result.velocity[-1, 0, 2]
    assert parting == pytest.approx(exact.restitution, abs=1e-3)
    assert result.statistics.max_depth[0] == pytest.approx(exact.depth, rel=1e-2)
    linear, angular = momenta(result)
    assert np.abs(linear - linear[0]).max() < 1e-12 * np.abs(linear[0]).max()
    assert np.abs(angular - angular[0]).max() < 1e-9 * np.abs(linear[0]).max()


def test_blocks_that_meet_off_centre_keep_their_angular_momentum():
    result = ran(blocks(x=25.0, vz=-1.0, vx=-0.2, friction=0.3, run="{duration: 1 ms}"), "lattice")
    assert np.abs(result.spin[-1, :2]).max() > 1e-3
    linear, angular = momenta(result)
    assert np.abs(linear - linear[0]).max() < 1e-11 * np.abs(linear[0]).max()
    # as well as the iterations of a step end: its rotation is that of the last but one
    assert np.abs(angular - angular[0]).max() < 1e-7 * np.abs(angular[0]).max()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_block_rests_on_a_block_on_a_plane(solver):
    made = blocks(
        gravity=-9.81,
        low=5.0,
        top=15.0,
        restitution=0.2,
        run="{duration: 60 ms, print_step: 1 ms, step: 0.02 ms}",
    )
    result = ran(made, solver)
    g = 9.81e-3
    upper, under = (10.0 * g / 1000.0) ** (2 / 3), (30.0 * g / 1000.0) ** (2 / 3)
    height = result.position[-1, :2, 2]
    assert 5.0 - height[0] == pytest.approx(under, rel=1e-3)
    assert 10.0 - (height[1] - height[0]) == pytest.approx(upper, rel=1e-3)
    assert result.contact_force[-1] == pytest.approx([10.0 * g, 30.0 * g], rel=1e-3)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_block_slides_on_a_free_one_until_both_are_equally_fast(solver):
    mu, v, g = 0.3, 0.3, 9.81e-3
    made = blocks(
        gravity=-9.81,
        low=5.0 - (30.0 * g / 1000.0) ** (2 / 3),
        top=15.0 - (30.0 * g / 1000.0) ** (2 / 3) - (10.0 * g / 1000.0) ** (2 / 3),
        x=-8.0,
        vx=v,
        friction=mu,
        restitution=0.2,
        run="{duration: 100 ms, print_step: 1 ms}",
    )
    result = ran(made, solver)
    # the top is slowed by mu g, the one below it driven by mu g m_top/m_low
    way = v**2 / (2 * mu * g * (1 + 10.0 / 20.0))
    slid = result.position[-1, 1, 0] - result.position[-1, 0, 0] + 8.0
    assert slid == pytest.approx(way, rel=1e-2)  # friction rises over 1 mm/s of the 300
    assert result.velocity[-1, :2, 0] == pytest.approx([v / 3, v / 3], rel=1e-3)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stack_of_notes_comes_to_rest_and_stays(solver):
    result = ran(lower(loads(stack(3, "[3, 4]"))), solver)
    boxes = slice(0, 36)
    moved = result.position[:, boxes] - result.position[0, boxes]
    assert np.abs(moved[..., :2]).max() < 1e-6, "nothing pulls it along the table [mm]"
    weight = 0.72 * 9.81e-3
    assert result.contact_force[-1] == pytest.approx([2 * weight, weight, 3 * weight], rel=1e-3)
    speed = np.linalg.norm(result.velocity[:, boxes], axis=2).max(axis=1)
    assert speed[-1] < 1e-2 * speed.max()
    assert result.energy.balance_error < 5e-3


def test_a_sheet_slides_over_a_free_one_as_a_block_does():
    made = lower(
        loads(
            on_paper("""
name: pulled
materials:
  paper: HINGED_PAPER
sheets:
  low: {material: paper, size: [67 mm, 60 mm], thickness: 0.1 mm, mass: 0.36 g, boxes: [10, 9],
        center: [0 mm, 0 mm, 0.05 mm]}
  top: {material: paper, size: [33 mm, 40 mm], thickness: 0.1 mm, mass: 0.12 g, boxes: [5, 6],
        center: [-14 mm, 0 mm, 0.15 mm], velocity: [0.3 m/s, 0 m/s, 0 m/s]}
planes:
  floor: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 300 mm, 10 mm], mass: 600 g}
contacts:
  - {between: [low, top], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0.3}
  - {between: [low, floor], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0}
run: {duration: 100 ms, print_step: 2 ms, step: 0.05 ms}
""")
        )
    )
    # the boxes of both are of different sizes, and pass over each other by more than one
    result = ran(made, "lattice")
    low, top = slice(0, 90), slice(90, 120)
    x = [result.position[:, part, 0].mean(axis=1) for part in (low, top)]
    slid = (x[1] - x[0])[-1] - (x[1] - x[0])[0]
    assert slid == pytest.approx(0.3**2 / (2 * 0.3 * 9.81e-3 * (1 + 0.12 / 0.36)), rel=2e-3)
    assert result.velocity[-1, :120, 0] == pytest.approx(np.full(120, 0.3 * 0.12 / 0.48), rel=1e-3)
    assert np.abs(result.position[:, :120, 2] - result.position[0, :120, 2]).max() < 1e-3, "it stays flat"


def test_notes_that_exactly_touch_do_not_pass_through_each_other():
    # faces without depth have no stiffness: a round of Newton's method could go to the other side
    made = lower(loads(stack(5, "[4, 6]"), overrides=["run.step=0.2 ms", "run.duration=4 ms"]))
    result = mdlgen.solve(made, "lattice")  # it may fail for its energy: the step is as long as an impact
    assert result.time[-1] == pytest.approx(4.0)
    height = result.position[:, :120, 2].reshape(len(result.time), 5, 24).mean(axis=2)
    assert np.diff(height, axis=1).min() > 0.09


# -- the text
