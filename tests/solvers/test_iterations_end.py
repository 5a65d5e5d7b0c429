"""Iterations end where double precision ends, so no step is halved for nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mdlgen.model.lower import lower
from mdlgen.registry import solve
from mdlgen.spec.load import loads

# A block hangs far below on three supports that are stiff; next to it an arm swings freely.
ARM = """
name: arm
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  n: {material: p, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
    center: [0 mm, 0 mm, %s mm]}
rollers:
  a: {center: [30 mm, 0 mm, 0 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 6 g,
    arm: {pivot: [0 mm, 0 mm, 0 mm], mass: 4 g}}
contacts: [{between: [n, a], stiffness: 10 N/mm^1.5, friction: 0}]
supports:
  - {sheet: n, at: [1 mm, 1 mm], fix: [x, y, z]}
  - {sheet: n, at: [-5 mm, 1 mm], fix: [y, z]}
  - {sheet: n, at: [1 mm, -5 mm], fix: [z]}
run: {duration: 400 ms, margin: 60 mm, print_step: 2 ms}
"""


@pytest.mark.parametrize("height", [-300, -5000, -80])
def test_a_held_block_does_not_shorten_the_steps_of_an_arm(height: float) -> None:
    """A support of 5e5 N/mm answers the last digit of a coordinate by more than an iteration may leave."""
    result = solve(lower(loads(ARM % height)), "lattice")
    assert result.ok
    assert result.steps < 3 * 400 / 0.1  # the step is 0.1 ms or twice that: it is hardly halved
    # a bar of 4 g and a disc of 6 g, whose turn about its own axis is free, on a lever of 30 mm: by energy
    lever, inertia = 30.0, 6.0 * 30.0**2 + 4.0 * 30.0**2 / 3.0
    z = result.position[:, 1, 2]
    fallen = 9.81e-3 * (6.0 + 4.0 / 2.0) * -z
    speed = np.linalg.norm(result.velocity[:, 1], axis=1) / lever
    assert 0.5 * inertia * speed**2 == pytest.approx(fallen, abs=1e-3 * fallen.max())
    assert z.min() == pytest.approx(-lever, rel=1e-3)


BLOCKS = """
name: blocks
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  a: {material: p, size: [30 mm, 20 mm], thickness: 3 mm, mass: 5 g, boxes: [1, 1],
    rotation: [5 deg, 10 deg, 0 deg], velocity: [0.1 m/s, 0 m/s, 0 m/s]}
  b: {material: p, size: [20 mm, 24 mm], thickness: 2 mm, mass: %s g, boxes: [1, 1],
    center: [4 mm, 3 mm, 7 mm], rotation: [0 deg, -15 deg, 20 deg], velocity: [0 m/s, 0 m/s, -0.4 m/s]}
contacts: [{between: [a, b], stiffness: 800 N/mm^1.5, friction: 0.3, restitution: 0.5}]
run: {duration: 20 ms, margin: 40 mm}
"""


@pytest.mark.parametrize("mass", [2.0, 20.0])
def test_blocks_that_collide_in_free_flight_take_no_more_iterations_than_others(mass: float) -> None:
    result = solve(lower(loads(BLOCKS % mass)), "lattice")
    assert result.ok
    assert result.rounds < 3 * result.steps
    masses = result.model.bodies.mass[:2]
    momentum = np.einsum("b,tbi->ti", masses, result.velocity[:, :2])
    assert momentum == pytest.approx(
        np.tile(momentum[0], (len(momentum), 1)), abs=1e-9 * math.hypot(0.5, 0.8)
    )
    angular = np.einsum("b,tbi->ti", masses, np.cross(result.position, result.velocity)[:, :2])
    own = _own(result.rotation[:, :2], result.spin[:, :2], result.model.bodies.inertia[:2])
    whole = angular + own.sum(axis=1)
    assert whole == pytest.approx(np.tile(whole[0], (len(whole), 1)), abs=1e-6 * np.abs(whole[0]).max())


def _own(parameters: np.ndarray, spin: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    """Angular momentum of boxes about their centres, (t, boxes, 3)."""
    w, v = parameters[..., :1], parameters[..., 1:]

    def turned(a: np.ndarray, sign: float) -> np.ndarray:
        across = 2.0 * sign * np.cross(v, a)
        return a + w * across + np.cross(sign * v, across)

    return turned(inertia * turned(spin, -1.0), 1.0)
