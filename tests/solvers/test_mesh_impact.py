"""A block falls on a mesh, edge first, without friction and with restitution 1."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from solids import binary, brick

import mdlgen

FAST = 0.8  # mm/ms
MASS, LONG, THICK = 5.0, 30.0, 4.0  # g and mm


def after(folder: Path, angle: float, stiffness: float) -> tuple[float, float]:
    """The vertical speed of the block after the impact [mm/ms], and the energy that is made or lost, as a
    part of all energy."""
    (folder / "part.stl").write_bytes(binary(*brick(200.0, 200.0, 10.0)))
    a = math.radians(angle)
    height = 0.5 * (LONG * math.sin(a) + THICK * math.cos(a)) + 0.02
    text = (
        "name: n\ngravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]\n"
        "materials: {m: {E_md: 1 GPa, E_cd: 1 GPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}\n"
        f"sheets: {{n: {{material: m, size: [{LONG} mm, 20 mm], thickness: {THICK} mm, mass: {MASS} g, "
        f"boxes: [1, 1], center: [0 mm, 0 mm, {height} mm], rotation: [0 deg, {angle} deg, 0 deg], "
        f"velocity: [0 m/s, 0 m/s, {-FAST} m/s]}}}}\n"
        "meshes: {t: {file: part.stl, center: [0 mm, 0 mm, -5 mm]}}\n"
        f"contacts: [{{between: [n, t], stiffness: {stiffness} N/mm^1.5, friction: 0, restitution: 1, "
        "smoothing: 1 mm/s}]\nrun: {duration: 2 ms, margin: 20 mm}\n"
    )
    result = mdlgen.solve(mdlgen.lower(mdlgen.loads(text, folder=folder)), "lattice")
    assert result.ok, result.status
    block = result.model.sheets[0].first
    return float(result.velocity[-1, block, 2]), abs(result.energy.balance_error)


def rigid(angle: float) -> float:
    """That speed for a rigid block on a rigid plane: an impulse at the edge reverses the edge's speed."""
    a = math.radians(angle)
    arm = 0.5 * (LONG * math.cos(a) - THICK * math.sin(a))
    inertia = MASS * (LONG**2 + THICK**2) / 12.0
    return -FAST + 2.0 * FAST / (1.0 + MASS * arm**2 / inertia)


@pytest.mark.parametrize("angle", [25.0, 37.0, 52.0])
def test_a_stiff_contact_reverses_a_block_as_a_rigid_one_does(tmp_path: Path, angle: float) -> None:
    """The block keeps its energy at any stiffness. A soft contact acts for longer and reverses it less."""
    soft, stiff = after(tmp_path, angle, 2e5), after(tmp_path, angle, 2e7)
    far, near = abs(soft[0] - rigid(angle)), abs(stiff[0] - rigid(angle))
    assert near < 4e-3 * FAST and near < 0.5 * far
    assert soft[1] < 2e-3 and stiff[1] < 2e-3
    assert after(tmp_path, angle, 2e3)[1] < 2e-3
