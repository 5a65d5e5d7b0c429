"""Motors, bearings, torque limiters and shafts against closed forms, in both solvers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from axles import CONTROLLED, FEED, OTHER, STEPS_ON, alone, retarded, spin
from cutting import Cut, Cutting, written_with
from ran import solved
from same import bits

from mdlgen.backends.lattice import run as lattice
from mdlgen.errors import SpecError
from mdlgen.results.io.store import hdf5
from mdlgen.results.motors import axle_torque, lost_steps
from mdlgen.results.result import GRIPS, RUBS
from mdlgen.results.torques import drive_power

SOLVERS = ("lattice", "exudyn")
# 10 N mm and 300 rad/s, by a gear of 2: 20 N mm and 0.15 rad/ms at the roller; the rotor adds 4 * 500 g mm^2
MOTOR = "rollers.feed.drive={motor: {torque: 10 N*mm, speed: 300 rad/s, inertia: 500 g*mm^2, gear: 2}}"
STALL, NO_LOAD, INERTIA = 20.0, 0.15, FEED + 2000.0
TAU = INERTIA * NO_LOAD / STALL
# A bearing or a limiter has its torque from 0 on over a creep of 0.1 rad/s, which is passed in less than a
# step: exudyn, which takes the mean of both ends, misses half of the first step, 0.01 ms torque / inertia.
CREEP, FINE = 1e-4, "run.step=0.02 ms"
STEPPER = "rollers.feed.drive={profile: %s, motor: {torque: 20 N*mm, steps: {damping: 600 N*mm*ms/rad}}}"


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_motor_spins_its_inertia_up_along_its_line(solver: str) -> None:
    result = solved(alone(MOTOR), solver)
    due = NO_LOAD * (1.0 - np.exp(-result.time / TAU))
    # a step of 0.1 ms has an error of (0.1 / 22.5)^2 / 12
    assert np.abs(spin(result, "feed") - due).max() < 1e-5 * NO_LOAD
    # exudyn has its energy by trapezoids over steps
    assert abs(result.energy.balance_error) < (1e-6 if solver == "lattice" else 2e-4)


def test_the_error_of_a_motor_is_of_second_order() -> None:
    off = []
    for h in (1.0, 0.5, 0.25):
        result = solved(alone(MOTOR, f"run.step={h} ms"), "lattice")
        off.append(np.abs(spin(result, "feed") - NO_LOAD * (1.0 - np.exp(-result.time / TAU))).max())
    assert 3.8 < off[0] / off[1] < 4.3 and 3.8 < off[1] / off[2] < 4.3


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_motor_runs_where_its_line_meets_the_brake(solver: str) -> None:
    """The speed goes to w0 (1 - M / T0) with the same time constant, and drag makes both less."""
    bearing = "rollers.feed.bearing={torque: 4 N*mm, drag: 40 N*mm*ms/rad}"
    result = solved(alone(MOTOR, bearing, FINE, "run.duration=40 ms"), solver)
    slope = STALL / NO_LOAD + 40.0
    due = (STALL - 4.0) / slope * (1.0 - np.exp(-result.time * slope / INERTIA))
    assert np.abs(spin(result, "feed") - due).max() < 0.2 * CREEP
    roller = result.model.roller("feed")
    torque, power = axle_torque(result, roller), drive_power(result, roller)
    assert torque is not None and power is not None
    assert torque[-1] == pytest.approx(STALL * (1.0 - spin(result, "feed")[-1] / NO_LOAD), rel=1e-9)
    assert power[-1] == pytest.approx(torque[-1] * spin(result, "feed")[-1], rel=1e-9)
    assert result.events == []


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_motor_stalls_where_the_brake_takes_all_its_torque(solver: str) -> None:
    """Just below the torque at rest it turns, just above it creeps slower than the bearing's creep."""
    below, above = (
        solved(alone(MOTOR, FINE, f"rollers.feed.bearing={{torque: {brake} N*mm}}"), solver)
        for brake in (19.0, 21.0)
    )
    due = NO_LOAD * (1.0 - 19.0 / STALL) * (1.0 - np.exp(-below.time / TAU))
    assert np.abs(spin(below, "feed") - due).max() < CREEP and below.events == []
    assert 0.0 < spin(above, "feed")[-1] < CREEP
    (stall,) = above.events
    assert stall["kind"] == "stall" and stall["roller"] == "feed" and stall["duration_ms"] > 9.0
    assert stall["torque_n_mm"] == pytest.approx(STALL, rel=1e-3)


