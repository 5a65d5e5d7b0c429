"""The parts of a Model, which form islands as they touch, and the least speed that scales errors of each."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.kernels.state import Islands, Workspace
from mdlgen.backends.lattice.kernels.tuning import LEAST_WAY
from mdlgen.mechanics.arm import AXIAL, INERTIA
from mdlgen.mechanics.frame import RADIUS
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.model.tables import Ints, Model


def islands(model: Model, system: System) -> Islands:
    """Parts of a Model before the first step.

    The least speed of a part moves it by LEAST_WAY of its size in the time of the run. A velocity error of
    that speed times `run.tolerance` keeps its place within the tolerance.
    """
    sheets, moving, bodies = len(model.sheets), system.moving, system.bodies
    parts = sheets + len(moving)
    part = np.full(len(bodies), -1, np.int64)
    part[system.nodes] = system.sheets
    part[moving] = sheets + np.arange(len(moving))
    mass, size, answers = np.zeros(parts), np.zeros(parts), np.zeros(parts, bool)
    np.add.at(mass, system.sheets, bodies["mass"][system.nodes])
    answers[system.sheets] = True
    for k, sheet in enumerate(model.sheets):
        size[k] = max(sheet.size)
    of_border = np.zeros(system.border, np.int64)
    for k, b in enumerate(moving.tolist(), sheets):
        body = bodies[b]
        radius = float(body["size"][RADIUS])
        size[k] = radius if radius > 0.0 else 2.0 * float(body["half"][2])
        if body["coupled"] == FOLLOWER:  # all rollers of a shaft are one part
            part[b] = of_border[body["spin"]]
        elif body["spin"] >= 0:
            of_border[body["spin"]], answers[k] = k, True
            mass[k] += body["press"][AXIAL] / radius**2
        if body["slide"] >= 0:
            of_border[body["slide"]], answers[k] = k, True
            way = body["way"]
            if body["swings"] > 0:
                way = np.cross(body["turn"], model.bodies.position[b] - body["pivot"])
            mass[k] += body["press"][INERTIA] / float(way @ way)
    ends = _ends(model, part, answers)
    group = _groups(ends, answers)
    return Islands(
        part=part,
        of_border=of_border,
        of_row=ends[0],
        answers=answers,
        mass=mass,
        least=LEAST_WAY * size / model.run.duration,
        top=np.arange(parts),
        speed=np.zeros(parts),
        given=np.zeros(parts),
        energy=np.zeros(parts),
        scale=np.zeros(parts),
        strict=np.ones(parts),
        sums=np.zeros(parts),
        group=group,
        group_of_row=group[np.maximum(ends[0], 0)],
    )


def groups(work: Workspace) -> int:
    """Number of groups of parts, each of which has its own energy balance."""
    return 1 + int(work.islands.group.max(initial=0))


def _ends(model: Model, part: Ints, answers: np.ndarray) -> Ints:
    """Parts of each contact that forces move, (2, contacts); -1: they do not. If there is only one, it is the
    first."""
    named = {sheet.name: k for k, sheet in enumerate(model.sheets)}
    named |= {p.name: int(part[p.body]) for p in model.machine}
    found = np.full((2, len(model.contacts)), -1, np.int64)
    for row, ends in enumerate(zip(model.contacts.part_a, model.contacts.part_b, strict=True)):
        parts = [named.get(name, -1) for name in ends]
        parts = [k for k in parts if k >= 0 and answers[k]]
        found[: len(parts), row] = parts
    return found


def _groups(ends: Ints, answers: np.ndarray) -> Ints:
    """Number of the group of each part. Contacts join parts to groups, also without near pairs; 0 for parts
    that forces do not move."""
    one, two = ends[:, (ends >= 0).all(axis=0)]
    first = np.arange(len(answers))
    while True:
        before, least = first.copy(), np.minimum(first[one], first[two])
        np.minimum.at(first, one, least)
        np.minimum.at(first, two, least)
        if (first == before).all():
            break
    group = np.zeros(len(answers), np.int64)
    group[answers] = np.unique(first[answers], return_inverse=True)[1]
    return group
