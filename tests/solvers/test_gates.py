"""Planes, guides and meshes that turn about a pivot or slide, against closed forms, in both solvers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from ran import solved
from scipy.integrate import solve_ivp
from solids import binary, prism

from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.results.gates import place
from mdlgen.results.result import Result
from mdlgen.results.summary import summary
from mdlgen.spec.load import load, loads

SOLVERS = ("lattice", "exudyn")
G = 9.81e-3  # mm/ms^2
HEAD = """
name: gate
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {paper: {E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 1 N*mm, D_cd: 1 N*mm}}
sheets:
  block: {material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 0 mm, 0.497873 mm]}
"""
# k z^1.5 = m g: a block of 1 g lies 2.1 um deep on a plane of 100 N/mm^1.5
FLOOR = """
contacts:
  floor: {between: [block, PLATE], stiffness: 100 N/mm^1.5, restitution: 0.3, friction: 0.3,
    smoothing: 1 mm/s}
"""
LIFT = (
    HEAD
    + """
planes:
  lift: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [100 mm, 100 mm, 10 mm], slide: {direction: z,
    positions: {up: 10 mm}, profile: [[0 ms, 0 mm], [5 ms, 0 mm], [105 ms, up]]}}
"""
    + FLOOR.replace("PLATE", "lift")
    + "run: {duration: 40 ms, step: 0.5 ms, print_step: 5 ms}\n"
)
GUIDE = """
guides:
  flap: {line: {from: [0 mm, 0 mm, 0 mm], to: [60 mm, 0 mm, 0 mm], axis: -y, side: left}, width: 40 mm,
    thickness: 2 mm, mass: 4 g, pivot: {at: [0 mm, 0 mm, 0 mm], axis: y, inertia: 4800 g*mm^2,
      stiffness: 30 N*mm/rad}}
"""


def model(text: str, *overrides: str) -> Model:
    return lower(loads(text, overrides=overrides))


def angle(result: Result, index: int = 0) -> np.ndarray:
    """Place of a moving part over time."""
    part, _ = result.model.gates[index]
    found = place(result, part)
    assert found is not None
    return found


def ease(t: np.ndarray, way: float, begin: float, span: float) -> tuple[np.ndarray, np.ndarray]:
    """Place and acceleration of the law between two corners."""
    s = np.clip((t - begin) / span, 0.0, 1.0)
    inside = (t >= begin) & (t <= begin + span)
    return way * s * s * (3.0 - 2.0 * s), np.where(inside, way / span**2 * (6.0 - 12.0 * s), 0.0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_what_lies_on_a_plane_rises_with_it(solver: str):
    result = solved(model(LIFT), solver)
    assert result.status == "ok"
    way, rise = ease(result.time, 10.0, 5.0, 100.0)
    # the plane is on its law to round-off
    assert angle(result) == pytest.approx(way, abs=1e-11)
    # the block is a depth above it that changes by 0.7 um with the force
    height = result.position[:, 0, 2] - result.position[0, 0, 2]
    assert height == pytest.approx(way, abs=1.5e-3)
    # 1 %: at the jump of the acceleration the block rings, and its contact damps that
    late = result.time > 15.0
    assert result.contact_force[late, 0] == pytest.approx((G + rise)[late], rel=0.01)
    # the plane's work is what the block has now
    assert result.energy.driven == pytest.approx(
        G * height[-1] + 0.5 * float(result.velocity[-1, 0, 2]) ** 2, rel=2e-3
    )
    assert abs(result.energy.balance_error) < 2e-3


TILT = (
    HEAD
    + """
planes:
  ramp: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 100 mm, 10 mm], pivot: {
    at: [0 mm, 0 mm, 0 mm], axis: y, positions: {steep: 20 deg}, profile: [[0 ms, 0 deg], [400 ms, steep]]}}
