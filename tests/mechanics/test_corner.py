"""Poisson's effect as a law of corners: forces are the gradient of an energy, momentum is kept, and both
matrices of the lattice have what the forces do."""

from __future__ import annotations

import numpy as np
import pytest

from mdlgen.backends.lattice.arrays import System, build
from mdlgen.backends.lattice.kernels.integrate.corners import corners_into
from mdlgen.backends.lattice.kernels.statics import stiffness
from mdlgen.mechanics.corner import corner_forces
from mdlgen.mechanics.frame import Motion
from mdlgen.model.lower import lower
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import Model
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")
STEP = 1e-5  # of the quotients: errors of 1e-10 of what third derivatives are [mm], [rad]


def model(more: str = "", poisson: str = "0.4") -> Model:
    return lower(
        loads(f"""
name: patch
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  p: {{E_md: 20 MPa, E_cd: 15 MPa, D_md: 10 N*mm, D_cd: 6 N*mm, G: 5 MPa, poisson: {poisson},
      damping: {{time: [2 ms, 1 ms]}}}}
sheets:
  n: {{material: p, size: [6 mm, 4 mm], thickness: 0.6 mm, mass: 1 g, boxes: [3, 2], layout: plate{more}}}
""")
    )


def system(more: str = "", poisson: str = "0.4") -> System:
    return build(model(more, poisson))


def shaken(made: System, by: float, rates: float = 0.0, more: str = "") -> Motion:
    """Bodies near the start, none moved as another."""
    rng = np.random.default_rng(3)
    count = len(made.bodies)
    free = made.bodies["node"][:, None] >= 0
    x, r = np.zeros((count, 3)), np.tile(np.eye(3).ravel(), (count, 1))
    x[:-1] = model(more).bodies.position
    x += by * free * rng.normal(size=x.shape)
    r = (matrices(by * free * rng.normal(size=x.shape)) @ r.reshape(-1, 3, 3)).reshape(-1, 9)
    return Motion(x, r, rates * free * rng.normal(size=x.shape), rates * free * rng.normal(size=x.shape))


def forces(made: System, motion: Motion) -> tuple[float, float, np.ndarray]:
    """Stored energy, dissipated power, and forces of all corners."""
    f = np.zeros((len(made.bodies), 6))
    energies = [corner_forces(made.joints, corner, motion, f) for corner in made.corners]
    stored, lost = np.sum(energies, axis=0)
    return stored, lost, f


def moved(motion: Motion, body: int, way: int, by: float) -> Motion:
    x, r = motion.x.copy(), motion.r.copy()
    if way < 3:
        x[body, way] += by
    else:
        turn = by * np.eye(3)[way - 3]
        r[body] = (matrices(turn[None])[0] @ r[body].reshape(3, 3)).ravel()
    return motion._replace(x=x, r=r)


