"""The interface through which the Model uses a kind of part of the machine.

A new kind is a file in this folder with the name of the kind.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Rod
from mdlgen.geometry.solids import Solid
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import Bow, Face, Facets
from mdlgen.model.tables import Bodies, MachinePart, Model, Parameter, Press, RollerPart, SheetPart
from mdlgen.spec.scene import Scene

NONE = -1
P = TypeVar("P", bound=MachinePart)

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
    """A part as a page shows it."""

    name: str
    kind: str  # roller, sector (of a rim), mark, mesh (on a roller), plane or guide
    solid: Solid  # body axes [mm]


class Kind(Generic[P]):
    """One kind of part. Lengths in mm, bodies and places global where nothing else is said."""

    table: ClassVar[str]  # where they stand in a scene: `rollers`
    part: type[P]  # class of each in the Model
    with_sheet: ClassVar[int]  # kind of its contacts with sheets
    with_roller: ClassVar[int] = NONE  # kind of its contacts with rollers; NONE: it has none
    leads: ClassVar[bool] = False  # true if it may lead a sheet in any direction
    curved: ClassVar[bool] = False  # true if its contact with a box takes longer than that of a flat face
    by_area: ClassVar[bool] = (
        False  # true if boxes share its force by the area that each covers, not by depth
    )
    described: ClassVar[bool] = False  # true if `overview` has more of each than that it is there

    @property
    def name(self) -> str:
        """Word for one of this kind in a sentence."""
        return self.part.kind

    # -- as a run begins

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[P, ...]:
        """All of a scene, by name; their bodies are numbered from `first`. Raises SpecError."""
        raise NotImplementedError

    def parameters(
        self, scene: Scene, name: str, starts: Mapping[str, tuple[float, float]]
    ) -> list[Parameter]:
        """The parameters that the user gave for one, for MDL files; `starts`: the places along their slides
        where pressed parts touch and begin."""
        raise NotImplementedError

    def body(self, part: P, rollers: tuple[RollerPart, ...]) -> BodyRow:
        raise NotImplementedError

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> Face | Bow | Facets | None:
        """The face that a pressed roller at a place meets; None: none. Raises SpecError where both are
        pressed."""
        return None

    def press(self, part: P) -> Press | None:
        """The spring that presses it along a slide; None: none does."""
        return None

    def carrier(self, part: P) -> int:
        """Index of the roller that it moves with; -1: none."""
        return -1

    # -- where it may be

    def bounds(self, part: P, bodies: Bodies, rollers: tuple[RollerPart, ...]) -> tuple[Floats, Floats]:
        """Least and greatest coordinates that it may have during a run, (3,) each."""
        raise NotImplementedError

    def centre_bounds(self, part: P, position: Floats, margin: float | None) -> tuple[Floats, Floats] | None:
        """Bounds of its centre that end a run, which begins with it at a place; None: it is not watched.
        margin: None where no pair is left out."""
        return None

    def carry(self, part: P) -> Floats:
        """How far it may carry a sheet along each global axis, either way, (3,)."""
        return np.zeros(3)

    def reach(self, part: P, bodies: Bodies, way: Floats) -> float:
        """How far it reaches along a unit vector as the run begins: the greatest coordinate [mm]."""
        raise NotImplementedError

    def blocks(self, part: P) -> Floats:
        """Corners of blocks that it fits in as it is given, in the order of `geometry.solids` [mm],
        (n, 8, 3); asked of parts that may move."""
        raise NotImplementedError

    # -- how deep something is in it

    def overlap(self, part: P, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        """How deep a rod is in the part, whose body stands at a place; below zero by how far it is off."""
        raise NotImplementedError

    def inside(
        self, part: P, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats | None:
        """How deep points (..., 3) of bodies with these centres are in the part, whose body stands at a
        place: (...), where they are off not above zero; None where it is not computed."""
        return None

    def depth_at_start(self, model: Model, sheet: SheetPart, part: P) -> float:
        """Depth of a sheet in it as the run begins; 0 where it is off, or where none is computed."""
        return 0.0

    def depths(self, part: P, boxes: Boxes, at: Floats) -> Floats | None:
        """Depth of boxes in it, whose body is `at` (t, 3): (t, n), where they are off not above zero;
        None where their share of a force follows from areas."""
        return None

    def contact_depth(self, model: Model, row: int, sheet: SheetPart, part: P) -> float | None:
        """Depth of a sheet in it as the run begins by a row of the contacts, below zero by the distance where
        that is known; None where it is not computed."""
        return max(0.0, self.depth_at_start(model, sheet, part))

    def half_depth(self, part: P) -> float:
        """Half of what a box would have to cross to be behind it."""
        return 0.5

    def constraints(self, model: Model, sheet: SheetPart, part: P) -> list[tuple[Floats, Floats]] | None:
        """Points of a sheet that it has a contact with and the directions in which it holds them, in a static
        run; None where that is not known."""
        return None

    # -- what is shown of it

    def place(self, part: P) -> str:
        """Path in the scene of the value that places it, for lints."""
        return f"{self.table}.{part.name}.center"

    def drawn(self, part: P, half: Floats) -> list[Drawn]:
        """Its shape; half: half lengths of its body, see Bodies."""
        raise NotImplementedError

    def facts(self, model: Model, part: P) -> list[str]:
        """Sentences about its state as the run begins."""
        raise NotImplementedError

    def label(self, model: Model, part: P, seen: tuple[Floats, Floats]) -> Floats:
        """Place of its name in a picture, (3,); seen: least and greatest coordinates of moving parts."""
        return model.bodies.position[part.body]

    def overview(self, part: P) -> dict[str, Any]:
        """Entries of `mdlgen check --json` for one that is `described`."""
        return {}
