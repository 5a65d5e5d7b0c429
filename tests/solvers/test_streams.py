"""Sheets that come in and leave in a run: closed forms, shifts in time, energy, resumed runs, two solvers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from asked import as_asked
from cutting import Cut, Cutting, written_with
from papers import on_paper
from same import bits

import mdlgen
from mdlgen.backends.lattice import run as lattice
from mdlgen.backends.lattice.integrate import record
from mdlgen.backends.lattice.integrate.limit import Calls
from mdlgen.backends.lattice.integrate.passes import UNSEEN, _Pass, division
from mdlgen.backends.lattice.integrate.states import States
from mdlgen.backends.lattice.integrate.there import There
from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model
from mdlgen.report import boxes
from mdlgen.report.animation import animation
from mdlgen.results.io.store import hdf5, load
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

G = 9.81e-3  # mm/ms^2
# blocks that are thrown, and leave as they have fallen by 10 mm
THROWN = on_paper("""
name: thrown
materials: {paper: HINGED_PAPER}
sheets:
  block: {material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    velocity: [1 m/s, 0 m/s, 0 m/s]}
streams: {shot: {of: block, times: [0 ms, 30.013 ms, 61 ms], out: beyond z = -10 mm}}
run: {duration: 120 ms, step: 0.1 ms, print_step: 2 ms}
""")
# two fixed rollers, both driven, with notes that come in before them: nothing of a note stays in the machine
DRAWN = on_paper("""
name: drawn
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [24 mm, 40 mm], thickness: 0.1 mm, mass: 0.15 g, boxes: [6, 4],
    center: [-13 mm, 0 mm, 0 mm], velocity: [900 mm/s, 0 mm/s, 0 mm/s]}
streams: {infeed: {of: note, every: 40 ms, count: 3, out: beyond x = 6 mm}}
rollers:
  lower: {center: [0 mm, 0 mm, -5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 1 g,
    drive: {speed: 200 rad/s}}
  upper: {center: [0 mm, 0 mm, 5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 1 g,
    drive: {speed: -200 rad/s}}
contacts:
  - {between: [infeed, "*er"], stiffness: 100 N/mm^1.5, restitution: 0.4, friction: 0.4, smoothing: 20 mm/s}
run: {duration: 125 ms, step: 0.1 ms, print_step: 1 ms, tolerance: 0.01}
""")


def model(text: str, *sets: str) -> Model:
    return mdlgen.lower(loads(text, "streams", list(sets)))


def falls(by: float) -> float:
    """How long a fall takes [ms]."""
    return math.sqrt(2.0 * by / G)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_blocks_come_in_and_leave_at_their_times(solver: str) -> None:
    result = mdlgen.solve(model(THROWN), solver)
    assert as_asked(result), result.status
    assert result.stays is not None
    enters = [0.0, 30.013, 61.0]
    assert result.stays[:, 0].tolist() == enters
    # all of the block is beyond -10 mm as its upper face is
    fast = G * falls(10.5)
    # a hundredth of the tolerance of a place, and what the last step does not know of the acceleration
    near = (0.01 * 1e-3 * 2.0 + 0.5 * G * 0.1**2) / fast
    assert np.allclose(result.stays[:, 1], np.array(enters) + falls(10.5), rtol=0.0, atol=near)
    for k, begun in enumerate(enters):
        at = result.time - begun
        here = (at > 0.0) & (at < falls(10.5))
        place = np.stack([at, 0.0 * at, -0.5 * G * at**2], axis=1)[here]
        # the mid-point rule is exact for a constant acceleration; times of stored states are round
        assert np.abs(result.position[here, k] - place).max() < 1e-9
        gone = at >= falls(10.5)
        assert np.ptp(result.position[gone, k], axis=0).max() == 0.0


def test_a_note_of_a_stream_goes_as_a_single_one() -> None:
    result = mdlgen.solve(model(DRAWN), "lattice")
    alone = mdlgen.solve(model(DRAWN, "streams.infeed.count=1", "run.duration=45 ms"), "lattice")
    assert as_asked(result) and as_asked(alone), (result.status, alone.status)
    one, k = alone.model.sheets[0], result.model.sheets[2]
    late = np.flatnonzero(result.time >= 80.0 - 1e-9)
    moved = result.position[late[:45], k.first : k.first + k.count] - alone.position[:45, : one.count]
    # in the norm of run.tolerance, of which both may have as much
    assert np.sqrt(np.mean((moved**2).sum(axis=2))) < 0.01 * 31.0
    stay = np.diff(result.stays, axis=1).ravel()
    assert np.ptp(stay) < 0.1 and abs(stay[2] - np.diff(alone.stays).item()) < 0.1


def test_what_comes_in_and_leaves_is_booked() -> None:
    result = mdlgen.solve(model(THROWN), "lattice")
    kinetic, energy = 0.5 * 1.0 * 1.0**2, result.energy  # g (mm/ms)^2, N mm
    assert energy.entered == pytest.approx(2.0 * 1e-3 * kinetic * 1e3, rel=1e-12)
    # three have left, with the kinetic energy of the fall and less potential energy
    assert energy.left == pytest.approx(3.0 * kinetic, rel=1e-9)
    assert abs(energy.balance_error) < 1e-9
    assert energy.kinetic == 0.0


def test_the_place_is_taken() -> None:
    """In 5 ms it has moved by a quarter of its length, and fallen by an eighth of its thickness."""
    result = mdlgen.solve(model(THROWN, "streams.shot.times=[0 ms, 5 ms]", "run.duration=20 ms"), "lattice")
    assert not result.usable
    assert result.status.startswith("sheet shot_2 comes in at 5 ms where sheet shot_1 still is")
    assert result.time[-1] == 4.0  # of the last stored state


def test_what_rests_leaves() -> None:
    text = on_paper("""
name: tray
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 0.52 mm], out: [at rest, beyond z = -50 mm]}
planes: {tray: {center: [0 mm, 0 mm, -1 mm], normal: z, size: [60 mm, 60 mm, 2 mm], mass: 10 g}}
contacts:
  - {between: [note, tray], stiffness: 100 N/mm^1.5, restitution: 0.1, friction: 0.5, smoothing: 10 mm/s}
