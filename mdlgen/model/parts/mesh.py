"""Meshes: closed surfaces of triangles, fixed or on a roller, with mass and inertia of the solid inside."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Rod, into_triangles
from mdlgen.geometry.solids import CORNERS, Solid
from mdlgen.model.grid import rotation_matrix
from mdlgen.model.meshes import LIGHT, mass_of, placed, reach
from mdlgen.model.moved import carries, lower_motion, moves, swept, watched
from mdlgen.model.parameters.machine import center_rows
from mdlgen.model.parameters.moving import moving_rows
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.parts.kind import SLACK, BodyRow, Drawn, Kind
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Facets, facets_of_mesh
from mdlgen.model.tables import (
    BOX_MESH,
    CYLINDER_MESH,
    Bodies,
    MeshPart,
    Model,
    Parameter,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.mesh import Mesh
from mdlgen.spec.scene import Scene
from mdlgen.spec.solid import SCALES, moments

PIECE = 20000  # triangles of a part of a mesh that is drawn: a page counts corners in 16 bits


class _Meshes(Kind[MeshPart]):
    table, part = "meshes", MeshPart
    with_sheet, with_roller = BOX_MESH, CYLINDER_MESH
    leads = curved = by_area = described = True

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[MeshPart, ...]:
        names = [roller.name for roller in before.rollers]
        return tuple(
            _mesh(name, mesh, first + index, -1 if mesh.on is None else names.index(mesh.on))
            for index, (name, mesh) in enumerate(sorted(scene.meshes.items()))
        )

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> Facets:
        return facets_of_mesh(scene.meshes[name])

    def body(self, part: MeshPart, rollers: tuple[RollerPart, ...]) -> BodyRow:
        position, rotation = placed(part, rollers)
        inertia = part.mass * part.gyration
        fixed = part.on < 0 and part.moving is None
        return BodyRow(position, rotation, part.mass, inertia, fixed, np.zeros(3))

    def bounds(
        self, part: MeshPart, bodies: Bodies, rollers: tuple[RollerPart, ...]
    ) -> tuple[Floats, Floats]:
        """One on a pressed roller may move with it."""
        if part.moving is not None:
            return swept(part.moving, _points(part))
        low, high = _bounds(part, rollers)
        press = rollers[part.on].press if part.on >= 0 else None
        more = np.zeros(3) if press is None else rollers[part.on].radius * np.abs(press.direction) + SLACK
        return low - more, high + more

    def centre_bounds(
        self, part: MeshPart, position: Floats, margin: float | None
    ) -> tuple[Floats, Floats] | None:
        return None if part.moving is None else watched(part.moving, position)

    def carry(self, part: MeshPart) -> Floats:
        return np.zeros(3) if part.moving is None else carries(part.moving, _points(part))

    def blocks(self, part: MeshPart) -> Floats:
        return _points(part)[None]

    def reach(self, part: MeshPart, bodies: Bodies, way: Floats) -> float:
        return float(((part.center + part.corners @ part.axes.T) @ way).max())

    def carrier(self, part: MeshPart) -> int:
        return part.on

    def overlap(self, part: MeshPart, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        triangles = (part.center + part.corners @ part.axes.T)[part.triangles]
        return lambda rod: into_triangles(rod, triangles)

    def contact_depth(self, model: Model, row: int, sheet: SheetPart, part: MeshPart) -> None:
        """None: it is not computed, see `model.overlaps.sheets`."""

    def place(self, part: MeshPart) -> str:
        return f"meshes.{part.name}"

    def drawn(self, part: MeshPart, half: Floats) -> list[Drawn]:
        points = (part.corners - part.middle) @ part.principal
        kind, found = "guide" if part.on < 0 else "mesh", []
        for first in range(0, len(part.triangles), PIECE):
            used, own = np.unique(part.triangles[first : first + PIECE], return_inverse=True)
            found.append(Drawn(part.name, kind, Solid(points[used], own.reshape(-1, 3))))
        return found

    def parameters(
        self, scene: Scene, name: str, starts: Mapping[str, tuple[float, float]]
    ) -> list[Parameter]:
        mesh, base = scene.meshes[name], ("meshes", name)
        rows = center_rows(name, mesh.center, base)
        for k, axis in enumerate(NAMED_AXES):
            label = f"Rotation about {axis} (deg)"
            rows.append(Parameter(name, f"r_{axis}", label, mesh.rotation[k], "rad", (*base, "rotation", k)))
        rows += moving_rows(name, mesh, base)
        if mesh.density is not None:
            path = (*base, "density")
            return [*rows, Parameter(name, "rho", "Density (kg/mm3)", mesh.density, "g/mm^3", path)]
        mass = LIGHT if mesh.mass is None else mesh.mass
        return [*rows, Parameter(name, "M", "Mass", mass, "g", (*base, "mass"))]

    def facts(self, model: Model, part: MeshPart) -> list[str]:
        where = "fixed" if part.on < 0 else f"turns with {model.rollers[part.on].name}"
        where = where if part.moving is None else moves(part.moving)
        return [f"{part.file}, {len(part.triangles)} triangles", where]

    def overview(self, part: MeshPart) -> dict[str, Any]:
        return {
            "file": part.file,
            "triangles": len(part.triangles),
            "left_out": part.flat,
            "size_mm": np.ptp(part.corners, axis=0).tolist(),
            "volume_mm3": part.volume,
            "mass_g": part.mass,
            "inertia_g_mm2": (part.mass * part.gyration).tolist(),
        }


def _mesh(name: str, mesh: Mesh, body: int, on: int) -> MeshPart:
    scale, solid = SCALES[mesh.units], mesh.solid
    corners = solid.corners * scale
    volume, middle, second = moments(corners, solid.triangles)
    mass = mass_of(mesh)
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
        mass=mass,
        density=mesh.density,
        edge_radius=mesh.edge_radius,
        moving=lower_motion(mesh.moves, mass),
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


def _points(mesh: MeshPart) -> Floats:
    """Corners of the block of file axes that a mesh fits in [mm], (8, 3)."""
    low, high = mesh.corners.min(axis=0), mesh.corners.max(axis=0)
    block = 0.5 * (low + high) + 0.5 * (high - low) * CORNERS
    return mesh.center + block @ mesh.axes.T


def _bounds(mesh: MeshPart, rollers: tuple[RollerPart, ...]) -> tuple[Floats, Floats]:
    """Least and greatest coordinates of a mesh [mm], (3,); of one on a roller at any angle of it."""
    points = mesh.center + mesh.corners @ mesh.axes.T
    if mesh.on < 0:
        return points.min(axis=0), points.max(axis=0)
    roller = rollers[mesh.on]
    along = (points - roller.center) @ roller.axis
    around = reach(mesh, roller) * np.sqrt(np.maximum(0.0, 1.0 - roller.axis**2))
    ends = roller.center + np.outer([along.min(), along.max()], roller.axis)
    return ends.min(axis=0) - around, ends.max(axis=0) + around


KIND = _Meshes()
