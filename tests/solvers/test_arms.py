"""Rollers on arms and on sprung slides, against closed forms; both solvers, text, deck, spec."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from papers import on_paper
from ran import solved

import mdlgen
from mdlgen.backends.motionsolve import validate
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats, Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.results.compare import compare, travel
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

# about y a positive torque presses the roller, which is at +x from the pivot, down on the note
SKIMMER = on_paper("""
name: skimmer
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [67 mm, 30 mm], thickness: 0.1 mm, mass: 0.17 g, boxes: [7, 3]}
rollers:
  motor: {center: [0 mm, 0 mm, -7.55 mm], axis: y, radius: 7.5 mm, width: 20 mm, mass: 10 g,
    drive: {speed: 60 rad/s, ramp: 5 ms}}
  skim: {center: [0 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g,
    arm: {pivot: [-40 mm, 0 mm, 5.05 mm], mass: 8 g, torque: 60 N*mm, stiffness: 100 N*mm/rad,
      damping: 2000 N*mm*ms/rad}}
contacts:
  - {between: [note, motor], stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}
  - {between: [note, skim], stiffness: 300 N/mm^1.5, friction: 0.3, smoothing: 10 mm/s}
run: {duration: 40 ms, print_step: 0.25 ms}
""")
# a roller alone on a swinging arm; the sheet takes no part
SWING = on_paper("""
name: swing
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [20 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [1, 2],
    center: [900 mm, 0 mm, 0 mm], clamp: {edge: y_min, length: 0 mm}}
rollers:
  bob: {center: [4 mm, 3 mm, -60 mm], axis: y, radius: 20 mm, width: 20 mm, mass: 10 g,
    arm: {pivot: [0 mm, 0 mm, 0 mm], mass: 20 g}}
run: {duration: 600 ms, print_step: 1 ms, prune: false}
""")
SOLVERS = ("lattice", "exudyn")
G = 9.81e-3  # mm/ms^2
HELD = ("rollers.motor.drive.speed=0 rad/s", "sheets.note.clamp={edge: x_min, length: 0 mm}")


def skimmer(*overrides: str) -> Model:
    return lower(loads(SKIMMER, "skimmer", overrides))


def swing(*overrides: str) -> Model:
    return lower(loads(SWING, "swing", overrides))


def angle(result: Result, name: str) -> Floats:
    """By which an arm has turned about the roller's axis y [rad]."""
    roller = result.model.roller(name)
    assert roller.arm is not None
    way = result.position[:, roller.body] - roller.arm.pivot
    return np.unwrap(np.arctan2(-way[:, 2], way[:, 0])) - np.arctan2(-way[0, 2], way[0, 0])


def force(result: Result, name: str) -> Floats:
    """Of the note on a roller [N]."""
    sides = zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True)
    row = list(sides).index(("note", name))
    return result.contact_force[:, row]


def weights(made: Model) -> float:
    """Torque of roller and arm about a pivot 40 mm aside [N mm]."""
    return G * (5.0 * 40.0 + 8.0 * 20.0)


# -- swinging


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("drive", ["", "{speed: 0 rad/s}"], ids=["free", "held"])
def test_an_arm_swings_as_a_pendulum(solver: str, drive: str) -> None:
    """Its period: a roller that is free on the arm does not turn, one held by its drive does."""
    made = swing(*([f"rollers.bob.drive={drive}"] if drive else []))
    result = solved(made, solver)
    square = 4.0**2 + 60.0**2
    inertia = 20.0 * square / 3 + 10.0 * square + (0.5 * 10.0 * 20.0**2 if drive else 0.0)
    assert made.roller("bob").swung_inertia == pytest.approx(inertia, rel=1e-12)
    length = np.sqrt(square)
    most = np.arctan2(4.0, 60.0)
    period = 2 * np.pi * np.sqrt(inertia / (G * length * (20.0 / 2 + 10.0))) * (1 + most**2 / 16)
    x = result.position[:, made.roller("bob").body, 0]
    at = np.flatnonzero((x[:-1] > 0) & (x[1:] <= 0))
    crossings = result.time[at] + x[at] / (x[at] - x[at + 1]) * np.diff(result.time)[at]
    assert len(crossings) >= 2
    assert np.diff(crossings).mean() == pytest.approx(period, rel=1e-3)
    assert np.linalg.norm(result.position[:, made.roller("bob").body, ::2], axis=1).max() == pytest.approx(
        length
    )
    assert abs(result.energy.balance_error) < 0.01


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_sprung_arm_swings_about_its_balance(solver: str) -> None:
    """Without gravity: torque over stiffness, at the root of stiffness over inertia."""
    made = swing(
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "rollers.bob.arm.torque=3 N*mm",
        "rollers.bob.arm.stiffness=20 N*mm/rad",
    )
    result = solved(made, solver)
    rate = np.sqrt(20.0 / made.roller("bob").swung_inertia)
    due = 3.0 / 20.0 * (1 - np.cos(rate * result.time))
    assert np.abs(angle(result, "bob") - due).max() < 2e-3 * due.max()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_drive_turns_the_arm_back_as_it_speeds_up(solver: str) -> None:
    """Nothing else acts: angular momentum about the pivot stays zero."""
    made = swing(
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "rollers.bob.drive={profile: [[10 ms, 0 rad/s], [30 ms, 20 rad/s], [60 ms, 5 rad/s]]}",
        "run.duration=80 ms",
    )
    result = solved(made, solver)
    bob = made.roller("bob")
    rate = np.gradient(angle(result, "bob"), result.time)
    due = -bob.inertia_axial / bob.swung_inertia * bob.prescribed(result.time)
    corners = np.abs(result.time[:, None] - bob.corners[:, 0]).min(axis=1) > 1.5
    assert np.abs(rate - due)[corners].max() < 5e-3 * np.abs(due).max()
    spin = result.spin[:, bob.body, 1]
    assert np.allclose(spin, bob.prescribed(result.time) + due, rtol=0, atol=5e-3 * 0.02)
    assert abs(result.energy.balance_error) < 0.01


