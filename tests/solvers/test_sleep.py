"""Sheets that sleep: when they do, that nothing else changes by it, and what wakes them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from asked import as_asked
from same import bits

from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.model.lower import lower
from mdlgen.results.io.store import hdf5
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

G = 9.81e-3  # [mm/ms^2]
NOTES, MASS = 4, 0.72  # of the pile; of each [g]
SOFT = "{stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3, smoothing: 1 mm/s}"
SCENE = f"""
name: pile
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa}}}}
sheets:
  note: {{material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: {MASS} g, boxes: [3, 4],
    center: [1 mm, 2 mm, 0.05 mm]}}
piles: {{cassette: {{of: note, count: {NOTES}, jitter: 0.3 mm, contact: {SOFT}}}}}
planes: {{floor: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm]}}}}
contacts:
  floor: {{between: ["cassette_*", floor], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0.3}}
run: {{duration: 80 ms, print_step: 1 ms, step: 0.1 ms, tolerance: 0.01}}
"""
# a sheet that falls on the pile; a heavy one on a corner of it
FALLING = (
    "sheets.late={material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [3, 4], "
    "center: [0 mm, 0 mm, 18 mm]}",
    "contacts.late={between: [cassette_4, late], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}",
    "run.duration=100 ms",
)
CORNER = (
    *FALLING,
    "contacts.late.stiffness=400 N/mm^1.5",
    "sheets.late.center=[30 mm, 50 mm, 14 mm]",
    "contacts.late_floor={between: [late, floor], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}",
)
STICKING = "piles.cassette.contact.friction={static: 0.3, dynamic: 0.3, sticking: 50 N/mm}"

Turns = list[tuple[float, tuple[str, ...]]]
Solve = Callable[..., tuple[Result, Turns]]


@pytest.fixture
def solve(monkeypatch: pytest.MonkeyPatch) -> Solve:
    """Runs the scene; when sheets fell asleep, or woke, and which slept from then on."""
    turns: Turns = []
    turn = Sleep._turn

    def noted(self: Sleep, sheets: np.ndarray, t: float, *rest: object) -> None:
        turns.append((t, tuple(np.array([s.name for s in self._model.sheets])[sheets].tolist())))
        turn(self, sheets, t, *rest)

    monkeypatch.setattr(Sleep, "_turn", noted)

    def solved(*sets: str, sleep: bool = True, step: bool = True) -> tuple[Result, Turns]:
        turns.clear()
        model = lower(loads(SCENE, "pile", [*sets, f"run.sleep={str(sleep).lower()}"]))
        # with a step of its own a run has one pass
        result = lattice.solve(model, step=model.run.step if step else None)
        assert as_asked(result), result.status
        return result, turns.copy()

    return solved


def floor_force(result: Result) -> np.ndarray:
    """Of the floor on all sheets at the stored times [N]."""
    table = result.model.contacts
    rows = [k for k, part in enumerate(table.part_b) if part == "floor" and table.part_a[k] != "late"]
    return result.contact_force[:, rows].sum(axis=1)


def apart(one: Result, two: Result) -> float:
    """How far the places of bodies are apart in two runs, at most [mm]."""
    return float(np.abs(one.position - two.position).max())


@pytest.mark.parametrize("sets", [(), (STICKING,), ("sheets.cassette_4.mass=7 g",)])
def test_a_pile_that_rests_sleeps_and_all_else_is_as_it_was(solve: Solve, sets: tuple[str, ...]) -> None:
    result, turns = solve(*sets)
    names = tuple(f"cassette_{k}" for k in range(1, NOTES + 1))
    assert turns and turns[-1][1] == names
    awake, none = solve(*sets, sleep=False)
    assert not none
    assert apart(result, awake) < 2e-5
    mass = result.model.bodies.mass
    weight = G * sum(float(mass[s.first : s.first + s.count].sum()) for s in result.model.sheets)
    assert floor_force(result)[-1] == pytest.approx(weight, rel=2e-3)
    assert abs(result.energy.balance_error) < 2e-4
    for name in ("elastic", "dissipated"):
        value = getattr(awake.energy, name)
        assert getattr(result.energy, name) == pytest.approx(value, rel=2e-3)
    assert result.steps == awake.steps


@pytest.mark.parametrize("sets", [FALLING, CORNER])
def test_what_comes_down_on_it_wakes_it(solve: Solve, sets: tuple[str, ...]) -> None:
    """In the step in which it would move a box, so that the impact is what it is without sleep."""
    result, turns = solve(*sets)
    (slept, names), (woke, none) = turns[:2]
    assert len(names) == NOTES and not none and slept < woke
    awake, _ = solve(*sets, sleep=False)
    # the first force of what comes down
    row = next(k for k, part in enumerate(result.model.contacts.part_b) if part == "late")
    for run in (result, awake):
        first = run.time[np.flatnonzero(run.contact_force[:, row] > 0.0)[0]]
        assert first - 2.0 < woke < first + 0.1
    travel = float(np.ptp(awake.position, axis=0).max())
    before = result.time < woke
    assert np.abs(result.position - awake.position)[before].max() < 1e-6
    # a sheet that bounces is sensitive: where it lands differs in the ninth digit
    assert apart(result, awake) < 0.02 * travel
    pile = [s.first for s in result.model.sheets if s.name != "late"]
    assert np.abs(result.position - awake.position)[-1, pile].max() < 1e-3 * travel
    # from 0.3 to 1 % at this step, with sleep and without, where starts differ in the sixth digit
    assert abs(result.energy.balance_error) < 0.012


@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_a_sheet_that_sleeps_in_the_air_is_struck_as_one_that_does_not(
    solve: Solve, restitution: float
) -> None:
    """Without weight: the same to round-off until it is struck, then but for where overlaps were found, which
    goes by how sheets moved before; and momentum goes over whole."""
    sets = (
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "planes.floor.center=[0 mm, 0 mm, -65 mm]",
        *("piles.cassette.count=2", "piles.cassette.jitter=0 mm", "piles.cassette.gap=3 mm"),
        f"piles.cassette.contact.restitution={restitution}",
        "sheets.cassette_2.velocity=[0 mm/s, 0 mm/s, -100 mm/s]",
        "run.duration=60 ms",
    )
    result, turns = solve(*sets)
    assert [names for _, names in turns[:2]] == [("cassette_1",), ()]
    awake, _ = solve(*sets, sleep=False)
    before = result.time < turns[1][0]
    assert before.sum() > 20
    assert float(np.abs(result.position - awake.position)[before].max()) < 1e-12
    assert apart(result, awake) < 1e-6
    speeds = [float(result.sheet_motion(k)[1][-1, 2]) for k in range(2)]
    assert sum(speeds) == pytest.approx(-0.1, rel=1e-9)
    assert speeds[0] < speeds[1]


def test_forces_go_on_while_a_pile_sleeps(solve: Solve) -> None:
    """Each sheet bears those above it; statistics count the time."""
    result, turns = solve()
    asleep = result.time > turns[-1][0]
    assert asleep.sum() > 20
    table = result.model.contacts
    for k in range(2, NOTES + 1):
        row = [set(ends) for ends in zip(table.part_a, table.part_b, strict=True)].index(
            {f"cassette_{k - 1}", f"cassette_{k}"}
        )
        above = (NOTES + 1 - k) * MASS * G
        assert result.contact_force[asleep, row] == pytest.approx(above, rel=5e-3)
        assert result.statistics.mean_force[row] == pytest.approx(above, rel=0.1)
        assert np.isnan(result.statistics.last_force_at[row])


def test_what_only_turns_back_does_not_sleep(solve: Solve) -> None:
    """A sheet that is thrown up, and is slow for a moment; one that slides by smoothed friction."""
    lean = "gravity=[0.2 m/s^2, 0 m/s^2, -9.8 m/s^2]"
    result, turns = solve(lean)
    assert not turns
    slides = (result.position[-1, :, 0] - result.position[20, :, 0])[:-1]  # the last one is the floor
    assert slides.min() > 1e-3
    up = ("sheets.cassette_4.velocity=[0 mm/s, 0 mm/s, 300 mm/s]", "run.print_step=0.1 ms")
    result, turns = solve(*up, "run.duration=60 ms")
    high = result.sheet_motion(NOTES - 1)[0][:, 2].argmax()
    assert result.time[high] == pytest.approx(0.3 / G, abs=2.0)
    assert all("cassette_4" not in names for t, names in turns if t < 50.0)


def test_a_pile_on_a_driven_roller_stays_awake(solve: Solve) -> None:
    """It rests, and the roller under it slips: the work of that goes on."""
    held = (
        "rollers.under={center: [0 mm, 0 mm, -12 mm], axis: y, radius: 12 mm, width: 200 mm, mass: 15 g, "
        "drive: {surface_speed: 1 mm/s, direction: +x}}",
        "contacts.under={between: [cassette_1, under], stiffness: 100 N/mm^1.5, friction: 0.01, "
        "smoothing: 1 mm/s}",
        "run.duration=60 ms",
    )
    result, turns = solve(*held)
    assert not turns and result.energy.driven > 0.0


def test_a_step_that_is_chosen_has_its_estimate(solve: Solve) -> None:
    """Passes fall asleep each at their own time, and agree."""
    sets = ("sheets.*.boxes=[2, 2]", "run.step=null", "run.duration=60 ms")
    result, turns = solve(*sets, step=False)
    awake, _ = solve(*sets, step=False, sleep=False)
    assert turns and result.error_estimate is not None
    assert result.error_estimate <= result.model.run.tolerance
    assert apart(result, awake) < result.model.run.tolerance * 12.7


@pytest.mark.parametrize("between", ["0.7 ms", "1.3 ms", "1.7 ms"])
def test_what_rests_does_not_tremble_while_something_falls(solve: Solve, between: str) -> None:
    """What a step may leave goes with the speed of an island, not of the scene alone; at three steps."""
    result, turns = solve(*FALLING, "run.duration=80 ms", f"run.print_step={between}")
    quiet = (result.time > 20.0) & (result.time < 55.0)
    weight = G * MASS * NOTES
    assert floor_force(result)[quiet] == pytest.approx(weight, rel=2e-3)
    assert turns and turns[0][0] < 40.0


def test_results_are_as_long_as_the_run(solve: Solve) -> None:
    """All stored times are there, and finite, with a wake in the middle of two of them."""
    result, turns = solve(*FALLING, "run.print_step=2 ms")
    assert len(turns) >= 2 and (turns[1][0] / 2.0) % 1.0 > 0.05
    assert result.time == pytest.approx(np.linspace(0.0, 100.0, len(result.time)))
    assert all(np.isfinite(a).all() for a in (result.position, result.rotation, result.velocity))
    assert bits(hdf5(result)) == bits(hdf5(solve(*FALLING, "run.print_step=2 ms")[0]))
