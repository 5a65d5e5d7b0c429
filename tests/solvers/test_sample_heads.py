"""The head of a sample says what it shows; here is that it does, for those that no other test is about."""

from __future__ import annotations

import numpy as np
import pytest
import ran
from scipy.integrate import quad, solve_ivp
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.spec.load import load

G = 9.81e-3  # [mm/ms^2]


def solved(name: str, *sets: str) -> Result:
    return ran.solved(lower(load(samples() / f"{name}.yaml", sets)))


def force(result: Result, one: str, two: str) -> np.ndarray:
    """Of a contact of two parts over time [N]."""
    pairs = list(zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True))
    return np.asarray(result.contact_force[:, pairs.index((one, two))])


def along(result: Result, sheet: str) -> np.ndarray:
    """Place of a sheet's centre along x over time [mm]."""
    names = [part.name for part in result.model.sheets]
    return np.asarray(result.sheet_motion(names.index(sheet))[0][:, 0])


def test_each_note_of_a_stack_carries_what_lies_on_it() -> None:
    """And nothing creeps or gains energy."""
    result = solved("stack")
    weight = 0.72 * G
    for k in range(4):
        assert force(result, f"note_{k}", f"note_{k + 1}")[-1] == pytest.approx((4 - k) * weight, rel=1e-4)
    assert force(result, "note_0", "table")[-1] == pytest.approx(5 * weight, rel=1e-4)
    assert np.abs(result.position[-1, :60, :2] - result.position[0, :60, :2]).max() < 1e-9
    # lowered onto each other: from each note's depth upon depth, and no more
    energy = result.energy
    fallen = float(result.model.bodies.mass[:60] @ (result.position[0, :60, 2] - result.position[-1, :60, 2]))
    assert 0.0 < energy.elastic + energy.kinetic + energy.dissipated <= G * fallen * (1 + 1e-2)


def test_a_strip_stays_folded_where_a_rod_bent_it() -> None:
    """By the sum of what its joints keep; its wings swing about that. The elastic one swings about 0."""

    def opened(result: Result) -> np.ndarray:
        """Angle of the normals of the end boxes [deg]."""
        w, _, y, _ = result.rotation[:, [0, result.model.sheets[0].n_x - 1]].T
        return np.diff(np.degrees(2.0 * np.arctan2(y, w)), axis=0)[0]

    folded, elastic = solved("crease"), solved("crease", "materials.eur10.yield=null")
    kept = -np.degrees(30.0 * folded.summary()["sheets"]["strip"]["residual"]["curl_md_per_mm"])
    assert 30.0 < kept < 45.0
    late = folded.time > 7.0
    swing = opened(folded)[late]
    assert swing.min() > 0.0 and 0.5 * (swing.min() + swing.max()) == pytest.approx(kept, abs=5.0)
    assert opened(elastic)[elastic.time > 7.0].min() < -30.0
    assert folded.energy.plastic == pytest.approx(0.268, rel=0.02)


def test_a_roller_feeds_the_top_note_off_a_pile() -> None:
    """By the path of its surface, of which the ramp takes 5 ms. Each of the others slips on the next at less
    than the 1 mm/s over which friction changes its sign, since friction holds them."""
    result = solved("pile")
    end = float(result.time[-1])
    moved = [along(result, f"cassette_{k}")[-1] - along(result, f"cassette_{k}")[0] for k in range(1, 7)]
    assert moved[5] == pytest.approx(0.3 * (end - 5.0), rel=5e-3)
    assert 0.0 < moved[0] < 3e-3 * end and (np.diff(moved[:5]) > 0.0).all()
    assert (np.diff(moved[:5]) < 1e-3 * end).all()


def test_air_stops_a_note_that_lands() -> None:
    """Without air a box goes up at more than a third of the speed of a fall of 1 mm, 140 mm/s. With air the
    note sinks, and rocks at less than a twentieth of that."""
    fall = np.sqrt(2.0 * G * 1.0)
    up = []
    for sets in ((), ("contacts.landing.air=null",)):
        result = solved("landing", *sets)
        top = next(part for part in result.model.sheets if part.name == "top")
        up.append(float(result.velocity[:, top.first : top.first + top.count, 2].max()))
        assert abs(result.energy.balance_error) < 1e-2
    assert up[0] < fall / 20 and up[1] > fall / 3