def test_a_table_and_a_lower_voltage_are_what_the_line_is() -> None:
    line, table = (
        solved(
            alone(f"rollers.feed.drive={{motor: {{{law}, voltage: [[0 ms, 0.5], [9 ms, 0.5]]}}}}"), "lattice"
        )
        for law in (
            "torque: 20 N*mm, speed: 150 rad/s",
            "table: [[0 rad/s, 20 N*mm], [75 rad/s, 10 N*mm], [150 rad/s, 0 N*mm]]",
        )
    )
    assert np.abs(spin(line, "feed") - spin(table, "feed")).max() < 1e-12
    due = 0.075 * (1.0 - np.exp(-line.time * STALL / NO_LOAD / FEED))
    assert np.abs(spin(line, "feed") - due).max() < 1e-5


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_limiter_gives_its_torque_and_then_holds(solver: str) -> None:
    drive = "rollers.feed.drive={profile: [[0 ms, 0 rad/s], [1 ms, 60 rad/s]]}"
    made = alone(drive, FINE, "rollers.feed.limiter={torque: 15 N*mm}", "run.print_step=0.1 ms")
    result = solved(made, solver)
    turns = spin(result, "feed")
    assert turns[30] - turns[20] == pytest.approx(15.0 / FEED, rel=1e-3)  # by its torque alone
    assert turns[-3:] == pytest.approx(0.06, rel=1e-4)
    (slip,) = result.events
    assert slip["kind"] == "limiter_slips"
    # the area between both: (v - T t / J)^2 / (2 T / J), less that of the ramp
    assert slip["slip_rad"] == pytest.approx(0.06**2 * FEED / 30.0 - 0.03, rel=0.02)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_shaft_shares_the_torque_among_its_rollers(solver: str) -> None:
    """One spin: inertia J1 + r^2 J2, and drag at one is felt by the other."""
    shaft = (
        "shafts={main: {rollers: {feed: 1, other: -1.5}, inertia: 300 g*mm^2, "
        "bearing: {drag: 20 N*mm*ms/rad}, drive: {motor: {torque: 20 N*mm, speed: 150 rad/s}}}}"
    )
    result = solved(alone(shaft), solver)
    inertia, slope = FEED + 1.5**2 * OTHER + 300.0, STALL / NO_LOAD + 20.0
    due = STALL / slope * (1.0 - np.exp(-result.time * slope / inertia))
    assert np.abs(spin(result, "feed") - due).max() < 1e-5 * NO_LOAD
    assert np.abs(spin(result, "other") + 1.5 * spin(result, "feed")).max() < 1e-9
    assert abs(result.energy.balance_error) < (1e-6 if solver == "lattice" else 2e-4)


def test_a_prescribed_shaft_gives_each_roller_its_speed() -> None:
    made = alone("shafts={main: {rollers: {feed: 1, other: -1.5}, drive: {speed: 40 rad/s}}}")
    assert made.roller("feed").speed == pytest.approx(0.04)
    assert made.roller("other").speed == pytest.approx(-0.06) and not made.roller("other").turns


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stepper_keeps_in_step_below_its_torque(solver: str) -> None:
    profile = "[[0 ms, 0 rad/s], [20 ms, 20 rad/s]]"
    result = solved(alone(STEPPER % profile, "run.duration=18 ms"), solver)
    lost = lost_steps(result, result.model.roller("feed"))
    assert lost is not None and lost[0] == 0 and result.events == []
    assert result.behind is not None
    # it is behind by what speeds it up, sin(50 e) = J a / T; what it swings by falls with exp(-0.3 t)
    due = np.arcsin(FEED * 0.001 / 20.0) / 50.0
    assert result.behind[-1, 0] == pytest.approx(due, rel=0.01)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stepper_that_is_held_loses_the_periods_of_its_field(solver: str) -> None:
    """The field turns by three periods, 2 pi / 50 each, while a bearing holds it, by more than 20 N mm and
    600 N mm ms/rad times the speed of the field."""
    turns = 3 * 2.0 * np.pi / 50.0
    profile = f"[[0 ms, 0 rad/s], [4 ms, {1e3 * turns / 4.0} rad/s], [8 ms, 0 rad/s]]"
    result = solved(alone(STEPPER % profile, "rollers.feed.bearing={torque: 100 N*mm}"), solver)
    lost = lost_steps(result, result.model.roller("feed"))
    assert lost is not None and lost[0] == 12
    assert result.behind is not None and result.behind[-1, 0] == pytest.approx(turns, rel=3e-3)
    assert "lost_steps" in {event["kind"] for event in result.events}


