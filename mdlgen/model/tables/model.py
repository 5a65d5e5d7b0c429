"""The Model: all tables of a scene."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.over_time import factor, most, no_profile
from mdlgen.model.tables.bodies import (
    Bodies,
    Bushings,
    Corners,
    Curves,
    Frozen,
    Plastic,
    no_corners,
    no_plastic,
)
from mdlgen.model.tables.contacts import Contacts, ExternalPairs, Pairs
from mdlgen.model.tables.machine import (
    ExternalPart,
    GuidePart,
    MachinePart,
    MeshPart,
    PlanePart,
    Press,
    RollerPart,
)
from mdlgen.model.tables.moving import MovingPart
from mdlgen.model.tables.reactions import Reactions, no_reactions
from mdlgen.model.tables.sheets import SheetPart

P = TypeVar("P")

GROUND = -1
# A contact that gets too deep within fewer steps than this after touching may be held by finer steps.
FEW_STEPS = 4
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Anchor(Frozen):
    """A material point of a sheet: the mean of points on one or more boxes."""

    name: str
    sheet: int
    body: Ints  # (n,)
    local: Floats  # box axes [mm], (n, 3)
    share: Floats  # sums to 1, (n,)
    node: Ints  # nearest grid node as in Bushings.node; for the text
    at: tuple[float, float]  # sheet axes, from the centre [mm]
    edge: str | None
    formulas: tuple[str, str] = ("", "")  # formulas of `at`, as of a Parameter


@dataclass(frozen=True)
class Loads(Frozen):
    """Dead loads on bodies, global axes: a force at a point fixed in the body, and a moment."""

    body: Ints  # (n,)
    local: Floats  # (n, 3)
    force: Floats  # [N], (n, 3)
    moment: Floats  # [N mm], (n, 3)
    entry: Ints  # index in the spec's list, (n,)
    edge: tuple[str, ...]  # edge of each entry; empty: at a point
    # corners of a factor over time of each entry [ms, 1], (n, 2), (0, 2): 1; none at all: none has any
    profiles: tuple[Floats, ...] = ()

    @property
    def changing(self) -> list[int]:
        """The entries that have a factor over time."""
        return [entry for entry, profile in enumerate(self.profiles) if len(profile)]


@dataclass(frozen=True)
class Tension:
    """A clamped sheet that is pulled at the opposite edge."""

    sheet: int
    axis: int  # axis of the pull, 0: x, 1: y
    length: float  # sum of the joint lengths [mm]


@dataclass(frozen=True)
class Parameter:
    """A value that the user gave, by the name under which the text is written in it."""

    data_set: str  # identifier without the ds_ prefix
    member: str  # identifier without the real_ prefix
    label: str
    value: float  # internal units
    unit: str  # internal unit, as the user may write it
    path: tuple[str | int, ...] | None  # path in the spec; None: computed
    formula: str = ""  # formula over the parameters of the scene, as the user wrote it; "": a number
    follows: str = ""  # a formula over other rows, see parameters.starts; "": it does not


@dataclass(frozen=True)
class RunSettings:
    """How the Model is run; times in ms."""

    duration: float
    analysis: str
    step: float | None
    tolerance: float
    print_step: float
    symmetry: bool  # a scene that is its own mirror image may be halved
    threads: int = 1  # key of scenes of older versions; it has no effect
    sleep: bool = True  # sheets that rest may be left out
    limit: float | None = None  # wall time after which a run ends with its part so far; None: none
    margin: float | None = None  # margin for the first choice of pairs [mm]; None: of an older file


@dataclass(frozen=True)
class Model(Frozen):
    """A scene in plain tables."""

    name: str
    gravity: Floats  # [mm/ms^2], (3,)
    sheets: tuple[SheetPart, ...]
    machine: tuple[
        MachinePart, ...
    ]  # all its parts that have a body, as these are numbered: by kind, by name
    externals: tuple[ExternalPart, ...]  # a Model that has one is not run here
    bodies: Bodies
    bushings: Bushings
    curves: Curves
    contacts: Contacts
    pairs: Pairs
    external_pairs: ExternalPairs
    loads: Loads
    probes: tuple[Anchor, ...]
    supports: tuple[Anchor, ...]  # named support_0, ... as the bushings that hold them
    tension: Tension | None
    parameters: tuple[Parameter, ...]
    run: RunSettings
    unfollowed: tuple[tuple[str, str], ...] = ()  # formulas of values without a Parameter: places, texts
    following: tuple[int, ...] = ()  # entries of the contacts whose smoothing follows from the speeds
    require: tuple[str, ...] = ()  # requirements of a run, see spec.require
    author: str = ""  # author of the design, for the head of the page
    revision: str = ""
    plastic: Plastic = field(default_factory=no_plastic)
    corners: Corners = field(default_factory=no_corners)  # Poisson's effect of plates
    reactions: Reactions = field(default_factory=no_reactions)
    gravity_profile: Floats = field(default_factory=no_profile)  # corners [ms, 1], (n, 2); (0, 2): 1

    def __repr__(self) -> str:
        kinds = ("sheets", "rollers", "planes", "guides", "meshes", "bushings", "contacts")
        message = ", ".join(
            f"{len(getattr(self, kind))} {kind}" for kind in kinds if len(getattr(self, kind))
        )
        return f"<Model {self.name}: {len(self.bodies.name)} bodies, {message}>"

    def parts_of(self, kind: type[P]) -> tuple[P, ...]:
        """The parts of the machine of one kind, by name."""
        return tuple(part for part in self.machine if isinstance(part, kind))

    @cached_property
    def rollers(self) -> tuple[RollerPart, ...]:
        return self.parts_of(RollerPart)

    @cached_property
    def planes(self) -> tuple[PlanePart, ...]:
        return self.parts_of(PlanePart)

    @cached_property
    def guides(self) -> tuple[GuidePart, ...]:
        return self.parts_of(GuidePart)

    @cached_property
    def meshes(self) -> tuple[MeshPart, ...]:
        return self.parts_of(MeshPart)

    def with_parts(self, parts: Iterable[MachinePart]) -> Model:
        """With these in place of those of their names."""
        new = {part.name: part for part in parts}
        return replace(self, machine=tuple(new.get(part.name, part) for part in self.machine))

    def roller(self, name: str) -> RollerPart:
        return next(r for r in self.rollers if r.name == name)

    @property
    def begun_gravity(self) -> Floats:
        """Gravity as the run begins [mm/ms^2], (3,)."""
        return factor(self.gravity_profile, 0.0) * self.gravity

    @property
    def most_gravity(self) -> Floats:
        """Gravity at its greatest in size [mm/ms^2], (3,)."""
        return most(self.gravity_profile) * self.gravity

    @property
    def changes(self) -> bool:
        """True if a load, or gravity, has a factor over time."""
        return len(self.gravity_profile) > 0 or bool(self.loads.changing)

    @property
    def plates(self) -> list[tuple[PlanePart, Press]]:
        """The planes that springs press, and their presses."""
        return [(plane, plane.press) for plane in self.planes if plane.press is not None]

    @cached_property
    def gates(self) -> tuple[tuple[PlanePart | GuidePart | MeshPart, MovingPart], ...]:
        """The parts that turn about a pivot or slide, by a profile or by forces, and how."""
        parts = (*self.planes, *self.guides, *self.meshes)
        return tuple((part, part.moving) for part in parts if part.moving is not None)

    @cached_property
    def stopped(self) -> tuple[RollerPart | PlanePart, ...]:
        """The rollers and planes whose arm or press has stops."""
        return tuple(
            part
            for part in (*self.rollers, *self.planes)
            for own in (part.press, part.arm if isinstance(part, RollerPart) else None)
            if own is not None and own.stops is not None
        )

    @property
    def pair_friction(self) -> Floats:
        """Friction of each stored pair relative to that of its contact, (pairs,)."""
        return self.bodies.friction[self.pairs.a] * self.bodies.friction[self.pairs.b]

    def mass_share(self, sheet: int) -> Floats:
        """Mass of each box of a sheet over that of the sheet, (boxes,): weights of its centre of mass."""
        part = self.sheets[sheet]
        mass = self.bodies.mass[part.first : part.first + part.count]
        return mass / mass.sum()

    def called(self, body: int) -> str:
        """Name of a part of the machine or a box in a sentence."""
        kind = next((part.kind for part in self.machine if part.body == body), "box")
        return f"{kind} {self.bodies.name[body]}"

    def too_deep(self, one: int, other: int, beside: bool = False) -> str:
        """The message about a box or a roller too deep in another part; beside: it came by its end."""
        rollers = {roller.body for roller in self.rollers}
        if {one, other} <= rollers:
            return f"{self.called(one)} and {self.called(other)} overlap by more than the smaller radius"
        sheets = {part.body for part in self.machine}.isdisjoint({one, other})
        if sheets:
            return (
                f"{self.called(one)} is more than three quarters of its thickness into {self.called(other)}"
            )
        size = "radius" if rollers & {one, other} else "thickness"
        if beside:
            return f"half of {self.called(one)} is past the end of {self.called(other)}"
        return f"{self.called(one)} is more than half of its {size} into {self.called(other)}"

    def held_by(self, one: int, way: float) -> str:
        """A remedy for a body that is too deep in another one and approaches by `way` [mm] in a step. It is a
        finer step only where a few of its steps are that deep."""
        sheet = self.sheet_of(one)
        finer = sheet is None or way > 0.5 * sheet.thickness / FEW_STEPS
        if finer:
            return "a stiffer contact or a smaller run.step would hold it"
        return "a stiffer contact would hold it, a smaller run.step would not"

    def bounds_of(self, body: int) -> tuple[str, str]:
        """The bounds of a body in words, and the remedy where it has left them."""
        for plate, press in self.plates:
            if plate.body == body:
                return (
                    f"the length of its spring, {press.free_length:g} mm either way",
                    "give a stiffness, preload or free_length that hold it",
                )
        return (
            "the bounds from which its contacts were chosen",
            f"a run.margin above {self.pairs.margin:g} mm would keep more pairs than the limit; set "
            "run.prune: false and raise it by --limit pairs=..",
        )

    def sheet_of(self, body: int) -> SheetPart | None:
        """The sheet that a body is a box of, or None."""
        return next((s for s in self.sheets if s.first <= body < s.first + s.count), None)