"""
    + FLOOR.replace("PLATE", "ramp")
    + "run: {duration: 500 ms, step: 1 ms, print_step: 10 ms}\n"
)


def test_it_is_of_second_order_in_the_step():
    sets = ("contacts.floor.friction=0", "run.duration=100 ms")
    ends = [
        solved(model(TILT, f"run.step={step} ms", *sets), "lattice").position[-1, 0, 0]
        for step in (2.0, 1.0, 0.5, 0.0625)
    ]
    off = np.abs(np.array(ends[:3]) - ends[3])
    # a quarter for half of the step; the finest one has 1/256 of the first one's error left
    assert off[:2] / off[1:] == pytest.approx(4.0, rel=0.1)
    assert off[0] < 1e-3


@pytest.mark.parametrize("mu", [0.2, 0.3])
def test_a_block_slides_off_a_plane_that_tilts_beyond_the_angle_of_friction(mu: float):
    result = solved(model(TILT, f"contacts.floor.friction={mu}"), "lattice")
    assert result.status == "ok"
    turned = angle(result)
    along = np.stack([np.cos(turned), np.zeros_like(turned), -np.sin(turned)], axis=1)
    part, _ = result.model.gates[0]
    arm = result.position[:, 0] - result.position[:, part.body]
    place_on = np.einsum("ti,ti->t", arm, along)
    speed = np.gradient(place_on, result.time)
    # friction is smoothed over 1 mm/s: up to the angle of friction it creeps by less than that
    critical = math.atan(mu)
    assert np.abs(speed[turned < 0.97 * critical]).max() < 1e-3
    # from there on it slides with g (sin - mu cos); the plane stands at 20 deg from 400 ms on
    expected = G * (math.sin(math.radians(20.0)) - mu * math.cos(math.radians(20.0)))
    late = result.time > 420.0
    assert np.gradient(speed, result.time)[late][:-2] == pytest.approx(expected, rel=1e-3)


CARRY = (
    HEAD
    + """
planes:
  sled: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 100 mm, 10 mm], slide: {direction: x,
    profile: [[0 ms, 0 mm], [SPAN, 10 mm]]}}