CONTROL = (
    "rollers.feed.drive={speed: 100 rad/s, motor: {torque: 20 N*mm, speed: 200 rad/s, "
    "control: {proportional: 400 N*mm*ms/rad, integral: 40 N*mm/rad}}}"
)


@pytest.mark.parametrize("solver", SOLVERS)
def test_speed_control_takes_out_what_a_brake_leaves(solver: str) -> None:
    """By the integral the speed is the target's; torque at first is at the limit, later that of the brake."""
    made = alone(CONTROL, "rollers.feed.bearing={torque: 5 N*mm}", "run.duration=60 ms", "run.step=0.5 ms")
    result = solved(made, solver)
    torque = axle_torque(result, made.roller("feed"))
    assert torque is not None and torque[0] == pytest.approx(20.0) and torque.max() <= 20.0
    assert spin(result, "feed")[-1] == pytest.approx(0.1, rel=1e-2)
    assert torque[-1] == pytest.approx(5.0, rel=1e-2)
    assert spin(result, "feed").max() < 0.1 * 1.001  # no wind-up, no overshoot


@pytest.mark.parametrize("solver", SOLVERS)
def test_speed_control_answers_a_load_as_an_oscillator_of_its_gains(solver: str) -> None:
    """Within its limits the error e of the speed follows J e'' + k_p e' + k_i e = 0: omega_n^2 = k_i/J,
    zeta = k_p/(2 sqrt(k_i J)). A target that jumps to w and a brake M, both at 0: e = w, e' = (M - k_p w)/J.
    An error is left of neither."""
    gain, integral, target, brake = 200.0, 40.0, 0.05, 5.0
    drive = (
        f"rollers.feed.drive={{speed: 50 rad/s, motor: {{torque: 60 N*mm, speed: 1000 rad/s, "
        f"control: {{proportional: {gain} N*mm*ms/rad, integral: {integral} N*mm/rad}}}}}}"
    )
    made = alone(drive, "rollers.feed.bearing={torque: 5 N*mm}", "run.duration=60 ms", "run.step=0.1 ms")
    result = solved(made, solver)
    natural, damping = np.sqrt(integral / FEED), gain / (2.0 * np.sqrt(integral * FEED))
    assert damping == pytest.approx(0.5) and natural == pytest.approx(0.2)
    fast, rate = natural * np.sqrt(1.0 - damping**2), (brake - gain * target) / FEED
    t = result.time
    wave = target * np.cos(fast * t) + (rate + damping * natural * target) / fast * np.sin(fast * t)
    due = target - np.exp(-damping * natural * t) * wave
    # exudyn misses half of the brake in the first step, see CREEP
    off = np.abs(spin(result, "feed") - due)
    assert off.max() < 0.5 * 0.1 * brake / FEED and off[t > 40.0].max() < 1e-4 * target
    assert spin(result, "feed")[-1] == pytest.approx(target, rel=3e-3)
    assert result.behind is not None and result.behind[-1, 0] == pytest.approx(brake / integral, rel=0.02)


def test_the_error_of_speed_control_is_of_second_order() -> None:
    rows = [
        spin(solved(alone(CONTROL, f"run.step={h} ms"), "lattice"), "feed")[[4, 6, 8]]
        for h in (0.5, 0.25, 0.125)
    ]
    assert np.all(np.abs(rows[1] - rows[2]) < 0.35 * np.abs(rows[0] - rows[1]))


