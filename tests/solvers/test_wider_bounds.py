"""Runs in which a body leaves the bounds of its pairs: they continue with a wider margin."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from asked import as_asked
from cutting import Cut, Cutting, written_with
from same import bits

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.model.wider import wider, with_margin
from mdlgen.report.text import summary_text
from mdlgen.results.io.store import hdf5
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

# A load pushes a block against a wall, of which the bounds of its speeds know nothing.
PUSHED = """
name: pushed
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {steel: {E_md: 200 GPa, E_cd: 200 GPa}}
sheets:
  block: {material: steel, size: [10 mm, 8 mm], thickness: 2 mm, mass: 1 g, boxes: [1, 1]}
planes:
  wall: {center: [30 mm, 0 mm, 0 mm], normal: -x, size: [40 mm, 40 mm, 10 mm]}
  floor: {center: [0 mm, 0 mm, -40 mm], normal: z, size: [40 mm, 40 mm, 10 mm]}
loads: [{sheet: block, edge: x_min, force: [0.02 N, 0 N, 0 N]}]
contacts: [{between: [block, "*"], stiffness: 30 N/mm^1.5, friction: 0.2, restitution: 0.5}]
run: {duration: 60 ms, margin: 1 mm}
"""
# Two moments roll a sheet up between two rollers, left and right of the plane of its symmetry.
ROLLED = """
name: rolled
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.9 N*mm, D_cd: 0.4 N*mm}}
sheets:
  note: {material: paper, size: [20 mm, 48 mm], thickness: THICK mm, mass: 0.15 g, boxes: [1, 16]}
rollers:
  port: {center: [0 mm, -6 mm, -6 mm], axis: x, radius: 5 mm, width: 10 mm, mass: 1 g}
  starboard: {center: [0 mm, 6 mm, -6 mm], axis: x, radius: 5 mm, width: 10 mm, mass: 1 g}
loads:
  - {sheet: note, edge: y_max, moment: [3 N*mm, 0 N*mm, 0 N*mm]}
  - {sheet: note, edge: y_min, moment: [-3 N*mm, 0 N*mm, 0 N*mm]}
contacts: [{between: [note, "*"], stiffness: 300 N/mm^1.5, friction: 0.3, smoothing: 10 mm/s}]
run: {duration: 1.2 ms, step: 0.01 ms, print_step: 0.1 ms, margin: 0.1 mm}
"""
# The same block next to a pile that sleeps when it leaves its bounds; a note falls on the pile later.
PILE = """
name: pile
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa}, steel: {E_md: 200 GPa, E_cd: 200 GPa}}
sheets:
  note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [3, 4],
    center: [0 mm, 0 mm, 0.05 mm]}
  late: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [3, 4],
    center: [0 mm, 0 mm, 8 mm]}
  block: {material: steel, size: [10 mm, 8 mm], thickness: 2 mm, mass: 1 g, boxes: [1, 1],
    center: [60 mm, 0 mm, 1 mm]}
piles:
  deck: {of: note, count: 3, contact: {stiffness: 100 N/mm^1.5, restitution: 0.5, friction: FRICTION}}
planes:
  floor: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 200 mm, 10 mm]}
  wall: {center: [100 mm, 0 mm, 0 mm], normal: -x, size: [40 mm, 40 mm, 10 mm]}
loads: [{sheet: block, edge: x_min, force: [0.04 N, 0 N, 0 N]}]
contacts:
  - {between: [["deck_*", block], floor], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0.3}
  - {between: [late, floor], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0.3}
  - {between: [deck_3, late], stiffness: 100 N/mm^1.5, restitution: 0.5, friction: 0.3}
  - {between: [block, wall], stiffness: 100 N/mm^1.5, restitution: 0.2, friction: 0.3}