"""
    + FLOOR.replace("PLATE", "sled")
    + "run: {duration: 120 ms, step: 0.5 ms, print_step: 2 ms}\n"
)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_plane_carries_a_sheet_along_below_mu_g_and_slips_beyond(solver: str):
    # the greatest acceleration is 6 way / span^2: 0.0024 and 0.0067 mm/ms^2, mu g is 0.0029
    carried = solved(model(CARRY.replace("SPAN", "158 ms")), solver)
    way, _ = ease(carried.time, 10.0, 0.0, 158.0)
    # it lags by less than the speed of smoothing
    assert carried.position[:, 0, 0] == pytest.approx(way, abs=0.05)
    left = solved(model(CARRY.replace("SPAN", "95 ms")), solver)
    way, _ = ease(left.time, 10.0, 0.0, 95.0)
    early = left.time <= 20.0
    # it slips from the start, with mu g
    assert left.position[early, 0, 0] == pytest.approx(0.5 * 0.3 * G * left.time[early] ** 2, abs=0.02)
    assert (way - left.position[:, 0, 0]).max() > 0.5


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_flap_swings_at_its_own_frequency(solver: str):
    text = HEAD.replace("-9.81", "0") + GUIDE + FLOOR.replace("PLATE", "flap")
    text += "run: {duration: 120 ms, step: 0.25 ms, print_step: 0.5 ms, prune: false}\n"
    # its spring pushes it to 0.1 rad
    swung = model(text, "guides.flap.pivot.torque=3 N*mm", "sheets.block.center=[30 mm, 0 mm, 200 mm]")
    result = solved(swung, solver)
    omega = math.sqrt(30.0 / 4800.0)
    # a step of 0.25 ms changes the period by (omega dt)^2/24, 2e-5
    assert angle(result) == pytest.approx(0.1 * (1.0 - np.cos(omega * result.time)), abs=2e-4)
    assert abs(result.energy.balance_error) < 1e-3


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_sheet_that_lies_on_a_flap_opens_it_by_torque_over_stiffness(solver: str):
    text = HEAD + GUIDE + FLOOR.replace("PLATE", "flap")
    text += "run: {duration: 150 ms, step: 0.5 ms, print_step: 5 ms}\n"
    rest = model(
        text,
        "guides.flap.pivot.damping=600 N*mm*ms/rad",
        "sheets.block.center=[30 mm, 0 mm, 0.497873 mm]",
    )
    result = solved(rest, solver)
    # m g x cos(angle) = k angle, x along the flap; about y a weight at +x turns it with a positive angle
    assert angle(result)[-1] == pytest.approx(G * 30.0 / 30.0, rel=0.02)
    # the weight of the flap itself, with its center
    heavy = solved(
        model(
            text,
            "guides.flap.pivot.damping=600 N*mm*ms/rad",
            "guides.flap.pivot.center=[30 mm, 0 mm, 0 mm]",
            "sheets.block.center=[30 mm, 0 mm, 300 mm]",
            "run.prune=false",
        ),
        solver,
    )
    assert angle(heavy)[-1] == pytest.approx(4.0 * G * 30.0 / 30.0, rel=0.02)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_stop_returns_a_flap_with_its_restitution(solver: str):
    text = HEAD.replace("-9.81", "0") + GUIDE + FLOOR.replace("PLATE", "flap")
    text += "run: {duration: 110 ms, step: 0.05 ms, print_step: 0.5 ms, prune: false}\n"
    # a constant torque turns it from 0 to the stop at 0.05 rad, and on its way back brakes it
    hit = model(
        text,
        "guides.flap.pivot.stiffness=0 N*mm/rad",
        "guides.flap.pivot.torque=0.1 N*mm",
        "guides.flap.pivot.stops={low: 0 rad, high: 0.05 rad, stiffness: 20000 N*mm/rad, restitution: 0.6}",
        "sheets.block.center=[30 mm, 0 mm, 200 mm]",
    )
    result = solved(hit, solver)
    turned, acceleration = angle(result), 0.1 / 4800.0
    # at the stop after sqrt(2 way / a), then back by e^2 of the way
    first = math.sqrt(2.0 * 0.05 / acceleration)
    after = result.time > first + 3.0
    until = result.time < first + 1.1 * 0.6 * first
    assert turned.max() == pytest.approx(0.05, abs=0.003)
    assert 0.05 - turned[after & until].min() == pytest.approx(0.36 * 0.05, rel=0.05)
    assert abs(result.energy.balance_error) < 5e-3


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_guide_that_turns_lifts_a_block_that_friction_holds(solver: str):
    turns = "pivot: {at: [0 mm, 0 mm, 0 mm], axis: y, profile: [[0 ms, 0 deg], [60 ms, -8 deg]]}}"
    text = HEAD + GUIDE[: GUIDE.index("pivot:")] + turns + FLOOR.replace("PLATE", "flap")
    text += "run: {duration: 70 ms, step: 0.25 ms, print_step: 2 ms}\n"
    sets = ("sheets.block.center=[30 mm, 0 mm, 0.497873 mm]", "contacts.floor.friction=0.9")
    result = solved(model(text, *sets), solver)
    turned = angle(result)
    way, _ = ease(result.time, math.radians(-8.0), 0.0, 60.0)
    assert turned == pytest.approx(way, abs=1e-9)
    # what is at (30, 0.5) turns about the pivot; 0.02 mm: it creeps at a part of the speed of smoothing
    arm = result.position[0, 0, [0, 2]]
    z = arm[1] * np.cos(turned) - arm[0] * np.sin(turned)
    assert result.position[:, 0, 2] == pytest.approx(z, abs=0.02)
    assert abs(result.energy.balance_error) < 2e-3
    # the energy that it has gained is the work of the motion, less what friction took
    lifted = G * (z[-1] - z[0])
    assert result.energy.driven - result.energy.dissipated == pytest.approx(lifted, rel=0.02)


@pytest.mark.parametrize("solver", SOLVERS)
def test_meshes_move_as_planes_do(solver: str, tmp_path: Path):
    (tmp_path / "lift.stl").write_bytes(binary(*prism([(-30, -10), (30, -10), (30, 0), (-30, 0)], 60)))
    text = LIFT[: LIFT.index("planes:")] + LIFT[LIFT.index("contacts:") :]
    text += "meshes: {lift: {file: lift.stl, slide: SLIDE}}\n"
    slide = "{direction: z, profile: [[0 ms, 0 mm], [5 ms, 0 mm], [105 ms, 10 mm]]}"
    lifted = lower(loads(text.replace("SLIDE", slide), folder=tmp_path))
    result = solved(lifted, solver)
    way, rise = ease(result.time, 10.0, 5.0, 100.0)
    height = result.position[:, 0, 2] - result.position[0, 0, 2]
    assert height == pytest.approx(way, abs=0.02)
    late = result.time > 20.0
    assert result.contact_force[late, 0] == pytest.approx((G + rise)[late], rel=0.02)
    assert abs(result.energy.balance_error) < 2e-3
    # a free one on a spring: k way = m g
    spring = (
        "{direction: z, mass: 5 g, stiffness: 0.08 N/mm, force: 0.04905 N, damping: 0.8 N*ms/mm, "
        "stops: {low: -5 mm, high: 5 mm, stiffness: 9 N/mm}}"
    )
    text = text.replace("SLIDE", spring)
    sunk = solved(lower(loads(text, overrides=["run.duration=120 ms"], folder=tmp_path)), solver)
    assert angle(sunk)[-1] == pytest.approx(-G / 0.08, rel=0.01)


def test_each_group_has_the_work_of_its_own_gates():
    other = "other: {center: [300 mm, 0 mm, -5 mm], normal: z, size: [60 mm, 60 mm, 10 mm]}"
    sets = (
        f"planes.{other.split(':', 1)[0]}={other.split(': ', 1)[1]}",
        "sheets.more={material: paper, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1], "
        "center: [300 mm, 0 mm, 0.497873 mm]}",
        "contacts.more={between: [more, other], stiffness: 100 N/mm^1.5, friction: 0.3, smoothing: 1 mm/s}",
    )
    alone, both = solved(model(LIFT), "lattice"), solved(model(LIFT, *sets), "lattice")
    assert both.energy.driven == pytest.approx(alone.energy.driven, rel=1e-6)
    assert abs(both.energy.balance_error) < 2e-3


def test_the_summary_has_its_place_and_a_requirement_may_name_it():
    rising = model(LIFT, 'require=["planes.lift.slide above 3 mm", "planes.lift.slide above 9 mm"]')
    result = solved(rising, "lattice")
    record = summary(result)["planes"]["lift"]
    way, _ = ease(result.time, 10.0, 5.0, 100.0)
    assert record["slide_mm"] == pytest.approx(way[-1], abs=1e-9)
    assert (record["min_slide_mm"], record["max_slide_mm"]) == pytest.approx((0.0, way[-1]), abs=1e-9)


GATE = "guides.gate.pivot"


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        (("rollers.counter.center=[30 mm, 0 mm, 8 mm]",), "W173"),
        ((f"{GATE}.positions={{closed: 0 deg, open: 20 deg, wide: 40 deg}}",), "W174"),
        ((f"{GATE}.profile=[[0 ms, closed], [190 ms, open]]",), "W175"),
        ((f"{GATE}={{at: [2 mm, 0 mm, -0.7 mm], axis: -y, inertia: 9 g*mm^2, torque: 1 N*mm}}",), "W176"),
        (
            (
                f"{GATE}={{at: [2 mm, 0 mm, -0.7 mm], axis: -y, inertia: 9 g*mm^2, torque: 1 N*mm, "
                "stops: {low: 0 deg, high: 2 deg, stiffness: 9 N*mm/rad}}",
            ),
            "W177",
        ),
    ],
)
def test_lints_name_what_is_probably_wrong(changes: tuple[str, ...], code: str):
    sample = samples() / "diverter.yaml"
    known = {lint.code for lint in lints(lower(load(sample)))}
    found = {lint.code for lint in lints(lower(load(sample, changes)))}
    assert code not in known
    assert code in found


def test_the_sample_sends_the_first_note_straight_on_and_the_second_one_up():
    sample = samples() / "diverter.yaml"
    result = solved(lower(load(sample, ("run.step=0.125 ms",))), "lattice")
    first, second = (result.sheet_motion(k)[0] for k in (0, 1))
    gate = angle(result)
    # the first note has left the gate, which ends at 32 mm, before that moves, and the second one comes later
    k = int(np.abs(result.time - 80.0).argmin())
    assert first[k, 0] - 20.0 > 32.0 and second[k, 0] + 20.0 < 2.0
    assert np.degrees(gate[[0, k, -1]]) == pytest.approx((0.0, 0.0, 20.0), abs=1e-9)
    assert abs(first[-1, 2]) < 1.0 and first[-1, 0] > 100.0
    assert second[-1, 2] > 10.0 and second[-1, 0] > 40.0


ENDS = """
rollers:
  bob: {center: [4 mm, 3 mm, 60 mm], axis: y, radius: 20 mm, width: 20 mm, mass: 10 g, MOTION}