def test_a_stepper_and_speed_control_go_on_to_the_same_bits(tmp_path: Path) -> None:
    """A stepper that is out of step, and a motor at its limit: their angles are in the checkpoint."""
    made = alone(STEPS_ON, CONTROLLED, "run.print_step=0.4 ms")
    whole, provenance = lattice.solve(made), written_with
    with pytest.raises(Cut):
        lattice.solve(made, keep=Cutting(tmp_path / "c", provenance, 8))
    result = lattice.solve(made, keep=Cutting(tmp_path / "c", None, 100))
    assert bits(hdf5(result)) == bits(hdf5(whole)) and result.behind is not None


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("force", [1.0, 2.0, 4.0])
def test_a_retard_roller_holds_back_with_torque_over_radius(solver: str, force: float) -> None:
    """Whatever the force of the nip is, as long as its friction is more: it turns along and slips."""
    made = retarded(f"rollers.retard.press.preload={force} N")
    result = solved(made, solver)
    row = made.contacts.part_b.index("retard")
    assert result.contact_friction is not None
    late = result.time > 12.0
    pull = np.abs(result.contact_friction[late, row, RUBS]).mean()
    assert pull == pytest.approx(5.0 / 10.0, rel=0.01)
    assert result.contact_friction[late, row, GRIPS].mean() > 1.2 * pull
    assert spin(result, "retard")[-1] > 0.019


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_nip_on_a_shaft_slows_its_neighbour(solver: str) -> None:
    """The retard roller's 5 N mm, by equal radii 5 N mm at the feeding one, leave a motor of 20 N mm
    1 - 5/20 of its no-load speed; a roller that touches nothing turns with it, twice as fast."""
    spare = "{center: [90 mm, 0 mm, 30 mm], axis: y, radius: 8 mm, width: 16 mm, mass: 5 g}"
    motor = "{motor: {torque: 20 N*mm, speed: -30 rad/s}}"
    made = retarded(
        *("rollers.feed.drive=null", f"rollers.spare={spare}"),
        f"shafts={{main: {{rollers: {{feed: 1, spare: 2}}, drive: {motor}}}}}",
        *("run.duration=24 ms", "run.tolerance=0.01"),
    )
    result = solved(made, solver)
    late = result.time > 18.0
    assert spin(result, "feed")[late] == pytest.approx(-0.03 * (1.0 - 5.0 / 20.0), rel=0.01)
    assert spin(result, "spare") == pytest.approx(2.0 * spin(result, "feed"), rel=1e-9, abs=1e-12)


def test_a_strong_limiter_holds_the_note_and_the_lint_says_so() -> None:
    from mdlgen.checks import lints

    made = retarded("rollers.retard.limiter.torque=18 N*mm")
    assert [lint.code for lint in lints(made) if lint.code.startswith("W16")] == ["W161"]
    assert not [lint for lint in lints(retarded()) if lint.code.startswith("W16")]


@pytest.mark.parametrize(
    ("bearing", "says"),
    [
        ("torque: 7 N*mm", "5 N mm is not above the friction of its bearing, 7 N mm"),
        ("torque: 1 N*mm, drag: 300 N*mm*ms/rad", "at 13.33 rad/s at most, and its shaft has 20 rad/s"),
    ],
)
def test_a_limiter_that_does_not_turn_the_empty_roller_is_named(bearing: str, says: str) -> None:
    from mdlgen.checks import lints

    shaft = "rollers.retard.drive={speed: 20 rad/s}"
    found = lints(retarded(shaft, f"rollers.retard.bearing={{{bearing}}}"))
    assert says in next(lint.message for lint in found if lint.code == "W188")
    assert "W188" not in {lint.code for lint in lints(retarded(shaft))}


@pytest.mark.parametrize(
    ("overrides", "code"),
    [
        ([MOTOR, "rollers.feed.bearing={torque: 21 N*mm}"], "W160"),
        ([STEPPER.replace("600", "0") % "[[0 ms, 60 rad/s], [9 ms, 60 rad/s]]"], "W162"),
        (["shafts={main: {rollers: {feed: 1}, inertia: 3 g*mm^2}}"], "W163"),
        ([CONTROL.replace("speed: 100", "speed: 250")], "W164"),
    ],
)
def test_lints_of_drives(overrides: list[str], code: str) -> None:
    from mdlgen.checks import lints

    assert code in {lint.code for lint in lints(alone(*overrides))}


@pytest.mark.parametrize(
    ("override", "where", "what"),
    [
        ("rollers.feed.drive={motor: {torque: 1 N*mm}}", "rollers.feed.drive.motor", "no-load speed"),
        (
            "rollers.feed.drive={speed: 1 rad/s, motor: {torque: 1 N*mm, speed: 9 rad/s}}",
            "drive.speed",
            "voltage",
        ),
        ("rollers.feed.drive={motor: {torque: 1 N*mm, speed: 0 rad/s}}", "motor.speed", "other than 0"),
        ("rollers.feed.drive={motor: {table: [[1 rad/s, 1 N*mm], [2 rad/s, 0 N*mm]]}}", "table", "must be 0"),
        ("shafts={main: {rollers: {feed: 0}}}", "shafts.main.rollers.feed", "ratio is 0"),
        ("shafts={main: {rollers: {fed: 1}}}", "shafts.main.rollers.fed", "'feed'"),
        ("rollers.feed.limiter={torque: 0 N*mm}", "rollers.feed.limiter.torque", "0"),
        ("rollers.feed.limiter={torque: 1 N}", "rollers.feed.limiter.torque", "N*mm"),
    ],
)
def test_what_cannot_be_is_said_in_one_line(override: str, where: str, what: str) -> None:
    with pytest.raises(SpecError) as error:
        alone(override)
    assert where in str(error.value) and what in str(error.value) and "\n" not in str(error.value)
