"""Rollers that begin with a spin, lifted or turned, and forces over time, against closed forms."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

import mdlgen
from mdlgen.results.result import Result
from mdlgen.results.swing import swing

SOLVERS = ("lattice", "exudyn")
G = 9.81e-3  # [mm/ms^2]
HEAD = """
name: starts
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: {E_md: 1 GPa, E_cd: 1 GPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  block:
    material: paper
    size: [10 mm, 10 mm]
    thickness: 1 mm
    mass: 2 g
    boxes: [1, 1]
    center: [0 mm, 0 mm, 50 mm]
"""
ROLLERS = (
    HEAD
    + """
rollers:
  free: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 4 g, spin: 100 rad/s}
  held:
    center: [30 mm, 0 mm, 0 mm]
    axis: y
    radius: 5 mm
    width: 5 mm
    mass: 4 g
    press: {direction: -z, stiffness: 0.4 N/mm, preload: 0 N, damping_ratio: 0.1, start: -2 mm}
  hung:
    center: [60 mm, 0 mm, -20 mm]
    axis: y
    radius: 5 mm
    width: 5 mm
    mass: 4 g
    arm: {pivot: [60 mm, 0 mm, 0 mm], mass: 3 g, start: 60 deg, stiffness: 3 N*mm/rad, torque: 1 N*mm}
run: {duration: 40 ms, step: 0.1 ms, print_step: 2 ms}
"""
)
WEIGHT = "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"
FAST = ("rollers.held.press.start_speed=30 mm/s", "rollers.hung.arm.start_speed=5 rad/s", WEIGHT)
PUSHED = (
    HEAD
    + """
loads: [{sheet: block, at: [0 mm, 0 mm], force: [3 N, 0 N, 0 N], profile: [[0 ms, 0], [10 ms, 1]]}]
run: {duration: 10 ms, step: 0.1 ms, print_step: 1 ms}
"""
)


@cache
def solved(text: str, solver: str, *sets: str) -> Result:
    return mdlgen.solve(mdlgen.lower(mdlgen.loads(text, list(sets))), solver)


def body(result: Result, name: str) -> int:
    return result.model.bodies.name.index(name)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_free_roller_keeps_its_spin(solver):
    result = solved(ROLLERS, solver, *FAST)
    spin = result.spin[:, body(result, "free")]
    # nothing acts on it: round-off
    assert spin[:, 1] == pytest.approx(np.full(len(spin), 0.1), rel=1e-12)
    assert abs(result.energy.balance_error) < 1e-3


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("sets", [(), FAST], ids=["let go", "thrown"])
def test_a_pressed_roller_swings_about_its_balance(solver, sets):
    """x = a exp(-zeta w t) cos(w_d t) + ..: amplitude, frequency and damping at once."""
    result = solved(ROLLERS, solver, *sets)
    t = result.time
    mass, stiffness, ratio = 4.004, 0.4, 0.1
    rate = math.sqrt(stiffness / mass)
    damped, fade = rate * math.sqrt(1 - ratio**2), np.exp(-ratio * rate * t)
    rest, speed = (mass * G / stiffness, 0.03) if sets else (0.0, 0.0)
    away = -2.0 - rest
    across = (speed + ratio * rate * away) / damped
    want = fade * (away * np.cos(damped * t) + across * np.sin(damped * t)) + rest
    found = -result.position[:, body(result, "held"), 2]
    # second order: (w h)^2 / 12 of two turns
    assert found == pytest.approx(want, abs=2e-3)
    assert found[0] == pytest.approx(-2.0, rel=1e-14)
    assert want.max() > 1.4


@pytest.mark.parametrize("solver", SOLVERS)
def test_an_arm_begins_turned_and_swings(solver):
    """J angle'' = torque - k angle - (weights) sin(angle), by an integrator of order 8."""
    from scipy.integrate import solve_ivp

    result = solved(ROLLERS, solver, *FAST)
    length, roller, arm = 20.0, 4.0, 3.0
    inertia = roller * length**2 + arm * length**2 / 3

    def rates(_, y):
        weight = (roller + arm / 2) * length * G * math.sin(y[0])
        return [y[1], (1.0 - 3.0 * y[0] - weight) / inertia]

    end = result.time[-1]
    exact = solve_ivp(rates, (0, end), [math.pi / 3, 5e-3], "DOP853", result.time, rtol=1e-11, atol=1e-13)
    found = swing(result, result.model.roller("hung"))
    assert found is not None
    assert found == pytest.approx(exact.y[0], abs=1e-4)  # second order in the step
    assert abs(exact.y[0, -1] - exact.y[0, 0]) > 0.5


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_ramp_of_force_moves_a_block_by_the_cube_of_time(solver):
    """x = a t^3/6, a the rate of the acceleration; the step's error is a fourth in half of the step."""
    coarse, fine = (solved(PUSHED, solver, f"run.step={step} ms") for step in (0.2, 0.1))
    exact = 3.0 / 2.0 / 10.0 * coarse.time**3 / 6.0
    errors = [abs(result.position[-1, 0, 0] - exact[-1]) for result in (coarse, fine)]
    assert errors[0] < 2e-3 * exact[-1]
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.3)
    assert abs(fine.energy.balance_error) < 1e-3