# -- pressing


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_nip_of_an_arm_is_its_moment_over_its_length(solver: str) -> None:
    # with one point per box the normal force is the resultant; two of a foundation lean by 3 deg either way
    plain = ("contacts.0.friction=0", "contacts.1.friction=0", "contacts.1.share=pair")
    result = solved(skimmer(*HELD, *plain), solver)
    late = result.time > 30.0
    sunk = 100.0 * angle(result, "skim")[late].mean()  # what the spring has lost of its torque
    due = (60.0 - sunk + weights(result.model)) / 40.0
    assert force(result, "skim")[late].mean() == pytest.approx(due, rel=5e-4)
    assert np.ptp(force(result, "skim")[late]) < 0.01 * due


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("speed", [40.0, -40.0])
def test_a_motor_on_the_arm_bears_what_the_roller_rubs(solver: str, speed: float) -> None:
    """Friction at the rim has the lever R about a pivot at the height of the axis."""
    made = skimmer(
        *HELD, "contacts.0.friction=1.5", f"rollers.skim.drive={{speed: {speed} rad/s, ramp: 2 ms}}"
    )
    result = solved(made, solver)
    late = result.time > 30.0
    sunk = 100.0 * angle(result, "skim")[late].mean()
    # with a positive speed the lower side of the rim goes along -x; friction on it is along +x, and lifts the
    # arm as the normal force does
    lever = 40.0 + np.sign(speed) * 0.3 * 5.0
    due = (60.0 - sunk + weights(made)) / lever
    assert force(result, "skim")[late].mean() == pytest.approx(due, rel=5e-3)
    assert abs(result.energy.balance_error) < 0.01


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_slide_presses_with_its_preload(solver: str) -> None:
    """A pulling roller: 15 N where it just touches its counterpart, here a note's thickness before."""
    result = solved(
        lower(
            loads(
                SKIMMER,
                "slide",
                (
                    "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
                    "run.duration=20 ms",
                    "contacts.0.stiffness=3000 N/mm^1.5",
                    "contacts.1.stiffness=3000 N/mm^1.5",
                    "rollers.skim={center: [0 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, "
                    "width: 20 mm, mass: 5 g, press: {direction: -z, stiffness: 0.5 N/mm, preload: 15 N}}",
                ),
            )
        ),
        solver,
    )
    made = result.model
    late = result.time > 10.0
    press = made.roller("skim").press
    assert press is not None
    along = 5.05 - result.position[late, made.roller("skim").body, 2]
    due = 15.0 - 0.5 * (along.mean() - press.touch)
    assert due == pytest.approx(15.0, abs=0.1)
    assert force(result, "skim")[late].mean() == pytest.approx(due, rel=2e-3)


@pytest.mark.parametrize("overrides", [(), ("rollers.skim.drive={speed: -80 rad/s, ramp: 5 ms}",)])
def test_both_solvers_agree_about_an_arm(overrides: tuple[str, ...]) -> None:
    made = skimmer(*overrides, "rollers.skim.center=[0 mm, 0 mm, 5.5 mm]")  # it falls on the note first
    one, two = (solved(made, solver) for solver in SOLVERS)
    assert compare(two, one).relative < 0.01
    assert abs(travel(one)[0]) > 5.0
    assert abs(one.energy.balance_error) < 0.02


