"""Sheets that lie in themselves: how far blocks overlap, and how a run ends, in both solvers."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.model.overlaps.fold import Folds, overlaps
from mdlgen.model.rotations import matrices
from mdlgen.spec.load import loads

SOLVERS = ["lattice", "exudyn"]
# a strip of 100 mm that a moment at its end rolls up: M = 2 pi D W/L closes it
STRIP = """
name: roll
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3530 MPa, E_cd: 3530 MPa, D_md: 0.4 N*mm, D_cd: 0.4 N*mm,
  damping: {{time: 0.5 ms}}}}}}
sheets:
  n: {{material: p, size: [100 mm, 10 mm], thickness: {thick} mm, mass: 0.1 g, boxes: [{boxes}, 1],
       layout: plate, clamp: {{edge: x_min, length: 0 mm}}}}
loads: [{{sheet: n, edge: x_max, {load}}}]
run: {{{run}}}
"""


def strip(
    turns: float, run: str = "analysis: static", boxes: int = 40, thick: float = 0.1, force: str = ""
) -> str:
    moment = -turns * 2.0 * math.pi * 0.4 * 10.0 / 100.0
    return STRIP.format(
        load=f"moment: [0 N*mm, {moment!r} N*mm, 0 N*mm]{force}", run=run, boxes=boxes, thick=thick
    )


# -- depths


def test_blocks_overlap_by_the_shortest_way_out() -> None:
    half = np.array([[2.0, 1.0, 0.05]])
    flat = np.eye(3)[None]

    def deep(gap: tuple[float, float, float], turn: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> float:
        axes = matrices(np.array([turn]))
        return float(overlaps(np.array([gap]), flat, axes, half, half)[0])

    assert deep((0.0, 0.0, 0.08)) == pytest.approx(0.02)  # face on face
    assert deep((3.9, 0.0, 0.0)) == pytest.approx(0.1)  # end to end, with the thickness the same
    assert deep((3.99, 0.0, 0.0)) == pytest.approx(0.01)
    assert deep((0.0, 0.0, 0.2)) == pytest.approx(-0.1)
    upright = (0.0, math.pi / 2, 0.0)
    assert deep((0.0, 0.0, 2.0), upright) == pytest.approx(0.05)  # an end on a face
    assert deep((0.0, 0.0, 1.0), upright) == pytest.approx(1.05)  # through it
    assert deep((0.0, 0.0, 2.3), upright) == pytest.approx(-0.25)
    # edges that cross, their faces tilted: apart by what no face tells
    assert deep((0.0, 2.2, 1.2), (math.pi / 4, 0.0, 0.0)) < 0.0


def test_what_cannot_fold_is_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    """Normals within a right angle of their mean: a strip bent by half a turn."""
    made = lower(loads(strip(0.49)))
    result = mdlgen.solve(made, "lattice")
    assert as_asked(result), result.status
    folds = Folds(made)
    monkeypatch.setattr(folds, "_meet", lambda *_: pytest.fail("it was looked at"))
    places, turns = result.position[-1], _rotations(result)
    assert folds.found(places, turns, 0.0) is None
    begun = time.perf_counter()
    for _ in range(100):
        folds.found(places, turns, 0.0)
    assert time.perf_counter() - begun < 0.1


def _rotations(result) -> np.ndarray:
    e0, e = result.rotation[-1][:, 0], result.rotation[-1][:, 1:]
    angle = 2.0 * np.arctan2(np.linalg.norm(e, axis=1), e0)
    axis = e / np.maximum(np.linalg.norm(e, axis=1), 1e-300)[:, None]
    return matrices(axis * angle[:, None]).reshape(-1, 9)


# -- runs


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("turns, meets", [(0.9, False), (1.0, False), (1.2, True)])
def test_a_strip_that_is_rolled_up_by_more_than_a_turn_lies_in_itself(
    solver: str, turns: float, meets: bool
) -> None:
    """A moment alone bends it into a circle of L/(2 pi turns), which beyond one turn is in itself."""
    result = mdlgen.solve(lower(loads(strip(turns))), solver)
    assert as_asked(result) != meets, result.status
    if meets:
        assert "sheet n lies in itself" in result.status
        names = [word.strip(",;") for word in result.status.split() if word.startswith("n_")]
        rows = sorted(int(name.split("_")[1]) for name in names[:2])
        # of 40 boxes the last fifth of a turn lies on the first one
        assert rows[0] < 0.25 * 40 and rows[1] > 0.75 * 40


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_run_ends_where_a_sheet_comes_into_itself(solver: str) -> None:
    """The same in time: a moment of two turns rolls it up, and it ends before it is through itself."""
    run = "duration: 60 ms, print_step: 0.25 ms, step: 0.05 ms, margin: 200 mm"
    result = mdlgen.solve(lower(loads(strip(1.6, run, boxes=20))), solver)
    assert not as_asked(result)
    assert "sheet n lies in itself at" in result.status and "box n_" in result.status
    assert 1.0 < result.time[-1] < 60.0


def test_the_command_ends_with_exit_code_4(tmp_path, capsys) -> None:
    from mdlgen.cli import main

    (tmp_path / "roll.yaml").write_text(strip(1.2))
    with pytest.MonkeyPatch.context() as patched, pytest.raises(SystemExit) as ended:
        patched.setattr(
            "sys.argv", ["mdlgen", "run", str(tmp_path / "roll.yaml"), "-o", str(tmp_path / "out")]
        )
        main()
    assert ended.value.code == 4
    assert "lies in itself" in capsys.readouterr().err
