"""Runs with friction as it is measured, in both solvers: a block on a plane against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.bench.oracles import rubbing
from mdlgen.results.result import Result

G = 9.81e-3  # [mm/ms^2]
SPEED = 1.5  # [mm/ms]
BOTH = pytest.mark.parametrize("solver", ["lattice", "exudyn"])
# of speeds, relative to that at the start: friction over a smoothing of 1 mm/s, and a run's own tolerance
WITHIN = 1e-3


def slides(friction: object, solver: str = "lattice", **over: Any) -> Result:
    """The block of verify/slide over 40 ms; in exudyn over 20, in steps whose half is 5e-4 of that."""
    scene = mdlgen.load("samples/verify/slide.yaml")
    given = {key.replace("__", "."): value for key, value in over.items()}
    run = (
        {"run.duration": "20 ms", "run.step": "0.02 ms"} if solver == "exudyn" else {"run.duration": "40 ms"}
    )
    scene = scene.with_({"contacts.0.friction": friction, **run, **given})
    result = mdlgen.solve(mdlgen.lower(scene), solver)
    assert as_asked(result), result.status
    return result


def on_a_slope(angle: float, axis: int) -> dict[str, Any]:
    """Gravity of a slope [rad] down along an axis, and the block at rest on it, as deep as it presses."""
    down = [0.0, 0.0, -9.81 * math.cos(angle)]
    down[axis] = 9.81 * math.sin(angle)
    sunk = (10.0 * G * math.cos(angle) / 1000.0) ** (2 / 3)
    return {
        "gravity": [f"{g!r} m/s^2" for g in down],
        "sheets__block__velocity": ["0 m/s", "0 m/s", "0 m/s"],
        "sheets__block__center": ["-400 mm", "0 mm", f"{5.0 - sunk!r} mm"],
    }


def mean(result: Result) -> float:
    """Coefficient of friction over the run, by the speed that is lost."""
    lost = float(np.linalg.norm(result.velocity[0, 0]) - np.linalg.norm(result.velocity[-1, 0]))
    return lost / (G * float(result.time[-1]))


@BOTH
@pytest.mark.parametrize("angle", [0.0, 45.0, 90.0])
def test_friction_goes_with_the_direction_of_the_sheet(solver: str, angle: float) -> None:
    """At an angle to MD, the block turned by 30 degrees on the plane."""
    way = math.radians(30.0 + angle)
    velocity = [f"{SPEED * math.cos(way)!r} m/s", f"{SPEED * math.sin(way)!r} m/s", "0 m/s"]
    over: dict[str, Any] = {"sheets__block__turn": "30 deg", "sheets__block__velocity": velocity}
    result = slides({"md": 0.2, "cd": 0.5}, solver, **over)
    start = SPEED * math.cos(math.radians(angle)), SPEED * math.sin(math.radians(angle))
    _, exact = rubbing.aslant(start, (0.2, 0.5), G, float(result.time[-1]))
    found = result.velocity[-1, 0] @ result.model.sheets[0].rotation
    assert found[:2] == pytest.approx(exact, abs=WITHIN * SPEED)


@BOTH
@pytest.mark.parametrize(("turn", "mu"), [(0.0, 0.2), (180.0, 0.4)])
def test_each_face_has_its_friction(solver: str, turn: float, mu: float) -> None:
    over: dict[str, Any] = {"sheets__block__rotation": [f"{turn} deg", "0 deg", "0 deg"]}
    result = slides({"front": 0.4, "back": 0.2}, solver, **over)
    assert mean(result) == pytest.approx(mu, rel=WITHIN)


@BOTH
def test_a_block_slows_down_over_a_stribeck_curve(solver: str) -> None:
    result = slides({"static": 0.8, "kinetic": 0.2, "stribeck_velocity": "1.2 m/s"}, solver)

    def mu(v: float) -> float:
        return 0.2 + 0.6 * math.exp(-(((v - 1e-3) / 1.2) ** 2))

    _, speed = rubbing.over_speeds(SPEED, mu, G, float(result.time[-1]))
    assert result.velocity[-1, 0, 0] == pytest.approx(speed, abs=WITHIN * SPEED)


@BOTH
def test_a_table_is_followed_in_times_of_its_first_coefficient_by_direction(solver: str) -> None:
    rows = [["1 mm/s", 0.4], ["1.3 m/s", 0.4], ["1.4 m/s", 0.2]]
    over: dict[str, Any] = {"sheets__block__velocity": ["0 m/s", "1.5 m/s", "0 m/s"]}
    result = slides({"md": 0.2, "cd": 0.5, "speed": rows}, solver, **over)
    # half of 0.5 above 1.4 m/s of the slip that is stretched by 0.5/0.2: all the way
    assert mean(result) == pytest.approx(0.25, rel=WITHIN)


@BOTH
def test_a_heavy_block_has_less_friction_by_its_pressure(solver: str) -> None:
    """The ratio of two weights of 1 and 4 is 4^n."""
    found = []
    for mass in (10.0, 40.0):
        sunk = (mass * G / 1000) ** (2 / 3)
        over: dict[str, Any] = {
            "sheets__block__mass": f"{mass} g",
            "sheets__block__center": ["-400 mm", "0 mm", f"{5.0 - sunk!r} mm"],
        }
        at = f"{10.0 * G / 400.0!r} MPa"
        found.append(mean(slides({"mu": 0.3, "pressure": {"at": at, "exponent": -0.25}}, solver, **over)))
    assert found[0] == pytest.approx(0.3, rel=WITHIN)
    assert found[1] / found[0] == pytest.approx(4.0**-0.25, rel=WITHIN)


@BOTH
def test_a_large_block_has_the_mean_of_what_scatters(solver: str) -> None:
    """200 x 200 mm have some 1400 independent places of 3 mm: three standard deviations are 1.6 %."""
    scatter = {"deviation": "20 %", "length": "3 mm", "seed": 5}
    result = slides({"mu": 0.3, "scatter": scatter}, solver, sheets__block__size=["200 mm", "200 mm"])
    assert mean(result) == pytest.approx(0.3, rel=0.016)
    assert mean(result) != pytest.approx(0.3, rel=1e-5), "it is drawn, not the mean"


@pytest.mark.parametrize("turn", [0.0, 180.0])
def test_friction_that_sticks_holds_by_the_face(turn: float) -> None:
    """On a slope of 0.3 a block stays on its front, of 0.4, and slides on its back, of 0.2."""
    slope = math.atan(0.3)
    over = {"sheets__block__rotation": [f"{turn} deg", "0 deg", "0 deg"], **on_a_slope(slope, 0)}
    result = slides({"front": 0.4, "back": 0.2, "sticking": "40 N/mm"}, **over)
    moved = float(result.position[-1, 0, 0] - result.position[0, 0, 0])
    if turn == 180.0:
        assert moved == pytest.approx(0.0, abs=0.01)
    else:
        # it swings on its spring, by omega = 2 rad/ms, to where that has the limit, and slides from there
        pulled, limit, omega = G * math.sin(slope), 0.2 * G * math.cos(slope), 2.0
        turn = math.acos(1.0 - limit / pulled)
        left = 40.0 - turn / omega
        exact = limit / omega**2 + pulled / omega * math.sin(turn) * left + 0.5 * (pulled - limit) * left**2
        assert moved == pytest.approx(exact, rel=5e-3)


@BOTH
def test_friction_that_sticks_slides_by_its_curve_over_the_speed(solver: str) -> None:
    friction = {"static": 0.8, "kinetic": 0.2, "stribeck_velocity": "1.2 m/s", "sticking": "40 N/mm"}
    result = slides(friction, solver, run__duration="20 ms", run__step="0.02 ms")

    def mu(v: float) -> float:
        return 0.2 + 0.6 * math.exp(-(((v - 1e-3) / 1.2) ** 2))

    _, speed = rubbing.over_speeds(SPEED, mu, G, float(result.time[-1]))
    # its spring is stretched first, over mu N/k_t = 0.5 um
    assert result.velocity[-1, 0, 0] == pytest.approx(speed, abs=2.0 * WITHIN * SPEED)


@BOTH
def test_friction_that_sticks_holds_by_the_first_number_of_its_table(solver: str) -> None:
    """On a slope of 0.3: with 0.4 at rest it stays, though it is 0.1 at 5 mm/s."""
    table = {"speed": [["1 mm/s", 0.4], ["5 mm/s", 0.1]], "sticking": "400 N/mm"}
    over = {**on_a_slope(math.atan(0.3), 0), "run__step": "0.05 ms", "run__duration": "20 ms"}
    x = slides(table, solver, **over).position[:, 0, 0]
    assert np.ptp(x) < 0.01


@BOTH
@pytest.mark.parametrize(("seed", "stays"), [(1, False), (2, True)])
def test_friction_that_sticks_scatters_by_the_place(solver: str, seed: int, stays: bool) -> None:
    """One seed gives more than 0.3, the other one less: on a slope of 0.3 the block stays, or slides."""
    friction = {"mu": 0.3, "scatter": {"deviation": "30 %", "length": "40 mm", "seed": seed}}
    run = {"run__duration": "5 ms", "run__step": "0.02 ms", "run__tolerance": 0.01}
    assert (mean(slides(friction, solver, **run)) > 0.3) == stays
    over = {**on_a_slope(math.atan(0.3), 0), **run, "run__duration": "20 ms", "run__step": "0.05 ms"}
    result = slides({**friction, "sticking": "400 N/mm"}, solver, **over)
    assert (np.ptp(result.position[:, 0, 0]) < 0.01) == stays


def test_a_held_block_creeps_as_its_own_direction_has_it() -> None:
    """At 60 % of the limit along CD, which holds more: over v_s/m, by Eq. 12."""
    part, mu_md, mu_cd = 0.6, 0.2, 0.5
    slope = math.atan(part * mu_cd)
    result = slides([mu_md, mu_cd], **on_a_slope(slope, 1))
    creep = 2.0 * 1e-3 * mu_md / mu_cd * math.sin(math.asin(part) / 3.0)
    assert result.velocity[-1, 0, 1] == pytest.approx(creep, rel=1e-2)


def test_a_sheet_turns_between_rollers_of_friction_by_direction() -> None:
    """A flexible note in transport: both solvers have the same place of it at the end."""
    scene = mdlgen.load("samples/transport_4x4.yaml")
    over: dict[str, Any] = {
        "contacts.*.friction": 0.8,
        "run.duration": "6 ms",
        "sheets.note.boxes": [5, 8],
    }
    scene = scene.with_(over)
    pairs = [k for k, c in enumerate(scene.contacts) if "note" in c.between]
    scene = scene.with_({f"contacts.{k}.friction": [0.3, 0.7] for k in pairs})
    found = [mdlgen.solve(mdlgen.lower(scene), solver) for solver in ("lattice", "exudyn")]
    assert all(as_asked(result) for result in found)
    one, two = (result.position[-1] for result in found)
    assert np.abs(one - two).max() < 2e-3 * np.abs(one - found[0].position[0]).max()


def test_the_sample_does_what_it_says() -> None:
    model = mdlgen.lower(mdlgen.load("samples/verify/aslant.yaml"))
    result = mdlgen.solve(model, "lattice")
    assert as_asked(result)
    moved = result.position[-1, 0] - result.position[0, 0]
    assert moved[:2] == pytest.approx([316.0, 170.0], abs=1.0), "mm, as its comment says"
    speed = np.linalg.norm(result.velocity[:, 0], axis=1)
    stops = float(result.time[np.flatnonzero(speed < 1e-3)[0]])
    assert stops == pytest.approx(530.0, abs=4.0), "ms"


PLAIN = "{mu: 0.3}"


@pytest.mark.parametrize(
    "friction", [PLAIN, "[0.3, 0.3]", "{front: 0.3, back: 0.3}", "{static: 0.3, kinetic: 0.3}"]
)
def test_what_is_one_number_is_that_number(friction: str) -> None:
    model = mdlgen.lower(mdlgen.load("samples/verify/slide.yaml", [f"contacts.0.friction={friction}"]))
    plain = mdlgen.lower(mdlgen.load("samples/verify/slide.yaml"))
    assert model.contacts.mu_static == plain.contacts.mu_static == 0.3
    assert model.contacts.mu_dynamic == plain.contacts.mu_dynamic
