"""Meshes: Scene -> tables, with mass, middle and inertia of the solid inside, and where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.grid import rotation_matrix
from mdlgen.model.tables import Floats, MeshPart, Model, RollerPart
from mdlgen.spec.mesh import Mesh
from mdlgen.spec.scene import Scene
from mdlgen.spec.solid import SCALES, moments, signed_volume

LIGHT = 1.0  # g: of a fixed mesh without a mass, where it is of no effect
BALANCED = (
    1e-3  # of a roller's radius: how far the middle of mass may be from the axis of one that is not driven
)


def lower_meshes(scene: Scene, rollers: tuple[RollerPart, ...], first: int) -> tuple[MeshPart, ...]:
    """All meshes; their bodies are numbered from `first`."""
    names = [roller.name for roller in rollers]
    return tuple(
        _mesh(name, mesh, first + index, -1 if mesh.on is None else names.index(mesh.on))
        for index, (name, mesh) in enumerate(sorted(scene.meshes.items()))
    )


def mass_of(mesh: Mesh) -> float:
    """Mass as given, or of the solid's volume [g]."""
    if mesh.density is None:
        return mesh.mass or LIGHT
    return mesh.density * signed_volume(mesh.solid.corners, mesh.solid.triangles) * SCALES[mesh.units] ** 3


def _mesh(name: str, mesh: Mesh, body: int, on: int) -> MeshPart:
    scale, solid = SCALES[mesh.units], mesh.solid
    corners = solid.corners * scale
    volume, middle, second = moments(corners, solid.triangles)
    gyration, principal = _principal(second)
    return MeshPart(
        name=name,
        body=body,
        file=mesh.file,
        scale=scale,
        at=mesh.at,
        on=on,
        center=np.array(mesh.center),
        angles=mesh.rotation,
        axes=rotation_matrix(mesh.rotation),
        corners=corners,
        triangles=solid.triangles,
        flat=solid.flat,
        volume=volume,
        middle=middle,
        principal=principal,
        gyration=gyration,
        mass=mass_of(mesh),
        density=mesh.density,
        edge_radius=mesh.edge_radius,
    )


def _principal(second: Floats) -> tuple[Floats, Floats]:
    """Inertia over mass about the principal axes (3,), and these in columns (3, 3), from the mean of r r^T.

    Axes that are those of the file to round-off are exactly those.
    """
    inertia = np.trace(second) * np.eye(3) - second
    off = np.abs(inertia - np.diag(np.diag(inertia))).max()
    if off <= 1e-6 * np.abs(inertia).max():
        return np.diag(inertia).copy(), np.eye(3)
    values, axes = np.linalg.eigh(inertia)
    axes *= np.where(axes[np.abs(axes).argmax(axis=0), range(3)] < 0.0, -1.0, 1.0)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    # to digits that every library of linear algebra gives: they stand in texts
    values = np.array([float(f"{v:.13g}") for v in values])
    return values, np.asarray(np.round(axes, 14) + 0.0, dtype=np.float64)


def check_balance(model: Model) -> None:
    """Raises RefusedError where a mesh has its mass off the axis of a roller that would feel it: a solver has
    mass and inertia of what is on a roller, not what the roller's turn makes of a weight beside it."""
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
    """The rollers with mass and inertia of what is on them."""
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


def bounds(mesh: MeshPart, rollers: tuple[RollerPart, ...]) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of a mesh [mm], (3,); of one on a roller at any angle of it."""
    points = mesh.center + mesh.corners @ mesh.axes.T
    if mesh.on < 0:
        return points.min(axis=0), points.max(axis=0)
    roller = rollers[mesh.on]
    along = (points - roller.center) @ roller.axis
    around = reach(mesh, roller) * np.sqrt(np.maximum(0.0, 1.0 - roller.axis**2))
    ends = roller.center + np.outer([along.min(), along.max()], roller.axis)
    return ends.min(axis=0) - around, ends.max(axis=0) + around


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
