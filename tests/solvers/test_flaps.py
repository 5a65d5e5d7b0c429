"""Flaps with an inertia and a spring, and stops, against closed forms, in both solvers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from gate_scenes import FLOOR, GUIDE, HEAD, SOLVERS, G, angle, model
from ran import solved
from scipy.integrate import solve_ivp


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
