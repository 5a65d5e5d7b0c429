"""Numbering of the present bodies, while some sheets are not in the machine.

A step copies and clears the rows of all its bodies. So sheets that have not entered yet, or have left, have
no rows. The present bodies are renumbered, in the same order, each time a sheet comes in or leaves. Contacts
keep their rows; sheets and parts keep their numbers. Sums have the same terms in the same order, so a pass is
bitwise identical to one with the rows of all bodies.
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
    """The present bodies of a System. Both fields are None if all bodies are present."""

    bodies: Ints | None = None  # their numbers in the whole System, in ascending order, (n,).
    # number of each body of the whole System among them, (bodies + 1,); -1: absent, and the last one, ground
    place: Ints | None = None

    @classmethod
    def of(cls, gone: NDArray[np.bool_]) -> There:
        """All bodies except those that are `gone` (bodies,)."""
        if not gone.any():
            return cls()
        bodies = np.flatnonzero(~gone)
        place = np.full(len(gone) + 1, -1)
        place[bodies] = np.arange(len(bodies))
        return cls(bodies, place)

    def whole(self, own: Ints) -> Ints:
        """Numbers in the whole System of present bodies."""
        return own if self.bodies is None else self.bodies[own]

    def own(self, whole: Ints) -> Ints:
        """Numbers of bodies of the whole System among the present ones; -1: absent, or the ground of a
        joint."""
        return whole if self.place is None else self.place[whole]

    def body(self, own: int) -> int:
        """Number in the whole System of a present body."""
        return own if self.bodies is None else int(self.bodies[own])

    def number(self, body: int) -> int:
        """Number of a body of the whole System, which must be present, among the present ones."""
        return body if self.place is None else int(self.place[body])

    def rows(self, array: np.ndarray) -> np.ndarray:
        """Rows of present bodies, of an array for the whole System; it may have a last row for the ground."""
        if self.bodies is None:
            return array
        return array[self.bodies[self.bodies < len(array)]]


class Whole:
    """Places of all bodies of a pass: the present ones from its state, the others as they were last."""

    def __init__(self, there: There, x: Floats, r: Floats):
        """`there`: the present bodies; x (bodies, 3) [mm], r (bodies, 9): all bodies as the pass begins."""
        self.there, self._x, self._r = there, x, r

    def places(self, state: State) -> tuple[Floats, Floats]:
        """x and r of all bodies, with the present ones from `state`; the caller must not change them."""
        if self.there.bodies is None:
            return state.x, state.r
        self._x[self.there.bodies], self._r[self.there.bodies] = state.x, state.r
        return self._x, self._r

    def motion(self, state: State, motion: Motion) -> Motion:
        """Motion of all bodies, with the present ones from `state`; the velocities of the others are 0."""
        x, r = self.places(state)
        if self.there.bodies is None:
            return Motion(x, r, motion.u, motion.w)
        u, w = np.zeros_like(x), np.zeros_like(x)
        u[self.there.bodies], w[self.there.bodies] = motion.u, motion.w
        return Motion(x, r, u, w)

    def carried(self, state: State) -> dict[str, np.ndarray]:
        """x and r of all bodies for a checkpoint, by name."""
        self._x, self._r = self.places(state)
        return {"sleep.x": self._x, "sleep.r": self._r}

    def turn(self, there: There, state: State) -> tuple[Floats, Floats]:
        """Changes the present bodies to these. Returns their x and r."""
        self._x, self._r = self.places(state)
        self.there = there
        return there.rows(self._x), there.rows(self._r)


def parts_of(
    system: System, parts: Parts, asleep: NDArray[np.bool_], gone: NDArray[np.bool_]
) -> tuple[System, Ints, There]:
    """Returns the System with the sheets `asleep` (sheets,) as fixed parts and without the sheets `gone`
    (sheets,); the numbers of its pairs among those of the whole System, without searched ones; its bodies.

    Films of air and bristles refer to bodies by number, and have states that last from step to step. So in
    scenes with them all bodies count as present.
    """
    some, chosen = awake(system, parts, asleep, gone)
    if parts.air or len(system.bristles):
        return some, chosen, There()
    there = There.of(np.append(gone, False)[parts.sheet_of])  # the last entry is for bodies of no sheet, -1
    return _renumbered(some, there), chosen, there


def _renumbered(system: System, there: There) -> System:
    """A System with only the present bodies; joints, pairs, loads and images refer to their new numbers."""
    if there.bodies is None:
        return system
    own, search = there.own, system.search
    joints, pairs, loads = system.joints.copy(), system.pairs, system.loads.copy()
    joints["a"], joints["b"] = own(joints["a"]), own(joints["b"])
    first = pairs[: search.first]  # pairs after these are searched
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
