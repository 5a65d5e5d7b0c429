"""The bodies that the steps of a pass have while sheets are not in the machine.

A step copies and clears the rows of all its bodies. So sheets that have not come yet, or have left, have no
rows: bodies that are there are numbered among themselves, in the same order, and numbered again as a sheet
comes in or leaves. Contacts keep their rows, sheets and parts their numbers. Sums have the same terms in the
same order: a pass is bitwise identical to one with the rows of all bodies.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.integrate.awake import Parts, awake
from mdlgen.backends.lattice.kernels.state import State
from mdlgen.mechanics.frame import Motion
from mdlgen.model.tables import Floats, Ints


class There(NamedTuple):
    """Which bodies there are, by their numbers in the whole System, rising, (n,), and the number that each of
    the whole has among them, (bodies + 1,), -1: none, as the last one; None: all of both."""

    bodies: Ints | None = None
    place: Ints | None = None

    @classmethod
    def of(cls, gone: NDArray[np.bool_]) -> There:
        """Without the bodies that are `gone` (bodies,)."""
        if not gone.any():
            return cls()
        bodies = np.flatnonzero(~gone)
        place = np.full(len(gone) + 1, -1)
        place[bodies] = np.arange(len(bodies))
        return cls(bodies, place)

    def whole(self, own: Ints) -> Ints:
        """The numbers in the whole of bodies that are there."""
        return own if self.bodies is None else self.bodies[own]

    def own(self, whole: Ints) -> Ints:
        """The numbers that bodies of the whole have here; -1: of the ground of a joint, or of one that is
        not there."""
        return whole if self.place is None else self.place[whole]

    def body(self, own: int) -> int:
        """The number in the whole of a body that is there."""
        return own if self.bodies is None else int(self.bodies[own])

    def number(self, body: int) -> int:
        """The number that a body of the whole has here, which is there."""
        return body if self.place is None else int(self.place[body])

    def rows(self, array: np.ndarray) -> np.ndarray:
        """Those of an array with a row for each body of the whole; with or without one for the ground."""
        if self.bodies is None:
            return array
        return array[self.bodies[self.bodies < len(array)]]


class Whole:
    """Where all bodies of a pass are."""

    def __init__(self, there: There, x: Floats, r: Floats):
        """Which of them are there; where all are as the pass begins: x (bodies, 3) [mm], r (bodies, 9)."""
        self.there, self._x, self._r = there, x, r

    def places(self, state: State) -> tuple[Floats, Floats]:
        """Of all bodies, x and r, with the state of those that are there; not to be written to."""
        if self.there.bodies is None:
            return state.x, state.r
        self._x[self.there.bodies], self._r[self.there.bodies] = state.x, state.r
        return self._x, self._r

    def motion(self, state: State, motion: Motion) -> Motion:
        """Of all bodies, in the same way, with their velocities; those that are not there have none."""
        x, r = self.places(state)
        if self.there.bodies is None:
            return Motion(x, r, motion.u, motion.w)
        u, w = np.zeros_like(x), np.zeros_like(x)
        u[self.there.bodies], w[self.there.bodies] = motion.u, motion.w
        return Motion(x, r, u, w)

    def carried(self, state: State) -> dict[str, np.ndarray]:
        """Where all bodies are, by names; `restore` has them all."""
        self._x, self._r = self.places(state)
        return {"sleep.x": self._x, "sleep.r": self._r}

    def turn(self, there: There, state: State) -> tuple[Floats, Floats]:
        """From now on these bodies are there; their x and r."""
        self._x, self._r = self.places(state)
        self.there = there
        return there.rows(self._x), there.rows(self._r)


def parts_of(
    system: System, parts: Parts, asleep: NDArray[np.bool_], gone: NDArray[np.bool_]
) -> tuple[System, Ints, There]:
    """The System with the sheets that are `asleep` (sheets,) as parts that do not move and without those that
    are `gone` (sheets,), which of the pairs before those that are searched it has, and which bodies.

    Films of air and bristles have numbers of bodies, and states that last: with them all bodies are there.
    """
    some, chosen = awake(system, parts, asleep, gone)
    if parts.air or len(system.bristles):
        return some, chosen, There()
    there = There.of(np.append(gone, False)[parts.sheet_of])  # the last one is of what is no sheet
    return _renumbered(some, there), chosen, there


def _renumbered(system: System, there: There) -> System:
    """A System with the bodies alone that are there, whose joints, pairs, loads and images are of these."""
    if there.bodies is None:
        return system
    own, search = there.own, system.search
    joints, pairs, loads = system.joints.copy(), system.pairs, system.loads.copy()
    joints["a"], joints["b"] = own(joints["a"]), own(joints["b"])
    first = pairs[: search.first]  # those behind are searched
    first["a"], first["b"] = own(first["a"]), own(first["b"])
    loads["body"] = own(loads["body"])
    images = system.images[own(system.images["body"]) >= 0]
    images["body"], images["of"] = own(images["body"]), own(images["of"])
    regions = search.regions.copy()
    regions["a"], regions["b"] = own(regions["a"]), own(regions["b"])
    radius = there.rows(search.radius)
    return system._replace(
        bodies=system.bodies[there.bodies],
        joints=joints,
        pairs=pairs,
        loads=loads,
        nodes=own(system.nodes),
        images=images,
        search=search._replace(
            regions=regions,
            boxes=own(search.boxes),
            place=np.zeros((len(radius), 3)),
            radius=radius,
            rough=there.rows(search.rough),
            following=np.full(len(radius), -1, np.int64),
            cell=np.zeros((len(radius), 3), np.int64),
        ),
    )
