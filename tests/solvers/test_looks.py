"""What is stored changes nothing: a pass looks at its sheets and parts after steps of its own."""

from __future__ import annotations

import numpy as np
import pytest
from test_sleep import FALLING, SCENE
from test_symmetry import ROLLED

from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate.looks import Looks
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.kernels.tuning import LOOKS
from mdlgen.model.lower import lower
from mdlgen.results.result import Result
from mdlgen.spec.load import loads


def solved(text: str, print_step: float, *sets: str) -> Result:
    asked = [*sets, f"run.print_step={print_step} ms"]
    return lattice.solve(lower(loads(text, overrides=asked)), step=0.1 if text is SCENE else 0.01)


@pytest.mark.parametrize("sets", [(), FALLING])
def test_when_sheets_sleep_does_not_depend_on_what_is_stored(
    sets: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A pile falls asleep, and wakes in the middle of a step where a sheet falls on it."""
    turns: list[tuple[float, list[bool]]] = []
    turn = Sleep._turn

    def noted(self: Sleep, sheets: np.ndarray, t: float, *rest: object) -> None:
        turns.append((t, sheets.tolist()))
        turn(self, sheets, t, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(Sleep, "_turn", noted)
    found = []
    for print_step in (0.5, 1.0, 10.0):
        turns.clear()
        found.append((solved(SCENE, print_step, *sets), tuple(map(str, turns))))
    (first, slept), *others = found
    assert slept
    for other, same in others:
        assert same == slept
        assert (other.steps, other.iterations, other.step) == (first.steps, first.iterations, first.step)
        shared = np.searchsorted(first.time, other.time)
        np.testing.assert_allclose(first.time[shared], other.time, rtol=1e-15)
        for what in ("position", "rotation", "velocity"):
            np.testing.assert_array_equal(getattr(first, what)[shared], getattr(other, what), what)


def test_a_half_that_passes_its_plane_is_found_between_stored_states() -> None:
    """The state in which it is found is stored with those that were asked for."""
    often, seldom = (solved(ROLLED, print_step) for print_step in (0.1, 1.5))
    assert "has passed the plane of the scene's symmetry" in often.status
    assert seldom.status == often.status
    assert seldom.time[-1] == pytest.approx(often.time[-1], abs=1e-12)
    np.testing.assert_array_equal(seldom.position[-1], often.position[-1])


@pytest.mark.parametrize("outputs", [1, 7, 199, 200, 201, 1000])
@pytest.mark.parametrize("each", [1, 3, 40])
def test_a_pass_looks_at_most_so_often_and_at_its_end(outputs: int, each: int) -> None:
    looks, steps = Looks(80.0, outputs, each), outputs * each
    stops = [stop for output in range(outputs) for stop in looks.stops(output)]
    assert stops == sorted(set(stops)) and stops[-1] == steps
    assert {(output + 1) * each for output in range(outputs)} <= set(stops)
    due = [step for step in range(1, steps + 1) if looks.due(step)]
    assert set(due) <= set(stops) and due[-1] == steps
    assert min(steps, LOOKS) / 2 <= len(due) <= LOOKS + 1
    assert [looks.time(step) for step in due] == pytest.approx(
        [80.0 * step / steps for step in due], rel=1e-14
    )
    if steps % LOOKS == 0:  # as many as states by default, at their times
        every = steps // LOOKS
        assert [looks.time(step) for step in due] == [(k + 1) * 80.0 / LOOKS for k in range(LOOKS)]
        assert due == [every * (k + 1) for k in range(LOOKS)]


def test_the_rest_of_a_step_is_the_same_wherever_a_pass_stops() -> None:
    """Of a step of 0.1 ms, begun and left in its middle, where it stops after the next or looks later on."""
    size = 80.0 / 800
    seldom, often = Looks(80.0, 20, 40), Looks(80.0, 800, 1)
    t = 400 * size + 0.3 * size
    whole, part = seldom.left(404, t, size), often.left(402, t, size)
    assert len(whole) == 4 and len(part) == 2
    assert whole[:2].tolist() == part.tolist()
    assert whole[0] == pytest.approx(0.7 * size) and whole[1] == size
    assert len(often.left(401, 401 * size, size)) == 0
