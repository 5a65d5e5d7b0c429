"""Rows of meshes."""

from __future__ import annotations

from mdlgen.backends.motionview.writer.axes import components
from mdlgen.backends.motionview.writer.rows import MeshView, Value
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import MeshPart, Model


def mesh_view(model: Model, mesh: MeshPart, given: list[Value]) -> MeshView:
    """One mesh; what its file says is written as numbers."""
    roller = model.rollers[mesh.on] if mesh.on >= 0 else None
    middle = zip("xyz", mesh.middle, strict=True)
    round_ = zip("xyz", mesh.gyration, strict=True)
    derived = [("scale", "Of the file's numbers to mm", number(mesh.scale))]
    derived += [(f"c_{a}", f"Middle of mass, {a} of the file (mm)", number(v)) for a, v in middle]
    derived += [(f"j_{a}", f"Inertia over mass about axis {a} (mm2)", number(v)) for a, v in round_]
    mass = "$M"
    if mesh.density is not None:
        derived.append(("V", "Volume (mm3)", number(mesh.volume)))
        mass = "$rho*$V"
    return MeshView(
        name=mesh.name,
        given=given,
        derived=derived,
        mass=mass,
        file=mesh.file,
        ground="B_Ground" if roller is None else f"b_{roller.name}",
        on="B_Ground" if roller is None else f"b_{roller.name}",
        slides=roller.name if roller is not None and roller.press is not None else "",
        z=components(mesh.principal[:, 2]),
        x=components(mesh.principal[:, 0]),
    )


def mesh_graphics(mesh: MeshPart) -> list[str]:
    """Name of the triangles that show a mesh."""
    return [f"gcad_{mesh.name}"]
