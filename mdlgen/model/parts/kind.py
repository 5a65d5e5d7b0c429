"""What the Model has to know of a kind of part of the machine.

A new kind is a file beside this one, and a line in `kinds.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol, TypeVar

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Rod
from mdlgen.geometry.solids import Solid
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Bow, Face, Facets
from mdlgen.model.tables import Bodies, Model, Press, RollerPart, SheetPart
from mdlgen.spec.scene import Scene

P = TypeVar("P")

# The centre of a box may be beyond its bounds by one step before a solver sees it; parts reach this far more.
SLACK = 1.0  # mm


class BodyRow(NamedTuple):
    """Row of a part in Bodies, as the run begins."""

    position: Floats  # centre of mass [mm], (3,)
    rotation: Floats  # (3, 3)
    mass: float  # [g]
    inertia: Floats  # principal, body axes [g mm^2], (3,)
    fixed: bool
    half: Floats  # half lengths of a block, else zero [mm], (3,)


class Boxes(NamedTuple):
    """Boxes of sheets at stored times."""

    place: Floats  # of the centres [mm], (t, n, 3)
    turn: Floats  # rotations, (t, n, 3, 3)
    half: Floats  # half lengths [mm], (n, 3)


class Drawn(NamedTuple):
    """What a page shows of a part."""

    name: str
    kind: str  # roller, sector (of a rim), mark, mesh (on a roller), plane or guide
    solid: Solid  # body axes [mm]


class Kind(Protocol[P]):
    """One kind of part. Lengths in mm, bodies and places global where nothing else is said."""

    @property
    def name(self) -> str:
        """What one is called in a sentence."""
        ...

    @property
    def table(self) -> str:
        """Where they stand in a scene and in a Model: `rollers`."""
        ...

    @property
    def part(self) -> type[P]:
        """What the Model has for each."""
        ...

    @property
    def with_sheet(self) -> int:
        """Kind of its contacts with sheets."""
        ...

    @property
    def with_roller(self) -> int:
        """Kind of its contacts with rollers."""
        ...

    @property
    def leads(self) -> bool:
        """Whether it may lead a sheet in any direction."""
        ...

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[P, ...]:
        """All of a scene, by name; their bodies are numbered from `first`. Raises SpecError."""
        ...

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> Face | Bow | Facets | None:
        """The face that a pressed roller at a place meets; None: none. Raises SpecError where both are
        pressed."""
        ...

    def body(self, part: P, rollers: tuple[RollerPart, ...]) -> BodyRow: ...

    def bounds(self, part: P, bodies: Bodies, rollers: tuple[RollerPart, ...]) -> tuple[Floats, Floats]:
        """Least and greatest coordinates that it may have during a run, (3,) each."""
        ...

    def reach(self, part: P, bodies: Bodies, way: Floats) -> float:
        """How far it reaches along a unit vector as the run begins: the greatest coordinate [mm]."""
        ...

    def press(self, part: P) -> Press | None:
        """The spring that presses it along a slide; None: none does."""
        ...

    def carrier(self, part: P) -> int:
        """Index of the roller that it moves with; -1: none."""
        ...

    def overlap(self, part: P, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        """How deep a rod is in the part, whose body stands at a place; below zero by how far it is off."""
        ...

    def inside(
        self, part: P, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats | None:
        """How deep points (..., 3) of bodies with these centres are in the part, whose body stands at a
        place: (...), where they are off not above zero; None where it is not computed."""
        ...

    def depth_at_start(self, model: Model, sheet: SheetPart, part: P) -> float:
        """How deep a sheet is in it as the run begins; 0 where it is off, or where none is computed."""
        ...

    def place(self, part: P) -> str:
        """Where in the scene it is said that it stands, for lints."""
        ...

    def depths(self, part: P, boxes: Boxes, at: Floats) -> Floats | None:
        """How deep boxes are in it, whose body is `at` (t, 3): (t, n), where they are off not above zero;
        None where their share of a force follows from areas."""
        ...

    def drawn(self, part: P, half: Floats) -> list[Drawn]: ...
