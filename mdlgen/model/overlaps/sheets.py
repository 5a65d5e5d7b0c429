"""Sheets and what they have no contact with, other sheets and rigid parts: whether they come to overlap.

Two sheets in one place are always a mistake. A sheet that is inside a rigid part where both are given stands
in a hole that is not modelled, and that pair is left alone. Meshes are not checked.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mdlgen.model.moved import as_begun, since
from mdlgen.model.overlaps.fold import overlaps
from mdlgen.model.overlaps.parts import HAIR
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.tables import (
    Floats,
    Ints,
    MachinePart,
    Model,
    SheetPart,
)

# Greatest depth of two sheets in each other, relative to the thinner one: material between them is
# compressed.
DEEP = 0.5
# Distances below which one sheet lies on another, relative to the thinner one, and on a part, to the sheet.
ON_SHEET, ON_PART = 0.5, 0.75
# Places of a box that are checked, along and across it, in half lengths.
_PLACES = np.array([[i, j] for i in (-1.0, 0.0, 1.0) for j in (-1.0, 0.0, 1.0)])
_AT_ONCE = 256  # boxes of a sheet that are compared with all of another

Extent = tuple[Floats, Floats]  # low and high corner [mm], (3,) each


class SheetOverlaps:
    """The pairs of a Model without a contact of which one is a sheet, and what they do at its states."""

    def __init__(self, model: Model, solved: NDArray[np.bool_] | None = None) -> None:
        """`solved` (bodies,): those whose places are known, of a scene that is halved by its symmetry."""
        self._model = model
        boxes = [np.arange(s.first, s.first + s.count) for s in model.sheets]
        self._boxes: list[Ints] = [b if solved is None else b[solved[b]] for b in boxes]
        self._reach: dict[str, Extent] = {}
        self._arms = np.linalg.norm(model.bodies.half, axis=1)
        met = {frozenset(pair) for pair in zip(model.contacts.part_a, model.contacts.part_b, strict=True)}
        self._parts = list(self._with_parts(met))
        count = len(model.sheets)
        apart = [
            (a, b)
            for a in range(count)
            for b in range(a + 1, count)
            if frozenset((model.sheets[a].name, model.sheets[b].name)) not in met
        ]
        self._sheets: Ints = np.array(apart, int).reshape(-1, 2)
        # Two sheets are checked again once they may have come together: how far apart they were, and how
        # far both had come by then.
        self._apart = np.zeros(len(apart))
        self._then = np.zeros(len(apart))
        self._way = np.zeros(count)
        self._last: tuple[Floats, Floats] | None = None
        rotation = model.bodies.rotation.reshape(-1, 9)
        self._watched = [
            (sheet, part)
            for sheet, part in self._parts
            if self._inside(sheet, part, model.bodies.position, rotation, 0.0, HAIR) == 0.0
        ]

    def _with_parts(self, met: set[frozenset[str]]) -> Iterator[tuple[int, MachinePart]]:
        model = self._model
        carrying = {model.rollers[m.on].name for m in model.meshes if m.on >= 0}
        for k, sheet in enumerate(model.sheets):
            for part in model.machine:
                if part.name not in carrying and frozenset((sheet.name, part.name)) not in met:
                    yield k, part

    def found(
        self, position: Floats, rotation: Floats, time: float, there: NDArray[np.bool_] | None = None
    ) -> str | None:
        """Why a run cannot go on from places (n, 3) [mm] and rotations (n, 9) of bodies at a time [ms]; None:
        it can. `there` (sheets,): sheets that are, None: all."""
        if not len(self._sheets) and not self._watched:
            return None
        extents = [
            self._extent(boxes if there is None or there[k] else boxes[:0], position, rotation)
            for k, boxes in enumerate(self._boxes)
        ]
        self._moved(position, rotation)
        for k in self._near(extents, there):
            one, two = (int(s) for s in self._sheets[k])
            deep, apart = self._between(one, two, position, rotation)
            self._apart[k], self._then[k] = apart, self._way[one] + self._way[two]
            if deep > DEEP * self._thin(one, two):
                return self._reason(f"sheet {self._name(one)}", f"sheet {self._name(two)}", deep, time)
        for sheet, part in self._watched:
            if there is not None and not there[sheet]:
                continue
            if self._apart_from(part, extents[sheet], position):
                continue
            deep = self._inside(sheet, part, position, rotation, 0.0, HAIR)
            if deep:
                other = self._model.called(part.body)
                return self._reason(f"sheet {self._name(sheet)}", other, deep, time)
        return None

    def in_each_other(self, one: int, two: int, position: Floats, rotation: Floats) -> float:
        """How deep two sheets, by their numbers, are in each other [mm]; 0 where that is no more than
        contacts press them."""
        extents = [self._extent(self._boxes[k], position, rotation) for k in (one, two)]
        if _gap(*extents) > 0.0:
            return 0.0
        deep, _ = self._between(one, two, position, rotation)
        return deep if deep > DEEP * self._thin(one, two) else 0.0

    def begin(self) -> tuple[list[tuple[SheetPart, SheetPart]], list[tuple[SheetPart, MachinePart]]]:
        """The pairs that lie on each other, or in each other, where they are given."""
        model = self._model
        position, rotation = model.bodies.position, model.bodies.rotation.reshape(-1, 9)
        extents = [self._extent(boxes, position, rotation) for boxes in self._boxes]
        sheets = [
            (model.sheets[a], model.sheets[b])
            for a, b in self._sheets.tolist()
            if model.sheets[a].enters == model.sheets[b].enters == 0.0
            and _gap(extents[a], extents[b]) < ON_SHEET * self._thin(a, b)
            and self._between(a, b, position, rotation)[0] > -ON_SHEET * self._thin(a, b)
        ]
        parts = []
        for k, part in self._parts:
            sheet = model.sheets[k]
            off = ON_PART * sheet.thickness
            if not self._apart_from(part, extents[k], position, sheet.thickness) and any(
                self._inside(k, part, position, rotation, side * off, 0.0) for side in (-1.0, 0.0, 1.0)
            ):
                parts.append((sheet, part))
        return sheets, parts

    def _name(self, sheet: int) -> str:
        return self._model.sheets[sheet].name

    def _thin(self, one: int, two: int) -> float:
        return min(self._model.sheets[one].thickness, self._model.sheets[two].thickness)

    def _reason(self, one: str, two: str, deep: float, time: float) -> str:
        names = ", ".join(called.partition(" ")[2] for called in (one, two))
        return (
            f"{one} and {two} overlap by {deep:.3g} mm at {time:.6g} ms, and no contact holds them apart; "
            f"give a contact between [{names}]"
        )

    def _extent(self, boxes: Ints, position: Floats, rotation: Floats) -> Extent:
        if not len(boxes):
            return np.full(3, np.inf), np.full(3, -np.inf)
        reach, at = self._reaches(boxes, rotation), position[boxes]
        return (at - reach).min(axis=0), (at + reach).max(axis=0)

    def _moved(self, position: Floats, rotation: Floats) -> None:
        """Adds to how far each sheet has come what a corner of it has moved at most."""
        if len(self._sheets):
            position, rotation = (array[: len(self._arms)].copy() for array in (position, rotation))
            if self._last is not None:
                moved = np.linalg.norm(position - self._last[0], axis=1)
                moved += self._arms * np.linalg.norm(rotation - self._last[1], axis=1)
                self._way += [moved[boxes].max(initial=0.0) for boxes in self._boxes]
            self._last = position, rotation

    def _near(self, extents: list[Extent], there: NDArray[np.bool_] | None) -> list[int]:
        """Pairs of sheets that must be checked; for the others the distance of their bounds is noted."""
        if not len(self._sheets):
            return []
        ways = self._way[self._sheets].sum(axis=1)
        due = np.flatnonzero(~(ways - self._then < self._apart))
        if there is not None:
            due = due[there[self._sheets[due]].all(axis=1)]
        low, high = (np.array([e[k] for e in extents]) for k in (0, 1))
        one, two = self._sheets[due].T
        gaps = np.maximum(low[one] - high[two], low[two] - high[one]).max(axis=1)
        clear = gaps > 0.0
        self._apart[due[clear]], self._then[due[clear]] = gaps[clear], ways[due[clear]]
        return due[~clear].tolist()

    def _between(self, one: int, two: int, position: Floats, rotation: Floats) -> tuple[float, float]:
        """How deep two sheets are in each other, below zero where they are apart, and how far apart they are
        at least [mm]."""
        half = self._model.bodies.half
        a, b = self._boxes[one], self._boxes[two]
        if not (len(a) and len(b)):
            return -np.inf, np.inf
        margin = 2.0 * max(half[a][:, 2].max(), half[b][:, 2].max())
        first, second = self._close(a, b, position, rotation, margin)
        if not len(first):
            return -margin, margin
        gap = position[second] - position[first]
        turns = [rotation[boxes].reshape(-1, 3, 3) for boxes in (first, second)]
        halves = half[first], half[second]
        # most are apart along a normal of the two, which is the least work to see
        deep = _along_normals(gap, turns, halves)
        left = np.flatnonzero(deep > 0.0)
        if len(left):
            deep[left] = overlaps(gap[left], *(t[left] for t in turns), *(h[left] for h in halves))
        worst = float(deep.max())
        return max(worst, -margin), max(0.0, min(-worst, margin))

    def _close(
        self, a: Ints, b: Ints, position: Floats, rotation: Floats, margin: float
    ) -> tuple[Ints, Ints]:
        """Boxes of two sheets, by pairs, of which the bounds are no further apart than `margin`."""
        reach_a, reach_b = self._reaches(a, rotation) + margin, self._reaches(b, rotation)
        at_a, at_b = position[a], position[b]
        low, high = (at_b - reach_b).min(axis=0), (at_b + reach_b).max(axis=0)
        among = np.flatnonzero(((at_a - reach_a <= high) & (at_a + reach_a >= low)).all(axis=1))
        pairs: list[Ints] = []
        for k in range(0, len(among), _AT_ONCE):
            some = among[k : k + _AT_ONCE]
            gap = np.abs(at_a[some][:, None] - at_b) - reach_a[some][:, None] - reach_b
            one, two = np.nonzero((gap <= 0.0).all(axis=2))
            pairs.append(np.stack([a[some[one]], b[two]]))
        first, second = np.concatenate(pairs, axis=1) if pairs else np.zeros((2, 0), int)
        return first, second

    def _reaches(self, boxes: Ints, rotation: Floats) -> Floats:
        """Half extents of boxes along the global axes [mm], (n, 3)."""
        turns = np.abs(rotation[boxes].reshape(-1, 3, 3))
        return np.einsum("nij,nj->ni", turns, self._model.bodies.half[boxes])

    def _apart_from(self, part: MachinePart, extent: Extent, position: Floats, more: float = 0.0) -> bool:
        moving = getattr(part, "moving", None)
        if moving is not None and moving.turns:
            return False
        if part.name not in self._reach:
            self._reach[part.name] = self._part_extent(part)
        low, high = self._reach[part.name]
        return _gap(extent, (low + position[part.body], high + position[part.body])) > more

    def _part_extent(self, part: MachinePart) -> Extent:
        """Bounds of a part about the place of its body."""
        kind, bodies = kind_of(part), self._model.bodies
        low, high = (
            sign * np.array([kind.reach(part, bodies, sign * axis) for axis in np.eye(3)])
            for sign in (-1.0, 1.0)
        )
        return low - bodies.position[part.body], high - bodies.position[part.body]

    def _inside(
        self, sheet: int, part: MachinePart, position: Floats, rotation: Floats, off: float, least: float
    ) -> float | None:
        """How deep places of a sheet, `off` its middle by so much, are in a part; 0 below `least` [mm], None
        where that is not computed."""
        boxes = self._boxes[sheet]
        if not len(boxes):
            return 0.0
        half, turns = self._model.bodies.half[boxes], rotation[boxes].reshape(-1, 3, 3)
        own = np.empty((len(boxes), len(_PLACES), 3))
        own[:, :, :2] = half[:, None, :2] * _PLACES
        own[:, :, 2] = off
        at = position[boxes]
        points = at[:, None] + np.einsum("nij,nkj->nki", turns, own)
        bodies = self._model.bodies
        stands = position[part.body], bodies.rotation[part.body]
        if getattr(part, "moving", None) is not None:
            turned = since(bodies, part.body, rotation[part.body].reshape(3, 3))
            points = as_begun(bodies, part.body, position[part.body], turned, points)
            at = as_begun(bodies, part.body, position[part.body], turned, at)
            stands = bodies.position[part.body], bodies.rotation[part.body]
        deep = kind_of(part).inside(part, points, at[:, None], *stands)
        if deep is None:
            return None
        worst = float(deep.max())
        return worst if worst > least else 0.0


def _gap(one: Extent, two: Extent) -> float:
    """How far two bounds are apart, below zero where they overlap."""
    return float(np.maximum(one[0] - two[1], two[0] - one[1]).max())


def _along_normals(gap: Floats, turns: list[Floats], halves: tuple[Floats, Floats]) -> Floats:
    """How far blocks overlap along the normals of the two, the less of both; (n,), as of `fold.overlaps`."""
    least = np.full(len(gap), np.inf)
    for normal in (turns[0][:, :, 2], turns[1][:, :, 2]):
        reach = sum(
            (np.abs(np.einsum("ni,nij->nj", normal, turn)) * half).sum(axis=1)
            for turn, half in zip(turns, halves, strict=True)
        )
        least = np.minimum(least, reach - np.abs(np.einsum("ni,ni->n", normal, gap)))
    return least
