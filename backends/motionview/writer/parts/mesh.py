"""Rows of meshes."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.backends.motionview.writer.axes import components
from mdlgen.backends.motionview.writer.moving import MovingView, moving_derived, moving_view
from mdlgen.backends.motionview.writer.parts.kind import Kind, PartView
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import MeshPart, Model


@dataclass(frozen=True)
class MeshView(PartView):
    """One mesh; its graphic is the file."""

    template = "mesh.mdl.j2"
    moving: MovingView | None
    derived: list[tuple[str, str, str]]
    mass: str  # reference to it
    file: str
    ground: str  # body that its axes are fixed to
    on: str  # body that it is fixed to
    slides: str  # the pressed roller that it is on; empty: none
    z: tuple[str, str, str]  # axes of its inertia, those of the file
    x: tuple[str, str, str]


class _Meshes(Kind[MeshPart]):
    def view(self, model: Model, part: MeshPart, given: list[Value]) -> MeshView:
        """One mesh; what its file says is written as numbers."""
        roller = model.rollers[part.on] if part.on >= 0 else None
        middle = zip("xyz", part.middle, strict=True)
        round_ = zip("xyz", part.gyration, strict=True)
        derived = [("scale", "Of the file's numbers to mm", number(part.scale))]
        derived += [(f"c_{a}", f"Middle of mass, {a} of the file (mm)", number(v)) for a, v in middle]
        derived += [(f"j_{a}", f"Inertia over mass about axis {a} (mm2)", number(v)) for a, v in round_]
        mass = "$M"
        if part.density is not None:
            derived.append(("V", "Volume (mm3)", number(part.volume)))
            mass = "$rho*$V"
        members = {value.member for value in given}
        derived += moving_derived(members)
        return MeshView(
            name=part.name,
            given=given,
            moving=moving_view(part.name, part.moving, f"p_{part.name}_cm", members, mass),
            derived=derived,
            mass=mass,
            file=part.file,
            ground="B_Ground" if roller is None else f"b_{roller.name}",
            on="B_Ground" if roller is None else f"b_{roller.name}",
            slides=roller.name if roller is not None and roller.press is not None else "",
            z=components(part.principal[:, 2]),
            x=components(part.principal[:, 0]),
        )

    def graphics(self, part: MeshPart) -> list[str]:
        return [f"gcad_{part.name}"]


KIND = _Meshes()