def quotients(made: System, motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """By places and turns of the boxes: minus those of the energy, (bodies, 6), and of the forces,
    (bodies, 6, bodies, 6)."""
    gradient = np.zeros((len(made.bodies), 6))
    growth = np.zeros((*gradient.shape, *gradient.shape))
    for body in made.nodes:
        for way in range(6):
            (up, _, more), (down, _, less) = (
                forces(made, moved(motion, body, way, s * STEP)) for s in (1, -1)
            )
            gradient[body, way] = -(up - down) / (2 * STEP)
            growth[body, way] = -(more - less) / (2 * STEP)
    return gradient, growth


@pytest.mark.parametrize("more", ["", ", clamp: {edge: x_max}", ", clamp: {edge: y_min}"])
def test_forces_are_the_gradient_of_the_energy(more: str) -> None:
    """But for a part of the square of the turn of a joint: the middle frame turns with the mean of both boxes
    to that order, in a corner as in a bushing."""
    made = system(more)
    by = 0.03
    motion = shaken(made, by, more=more)
    _, _, f = forces(made, motion)
    gradient, _ = quotients(made, motion)
    # joints turn by up to three times as much
    assert np.abs(f[made.nodes] - gradient[made.nodes]).max() < by**2 * np.abs(f).max()


def test_a_couple_along_the_axis_of_bending_alone_is_the_exact_gradient() -> None:
    made = system()
    made.corners["stretch"] = 0.0
    motion = shaken(made, 0.3)
    _, _, f = forces(made, motion)
    gradient, _ = quotients(made, motion)
    assert np.abs(f[made.nodes] - gradient[made.nodes]).max() < 1e-7 * np.abs(f).max()


def test_momentum_is_kept_and_nothing_depends_on_how_all_is_turned() -> None:
    made = system()
    motion = shaken(made, 0.2, 0.3)
    stored, lost, f = forces(made, motion)
    assert np.abs(f[:, :3].sum(axis=0)).max() < 1e-12 * np.abs(f).max()
    assert np.abs((np.cross(motion.x, f[:, :3]) + f[:, 3:]).sum(axis=0)).max() < 1e-12 * np.abs(f).max() * 10
    turn = matrices(np.array([[0.4, -1.1, 0.7]]))[0]
    spin = np.array([0.2, -0.5, 0.3])
    x = motion.x @ turn.T
    turned = Motion(
        x,
        (turn @ motion.r.reshape(-1, 3, 3)).reshape(-1, 9),
        motion.u @ turn.T + np.cross(spin, x),  # dampers do not feel a rigid motion
        motion.w @ turn.T + spin,
    )
    again, less, g = forces(made, turned)
    assert again == pytest.approx(stored, rel=1e-12) and less == pytest.approx(lost, rel=1e-12)
    assert np.allclose(g[:-1, :3], f[:-1, :3] @ turn.T, rtol=0, atol=1e-12 * np.abs(f).max())


def test_the_matrix_of_statics_is_the_growth_of_the_forces() -> None:
    made = system(", clamp: {edge: x_min}")
    motion = shaken(made, 0.05, more=", clamp: {edge: x_min}")
    _, growth = quotients(made, motion)
    size, nodes = 6 * (made.reach + 1), made.nodes
    a = np.zeros((len(nodes), 6, size))
    stiffness.corners_into(made.tables, motion, np.zeros((len(made.bodies), 6)), a)
    for n, one in enumerate(nodes):
        for m, two in enumerate(nodes[n : n + made.reach + 1]):
            whole = growth[one, :, two, :]
            wanted = 0.5 * (whole + growth[two, :, one, :].T)
            assert np.abs(a[n, :, 6 * m : 6 * m + 6] - wanted).max() < 1e-6 * np.abs(growth).max()


@pytest.mark.parametrize("more", ["", ", clamp: {edge: x_max}", ", clamp: {edge: y_min}"])
def test_the_matrix_of_a_step_is_the_growth_of_the_forces(more: str) -> None:
    """Where nothing is bent or pulled it is exact; there is no other place in it than the offsets say."""
    made = system(more)
    motion = shaken(made, 0.0, more=more)
    _, growth = quotients(made, motion)
    nodes = made.nodes
    slots = np.searchsorted(made.offsets, np.arange(made.reach + 1))
    a = np.zeros((len(nodes), 6, 6 * len(made.offsets)))
    damped = made.tables._replace(corners=made.corners.copy())
    for name in ("bend_damping", "stretch_damping"):
        damped.corners[name] = 0.0
    corners_into(damped, 0.5, motion.x, motion.r, a, slots)
    for n, one in enumerate(nodes):
        for m, two in enumerate(nodes[n:]):
            wanted = 0.25 * growth[one, :, two, :]
            near = 1e-8 * np.abs(growth).max()
            if m in made.offsets:
                at = 6 * slots[m]
                assert np.abs(a[n, :, at : at + 6] - wanted).max() < near
            else:
                assert np.abs(wanted).max() < near


def test_dampers_take_energy_from_any_motion() -> None:
    """Bushings and corners together: no rates of two joints around a corner gain."""
    made = system(poisson="0.8")
    rows = made.corners["joint"][0]
    k = np.array([made.joints["c"][r, 4 if n < 2 else 3] for n, r in enumerate(rows)])
    whole = np.diag(k)
    for n in range(4):
        i, j = n // 2, 2 + n % 2
        whole[i, j] = whole[j, i] = made.corners["bend_damping"][0, n]
    assert np.linalg.eigvalsh(whole).min() > 0.0
