"""Meshes on rollers: what they weigh there, and where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Floats, MeshPart, Model, RollerPart
from mdlgen.spec.mesh import Mesh
from mdlgen.spec.solid import SCALES, signed_volume

LIGHT = 1.0  # g: of a fixed mesh without a mass, where it is of no effect
BALANCED = (
    1e-3  # of a roller's radius: how far the middle of mass may be from the axis of one that is not driven
)


def mass_of(mesh: Mesh) -> float:
    """Mass as given, or of the solid's volume [g]."""
    if mesh.density is None:
        return mesh.mass or LIGHT
    return mesh.density * signed_volume(mesh.solid.corners, mesh.solid.triangles) * SCALES[mesh.units] ** 3


def check_balance(model: Model) -> None:
    """Raises RefusedError where a mesh has its mass off the axis of a roller that would feel it. A solver
    adds mass and inertia of the mesh to the roller, but not the torque of an eccentric weight."""
    for mesh in model.meshes:
        if mesh.on < 0:
            continue
        roller = model.rollers[mesh.on]
        gap = mesh.center + mesh.axes @ mesh.middle - roller.center
        off = float(np.linalg.norm(gap - roller.axis * (gap @ roller.axis)))
        most = BALANCED * roller.radius
        if (roller.turns or roller.press is not None) and off > most:
            raise RefusedError(
                f"mesh {mesh.name}: its middle of mass is {off:.3g} mm off the axis of {roller.name}, which "
                f"is free to turn or to slide; a run allows {most:.3g} mm. Move it, or drive the roller"
            )


def loaded(rollers: tuple[RollerPart, ...], meshes: tuple[MeshPart, ...]) -> tuple[RollerPart, ...]:
    """The rollers with mass and inertia of the meshes on them."""
    made = []
    for index, roller in enumerate(rollers):
        mass = inertia = 0.0
        for mesh in meshes:
            if mesh.on == index:
                turn = mesh.axes @ mesh.principal
                mass += mesh.mass
                inertia += mesh.mass * float((roller.axis @ turn) ** 2 @ mesh.gyration)
        made.append(replace(roller, carried=(mass, inertia)) if mass > 0.0 else roller)
    return tuple(made)


def origin(mesh: MeshPart, rollers: tuple[RollerPart, ...]) -> Floats:
    """Where the origin of the file's axes is at the start [mm]: a pressed roller has slid."""
    press = rollers[mesh.on].press if mesh.on >= 0 else None
    return mesh.center if press is None else mesh.center + press.start * press.direction


def placed(mesh: MeshPart, rollers: tuple[RollerPart, ...]) -> tuple[Floats, Floats]:
    """Centre of mass and axes of the body at the start, (3,) and (3, 3)."""
    return origin(mesh, rollers) + mesh.axes @ mesh.middle, mesh.axes @ mesh.principal


def reach(mesh: MeshPart, roller: RollerPart) -> float:
    """Greatest distance of a mesh from the axis of its roller [mm]."""
    arms = mesh.center + mesh.corners @ mesh.axes.T - roller.center
    return float(np.linalg.norm(arms - np.outer(arms @ roller.axis, roller.axis), axis=1).max())


def carriers(model: Model) -> dict[int, int]:
    """Body of the roller that each mesh on one moves with, by its own body."""
    return {m.body: model.rollers[m.on].body for m in model.meshes if m.on >= 0}


def carried(model: Model, x: Floats, r: Floats, u: Floats, w: Floats) -> None:
    """Fills the rows of meshes on rollers from those of the rollers: places (..., n, 3), rotations
    (..., n, 9), velocities and angular velocities (..., n, 3)."""
    start, turn = model.bodies.position, model.bodies.rotation
    for own, roller in carriers(model).items():
        turned = r[..., roller, :].reshape(*r.shape[:-2], 3, 3) @ turn[roller].T
        arm = turned @ (start[own] - start[roller])
        x[..., own, :] = x[..., roller, :] + arm
        r[..., own, :] = (turned @ turn[own]).reshape(*r.shape[:-2], 9)
        u[..., own, :] = u[..., roller, :] + np.cross(w[..., roller, :], arm)
        w[..., own, :] = w[..., roller, :]