def test_a_snatched_note_pulls_with_the_force_of_its_curve() -> None:
    """A simple wave runs from the edge that is held: v is the integral of c(eps) = sqrt(sigma'/rho) up to the
    strain behind it. The force there is its stress times the section, until the wave comes back."""
    result = solved("snatch")
    sheet, rho = result.model.sheets[0], 0.72 / (67.0 * 127.0 * 0.1)
    curve = load(samples() / "snatch.yaml").materials["invented"].curve_md
    assert curve is not None
    stress = PchipInterpolator(*np.array(curve.points).T)
    slope = stress.derivative()

    def speed(strain: float) -> float:
        return float(quad(lambda e: np.sqrt(slope(e) / rho), 0.0, strain, limit=200, epsabs=1e-6)[0])

    pulled = float(stress(brentq(lambda e: speed(e) - 12.0, 1e-4, 0.02))) * 127.0 * 0.1
    linear = 12.0 * np.sqrt(float(slope(0.0)) * rho) * 127.0 * 0.1
    assert pulled < 0.92 * linear
    own = slice(sheet.first, sheet.first + sheet.count)
    momentum = result.velocity[:, own, 0] @ result.model.bodies.mass[own]
    # a wave takes 33 us from edge to edge, and 10 boxes blur it
    first, last = (int(np.searchsorted(result.time, t - 1e-9)) for t in (0.01, 0.05))
    found = (momentum[first] - momentum[last]) / (result.time[last] - result.time[first])
    assert found == pytest.approx(pulled, rel=0.03)
    # the other edge moves on until the wave is there
    lead = result.anchor_motion(0)[0][:, 0]
    half = int(np.searchsorted(result.time, 0.016 - 1e-9))
    assert lead[half] - lead[0] == pytest.approx(12.0 * 0.016, rel=1e-3)


def test_a_block_tumbles_about_its_middle_axis() -> None:
    """It turns over, and over again; momentum and energy are those of the start."""
    result = solved("verify/flip")
    inertia, spin = result.model.bodies.inertia[0], result.spin[:, 0]
    turn = Rotation.from_quat(np.roll(result.rotation[:, 0], -1, axis=1))
    own = turn.inv().apply(spin)
    angular = turn.apply(inertia * own)
    assert np.abs(angular - angular[0]).max() < 1e-4 * np.linalg.norm(angular[0])
    energy = 0.5 * (own**2 @ inertia)
    assert energy == pytest.approx(np.full(len(energy), energy[0]), rel=1e-4)
    axis = turn.apply([1.0, 0.0, 0.0])[:, 0]
    sides = np.sign(axis[np.abs(axis) > 0.9])
    assert (np.diff(sides) != 0).sum() >= 1
    # Euler's equations by another integrator
    i1, i2, i3 = inertia
    exact = solve_ivp(
        lambda _, w: [
            (i2 - i3) * w[1] * w[2] / i1,
            (i3 - i1) * w[2] * w[0] / i2,
            (i1 - i2) * w[0] * w[1] / i3,
        ],
        (0.0, float(result.time[-1])),
        own[0],
        t_eval=result.time,
        rtol=1e-10,
        atol=1e-13,
    )
    assert np.abs(own - exact.y.T).max() < 1e-2 * np.linalg.norm(own[0])


def test_a_block_slides_down_its_slope() -> None:
    """With g (sin a - mu cos a) once it is faster than the smoothing of friction."""
    result = solved("verify/incline")
    exact = 9.81 * (np.sin(np.radians(20.0)) - 0.3 * np.cos(np.radians(20.0))) * 1e-3
    assert exact == pytest.approx(0.5897e-3, abs=5e-8)
    late = result.time >= 100.0
    speed = result.velocity[late, 0, 0]
    assert (speed[-1] - speed[0]) / (result.time[late][-1] - result.time[late][0]) == pytest.approx(
        exact, rel=1e-3
    )


