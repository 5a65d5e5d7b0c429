"""Meshes: parts whose shape is a file of triangles, fixed or on a roller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, field_serializer, model_validator

from mdlgen.spec.beside import beside
from mdlgen.spec.fields import Angles, LengthOrZero, Mass, Name, Position, origin
from mdlgen.spec.limits import Tally
from mdlgen.spec.machine_part import not_modelled, rim_of_sectors
from mdlgen.spec.moving import MovingPart, Pivot, Slide, pivot_field, slide_field
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.solid import Solid, read_solid
from mdlgen.spec.source import Source
from mdlgen.spec.strict import fail, with_values

if TYPE_CHECKING:
    from mdlgen.spec.contact import Contact
    from mdlgen.spec.machine import Roller

Density = Annotated[float, quantity("g/mm^3", 0.0, open_low=True)]


class Mesh(MovingPart):
    """A part with the shape of a closed surface of triangles."""

    kind = "mesh"
    file: str = Field(
        description="STL (binary or ASCII) or OBJ, in the folder of the spec or below: a closed surface"
    )
    units: Literal["mm", "cm", "m", "in"] = Field(default="mm", description="unit of the file's numbers")
    center: Position = Field(
        default=origin("mm"), description="where the origin of the file's axes is at the start"
    )
    rotation: Angles = Field(
        default=origin("deg"),
        description="rotation of the file's axes, about the global x, then y, then z axis",
    )
    on: Name | None = Field(
        default=None, description="the roller that it turns with; center and rotation are those at the start"
    )
    mass: Mass | None = Field(
        default=None, description="mass m; the inertia is that of a solid of even density"
    )
    density: Density | None = Field(default=None, description="density, in place of mass")
    at: Literal["nodes", "centres"] = Field(
        default="nodes",
        description="where the depth of a triangle, or of the part of it that a box covers, is measured: at "
        "its corners (nodes) or in its middle (centres)",
    )
    edge_radius: LengthOrZero = Field(
        default=default("0 mm"),
        description="radius of its edges where the outer sides of a sheet meet them, below 1 mm; 0: the "
        "edges are as sharp as those of the triangles",
    )
    pivot: Pivot | None = pivot_field()
    slide: Slide | None = slide_field()
    _solid: Solid | None = PrivateAttr(default=None)
    _from: Source = PrivateAttr(default_factory=Source)

    @model_validator(mode="after")
    def _read(self, info: ValidationInfo) -> Mesh:
        if self.mass is not None and self.density is not None:
            raise fail("mass and density are both given; give one of them")
        if self.edge_radius >= 1.0:
            raise fail(f"{self.edge_radius:g} mm; allowed: below 1 mm", within=("edge_radius",))
        if self.on is not None and self.mass is None and self.density is None:
            raise fail("on a roller its mass counts; give mass or density")
        tally = (info.context or {}).get("tally") or Tally()
        name, folder = beside(self.file, info)
        self._from = Source(folder=folder)
        self._solid = read_solid(name, folder, self.units, tally)
        return with_values(self, file=name)

    @field_serializer("file")
    def _anywhere(self, file: str) -> str:
        """With its folder, so that what is dumped can be read from anywhere."""
        folder = self._from.folder
        return file if folder is None else str(folder.absolute() / file)

    @property
    def solid(self) -> Solid:
        """The surface, in the unit of the file."""
        assert self._solid is not None, "read as the mesh is made"
        return self._solid

    def unlike_sheets(self, name: str, contact: Contact) -> tuple[str, str] | None:
        if contact.share != "pair":
            return None
        return (
            "share",
            f"share: pair is not modelled with the mesh {name}: boxes share it by the area they cover",
        )

    def unlike_roller(self, names: tuple[str, str], roller: Roller) -> str | None:
        if self.on is not None:
            return f"{not_modelled(names)}{names[1]} is on a roller, and such a mesh touches sheets only"
        if roller.rim is not None:
            return rim_of_sectors(names, "a mesh")
        return None
