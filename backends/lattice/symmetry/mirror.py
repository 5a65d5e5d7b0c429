"""Scenes that are their own mirror image: one half is solved, and the other one follows by reflection.

A machine for paper is often the same left and right of a plane along the path, and so is its motion. Boxes,
rollers and contacts on one side are eliminated; a box at the plane is joined to its own image. Nothing is
approximated: for a symmetric motion the equations of the half are those of the whole, and a scene that begins
symmetric stays so. An asymmetry that grows out of round-off, such as buckling to one side, cannot appear.
With `run.symmetry: false` both halves are solved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import IMAGE, System, offsets
from mdlgen.backends.lattice.bristles import halved
from mdlgen.backends.lattice.hinges import halved as halved_hinges
from mdlgen.backends.lattice.kernels.state import TURNS
from mdlgen.mechanics.turning import ABOUT_A, ALONG
from mdlgen.model.tables import Floats, Ints


@dataclass(frozen=True)
class Mirror:
    """The plane normal . x = at, and the mirror images of bodies and contacts in it."""

    normal: Floats  # (3,).
    at: float  # [mm].
    image: Ints  # mirror image of each body; a body in the plane is its own image.
    signs: Floats  # signs of the axes of an image relative to the reflected axes, (bodies, 3).
    gone: NDArray[np.bool_]  # true for eliminated bodies, (bodies,).
    boxes: NDArray[np.bool_]  # true for boxes of sheets.
    rows: Ints  # row of the contacts that is solved for each row: itself, or its image.
    times: Floats  # 2 for a row that is its own image, else 1.
    senses: Floats  # 1 or -1: sense of rotation about the axes of the parts, and of slip, (rows, 3).
    apart: bool  # true where pairs of a box and a part, or another sheet's box, across the plane are omitted.

    def seen(self, vectors: Floats) -> Floats:
        """Mirror images of vectors (..., 3)."""
        return vectors - 2.0 * (vectors @ self.normal)[..., None] * self.normal

    def places(self, points: Floats) -> Floats:
        """Mirror images of points (..., 3) [mm]."""
        return self.seen(points) + 2.0 * self.at * self.normal

    def axes(self, rotations: Floats) -> Floats:
        """Mirror images of axes (..., 3, 3), in columns; they are not rotations."""
        return self.seen(rotations.swapaxes(-1, -2)).swapaxes(-1, -2)

    def fill(self, x: Floats, r: Floats, u: Floats, w: Floats) -> None:
        """Sets the eliminated bodies: places (..., bodies, 3), rotations (..., bodies, 9) of boxes,
        velocities."""
        to = np.flatnonzero(self.gone)
        of = self.image[to]
        x[..., to, :] = self.places(x[..., of, :])
        u[..., to, :], w[..., to, :] = self.seen(u[..., of, :]), -self.seen(w[..., of, :])
        to = to[self.boxes[to]]
        whole = r[..., self.image[to], :]
        turned = self.axes(whole.reshape(*whole.shape[:-1], 3, 3)) * self.signs[to][:, None, :]
        r[..., to, :] = turned.reshape(whole.shape)

    def sums(self, rows: Floats) -> Floats:
        """Sums over the pairs of each row of the contacts, (..., rows), of both sides."""
        return self.largest(rows * self.times)

    def acts(self, rows: Floats) -> Floats:
        """Forces of rows of contacts, (..., rows, 5), of both sides: normal force, then the columns of
        mechanics.turning. Opposite rotations of a part and its image in the same row cancel out."""
        whole = rows[..., self.rows, :] * self.times[self.rows, None]
        image = (self.rows != np.arange(len(self.rows)))[:, None]
        own = np.where(self.times[:, None] > 1.0, 0.5 + 0.5 * self.senses, 1.0)
        whole[..., TURNS + ABOUT_A : TURNS + ALONG + 1] *= np.where(image, self.senses, own)
        return whole

    def largest(self, rows: Floats) -> Floats:
        """Values of all rows of the contacts, (..., rows): an image has the value of its row."""
        return rows[..., self.rows]

    def passed(self, x: Floats, boxes: Ints) -> int:
        """A box that has passed the plane, where it may meet parts with which it has no pairs; -1: none."""
        beyond = np.flatnonzero(x[boxes] @ self.normal > self.at) if self.apart else []
        return int(boxes[beyond[0]]) if len(beyond) else -1

    def touched(self, system: System, marks: NDArray[np.bool_]) -> int:
        """Number of pairs of the whole scene to which the marked pairs of the half correspond."""
        own = self.image == np.arange(len(self.image))
        pairs = system.pairs[: system.search.first]
        alone = pairs["mark"][own[pairs["a"]] & own[pairs["b"]]]
        return int(2 * marks.sum() - marks[alone].sum())


def halve(system: System, mirror: Mirror) -> System:
    """The side of a System that is solved."""
    gone = np.append(mirror.gone, False)
    own = np.append(mirror.image == np.arange(len(mirror.image)), False)
    bodies = system.bodies.copy()
    for name in ("node", "slide", "spin"):
        bodies[name][gone] = -1
    for name in ("axis", "clutch", "swings"):
        bodies[name][gone] = 0
    # a roller, or a pressed plate, in the plane: half of it, loaded by one side alone
    bodies["press"][own] *= 0.5
    bodies["clutch"][own, 1] *= 0.5
    border = 0
    for row in bodies:
        for name in ("slide", "spin"):
            if row[name] >= 0:
                row[name], border = border, border + 1
    left = ~mirror.gone[system.nodes]
    nodes = system.nodes[left]
    bodies["node"][nodes] = np.arange(len(nodes))
    ends = [np.where(system.joints[end] >= 0, system.joints[end], len(bodies) - 1) for end in "ab"]
    free = [bodies["node"][end] >= 0 for end in ends]
    kept = free[0] | free[1]
    joints = system.joints[kept].copy()
    joints["mirrored"] = (gone[ends[0]] | gone[ends[1]])[kept]
    far = np.array(sorted({body for end in ends for body in end[kept & gone[end]].tolist()}), np.int64)
    images = np.zeros(len(far), IMAGE)
    images["body"], images["of"], images["signs"] = far, mirror.image[far], mirror.signs[far]
    images["normal"], images["at"] = mirror.normal, mirror.at
    a, b = system.pairs["a"], system.pairs["b"]
    near = ~gone[a] & ~gone[b]
    near[system.search.first :] = True  # unused rows, see search
    pairs = system.pairs[near].copy()
    pairs["k"][(own[a] & own[b])[near]] *= 0.5
    bristles, held = halved(system.bristles, system.held, pairs, near, own)
    return system._replace(
        bodies=bodies,
        joints=joints,
        pairs=pairs,
        bristles=bristles,
        held=held,
        yields=halved_hinges(system.yields, system.joints, kept, mirror.image, gone[ends[0]] | gone[ends[1]]),
        loads=system.loads[~gone[system.loads["body"]]],
        nodes=nodes,
        sheets=system.sheets[left],
        offsets=offsets(bodies, joints, system.corners),
        border=border,
        images=images,
        search=system.search._replace(
            first=int(near[: system.search.first].sum()),
            boxes=system.search.boxes[~gone[system.search.boxes]],
        ),
        mirror=mirror,
    )
