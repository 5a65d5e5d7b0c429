"""Planes, guides and meshes that turn about a pivot or slide, against closed forms, in both solvers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from gate_scenes import FLOOR, GUIDE, HEAD, LIFT, SOLVERS, G, angle, ease, model
from ran import solved
from solids import binary, prism

from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.summary import summary
from mdlgen.spec.load import load, loads


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
        (
            (
                "sheets.lies={material: paper, size: [20 mm, 20 mm], thickness: 0.1 mm, mass: 0.1 g, "
                "boxes: [4, 4], center: [20 mm, 0 mm, 4 mm]}",
            ),
            "W187",
        ),
        (("guides.gate.line.side=right",), "W186"),
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


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_flexible_sheet_is_lifted_as_a_whole(solver: str):
    block = (
        "size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],\n"
        "    center: [0 mm, 0 mm, 0.497873 mm]"
    )
    note = (
        "size: [67 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [4, 2], center: [0 mm, 0 mm, 0.0505 mm]"
    )
    text = LIFT.replace(block, note).replace("duration: 40 ms", "duration: 30 ms")
    result = solved(model(text), solver)
    way, rise = ease(result.time, 10.0, 5.0, 100.0)
    boxes = result.position[-1, :8, 2]
    assert np.ptp(boxes) < 1e-4
    # its depth differs by 1 um from that at the start
    assert boxes == pytest.approx(0.0499 + way[-1], abs=1e-3)
    # 2 %: it still rings from the jump of the acceleration, which the dampers of joints do not brake
    assert result.contact_force[-1, 0] == pytest.approx(0.3 * (G + rise[-1]), rel=0.02)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_free_roller_on_a_plane_that_slides_turns_with_it(solver: str):
    roller = """rollers:
  free: {center: [60 mm, 0 mm, 5 mm], axis: y, radius: 5 mm, width: 10 mm, mass: 2 g,
    press: {direction: -z, stiffness: 0.1 N/mm, preload: 0.5 N}}
planes:"""
    contact = (
        "  roll: {between: [free, sled], stiffness: 100 N/mm^1.5, friction: 0.5, smoothing: 1 mm/s}\nrun: "
    )
    text = CARRY.replace("SPAN", "158 ms").replace("planes:", roller).replace("run: ", contact)
    result = solved(model(text), solver)
    s = result.time / 158.0
    speed = 10.0 / 158.0 * 6.0 * s * (1.0 - s)
    # -y: the surface below it moves along +x; it slips by less than the smoothing
    assert -5.0 * result.spin[:, 1, 1] == pytest.approx(speed, abs=1e-3)


def test_a_static_analysis_refuses_a_part_that_moves_by_name():
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