def test_a_note_waits_for_the_rubber_and_is_pulled_away() -> None:
    """The sample: rim, arm and slide together; the pull takes over before the rubber has passed."""
    made = lower(load(samples() / "peel.yaml"))
    one = solved(made, "lattice")
    moved = one.sheet_motion(0)[0][:, 0] - 16.0
    # the rim's angle under the note is 270 deg less what the roller has turned
    at = 270.0 - np.degrees(made.roller("feed").turned(one.time))
    assert np.abs(moved[at > 220.0]).max() < 0.25  # it creeps with the plastic
    fed = (at < 200.0) & (moved < 9.0)
    speed = np.gradient(moved, one.time)
    assert speed[fed].mean() == pytest.approx(15.0 * 0.06, rel=0.01)
    pulled = one.time > 50.0
    assert speed[pulled].mean() == pytest.approx(7.5 * 0.16, rel=0.01)
    assert force(one, "pull_idler")[pulled].mean() == pytest.approx(15.0, rel=0.06)


def test_both_solvers_agree_about_a_note_that_waits_for_the_rubber() -> None:
    made = lower(load(samples() / "peel.yaml"))
    one, two = (solved(made, solver) for solver in SOLVERS)
    assert compare(two, one).relative < 0.01


# -- text, deck, spec


@pytest.mark.parametrize(
    "overrides",
    [
        (),
        ("rollers.skim.axis=[0.1, 1, 0.3]", "rollers.skim.drive={speed: -80 rad/s}"),
        ("rollers.skim.arm={pivot: [-40 mm, 0 mm, 9 mm], mass: 8 g, center: [-30 mm, 0 mm, 1 mm]}",),
        (
            "rollers.skim.arm.inertia=900 g*mm^2",
            "rollers.skim.rim={sectors: [{from: 0 deg, to: 90 deg, friction: 2}]}",
        ),
    ],
    ids=["spring", "askew", "bare", "rim"],
)
def test_text_deck_and_model_have_one_arm(tmp_path: Path, overrides: tuple[str, ...]) -> None:
    file = tmp_path / "skimmer.yaml"
    file.write_text(SKIMMER.replace("boxes: [7, 3]", "boxes: [3, 2]"))
    made = load(file, overrides)
    found = verify(made, lower(made))
    assert [str(d) for d in found.all_differences()] == []
    assert all(c.largest <= 1e-12 for kinds in found.kinds.values() for c in kinds.values())
    assert found.perturbed is not None and found.perturbed.largest <= 1e-12
    assert not [name for name in found.perturbed.shown_only if name.startswith("ds_skim.real_a_")]
    assert validate(emitter("motionsolve").emit(lower(made))) == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("real_T_a, 60.0", "real_T_a, 61.0"),
        ("real_a_x, -40.0", "real_a_x, -40.01"),
        ("LIN, ds_skim.real_k_a.value", "LIN, 100.0"),
        ("0, ds_skim.real_T_a.value )", "0, -ds_skim.real_T_a.value )"),
        ("b_skim_arm, B_Ground, p_skim_pivot, VECTOR", "b_skim_arm, B_Ground, p_skim_arm, VECTOR"),
    ],
)
def test_another_arm_in_the_text_is_caught(tmp_path: Path, old: str, new: str) -> None:
    made = loads(SKIMMER, "skimmer", ("sheets.note.boxes=[3, 2]",))
    text = emitter("motionview").emit(lower(made))
    assert text.count(old) >= 1
    file = tmp_path / "skimmer.mdl"
    file.write_text(text.replace(old, new, 1))
    assert not verify(made, lower(made), text=file).ok


@pytest.mark.parametrize(
    ("override", "where", "message"),
    [
        (
            "rollers.skim.press={direction: z, stiffness: 1 N/mm, preload: 1 N}",
            "rollers.skim",
            "has no press",
        ),
        ("rollers.skim.one_way={direction: 1, torque: 1 N*mm}", "rollers.skim", "has no one_way"),
        ("rollers.skim.arm.pivot=[0 mm, 9 mm, 5.05 mm]", "arm", "an arm needs a length"),
        ("rollers.skim.arm.mass=0 g", "arm.mass", "more than 0 g"),
        ("rollers.skim.arm.torque=5 N", "arm.torque", "N*mm"),
    ],
)
def test_a_bad_arm_is_reported_in_one_line(override: str, where: str, message: str) -> None:
    with pytest.raises(SpecError) as error:
        skimmer(override)
    assert where in str(error.value) and message in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_static_analysis_refuses_an_arm_by_name(solver: str) -> None:
    made = skimmer("run.analysis=static", *HELD)
    with pytest.raises(RefusedError, match="arm"):
        mdlgen.solve(made, solver)