run: {duration: 100 ms, step: 0.1 ms}
""")
    result = mdlgen.solve(model(text), "lattice")
    assert as_asked(result), result.status
    left = float(result.stays[0, 1])
    assert 5.0 < left < 60.0
    assert [(e["kind"], e["sheet"]) for e in result.events if e["kind"] == "left"] == [("left", "note")]
    assert result.contact_force[result.time > left].max() == 0.0
    assert result.summary()["sheets"]["note"]["left_ms"] == left


def test_a_sheet_that_leaves_in_front_of_a_sensor_clears_it() -> None:
    """Not the next one, which is 20 mm away then."""
    eye = "sensors={eye: {beam: [[46 mm, 0 mm, 5 mm], [46 mm, 0 mm, -15 mm]]}}"
    result = mdlgen.solve(model(THROWN, eye, "run.duration=60 ms"), "lattice")
    seen = [(row["kind"], row["sheet"]) for row in result.reactions]
    assert seen == [("covered", "shot_1"), ("cleared", "shot_1")]
    # it looks a thousandth of a step later
    assert result.reactions[1]["time_ms"] == pytest.approx(float(result.stays[0, 1]), abs=2e-4)


def test_a_rule_lets_sheets_in() -> None:
    shot = "streams={shot: {of: block, by_rule: true, count: 2, out: beyond z = -10 mm}}"
    made = model(THROWN, shot, "run.duration=60 ms")
    assert np.isnan([sheet.enters for sheet in made.sheets]).all()
    going = _Pass(made, lattice.build(made), division(made, 0.1), UNSEEN, math.inf)
    going.steer(0.0, 0.0, False)
    going.passing.enter(1, 7.03)
    going.go()
    result = going.result()
    assert result.stays[1].tolist() == pytest.approx([7.03, 7.03 + falls(10.5)], abs=2e-4)
    assert np.isnan(result.stays[0]).all()
    assert np.array_equal(result.position[-1, 0], made.bodies.position[0])


def test_steps_have_the_bodies_that_are_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """And is stored; a result is the same with all of them, and with calls of compiled code of any length."""
    made = model(
        DRAWN, "streams.infeed.count=2", "run.duration=70 ms", "run.step=0.5 ms", "run.tolerance=0.1"
    )
    going = _Pass(made, lattice.build(made), division(made, 0.1), UNSEEN, math.inf)
    assert len(going.passing._sleep.work.state.x) == 24 + 2 + 1  # a note, rollers, the ground
    result = lattice.solve(made)
    monkeypatch.setattr(Calls, "took", lambda self, many, seconds: setattr(self, "many", 3))
    monkeypatch.setattr(There, "of", classmethod(lambda cls, gone: cls()))
    monkeypatch.setattr(record, "StatesThere", lambda model, mirror: States(model, mirror, 1))
    again = lattice.solve(made)
    for name in ("position", "rotation", "velocity", "spin", "contact_force", "stays"):
        assert np.array_equal(getattr(result, name), getattr(again, name), equal_nan=True), name
    assert result.energy == again.energy


def test_loads_over_time_are_those_of_sheets_that_are_there() -> None:
    """A block that comes in at 20 ms is pushed by t/30 ms of 1 mN up to 30 ms, then by all of it; the load of
    another one ends as that leaves."""
    text = (
        THROWN.split("streams:")[0]
        + """\
  late: {material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 60 mm, 0 mm], enters: 20 ms}
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
loads:
- {sheet: late, edge: x_min, force: [1 mN, 0 N, 0 N], profile: [[0 ms, 0], [30 ms, 1]]}
- {sheet: block, edge: x_min, force: [1 mN, 0 N, 0 N], profile: [[0 ms, 1], [30 ms, 1]]}
run: {duration: 60 ms, step: 0.1 ms}
"""
    )
    result = mdlgen.solve(model(text, "sheets.block.out=beyond x = 3 mm"), "lattice")
    speed = 1e-3 * (30.0**2 - 20.0**2) / 60.0  # N/g is mm/ms^2
    way = 1e-3 * ((30.0**3 - 20.0**3) / 180.0 - 20.0**2 / 60.0 * 10.0) + speed * 30.0 + 0.5e-3 * 30.0**2
    late = next(sheet for sheet in result.model.sheets if sheet.name == "late")
    # the rule is exact where a force is linear over a step
    assert result.position[-1, late.first, 0] == pytest.approx(way, abs=1e-6)


def test_halved_streams(monkeypatch: pytest.MonkeyPatch) -> None:
    """One side of a symmetric scene, and both, which run.symmetry asks for."""
    one = mdlgen.solve(model(DRAWN, "run.duration=60 ms"), "lattice")
    both = mdlgen.solve(model(DRAWN, "run.duration=60 ms", "run.symmetry=false"), "lattice")
    assert one.halved and not both.halved
    # iterations end within a tenth of the tolerance
    assert np.abs(one.position[-1] - both.position[-1]).max() < 0.01
    assert one.stays == pytest.approx(both.stays, abs=1e-3, nan_ok=True)
    assert one.energy.left == pytest.approx(both.energy.left, rel=1e-3)


@pytest.mark.parametrize("text", [THROWN, DRAWN])
def test_a_stream_goes_on_to_the_same_bits(text: str, tmp_path: Path) -> None:
    made = model(text, "run.print_step=5 ms", "run.step=0.5 ms", "run.duration=60 ms", "run.tolerance=0.1")
    whole, cuts = lattice.solve(made), 0
    provenance = written_with
    while True:
        try:
            result = lattice.solve(
                made, keep=Cutting(tmp_path / "c", provenance, 4 + 5 * cuts, most=2), threads=1
            )
            break
        except Cut:
            cuts, provenance = cuts + 1, None
    assert cuts >= 2
    assert bits(hdf5(result)) == bits(hdf5(whole))
    assert result.energy == whole.energy
    assert np.array_equal(result.stays, whole.stays, equal_nan=True)


def test_the_file_has_when_sheets_are_there(tmp_path: Path) -> None:
    result: Result = mdlgen.solve(model(THROWN), "lattice")
    result.save(tmp_path)
    again = load(tmp_path)
    assert np.array_equal(again.stays, result.stays) and again.energy == result.energy
    assert again.model.sheets[1].out == ((2, -10.0, -1.0),)


def test_requirements_are_of_sheets_while_they_are_there() -> None:
    asked = "speed above 990 mm/s throughout, left below 115 ms, no jam, sheets.shot_2.speed above 1 m/s"
    result = mdlgen.solve(model(THROWN, f"require=[{asked}]"), "lattice")
    assert [o.passed for o in result.verdict] == [True] * 4, [str(o) for o in result.verdict]
    missed = mdlgen.solve(model(THROWN, "require=[left below 100 ms]"), "lattice").verdict[0]
    assert not missed.passed and missed.of == "shot_3"


def test_sheets_are_drawn_while_they_are_there() -> None:
    """On the page by times, in a still by what is there; before a run the sheets with which it begins."""
    made = model(THROWN, "run.duration=60 ms")
    result = mdlgen.solve(made, "lattice")
    at = np.arange(len(result.time))
    rows = animation(result, at, {})["stays"]
    assert [row[:3] for row in rows] == [[0, 1, 0.0], [1, 1, 30.013], [2, 1, None]]
    assert rows[0][3] == result.stays[0, 1] and rows[1][3] is None
    when = np.array(boxes.there(result, at))
    assert when[0].tolist() == [True, False, False]
    assert when[result.time == 40.0].tolist() == [[True, True, False]]
    assert when[result.time == 50.0].tolist() == [[False, True, False]]
    assert np.array_equal(boxes.at_start(made), [True, False, False])


def test_both_solvers_agree() -> None:
    """Of notes through a nip, by the estimates of both."""
    sets = ("run.duration=60 ms", "streams.infeed.count=2", "sheets.note.boxes=[3, 2]", "run.step=0.05 ms")
    one, two = (mdlgen.solve(model(DRAWN, *sets), solver) for solver in ("lattice", "exudyn"))
    assert as_asked(one) and as_asked(two), (one.status, two.status)
    assert np.abs(one.stays - two.stays)[~np.isnan(one.stays)].max() < 0.1
    assert one.energy.entered == pytest.approx(two.energy.entered, rel=1e-9)
    assert one.energy.left == pytest.approx(two.energy.left, rel=0.02)
    found = mdlgen.compare(one, two)
    assert found.relative < 0.01, found


# notes that fall into a tray and on each other, the first 4 ms after the run begins
TRAY = on_paper("""
name: tray
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [20 mm, 20 mm], thickness: 0.5 mm, mass: 0.3 g, boxes: [2, 2],
    center: [0 mm, 0 mm, 3 mm]}