planes:
  far: {center: [0 mm, 0 mm, -99 mm], normal: z, size: [10 mm, 10 mm, 1 mm]}
"""
STOPPED = "stops: {low: -1 mm, high: 2 mm, stiffness: 40 N/mm, restitution: 0.5}"


@pytest.mark.parametrize("solver", SOLVERS)
def test_presses_and_arms_have_stops_too(solver: str):
    text = HEAD.replace("-9.81", "0") + ENDS + FLOOR.replace("PLATE", "far")
    text += "run: {duration: 50 ms, step: 0.05 ms, print_step: 1 ms, prune: false}\n"
    press = f"press: {{direction: x, stiffness: 0.02 N/mm, preload: 0.1 N, {STOPPED}}}"
    pressed = solved(model(text.replace("MOTION", press)), solver)
    # the spring holds it on the stop, where it begins; it yields by force over stiffness
    way = pressed.position[:, 1, 0] - 4.0
    depth = (0.1 - 0.02 * 2.0) / 40.0
    assert way[0] == pytest.approx(2.0, abs=1e-12)
    assert way[-1] == pytest.approx(2.0 + depth, abs=0.2 * depth)
    arm = "arm: {pivot: [0 mm, 0 mm, 0 mm], mass: 20 g, torque: 80 N*mm, STOPS}"
    stops = "stops: {low: -0.01 rad, high: 0.05 rad, stiffness: 200000 N*mm/rad, restitution: 0.5}"
    swung = solved(model(text.replace("MOTION", arm.replace("STOPS", stops))), solver)
    turned = np.arctan2(swung.position[:, 1, 0], swung.position[:, 1, 2])
    inertia = swung.model.rollers[0].swung_inertia

    def rates(_: float, state: np.ndarray) -> list[float]:
        # Eq. 11 with a sharp sign, beta = (1 - 1/4)/(1 + 1/4)
        deep = max(state[0] - 0.05, 0.0)
        return [state[1], (80.0 - 2e5 * deep * (1.0 + 0.6 * np.sign(state[1]))) / inertia]

    expected = solve_ivp(rates, (0.0, 50.0), (0.0, 0.0), t_eval=swung.time, max_step=0.02).y[0]
    assert expected.max() > 0.05 and expected[11:18].min() < 0.045
    assert turned - turned[0] == pytest.approx(expected, abs=4e-4)
    for name in ("motionview", "motionsolve", "msolve"):
        with pytest.raises(RefusedError, match="the press of bob has stops"):
            emitter(name).emit(pressed.model)


def test_text_deck_and_script_refuse_what_moves_by_name():
    for name in ("motionview", "motionsolve", "msolve"):
        with pytest.raises(RefusedError, match="lift has a slide"):
            emitter(name).emit(model(LIFT))
    with pytest.raises(RefusedError, match=r"static analysis with a part that moves \(lift\)"):
        solved(model(LIFT, "run.analysis=static"), "lattice")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("planes.lift.slide.profile=[[0 ms, up], [9 ms, up]]", "begins at 10 mm; allowed: 0"),
        ("planes.lift.slide.profile=[[0 ms, 0 mm], [9 ms, on]]", "'on' is no name of positions"),
        ("planes.lift.slide.profile=[[5 ms, 0 mm], [5 ms, up]]", "5 ms is not above"),
        ("planes.lift.slide.mass=1 g", "profile prescribes the motion, mass lets forces"),
        ("planes.lift.slide.stiffness=1 N/mm", "which needs mass"),
        ("planes.lift.pivot={at: [0 mm, 0 mm, 0 mm], axis: y, inertia: 1 g*mm^2}", "a pivot or a slide"),
        ("planes.lift.press={direction: z, stiffness: 1 N/mm, preload: 1 N}", "give it no slide"),
        ("planes.lift.repeat={count: 2, step: [0 mm, 0 mm, 30 mm]}", "give it no slide"),
    ],
)
def test_what_no_motion_can_have_is_refused(change: str, message: str):
    with pytest.raises(SpecError) as caught:
        loads(LIFT, overrides=[change, *(["planes.lift.mass=1 g"] if "press" in change else [])])
    assert message in str(caught.value)
