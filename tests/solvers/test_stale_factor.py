"""A factor of an earlier state, with contacts that held sheets in it and have let them go since."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.lattice.integrate.work import arrays, control
from mdlgen.backends.lattice.kernels import forces, tuning
from mdlgen.backends.lattice.kernels.contact import between
from mdlgen.backends.lattice.kernels.integrate import convex, momentum, tangent
from mdlgen.backends.lattice.kernels.state import BEFORE, FACTORS, GRADIENT, Control, Workspace
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

H, LAG = 0.05, 1e-3  # half of a step, and the numerical damping of joints [ms]
LIMIT = 1e-3  # what a step may leave [mm/ms]
SLIDES = 0.05  # how fast one note is against the other [mm/ms]
ASIDE, LOW, TOP = range(3)  # sheets, by their names

SCENE = """
name: pair
materials: {p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets:
  low: {material: p, size: [40 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [4, 2]}
  top: {material: p, size: [40 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [4, 2],
    center: [2 mm, 1 mm, 0.097 mm], turn: 2 deg}
  aside: {material: p, size: [40 mm, 20 mm], thickness: 0.1 mm, mass: 1 g, boxes: [4, 2],
    center: [100 mm, 0 mm, 0 mm]}
contacts:
  - {between: [low, top], stiffness: 2000 N/mm^1.5, restitution: 0.2, friction: 0.3, smoothing: 1 mm/s}
run: {duration: 10 ms}
"""


def _see(work: Workspace) -> tuple[int, int]:
    """Evaluates contacts where the notes are. Returns how many pairs touch, how many are near."""
    mid = work.mid
    forces.place(work.tables, 0.0, 0.0, work.state, mid.motion)
    close = forces.near_pairs(work.tables, mid.motion, 0.05, 2 * H, mid.near)
    mid.forces[:] = 0.0
    count, _ = between.near_forces(work, close, 0.0)
    work.condensed.axes[:] = mid.motion.r
    return count, close


def _solve(work: Workspace, steering: Control, momenta: np.ndarray) -> np.ndarray:
    """The change of velocities (nodes, 6), global axes, for momenta (nodes, 6) that are left of a step."""
    res, nodes, axes = work.matrix.res, work.tables.nodes, work.condensed.axes
    work.free.residual[:] = res[:] = momenta.ravel()
    work.matrix.resb[:] = 0.0
    tangent.turn_nodes(nodes, axes, res, True)
    counts = _see(work)
    assert counts[0] > 4
    assert convex.solve_convex(work, H, H, LAG, counts, LIMIT, steering, True, False) > 0
    change = res.copy()
    tangent.turn_nodes(nodes, axes, change, False)
    return change.reshape(-1, 6)


@pytest.fixture
def lifted() -> tuple[Workspace, Control]:
    """Two notes with the factor of when they were pressed into each other by 3 um; by now it is 0.02 um."""
    model = lower(loads(SCENE))
    work = arrays(model, build(model))
    steering = control(work)
    _solve(work, steering, 0.1 * LIMIT * _mass(work)[:, None] * np.eye(6)[2])
    assert steering.counters[FACTORS] == 1
    top = work.tables.nodes[work.free.label == TOP]
    work.state.x[top, 2] += 0.003 - 2e-5
    return work, steering


def _mass(work: Workspace) -> np.ndarray:
    return work.tables.bodies["mass"][work.tables.nodes]


def _momenta(work: Workspace) -> np.ndarray:
    """One note slides on the other. A note that touches nothing moves too, which any factor knows, and which
    is most of what there is to gain."""
    label, velocities = work.free.label, np.zeros((len(work.free.label), 6))
    velocities[:, 0] = np.array([0.0, -SLIDES, SLIDES])[label]
    velocities[:, 2] = np.where(label == ASIDE, 8.0 * LIMIT, 0.0)
    return _mass(work)[:, None] * velocities


def _slid(work: Workspace, change: np.ndarray) -> float:
    """How much of the sliding a change takes off."""
    label = work.free.label
    return float(change[label == TOP, 0].mean() - change[label == LOW, 0].mean()) / (2.0 * SLIDES)


def test_what_contacts_have_let_go_moves(lifted: tuple[Workspace, Control]) -> None:
    """By its momentum: hardly any friction is left to hold it."""
    work, steering = lifted
    change = _solve(work, steering, _momenta(work))
    assert _slid(work, change) == pytest.approx(1.0, abs=0.02)
    assert steering.counters[FACTORS] > 1


def test_an_old_factor_alone_would_hold_it(
    lifted: tuple[Workspace, Control], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The change is little, gone along wholly, and wrong."""
    monkeypatch.setattr(convex, "CURED", np.inf)
    work, steering = lifted
    change = _solve(work, steering, _momenta(work))
    assert np.abs(change[:, :3]).max() < tuning.FIRST_DIRECTION * LIMIT
    assert _slid(work, change) < 0.2
    assert steering.counters[FACTORS] == 1


@pytest.mark.parametrize(("left", "cured"), [(0.4, True), (0.9, False)])
def test_each_sheet_counts_by_itself(
    left: float, cured: bool, lifted: tuple[Workspace, Control], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside one that had more momentum, and has lost it."""
    work, _ = lifted
    nodes, axes, label = work.tables.nodes, work.condensed.axes, work.free.label
    velocities = np.zeros((len(label), 6))
    velocities[:, 0] = np.array([1.0, 0.02, 0.02])[label]
    before = _mass(work)[:, None] * velocities
    after = before * np.array([0.0, left, 0.1])[label][:, None]

    def leaves(*_: object) -> None:
        work.frozen.vectors[GRADIENT] = after.ravel()
        tangent.turn_nodes(nodes, axes, work.frozen.vectors[GRADIENT], True)

    monkeypatch.setattr(convex, "_gradient", leaves)
    momentum.let_go(work, before.ravel(), np.zeros(0), work.free.lets[BEFORE])
    assert convex._cured(work, H, axes, 1.0, tuning.FIRST_DIRECTION * LIMIT) is cured


@pytest.mark.parametrize("sheet", [LOW, TOP])
def test_what_would_move_by_its_momentum_were_it_free(sheet: int, lifted: tuple[Workspace, Control]) -> None:
    """Along any way, and about any axis by a moment that has no sum; the strictest sheet counts."""
    work, _ = lifted
    mass, own = _mass(work), np.flatnonzero(work.free.label == sheet)
    draw = np.random.default_rng(3)
    drift, pull = draw.normal(size=3), draw.normal(size=3)
    moves, turns = np.zeros((2, len(mass), 6))
    moves[own, :3] = mass[own, None] * drift
    turns[own[[0, -1]], :3] = [pull, -pull]
    none, into = np.zeros(0), np.zeros(3)
    found = momentum.let_go(work, moves.ravel(), none, into)
    assert found == into[sheet] == pytest.approx(np.linalg.norm(drift), rel=1e-9)
    x = work.mid.motion.x[work.tables.nodes[own]]
    arm = x - x.mean(axis=0)
    about = work.tables.bodies["inertia"][work.tables.nodes[own]]
    inertia = (mass[own] * (arm**2).sum(axis=1)).sum() + 0.5 * about.sum()
    moment = np.linalg.norm(np.cross(arm[0] - arm[-1], pull))
    turn = moment / np.sqrt(inertia * mass[own].sum())
    found = momentum.let_go(work, turns.ravel(), none, into)
    assert found == into[sheet] == pytest.approx(float(turn), rel=1e-9)
    assert np.delete(into, sheet) == pytest.approx(0.0, abs=1e-12)
    work.islands.strict[sheet] = 3.0
    assert momentum.let_go(work, turns.ravel(), none, into) == pytest.approx(3.0 * found, rel=1e-9)


def test_a_sheet_of_one_box_would_turn_by_its_own_inertia() -> None:
    model = lower(loads(SCENE, overrides=["sheets.aside.boxes=[1, 1]"]))
    work = arrays(model, build(model))
    row = int(np.flatnonzero(work.free.label == ASIDE)[0])
    turns, into = np.zeros((len(work.free.label), 6)), np.zeros(3)
    turns[row, 3:] = [0.0, 0.0, 2e-3]  # [N mm ms]
    mass, a, b, c = 1.0, 40.0, 20.0, 0.1  # [N ms^2/mm, mm], the first of which is a gram
    inertia = mass * (a**2 + b**2 + c**2) / 12  # of a plate, by distances from its centre
    found = momentum.let_go(work, turns.ravel(), np.zeros(0), into)
    assert found == into[ASIDE] == pytest.approx(2e-3 / np.sqrt(inertia * mass), rel=1e-9)
