"""Rollers and the plates, guides and meshes that they have no contact with: whether they come to overlap.

Parts that overlap where they are given stand in a hole that is not modelled, and are not checked. The same
holds for a roller that presses on one in such a hole, right below it, and is no wider and no larger: where
the nip yields it moves into the same hole. Parts that are apart at first and overlap later, or once springs
are in balance, would need a contact, and the run ends. Checked are pairs of which a part moves: a roller on a
slide or an arm, a plate on a slide.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from mdlgen.geometry.rods import Rod
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import (
    Floats,
    MachinePart,
    Model,
    Press,
    RollerPart,
)

HAIR = 0.05  # mm: less is the depth of the contacts through a sheet between the two
_STEPS = 33  # places along a slide that are checked


class Pair(NamedTuple):
    """A roller and a part without a contact, and how much they overlap where they are given."""

    roller: RollerPart
    part: MachinePart
    start: float


def _press(part: MachinePart) -> Press | None:
    return kind_of(part).press(part)


def rod(roller: RollerPart, center: Floats) -> Rod:
    """A roller at a place; of a rim the least radius, wherever that stands."""
    radius = roller.radius if roller.rim is None else float(roller.rim.radius.min())
    return Rod(center, roller.axis, radius, 0.5 * roller.width)


class Overlaps:
    """The pairs of a Model that are checked, and their overlaps at its states."""

    def __init__(self, model: Model) -> None:
        self._model = model
        self._into_part: dict[int, Callable[[Rod], float]] = {}
        self._met = set(zip(model.contacts.part_a, model.contacts.part_b, strict=True))
        self.pairs = [Pair(roller, part, self._given(roller, part)) for roller, part in self._candidates()]
        self._watched = [
            pair
            for pair in self.pairs
            if pair.start <= HAIR and not self._over_a_hole(pair.roller, pair.part)
        ]
        self._bodies = np.array([[p.roller.body, p.part.body] for p in self._watched], int).reshape(-1, 2)
        # relative place of a pair when it was checked last, and its distance then
        self._places = np.zeros((len(self._watched), 3))
        self._apart = np.zeros(len(self._watched))

    def _candidates(self) -> Iterator[tuple[RollerPart, MachinePart]]:
        model = self._model
        parts = [p for p in model.machine if not isinstance(p, RollerPart) and kind_of(p).carrier(p) < 0]
        for roller in model.rollers:
            moves = roller.press is not None or roller.arm is not None
            for part in parts:
                if (moves or _press(part) is not None) and (roller.name, part.name) not in self._met:
                    yield roller, part

    def _over_a_hole(self, roller: RollerPart, part: MachinePart) -> bool:
        """True if a roller is pressed on one that stands in a hole of the part, right below it, and is no
        wider and no larger."""
        press = roller.press
        if press is None or _press(part) is not None:
            return False
        for other in self._model.rollers:
            nip = {(roller.name, other.name), (other.name, roller.name)} & self._met
            if not nip or (other.name, part.name) in self._met or other.radius < roller.radius:
                continue
            gap = other.center - roller.center
            along, ahead = float(gap @ roller.axis), float(gap @ press.direction)
            aside = float(np.linalg.norm(gap - along * roller.axis - ahead * press.direction))
            narrow = abs(along) + 0.5 * (roller.width - other.width) <= HAIR
            if ahead > 0.0 and aside <= HAIR and narrow and self._given(other, part) > HAIR:
                return True
        return False

    def _given(self, roller: RollerPart, part: MachinePart) -> float:
        """Overlap where both are given: a spring may have moved one into the other before the run."""
        by = np.zeros(3)
        if _press(part) is not None:
            by = part.center - self._model.bodies.position[part.body]
        return self.depth(roller, part, roller.center, by)

    def depth(
        self, roller: RollerPart, part: MachinePart, at: Floats | None = None, by: Floats | None = None
    ) -> float:
        """How far a roller with its centre `at` overlaps a part that has moved `by`; as they begin [mm]."""
        return max(0.0, self._into(roller, part, at, by))

    def _into(
        self, roller: RollerPart, part: MachinePart, at: Floats | None = None, by: Floats | None = None
    ) -> float:
        """As `depth`; below zero by how far they are apart at least."""
        position = self._model.bodies.position
        center = position[roller.body] if at is None else at
        shape = rod(roller, center if by is None else center - by)
        if part.body not in self._into_part:
            kind, rotation = kind_of(part), self._model.bodies.rotation
            self._into_part[part.body] = kind.overlap(part, position[part.body], rotation[part.body])
        return self._into_part[part.body](shape)

    def found(self, position: Floats, time: float) -> str | None:
        """Why a run cannot go on from places of bodies (n, 3) at a time [ms]; None: it can.

        A pair is checked again once it may have come together since then.
        """
        if not self._watched:
            return None
        start = self._model.bodies.position
        rollers, parts = self._bodies.T
        moved = position[parts] - start[parts]
        places = position[rollers] - moved
        way = np.sqrt(np.square(places - self._places).sum(axis=1))
        for k in np.flatnonzero(~(way < self._apart)):
            roller, part, before = self._watched[k]
            deep = self._into(roller, part, position[roller.body], moved[k])
            self._places[k], self._apart[k] = places[k], max(0.0, -deep)
            if deep > HAIR + before:
                two = [self._model.called(body) for body in (roller.body, part.body)]
                return (
                    f"{two[0]} and {two[1]} overlap by {deep:.3g} mm at {time:.6g} ms, and no contact holds "
                    f"them apart; give a contact between [{roller.name}, {part.name}]"
                )
        return None

    def ahead(self) -> list[Pair]:
        """The pairs that are apart and in each other's path. A pressed roller goes up to what it is pressed
        on, or by its radius; a plate up to the end of its spring's push. An arm that meets no other part goes
        by a radius either way."""
        return [pair for pair in self._watched if any(self._deep(pair, *move) for move in self._moves(pair))]

    def _deep(self, pair: Pair, at: Floats, by: Floats) -> bool:
        return self.depth(pair.roller, pair.part, at, by) > HAIR + pair.start

    def _rows(self, roller: RollerPart) -> list[int]:
        """Contacts of a roller with other parts of the machine."""
        table = self._model.contacts
        sides = list(zip(table.part_a, table.part_b, strict=True))
        return [k for k in np.flatnonzero(table.of_machine).tolist() if roller.name in sides[k]]

    def _moves(self, pair: Pair) -> Iterator[tuple[Floats, Floats]]:
        roller, part, _ = pair
        model, still = self._model, np.zeros(3)
        start = model.bodies.position[roller.body]
        weight = model.begun_gravity
        if roller.press is not None:
            spring = roller.press
            mass = roller.loaded_mass + spring.carrier_mass
            force = spring.preload + mass * float(weight @ spring.direction)
            rows = self._rows(roller)
            if rows:
                softest = float(model.contacts.stiffness[rows].min())
                far = spring.touch - spring.start + (max(force, 0.0) / softest) ** (2 / 3)
            else:
                far = roller.radius
                if spring.stiffness > 0.0:
                    far = min(far, spring.touch + force / spring.stiffness - spring.start)
            for part_of in np.linspace(0.0, max(far, 0.0), _STEPS):
                yield start + part_of * spring.direction, still
        if roller.arm is not None and not self._rows(roller):
            arm = start - roller.arm.pivot
            length = float(np.linalg.norm(arm - roller.axis * (arm @ roller.axis)))
            most = min(np.pi, roller.radius / length)
            for turn in matrices(np.outer(np.linspace(-most, most, _STEPS), roller.axis)):
                yield roller.arm.pivot + turn @ arm, still
        spring = _press(part)
        if spring is not None:
            force = spring.preload + float(model.bodies.mass[part.body]) * float(weight @ spring.direction)
            far = spring.free_length
            if spring.stiffness > 0.0:
                far = min(far, force / spring.stiffness)
            for part_of in np.linspace(0.0, far - spring.start, _STEPS):
                yield start, part_of * spring.direction
