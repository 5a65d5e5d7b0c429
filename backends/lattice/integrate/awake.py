"""Reduces a System to what its steps have to solve. Sleeping sheets become fixed parts; sheets that have not
entered yet, or have left, are omitted.

The same kernels run on fewer nodes, joints and pairs, as for a halved scene (symmetry.mirror).
Bodies keep their numbers, contacts their rows.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System, offsets
from mdlgen.backends.lattice.search import with_room
from mdlgen.mechanics.corner import renumbered
from mdlgen.mechanics.over_time import GRAVITY, Changing
from mdlgen.model.tables import Ints, Model


class Parts:
    """Sheets and moving parts of each contact and each pair of a Model."""

    def __init__(self, model: Model, system: System):
        number = {sheet.name: k for k, sheet in enumerate(model.sheets)}
        table = model.contacts
        ends = (table.part_a, table.part_b)
        self.sheets = np.array([[number.get(name, -1) for name in end] for end in ends], int).reshape(2, -1)
        self.moves = np.zeros(len(table), bool)
        pairs = system.pairs[: system.search.first]
        self.moves[pairs["row"]] = _moves(model, system)[pairs["b"]]
        self.air = bool((table.air_viscosity > 0.0).any())
        count = len(system.bodies)
        self.sheet_of = np.full(count, -1)  # sheet of each body
        for k, sheet in enumerate(model.sheets):
            self.sheet_of[sheet.first : sheet.first + sheet.count] = k

    def of(self, some: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Contacts of some sheets with any body, (contacts,)."""
        own = some[np.maximum(self.sheets, 0)] & (self.sheets >= 0)
        return own[0] | own[1]

    def lasting(self, asleep: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Contacts of sleeping sheets with each other and with fixed parts, (contacts,)."""
        known = self.sheets >= 0
        sleeps = known & asleep[np.where(known, self.sheets, 0)]
        other = ~known[1] & ~self.moves
        return sleeps[0] & (sleeps[1] | other)


def _held(held: np.ndarray, pairs: np.ndarray, chosen: Ints) -> np.ndarray:
    """Rows of `held`, the pairs in contact patches, that are among the `chosen` pairs. They get the numbers
    that the chosen pairs have in `pairs`; the column "held" there is set to row + 1, or 0 for no patch."""
    if not len(held):
        return held
    place = np.full(int(max(held["pair"].max(), chosen.max(initial=0))) + 1, -1)
    place[chosen] = np.arange(len(chosen))
    found = held[place[held["pair"]] >= 0].copy()
    found["pair"] = place[found["pair"]]
    pairs["held"] = 0
    pairs["held"][found["pair"]] = 1 + np.arange(len(found))
    return found


def _changing(changes: Changing, loads: NDArray[np.bool_]) -> Changing:
    """The Changing of the remaining loads, with their new row numbers. `loads` is true for each load that
    remains."""
    left = np.append(loads, True)  # the last entry is that of gravity, whose row is -1
    rows = np.append(np.cumsum(loads) - 1, GRAVITY)
    acts = changes.acts[left[changes.acts["load"]]]
    acts["load"] = rows[acts["load"]]
    return changes._replace(acts=acts)


def _moves(model: Model, system: System) -> NDArray[np.bool_]:
    """Bodies other than boxes of sheets that may move: they slide, swing, turn, or are driven."""
    bodies = system.bodies
    moves = (bodies["slide"] >= 0) | (bodies["spin"] >= 0) | (bodies["swings"] > 0)
    for roller in model.rollers:
        moves[roller.body] |= roller.speed is not None
    return moves


def awake(
    system: System, parts: Parts, asleep: NDArray[np.bool_], gone: NDArray[np.bool_] | None = None
) -> tuple[System, Ints]:
    """The System, in its own arrays, with the sheets `asleep` (sheets,) as fixed parts and without the sheets
    `gone` (sheets,). Also returns the numbers of its pairs among the Model's pairs, without searched ones."""
    lasting = parts.lasting(asleep)
    if gone is not None:
        asleep = asleep | gone
        lasting |= parts.of(gone)
    bodies = system.bodies.copy()
    left = ~asleep[system.sheets]
    nodes = system.nodes[left]
    bodies["node"] = -1
    bodies["node"][nodes] = np.arange(len(nodes))
    free = [np.where(system.joints[end] >= 0, bodies["node"][system.joints[end]], -1) >= 0 for end in "ab"]
    own = free[0] | free[1]
    joints = system.joints[own].copy()
    corners = renumbered(system.corners[~asleep[system.corners["sheet"]]], np.cumsum(own) - 1)
    search = system.search
    chosen = np.flatnonzero(~lasting[system.pairs["row"][: search.first]])
    regions = ~lasting[search.regions["row"]]
    pairs, listed = with_room(system.pairs[chosen], float(search.room[regions].sum()))
    held = _held(system.held, pairs, chosen)
    met = np.zeros(len(bodies), bool)
    for region in search.regions[regions]:
        for end in "ab":
            met[region[end] : region[end] + region["many_" + end]] = True
    sleeps = np.append(asleep, False)[parts.sheet_of]  # the last entry is for bodies of no sheet, -1
    acts = ~sleeps[system.loads["body"]]
    return (
        system._replace(
            bodies=bodies,
            joints=joints,
            pairs=pairs,
            held=held,
            loads=system.loads[acts],
            changes=_changing(system.changes, acts),
            nodes=nodes,
            sheets=system.sheets[left],
            offsets=offsets(bodies, joints, corners),
            corners=corners,
            search=search._replace(
                regions=search.regions[regions],
                room=search.room[regions],
                listed=listed,
                first=len(chosen),
                boxes=search.boxes[met[search.boxes]],
                place=np.zeros_like(search.place),
            ),
        ),
        chosen,
    )