def test_the_impulse_of_a_force_is_exact_wherever_corners_lie():
    """In the lattice a step has the mean of the factor: a pulse between two of its middles is not missed."""
    corners = "[[0 ms, 0], [2.35 ms, 0], [2.4 ms, 40], [2.45 ms, 0], [7.07 ms, 0], [8 ms, 1]]"
    result = solved(PUSHED, "lattice", f"loads.0.profile={corners}", "run.step=1 ms")
    impulse = 3.0 * (0.5 * 0.1 * 40 + 0.5 * 0.93 + 2.0)
    assert result.velocity[-1, 0, 0] == pytest.approx(impulse / 2.0, rel=1e-12)
    assert abs(result.energy.balance_error) < 1e-9


@pytest.mark.parametrize("solver", SOLVERS)
def test_gravity_that_is_switched_off_leaves_straight_motion(solver):
    off = "gravity_profile=[[0 ms, 1], [4 ms, 1], [6 ms, 0]]"
    result = solved(PUSHED, solver, "loads=[]", WEIGHT, off)
    speed = -G * 5.0
    # lattice has the impulse of a ramp exactly, exudyn to second order in the step
    near = {"lattice": 1e-12, "exudyn": 1e-4}[solver]
    assert result.velocity[-5:, 0, 2] == pytest.approx(np.full(5, speed), rel=near)
    where = 50.0 - G * (8.0 + 4.0 * 2.0 + 4.0 / 3.0) + speed * (result.time[6:] - 6.0)
    # a ramp to 0 over T: g T^2/3 of way
    assert result.position[6:, 0, 2] == pytest.approx(where, abs={"lattice": 1e-5, "exudyn": 1e-4}[solver])
    assert abs(result.energy.balance_error) < 2e-3
    assert result.energy.driven == pytest.approx(0.5 * 2.0 * speed**2, rel=2e-3)  # the work of the weight


@pytest.mark.parametrize("solver", SOLVERS)
def test_weight_that_changes_acts_on_presses_and_arms(solver):
    """As the same gravity in full, which a factor of 1/2 of twice of it is."""
    twice = "gravity=[0 m/s^2, 0 m/s^2, -19.62 m/s^2]"
    half = "gravity_profile=[[0 ms, 0.5], [1 ms, 0.5]]"
    one, two = solved(ROLLERS, solver, *FAST), solved(ROLLERS, solver, *FAST, twice, half)
    for name in ("held", "hung"):
        here = body(one, name)
        assert two.position[:, here] == pytest.approx(one.position[:, here], abs=1e-9)
    assert abs(two.energy.balance_error) < 2e-3


def test_a_spin_is_carried_over_by_friction():
    """samples/verify/spun: v = omega R M/(M + 2 m), whatever friction and landing do."""
    result = mdlgen.solve(mdlgen.lower(mdlgen.load("samples/verify/spun.yaml")), "lattice")
    assert result.ok
    want = 0.1 * 5.0 * 4.0 / (4.0 + 2.0 * 1.0)
    assert result.velocity[-1, 0, 0] == pytest.approx(want, rel=2e-3)
    assert 5.0 * result.spin[-1, body(result, "wheel"), 1] == pytest.approx(-want, rel=2e-3)
    # momentum of the block and spin of the roller together, at each stored time
    speed, spin = result.velocity[:, 0, 0], result.spin[:, body(result, "wheel"), 1]
    assert 1.0 * speed - 0.5 * 4.0 * 5.0 * spin == pytest.approx(np.full(len(spin), 1.0), rel=1e-3)
    # until it stops slipping friction has mu times the impulse of the nip, which is that of spring and
    # weight, and what turned the roller back as it landed
    slips, rise = result.time < 4.0, result.velocity[:, body(result, "wheel"), 2]
    pressed = (0.2 + 4.01 * G) * result.time + 4.01 * rise
    assert (5.0 * -spin[slips] - speed[slips] > 1e-2).all()
    # the force of a nip stands at points along it, whose normals lean by up to 0.1: it is more by cos(0.1)
    assert speed[slips] == pytest.approx(0.3 * pressed[slips], abs=5e-3 * want)
    assert speed[result.time > 4.2] == pytest.approx(want, rel=3e-3)
    assert abs(result.energy.balance_error) < 1e-3
