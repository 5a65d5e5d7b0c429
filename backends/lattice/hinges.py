"""Joints that yield in bending: their records, and where each bushing of the Model has its own."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mdlgen.mechanics.plastic import HINGE
from mdlgen.model.tables import Floats, Ints, Model


class Yielding(NamedTuple):
    """Plastic hinges of a System; no records: it is elastic."""

    hinges: np.ndarray  # mechanics.plastic.HINGE
    of_row: Ints  # hinge of each row of Model.plastic
    # number of hinges of the whole scene for each one: 2 where its image is eliminated (symmetry.mirror)
    times: Floats


def yielding(model: Model, joints: np.ndarray, of: Ints) -> Yielding:
    """Hinges of a Model. `of`: the joint that each bushing is in; bushings in one joint have one hinge."""
    table = model.plastic
    chosen, of_row = np.unique(of[table.bushing], return_inverse=True)
    hinges = np.zeros(len(chosen), HINGE)
    hinges["joint"] = chosen
    hinges["axis"][of_row] = table.axis
    hinges["k"] = joints["k"][chosen, 3 + hinges["axis"]]
    for name, values in (("moment", table.moment), ("hardening", table.hardening)):
        np.add.at(hinges[name], of_row, values)
    return Yielding(hinges, of_row, np.ones(len(chosen)))


def halved(
    whole: Yielding, joints: np.ndarray, kept: np.ndarray, image: Ints, across: np.ndarray
) -> Yielding:
    """Hinges of one side of a scene, whose joints are those `kept` of the whole. `image`: that of each body;
    `across`: joints of the whole that join a box to its own image."""
    number = np.cumsum(kept) - 1
    ground = len(image)
    seen = np.append(image, ground)
    ends = np.stack([np.where(joints[end] >= 0, joints[end], ground) for end in "ab"])
    places = {frozenset(pair): k for k, pair in enumerate(ends.T.tolist()) if kept[k]}
    stays = kept[whole.hinges["joint"]]
    hinges = whole.hinges[stays].copy()
    hinges["joint"] = number[hinges["joint"]]
    at = np.full(len(joints), -1)
    at[whole.hinges["joint"][stays]] = np.arange(len(hinges))
    of_hinge = np.empty(len(whole.hinges), np.int64)
    for k, joint in enumerate(whole.hinges["joint"].tolist()):
        if not kept[joint]:
            joint = places[frozenset(seen[ends[:, joint]].tolist())]
        of_hinge[k] = at[joint]
    times = np.where(across[whole.hinges["joint"][stays]], 1.0, 2.0)
    return Yielding(hinges, of_hinge[whole.of_row], times)


def begin(hinges: np.ndarray) -> None:
    """Resets them for a new run."""
    for name in ("plastic", "begun", "lost"):
        hinges[name] = 0.0


def plastic_rows(yields: Yielding) -> Any:
    """Plastic rotation of each row of Model.plastic [rad]; last, the energy that all hinges dissipated
    [N mm]."""
    hinges = yields.hinges
    return np.append(hinges["plastic"][yields.of_row], hinges["lost"] @ yields.times)