run: {duration: 60 ms, print_step: 1 ms, step: 0.1 ms, tolerance: 0.01, margin: 1 mm}
"""
SCENES = {
    "pushed": PUSHED,
    "rolled": ROLLED.replace("THICK", "0.1"),
    "pile": PILE.replace("FRICTION", "0.3"),
    "sticking": PILE.replace("FRICTION", "{static: 0.3, dynamic: 0.3, sticking: 50 N/mm}"),
    # sheets stick on planes, too, and none of them sleeps
    "bristles": PILE.replace("FRICTION", "0.3").replace(
        "friction: 0.3}", "friction: {static: 0.3, dynamic: 0.3, sticking: 50 N/mm}}"
    ),
    "air": PILE.replace("friction: FRICTION", "friction: 0.3, air: {viscosity: 18.2 uPa*s}"),
}


@pytest.fixture
def widened(monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, bool]]:
    """Margins that passes took up, and whether a sheet slept then."""
    found: list[tuple[float, bool]] = []
    widen = Sleep._widen

    def noted(self: Sleep, model: mdlgen.Model, *rest: object) -> None:
        found.append((model.pairs.margin, bool(self._sheets.any())))
        widen(self, model, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(Sleep, "_widen", noted)
    return found


def solved(name: str, *sets: str, solver: str = "lattice") -> Result:
    return mdlgen.solve(mdlgen.lower(loads(SCENES[name], name, sets)), solver)


@pytest.mark.parametrize("name", SCENES)
def test_a_run_that_widens_its_margin_is_that_with_all_pairs(
    name: str, widened: list[tuple[float, bool]]
) -> None:
    narrow = solved(name)
    assert widened and as_asked(narrow), narrow.status
    assert any(asleep for _, asleep in widened) == (name in ("pile", "sticking"))
    assert narrow.model.pairs.margin == max(margin for margin, _ in widened)
    widened.clear()
    every = solved(name, "run.prune=false")
    assert not widened
    for what in ("position", "rotation", "velocity", "contact_force", "contact_torque"):
        np.testing.assert_array_equal(getattr(narrow, what), getattr(every, what), what)
    assert (narrow.touched, narrow.steps, narrow.energy) == (every.touched, every.steps, every.energy)
    assert narrow.halved == every.halved == (name == "rolled")
    if name != "rolled":  # it has come to the wall, which the first margin leaves out
        assert "wall" in narrow.model.contacts.part_b
        row = narrow.model.contacts.part_b.index("wall")
        assert narrow.statistics.max_force[row] > 0.1


@pytest.mark.parametrize("threads", [1, 2])
def test_a_step_that_is_searched(threads: int) -> None:
    """Each pass widens by itself, one at a time or two."""
    found = lattice.solve(mdlgen.lower(loads(SCENES["pushed"])), threads=threads)
    every = solved("pushed", "run.prune=false")
    assert found.ok and found.model.pairs.margin > 1.0
    assert found.error_estimate == every.error_estimate
    np.testing.assert_array_equal(found.position, every.position)


@pytest.mark.parametrize("name", ["pushed", "rolled", "sticking", "bristles"])
def test_a_run_that_was_cut_off_goes_on_with_the_margin_that_it_had(name: str, tmp_path: Path) -> None:
    model = mdlgen.lower(loads(SCENES[name], name))
    whole = lattice.solve(model)
    provenance: Callable[[], dict[str, str]] | None = written_with
    cuts = 0
    while True:
        try:
            result = lattice.solve(model, keep=Cutting(tmp_path / "c", provenance, 8 + 5 * cuts**2, most=2))
            break
        except Cut:
            cuts += 1
            provenance = None
    assert cuts >= 2
    assert bits(hdf5(result)) == bits(hdf5(whole))
    assert (result.steps, result.touched) == (whole.steps, whole.touched)


def test_a_part_of_a_run_counts_its_own_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """What was a part before a margin was widened has the pairs of then."""
    from mdlgen.runs.checkpoint import Checkpointer

    parts = []
    widen = Sleep._widen
    keep = Checkpointer()

    def noted(self: Sleep, *rest: object) -> None:
        before = keep.part
        widen(self, *rest)  # type: ignore[arg-type]
        if before is not None:
            parts.append((self._model, before()))

    monkeypatch.setattr(Sleep, "_widen", noted)
    lattice.solve(mdlgen.lower(loads(SCENES["rolled"])), step=0.01, keep=keep)
    assert parts
    assert all(part.model.pairs.margin < after.pairs.margin for after, part in parts)


def test_halves_that_reach_parts_of_the_other_side_begin_again_whole(
    widened: list[tuple[float, bool]],
) -> None:
    """A thick sheet may meet rollers that keep off the plane by 0.5 mm, once it has come so far."""
    SCENES["thick"] = ROLLED.replace("THICK", "1.2").replace("width: 10 mm", "width: 11 mm")
    try:
        narrow, every = (solved("thick", f"run.prune={rule}") for rule in ("true", "false"))
    finally:
        del SCENES["thick"]
    assert widened
    assert not narrow.halved and not every.halved
    np.testing.assert_array_equal(narrow.position, every.position)


def test_a_body_that_goes_on_without_end_leaves_its_bounds_a_few_times(
    widened: list[tuple[float, bool]],
) -> None:
    """Bounds end where there is no further pair to choose."""
    result = solved("pushed", "run.duration=2 s", "loads.0.force=[-0.02 N, 0 N, 0 N]", "run.step=1 ms")
    assert result.ok and result.position[-1, 0, 0] < -1e4, result.status
    assert 0 < len(widened) <= 2 * 8  # of a run, and the one at twice its step
    pairs = result.model.pairs
    assert len(pairs) == pairs.possible and np.isinf(pairs.low).all()


def test_a_margin_is_widened_to_what_holds_all_bodies() -> None:
    model = mdlgen.lower(loads(SCENES["pushed"]))
    place = model.bodies.position.copy()
    assert wider(model, place) is model
    place[0] = [-70.0, 0.0, 0.0]
    found = wider(model, place)
    assert found is not None and (found.pairs.low[0] <= place[0]).all()
    assert found.pairs.margin == 64.0 or len(found.pairs) == found.pairs.possible
    assert len(with_margin(model, 8.0).pairs) == 0 < len(with_margin(model, 24.0).pairs)


def test_the_margin_is_reported() -> None:
    summary = solved("pushed").summary()
    assert summary["pairs"]["margin_given_mm"] == 1.0
    wide = summary["pairs"]["margin_mm"]
    assert wide > 1.0
    assert f"run.margin 1 mm; the run continued with {wide:g} mm" in summary_text(summary)
    assert f"--set run.margin={wide:g}mm" in summary_text(summary)
    short = solved("pushed", "run.duration=5 ms").summary()
    assert short["pairs"]["margin_mm"] == 1.0
    assert "left the bounds" not in summary_text(short)


@pytest.mark.parametrize("sets", [(), ("run.step=0.02 ms",)])
def test_exudyn_begins_again_with_a_wider_margin(sets: tuple[str, ...]) -> None:
    narrow = solved("pushed", *sets, solver="exudyn")
    assert narrow.ok, narrow.status
    assert narrow.model.pairs.margin > 1.0
    every = solved("pushed", "run.prune=false", *sets, solver="exudyn")
    np.testing.assert_allclose(narrow.position, every.position, rtol=0, atol=1e-9)
    assert narrow.statistics.max_force[narrow.model.contacts.part_b.index("wall")] > 0.1
