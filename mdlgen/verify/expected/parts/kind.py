"""Expected content of an MDL file for a part of the machine, by entity. Lengths in mm, places and axes
global.

A new kind is a file in this folder with the name of the kind.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from mdlgen.altair.masses import masses
from mdlgen.altair.moving import joint_of, spring_axes
from mdlgen.altair.rims import Side
from mdlgen.altair.stops import stopped
from mdlgen.mechanics.gate import BLUNT
from mdlgen.model.tables import Floats, MachinePart, Model, MovingPart, Press
from mdlgen.verify.expected.units import SECOND
from mdlgen.verify.tables import Table

P = TypeVar("P", bound=MachinePart)


class Body(NamedTuple):
    """A body that the Model has no row for."""

    name: str
    mass: float  # [g]
    inertia: tuple[float, float, float]  # about its middle [g mm^2]
    place: Floats


class Joint(NamedTuple):
    """A joint between two bodies."""

    name: str
    type: str
    one: str
    two: str
    origin: Floats
    axis: Floats


class Box(NamedTuple):
    """A box that is shown."""

    name: str
    body: str
    center: Floats
    rotation: Floats  # axes in columns
    lengths: Floats | tuple[float, float, float]


class Marker(NamedTuple):
    """A marker that the text itself makes."""

    name: str
    body: str
    origin: Floats
    rotation: Floats  # axes in columns


class Spring(NamedTuple):
    """The spring of a pressed part, from its place to its anchor on ground."""

    name: str
    body: str
    press: Press
    place: Floats
    anchor: Floats


class Bushing(NamedTuple):
    """A spring about z, or along it, between a body and ground."""

    name: str
    body: str
    origin: Floats
    rotation: Floats  # axes in columns
    stiffness: float  # [N mm/rad]
    damping: float  # [N mm ms/rad]
    torque: float  # [N mm]
    turns: bool = True  # else along z: [N/mm], [N ms/mm] and [N]


class Kind(Generic[P]):
    """One kind of part, without entities unless a kind adds them."""

    def bodies(self, model: Model, part: P) -> Iterable[Body]:
        return ()

    def points(self, model: Model, part: P) -> Iterable[tuple[str, Floats]]:
        return ()

    def joints(self, model: Model, part: P) -> Iterable[Joint]:
        """But for the fixed joints of bodies that do not move."""
        return ()

    def boxes(self, model: Model, part: P) -> Iterable[Box]:
        return ()

    def markers(self, model: Model, part: P) -> Iterable[Marker]:
        return ()

    def vectors(self, model: Model, part: P) -> Iterable[tuple[str, Floats]]:
        return ()

    def outputs(self, model: Model, part: P) -> Iterable[tuple[str, Iterable[float]]]:
        """Six numbers each, in the made-up state."""
        return ()

    def springs(self, model: Model, part: P) -> Iterable[Spring]:
        return ()

    def bushings(self, model: Model, part: P) -> Iterable[Bushing]:
        return ()

    def data(self, model: Model, part: P) -> dict[str, float]:
        """The values that the MDL file computes, by member of the part's data set."""
        return {}

    def tables(self, model: Model) -> dict[str, Table]:
        """Tables of entities that only parts of this kind have, by the name in the read-back."""
        return {}

    def graphics(self, part: P, side: Side) -> list[str]:
        """Names of what a contact with one side of it acts on."""
        raise NotImplementedError

    def names(self, part: P) -> set[str]:
        """The names of entities in an MDL file that derive from its name, without contacts."""
        return {f"{kind}_{part.name}" for kind in ("p", "b", "gbox", "gcyl", "j", "o", "ds")} | {
            f"{start}_{part.name}_{end}" for start, end in (("p", "pivot"), ("j", "pivot"), ("j", "slide"))
        }


def own_vector(name: str, direction: Floats) -> Iterable[tuple[str, Floats]]:
    """A direction as a vector of its own; along a global axis there is one already."""
    there = any(np.array_equal(direction, axis) for axis in np.eye(3))
    return () if there else ((name, direction),)


def axis_vectors(name: str, rotation: Floats) -> Iterable[tuple[str, Floats]]:
    """The two that give a marker its axes, which are the columns of `rotation`."""
    return ((f"{name}_z", rotation[:, 2]), (f"{name}_x", rotation[:, 0]))


def gate_joint(name: str, moving: MovingPart | None, place: Floats) -> Iterable[Joint]:
    """The joint of a part that moves by a profile, at its pivot or its place."""
    if moving is None:
        return ()
    word, type = joint_of(moving)
    at = moving.pivot if moving.turns else place
    return (Joint(f"j_{name}_{word}", type, f"b_{name}", "B_Ground", at, moving.axis),)


def gate_points(
    model: Model, body: int, name: str, moving: MovingPart | None
) -> Iterable[tuple[str, Floats]]:
    """The point that a part turns about, and where its mass is if it does so freely."""
    if moving is None or not moving.turns:
        return ()
    pivot = (f"p_{name}_pivot", moving.pivot)
    return (pivot, (f"p_{name}_mass", masses(model).place[body])) if moving.free else (pivot,)


def gate_spring(name: str, moving: MovingPart | None, place: Floats) -> Iterable[Bushing]:
    """The spring of a part that moves freely."""
    if moving is None or not moving.sprung:
        return ()
    axes = spring_axes(moving)
    law = (moving.stiffness, moving.damping, moving.force)
    at = moving.pivot if moving.turns else place
    return (Bushing(f"bsh_{name}_gate", f"b_{name}", at, axes, *law, moving.turns),)


def stops_data(model: Model, name: str) -> dict[str, float]:
    """What a text computes of the stops of a part."""
    for one in stopped(model, BLUNT):
        if one.name == name:
            return {"b_e": one.share, "o_e": one.blunt / SECOND}
    return {}


def gate_way(name: str, moving: MovingPart | None) -> Iterable[tuple[str, Floats]]:
    """Its axis, or its direction, as a vector."""
    return () if moving is None else own_vector(f"v_{name}_moves", moving.axis)


def spring_of(model: Model, part: MachinePart, press: Press, body: str) -> Spring:
    """The spring of a part that stands where its body does."""
    anchor = part.center + press.direction * (press.touch - press.free_length)
    return Spring(f"cs_{part.name}", body, press, model.bodies.position[part.body], anchor)
