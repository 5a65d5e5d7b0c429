"""Rows of a whole scene, and of its sheets as a system definition."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from mdlgen.backends.motionview.writer.contact_rows import ContactView, ForceView, LawView, Pair
from mdlgen.backends.motionview.writer.parts.guide import GuideView
from mdlgen.backends.motionview.writer.parts.kind import PartView
from mdlgen.backends.motionview.writer.parts.mesh import MeshView
from mdlgen.backends.motionview.writer.parts.plane import PlaneView
from mdlgen.backends.motionview.writer.parts.roller import RollerView
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.sheet_rows import LoadView, ProbeView, SheetView, SupportView


class ShaftView(NamedTuple):
    """Speed of a shaft that turns rollers."""

    data_set: str
    label: str
    given: list[Value]


@dataclass(frozen=True)
class SceneView:
    """Everything that the main template loops over."""

    name: str
    static: bool
    static_settings: list[tuple[str, str]]  # attributes of the command that finds the state of rest
    parameters: list[Value]
    run: list[Value]
    sheets: list[SheetView]
    supports: list[SupportView]
    loads: list[LoadView]
    machine: list[PartView]
    shafts: list[ShaftView]
    contacts: list[ContactView]
    pairs: list[Pair]
    laws: list[LawView]  # of contacts whose numbers stand in solver commands
    probes: list[ProbeView]
    set_contact: bool
    forces: list[ForceView] = field(default_factory=list)  # of contacts, where they are asked for
    target: str = "2021"  # version of MotionView whose form of Contact is written

    @property
    def rollers(self) -> list[RollerView]:
        return [part for part in self.machine if isinstance(part, RollerView)]

    @property
    def planes(self) -> list[PlaneView]:
        return [part for part in self.machine if isinstance(part, PlaneView)]

    @property
    def moved(self) -> list[GuideView | PlaneView | MeshView]:
        return [*self.guides, *self.planes, *self.meshes]

    @property
    def guides(self) -> list[GuideView]:
        return [part for part in self.machine if isinstance(part, GuideView)]

    @property
    def meshes(self) -> list[MeshView]:
        return [part for part in self.machine if isinstance(part, MeshView)]


class Attachment(NamedTuple):
    """An argument of a system definition: what an entity of the model around is called inside."""

    name: str
    label: str
    entity: str  # Body or Graphic
    given: str  # the entity's variable in the model around, as far as the scene says it


@dataclass(frozen=True)
class SystemView:
    """The sheets as one system definition; `scene` holds no machine."""

    name: str
    variable: str  # of an instance
    definition: str
    attachments: list[Attachment]
    scene: SceneView