streams: {fall: {of: note, every: 40 ms, count: 2, from: 4 ms}}
planes: {tray: {center: [0 mm, 0 mm, -1 mm], normal: z, size: [60 mm, 60 mm, 2 mm], mass: 10 g}}
contacts:
  - {between: [fall, [fall, tray]], stiffness: 100 N/mm^1.5, restitution: 0.1, friction: 0.5,
    smoothing: 10 mm/s}
run: {duration: 70 ms, step: 0.1 ms, tolerance: 0.05}
""")


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_sheets_of_a_stream_lie_on_each_other(solver: str) -> None:
    """From a start without any sheet on."""
    result = mdlgen.solve(model(TRAY), solver)
    assert as_asked(result), result.status
    assert result.stays[:, 0].tolist() == [4.0, 44.0]
    height = [result.sheet_motion(k)[0][-1, 2] for k in range(2)]
    # half a thickness, and one and a half; a weight of 3 mN presses in by a micrometre, and they still settle
    assert height == pytest.approx([0.25, 0.75], abs=0.1)
    assert abs(result.energy.balance_error) < 0.02


def test_friction_that_sticks_begins_with_the_sheet() -> None:
    """The patches of a note that comes in late have what they have of one that is there from the start."""
    text = DRAWN.replace("friction: 0.4,", "friction: {static: 0.4, dynamic: 0.3, sticking: 40 N/mm},")
    sets = ("streams.infeed.count=1", "run.step=0.05 ms", "sheets.note.boxes=[3, 2]")
    early = mdlgen.solve(model(text, "run.duration=35 ms", *sets), "lattice")
    late = mdlgen.solve(model(text, "run.duration=45 ms", "streams.infeed.from=10 ms", *sets), "lattice")
    assert np.diff(late.stays).item() == pytest.approx(np.diff(early.stays).item(), abs=1e-9)
    assert late.energy.dissipated == pytest.approx(early.energy.dissipated, rel=1e-6)


def test_what_does_not_go_with_a_stream_is_refused_by_name() -> None:
    yields = model(DRAWN, "materials.paper.yield={curvature: 0.1 1/mm, hardening: 0.1}")
    for solver in ("lattice", "exudyn"):
        with pytest.raises(RefusedError, match="infeed_1 comes in or leaves during the run"):
            mdlgen.solve(yields, solver)
