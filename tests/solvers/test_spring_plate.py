"""Plates on springs: swinging alone and with a block, at rest, in an impact, under a stack; their text."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import ran
from asked import as_asked
from papers import on_paper

import mdlgen
from mdlgen.checks import lints
from mdlgen.cli import app
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model, PlanePart, Press
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.report.html.curves import panels
from mdlgen.report.meshes import moving
from mdlgen.results.io.series import series
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

SOLVERS = ["lattice", "exudyn"]
G = 9.81e-3  # mm/ms^2
BLOCK, PLATE = 30.0, 50.0  # g

# a rigid block over a plate that is given where it just touches the block
SCENE = """
name: scale
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {hard: {E_md: 1 GPa, E_cd: 1 GPa, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  block: {material: hard, size: [20 mm, 20 mm], thickness: 5 mm, mass: 30 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 2.5 mm]}
planes:
  plate: {center: [0 mm, 0 mm, -2 mm], normal: z, size: [40 mm, 40 mm, 4 mm], mass: 50 g,
    press: {direction: z, stiffness: 0.5 N/mm, preload: 1 N, damping_ratio: 0}}
contacts: [{between: [block, plate], stiffness: 30000 N/mm^1.5, restitution: 0.3, friction: 0}]
run: {duration: 200 ms, print_step: 0.5 ms}
"""
# Spring and contact as two springs in a row: what a contact so stiff changes of the period is below 1e-4.
STIFF = 1e-3


def solved(text: str, solver: str, *sets: str) -> Result:
    return ran.solved(lower(loads(text, overrides=sets)), solver)


def plate_of(model: Model) -> tuple[PlanePart, Press]:
    (found,) = model.plates
    return found


def way(result: Result) -> np.ndarray:
    """How far the plate is along its slide from where it is given [mm]."""
    plate, press = plate_of(result.model)
    return (result.position[:, plate.body] - plate.center) @ press.direction


def period(time: np.ndarray, place: np.ndarray, about: float) -> float:
    """Twice the mean time between the places where a swing crosses its middle."""
    side = place - about
    at = np.flatnonzero(side[:-1] * side[1:] < 0.0)
    crossings = time[at] + side[at] / (side[at] - side[at + 1]) * np.diff(time)[at]
    assert len(crossings) > 2
    return 2.0 * float(np.diff(crossings).mean())


# -- alone and with a block


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_block_and_its_plate_swing_as_one(solver: str) -> None:
    """The spring pushes more than both weigh: they begin below their balance, and swing about it."""
    result = solved(SCENE, solver)
    rest = (1.0 - (BLOCK + PLATE) * G) / 0.5
    place = way(result)
    assert period(result.time, place, rest) == pytest.approx(
        2 * math.pi * math.sqrt((BLOCK + PLATE) / 0.5), rel=STIFF
    )
    assert place.max() == pytest.approx(2 * rest, rel=1e-2) and place[-1] == pytest.approx(
        rest * (1 - math.cos(200 * math.sqrt(0.5 / (BLOCK + PLATE)))), rel=1e-2
    )
    block = result.position[:, 0, 2] - result.position[0, 0, 2]
    assert np.abs(block - place).max() < 2e-3  # what the contact gives
    assert abs(result.energy.balance_error) < 2e-3


@pytest.mark.parametrize("solver", SOLVERS)
def test_it_comes_to_rest_where_spring_and_preload_bear_the_weight(solver: str) -> None:
    """Damped, and let go 0.4 mm above balance."""
    sets = ("planes.plate.press.damping_ratio=0.7", "planes.plate.press.preload=0.6 N")
    step = ("run.step=0.05 ms",) if solver == "exudyn" else ()
    result = solved(SCENE, solver, *sets, "run.tolerance=1e-2", *step)
    rest = (0.6 - (BLOCK + PLATE) * G) / 0.5
    assert rest < -0.35 and way(result)[-1] == pytest.approx(rest, abs=1e-4)
    record = result.summary()["planes"]["plate"]
    assert record["nip_force_n"] == pytest.approx(BLOCK * G, rel=1e-3)
    assert record["center_mm"][2] == pytest.approx(-2 + rest, abs=1e-4)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_plate_alone_swings_on_its_spring(solver: str) -> None:
    """The block flies off, without gravity, and leaves the plate to its preload."""
    sets = ("gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]", "planes.plate.press.preload=0.1 N")
    up = "sheets.block.velocity=[0 m/s, 0 m/s, 0.1 m/s]"
    step = ("run.step=0.05 ms",) if solver == "exudyn" else ()
    result = solved(SCENE, solver, *sets, up, *step)
    free = result.contact_force[:, 0] == 0.0
    assert free[10:].all()
    place = way(result)
    assert period(result.time[10:], place[10:], 0.2) == pytest.approx(
        2 * math.pi * math.sqrt(PLATE / 0.5), rel=STIFF
    )
    assert place.max() == pytest.approx(0.4, rel=1e-2)  # twice the preload over the stiffness


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_mass_of_the_slide_counts(solver: str) -> None:
    result = solved(
        SCENE,
        solver,
        "planes.plate.press.carrier_mass=40 g",
        "planes.plate.press.preload=1.4 N",
    )
    mass = BLOCK + PLATE + 40.0
    found = period(result.time, way(result), (1.4 - mass * G) / 0.5)
    assert found == pytest.approx(2 * math.pi * math.sqrt(mass / 0.5), rel=STIFF)


@pytest.mark.parametrize("solver", SOLVERS)
def test_an_impact_on_a_free_plate_keeps_momentum_and_energy(solver: str) -> None:
    """The closed form of two bodies that meet in line, and lose nothing, or all but a part of their speed."""
    hit = (
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "sheets.block.center=[0 mm, 0 mm, 2.6 mm]",
        "sheets.block.velocity=[0 m/s, 0 m/s, -0.5 m/s]",
        "planes.plate.press={direction: z, stiffness: 0 N/mm, preload: 0 N, free_length: 20 mm}",
        "contacts.0.stiffness=300 N/mm^1.5",
        "run.duration=8 ms",
        "run.print_step=0.1 ms",
    )
    for restitution in (1.0, 0.5):
        result = solved(SCENE, solver, *hit, f"contacts.0.restitution={restitution}")
        plate, _ = plate_of(result.model)
        block, other = result.velocity[-1, 0, 2], result.velocity[-1, plate.body, 2]
        assert BLOCK * block + PLATE * other == pytest.approx(BLOCK * -0.5, rel=1e-6)
        # with a sharp change of sign the damping is right to its smoothing speed, 0.2 % of the impact's
        assert block - other == pytest.approx(0.5 * restitution, rel=1e-2)
        assert abs(result.energy.balance_error) < 5e-3


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_plate_that_moves_along_its_face_takes_a_block_with_it(solver: str) -> None:
    """Pressed obliquely in free fall: what rubs is the speed against the plate, not against ground."""
    sets = (
        "planes.plate.press.direction=[0.6, 0, 0.8]",
        "planes.plate.press.damping_ratio=0.3",
        "contacts.0.friction=1",
        "contacts.0.smoothing=0.1 mm/s",
        "run.duration=60 ms",
        "run.tolerance=1e-2",
        "sheets.block.velocity=[0 m/s, 0 m/s, -0.01 m/s]",
    )
    result = solved(SCENE, solver, *sets)
    block = result.position[:, 0] - result.position[0, 0]
    plate, _ = plate_of(result.model)
    moved = result.position[:, plate.body] - result.position[0, plate.body]
    far = np.abs(moved[:, 0]).max()
    assert far > 0.05 and np.abs(block[:, 0] - moved[:, 0]).max() < 0.05 * far


def test_a_plate_goes_no_further_than_its_spring_is_long() -> None:
    """It throws the block up, and would follow it: the run ends with its name, and what to do."""
    for prune in ("true", "false"):
        sets = (
            "planes.plate.press.preload=8 N",
            "planes.plate.press.stiffness=0.1 N/mm",
            f"run.prune={prune}",
        )
        for solver in SOLVERS:
            result = mdlgen.solve(lower(loads(SCENE, overrides=sets)), solver)
            assert not as_asked(result) and "plane plate left the length of its spring, 6 mm" in result.status
            offset = result.position[-1, plate_of(result.model)[0].body] - plate_of(result.model)[0].center
            assert 5.0 < np.linalg.norm(offset) < 8.0


@pytest.mark.parametrize("free_length", ["6 mm", "1e9 mm"])
def test_a_plate_that_its_spring_does_not_hold_is_refused_by_name(free_length: str) -> None:
    """At once, however far it might go; the texts have its spring at a length that it has."""
    long = f"planes.plate.press.free_length={free_length}"
    free = ("planes.plate.press.stiffness=0 N/mm", "contacts=[]", long)
    heavy = ("planes.plate.press={direction: z, stiffness: 0.1 N/mm, preload: 0 N, free_length: 2 mm}",)
    for sets, way in ((free, "left there, with its direction"), (heavy, "left there, against its direction")):
        with pytest.raises(SpecError, match=way) as error:
            lower(loads(SCENE, overrides=sets))
        assert error.value.path == ("planes", "plate", "press")


# -- at rest

CLAMPED = on_paper("""
name: bent
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {paper: PLATE_PAPER}
sheets:
  strip: {material: paper, size: [40 mm, 10 mm], thickness: 0.1 mm, mass: 50 mg, boxes: [8, 1],
    clamp: {edge: x_min}}
planes:
  plate: {center: [17 mm, 0 mm, -3.05 mm], normal: z, size: [6 mm, 20 mm, 6 mm], mass: 2 g,
    press: {direction: z, stiffness: 0.01 N/mm, preload: 25 mN}}
contacts: [{between: [strip, plate], stiffness: 10 N/mm^1.5, friction: 0}]
run: {analysis: static}
""")


def test_statics_of_both_solvers() -> None:
    """A clamped strip that a plate bends up: spring, weight and strip in balance."""
    fast, slow = solved(CLAMPED, "lattice"), solved(CLAMPED, "exudyn")
    plate, press = plate_of(fast.model)
    for result in (fast, slow):
        assert way(result)[0] > 0.3
        spring = press.preload - press.stiffness * way(result)[0] - plate.mass * G
        # the strip slopes by 1.4 deg over the plate's edge, and what pushes it is square to it
        assert result.contact_force[0, 0] == pytest.approx(spring, rel=4e-4)
    assert way(fast)[0] == pytest.approx(way(slow)[0], rel=1e-5)


# -- a stack


@pytest.fixture(scope="module")
def stack() -> Result:
    return ran.solved(lower(load(samples() / "spring_plate.yaml")), "lattice")


def test_both_solvers_agree_on_a_stack_under_a_roller(stack: Result) -> None:
    fast, slow = stack, ran.solved(stack.model, "exudyn")
    assert as_asked(fast) and as_asked(slow) and fast.model.run.duration == 40.0
    ways = [
        [r.sheet_motion(k)[0][-1, 0] - r.sheet_motion(k)[0][0, 0] for k in range(3)] for r in (fast, slow)
    ]
    travel = ways[0][0]
    assert travel > 20.0 and np.abs(np.subtract(*ways)).max() < 0.01 * travel
    assert ways[0] == pytest.approx(ways[1], rel=0.01)
    # notes rattle: the plate's place is that of the stack to a hundredth of what it rises by
    assert way(fast)[-40:].mean() == pytest.approx(way(slow)[-40:].mean(), abs=3e-3)
    for result in (fast, slow):
        assert abs(result.energy.balance_error) < 0.01


def test_notes_leave_a_stack_one_by_one(stack: Result) -> None:
    """The plate follows by the thickness of a note."""
    result = stack
    events = result.summary()["events"]
    left = next(e["time_ms"] for e in events if (e["kind"], e["sheet"]) == ("leave", "note_1"))
    entered = next(e["time_ms"] for e in events if (e["kind"], e["sheet"]) == ("enter", "note_2"))
    assert left < entered < left + 3.0
    place = way(result)
    before, after = (place[(result.time > t) & (result.time < t + 5)].mean() for t in (left - 6, entered + 4))
    assert after - before == pytest.approx(0.1, abs=0.02)
    moved = {s.name: result.sheet_motion(k)[0][:, 0] for k, s in enumerate(result.model.sheets)}
    # just before the end of note_1 comes to the roller, and is as quick as that
    here = int(np.searchsorted(result.time, left - 2.0))
    assert moved["note_1"][here] - moved["note_1"][0] > 12.0
    # between two notes one is held by no more than it is pulled: it creeps by the smoothing of friction
    assert abs(moved["note_2"][here] - moved["note_2"][0]) < 0.2
    assert abs(moved["note_3"][-1] - moved["note_3"][0]) < 0.1


def test_what_a_run_tells_of_it(stack: Result) -> None:
    result = stack
    plate, _ = plate_of(result.model)
    record = result.summary()["planes"]["plate"]
    assert record["center_mm"] == pytest.approx(result.position[-1, plate.body])
    assert record["contacts"]["note_3"]["max_force_n"] > 0.3 and record["max_penetration_mm"] > 0.0
    table = series(result)
    assert table["plate.z_mm"] == pytest.approx(result.position[:, plate.body, 2])
    row = result.model.contacts.part_b.index("plate")
    assert table["plate.force_n"] == pytest.approx(result.contact_force[:, row])
    at = np.arange(len(result.time))
    shown = panels(result, at, np.zeros((len(at), len(result.model.contacts))), None)
    lines = {p.key: [line.name for line in p.lines] for p in shown}
    assert lines["force"] == lines["penetration"] == ["feed", "plate"] and lines["slide"] == ["plate"]
    assert plate.body in moving(result.model)


def test_it_begins_in_balance_with_the_flat_sheet() -> None:
    """The force on a block is that of the spring less the plate's weight; of a part of it that is over the
    plate too, since a box has its stiffness wherever it is touched."""
    for over in ("[40 mm, 40 mm, 4 mm]", "[5 mm, 40 mm, 4 mm]"):
        sets = (
            f"planes.plate.size={over}",
            "contacts.0.stiffness=10 N/mm^1.5",
            "planes.plate.press.preload=1 N",
        )
        model = lower(loads(SCENE, overrides=sets))
        _, press = plate_of(model)
        assert press.touch == 0.0
        assert 10 * press.start**1.5 == pytest.approx(1.0 - 0.5 * press.start - PLATE * G, rel=1e-9)
    away = lower(loads(SCENE, overrides=["contacts=[]", "planes.plate.press.preload=1 N"]))
    assert plate_of(away)[1].start == pytest.approx((1.0 - PLATE * G) / 0.5, rel=1e-9)


def test_it_may_be_forgotten_as_any_part() -> None:
    (found,) = [x for x in lints(lower(loads(SCENE, overrides=["contacts=[]"]))) if x.code == "W111"]
    assert found.where == "planes.plate"


@pytest.mark.parametrize("thick", [0.08, 0.16])
def test_it_begins_in_balance_under_a_zone_of_another_thickness(thick: float) -> None:
    zone = f"{{x: [-20 mm, -5 mm], y: [-12 mm, 12 mm], thickness: {thick} mm}}"
    made = lower(load(samples() / "spring_plate.yaml", [f"sheets.note_3.zones={{strip: {zone}}}"]))
    plate, press = plate_of(made)
    result = mdlgen.solve(replace(made, run=replace(made.run, duration=0.01, print_step=0.01)), "lattice")
    force = series(result)["plate.force_n"][0]
    weight = plate.sliding_mass * G
    assert force == pytest.approx(press.preload - press.stiffness * press.start - weight, rel=1e-6)


# -- the texts

TILTED = (
    "planes.plate.normal=[0.6, 0, 0.8]",
    "planes.plate.press.direction=[0.1, 0.2, 1]",
    "planes.plate.press.carrier_mass=3 g",
    "planes.plate.press.free_length=20 mm",
)


@pytest.mark.parametrize("sets", [(), TILTED], ids=["level", "tilted"])
def test_text_deck_and_model_say_the_same(sets: tuple[str, ...]) -> None:
    scene = loads(SCENE, overrides=sets)
    model = lower(scene)
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    for kinds in found.kinds.values():
        assert all(c.largest <= 1e-12 for c in kinds.values())
        assert kinds["springs"].entities == kinds["joints"].entities == kinds["outputs"].entities == 1
    assert found.perturbed is not None and found.perturbed.largest <= 1e-12
    text = emitter("motionview").emit(model)
    assert "*TransJoint( j_plate_slide, " in text and "*CoilSpring( cs_plate, " in text
    assert "FixedJoint" not in text and "Pressed plates start in equilibrium" in text
    deck = emitter("motionsolve").emit(model)
    assert '"TRANSLATIONAL"' in deck and '"FIXED"' not in deck


def test_a_fixed_plate_is_written_as_before() -> None:
    model = lower(loads(SCENE, overrides=["planes.plate.press=null"]))
    text = emitter("motionview").emit(model)
    assert "*FixedJoint( j_plate, " in text and "TransJoint" not in text and "o_plate" not in text


# -- the spec


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("planes.plate.press.direction=[0, 0, 0]", "is not a direction"),
        ("planes.plate.press.direction=x", "lies in the plate's own face"),
        ("planes.plate.press.direction=[1, 0, 0.01]", "less than 3 degrees off it"),
        ("planes.plate.press.stiffness=-0.5 N/mm", "at least 0 N/mm"),
        ("planes.plate.press.preload=-1 N", "at least 0 N"),
        ("planes.plate.press.free_length=0 mm", "more than 0 mm"),
        ("planes.plate.press.damping_ratio=-1", "damping_ratio"),
        ("planes.plate.press.carrier_mass=0 g", "more than 0 g"),
        ("planes.plate.press.stiffness=0.5", "N/mm"),
        ("planes.plate.press.spring=1", "spring"),
        ("planes.plate.press={direction: z, stiffness: 1 N/mm}", "preload"),
    ],
)
def test_what_cannot_be_meant_is_reported_in_one_line(override: str, message: str) -> None:
    with pytest.raises(SpecError) as error:
        loads(SCENE, overrides=[override])
    line = str(error.value)
    assert message in line and "planes.plate.press" in line and "\n" not in line


def test_the_command_line_ends_with_one_line(capsys: pytest.CaptureFixture[str], tmp_path) -> None:
    (tmp_path / "scale.yaml").write_text(SCENE)
    wrong = "planes.plate.press.direction=y"
    with pytest.raises(SystemExit) as ended:
        app(["check", str(tmp_path / "scale.yaml"), "--set", wrong], prog_name="mdlgen")
    assert ended.value.code == 2
    message = capsys.readouterr().err.strip()
    assert "planes.plate.press.direction" in message and len(message.splitlines()) == 1