def test_a_roller_with_flats_pulls_while_its_round_part_is_down() -> None:
    """At the speed of its surface, less the slip that friction of the note on the plate takes; over a flat it
    does not touch, and the note comes to the ramp, which lifts its edge."""
    result = solved("pick")
    lobe = next(mesh for mesh in result.model.meshes if mesh.name == "lobe")
    flat = float(np.abs(lobe.corners[:, 0]).max())
    edge = np.degrees(np.arctan2(flat, np.sqrt(7.5**2 - flat**2)))  # from the middle of the round part
    angle = np.degrees(result.model.roller("pick").turned(result.time)) % 180.0
    from_round = np.minimum(angle, 180.0 - angle)
    pressed = force(result, "note", "lobe")
    late = result.time > 10.0
    # it reaches 0.04 mm into the note: its edge is out of that so far past the middle
    out = np.degrees(np.arccos(1.0 - 0.04 / 7.5))
    down, over = late & (from_round < edge - out), late & (from_round > edge + out)
    assert down.sum() > 50 and over.sum() > 20
    assert (pressed[down] > 0.2).all() and (pressed[over] == 0.0).all()
    speed = result.sheet_motion(0)[1][:, 0]
    assert speed[down] == pytest.approx(np.full(down.sum(), 0.06 * 7.5), rel=0.01)
    assert (np.diff(speed[over & (result.time < 34.0)]) < 0.0).all()
    assert result.anchor_motion(0)[0][-1, 2] > 1.0


def test_the_lower_of_two_notes_is_held_at_the_pad_and_follows() -> None:
    result = solved("retard_pad")
    time, upper, lower_ = result.time, along(result, "note_2"), along(result, "note_1")

    def between(begin: float, end: float) -> np.ndarray:
        return np.asarray((time >= begin) & (time <= end))

    # the upper one goes with the rollers' surfaces, from the ramp to its leaving
    way = between(20.0, 170.0)
    assert np.ptp(upper[way]) == pytest.approx(0.5 * 150.0, rel=0.01)
    # the lower one with it, as far as the line where the pad presses, and is held there
    assert np.ptp(lower_[between(10.0, 30.0)]) == pytest.approx(0.5 * 20.0, rel=0.01)
    held = between(60.0, 88.0)
    assert lower_[held] + 33.5 == pytest.approx(np.full(held.sum(), 12.0), abs=1.0)
    assert np.ptp(lower_[held]) < 0.01 * np.ptp(upper[held]) + 0.2
    left = next(
        event["time_ms"]
        for event in result.summary()["events"]
        if (event["kind"], event["sheet"], event["roller"]) == ("leave", "note_2", "feed")
    )
    follows = between(left + 5.0, left + 65.0)
    assert np.ptp(lower_[follows]) == pytest.approx(0.5 * 60.0, rel=0.02)
    assert lower_[-1] - 33.5 > 12.0 + 10.0  # it is out
    # pick roller and pad are down: spring and weight, less what the spring gives over the depth
    for one, two, pushed in (("pick", "table", 0.4 + 10.01 * G), ("feed", "pad", 0.6 - 2.0 * G)):
        found = float(force(result, one, two)[-1])
        assert found == pytest.approx(pushed - 0.1 * (found / 300.0) ** (2 / 3), rel=2e-3)


def test_a_second_guide_that_is_lower_is_no_edge() -> None:
    """The other form that the head of guide_joint names; the first is in test_edges."""
    sets = [f"guides.guide_2.line.{end}.2=-0.16 mm" for end in ("from", "to")]
    result = mdlgen.solve(lower(load(samples() / "guide_joint.yaml", sets)), "lattice")
    assert result.usable, result.status
    assert "stub" not in {event["kind"] for event in result.summary()["events"]}
    assert result.anchor_motion(0)[0][-1, 0] > 2.5


def test_notes_of_a_stream_come_and_go() -> None:
    """One every 60 ms, gone after 107 ms, two at most at a time, each up to 1 degree askew."""
    result = solved("stream")
    assert result.ok and all(outcome.passed for outcome in result.verdict)
    assert result.stays is not None
    came, left = result.stays.T
    assert came.tolist() == [0.0, 60.0, 120.0]
    # 149.5 mm at 1400 mm/s, and what the nips make of that
    assert np.abs(left - came - 107.0).max() < 1.0
    there = (result.time[:, None] >= came) & (result.time[:, None] < left)
    assert there.sum(axis=1).max() == 2
    skew = np.degrees([sheet.angles[2] for sheet in result.model.sheets])
    assert np.abs(skew).max() <= 1.0 and len(set(skew)) == 3
    for k, sheet in enumerate(result.model.sheets):
        boxes = slice(sheet.first, sheet.first + sheet.count)
        edge = (result.position[-1, boxes, 0] - result.model.bodies.half[boxes, 0]).min()
        assert left[k] < 230.0 and edge > 80.0 - 0.3  # half a box's length, seen askew
