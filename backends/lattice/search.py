"""Neighbour search: lists the near boxes of two sheets on a grid, again whenever boxes have moved.

Sheets that slide over each other meet in different boxes all the time, and all pairs of two sheets are many.
So the tables of a run have rows for more pairs behind those of the Model. These hold the pairs of boxes whose
centres are closer than their radii plus SKIN. While no box has moved by more than half of SKIN since the
search, no other pair can touch.

Boxes are sorted into the cells of a grid by their centres, and cells into a table by a hash of their numbers.
A box is compared with those of 27 cells. Sheets that are far apart cost only the access to empty cells.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import ROOM, SKIN
from mdlgen.mechanics.frame import LAW
from mdlgen.model.tables import BOX_BOX, Floats, Ints, Model

REGION = np.dtype(
    [
        ("row", "i8"),  # row of the contacts
        ("a", "i8"),  # first box of one sheet, and their number
        ("many_a", "i8"),
        ("b", "i8"),
        ("many_b", "i8"),
        ("shared", "i8"),
        ("k", "f8"),
        ("law", "f8", LAW),  # as in a pair
        ("mark", "i8"),  # mark of the first pair among those of all boxes
        ("sticking", "f8"),  # as in a pair
        ("least", "f8"),  # half length of a box of both sheets, along their faces [mm]
    ]
)
# Compact record of a searched pair: nearly all that steps read of it.
LISTED = np.dtype([("a", "i4"), ("b", "i4"), ("region", "i4")])  # boxes, -1: none from here on; its REGION


class Search(NamedTuple):
    """Data of the neighbour search; no regions: there is none."""

    regions: np.ndarray  # REGION, one for each contact of two sheets.
    room: Floats  # capacity of each of them for pairs.
    listed: np.ndarray  # LISTED, pairs from `first` on.
    first: int  # number of the Model's pairs, which precede.
    boxes: Ints  # bodies that are searched.
    place: Floats  # places of bodies in the last search [mm], (bodies, 3).
    radius: Floats  # radius of the sphere around a box [mm], (bodies,).
    rough: Floats  # friction of a box's contacts relative to that of the contact, (bodies,).
    size: float  # size of a cell [mm].
    head: Ints  # first box of the cells with a hash, -1: none; the length is a power of two.
    following: Ints  # next box of the same hash, (bodies,).
    cell: Ints  # cell of each box, (bodies, 3).


def plan(model: Model, pairs: np.ndarray) -> tuple[np.ndarray, Search, int]:
    """The pairs of a Model with unused rows for those that are searched; the search; the number of all
    possible pairs."""

    rows = np.flatnonzero(model.contacts.kind == BOX_BOX)
    sheets = {s.name: s for s in model.sheets}
    half = model.bodies.half
    radius = np.linalg.norm(half, axis=1)
    regions = np.zeros(len(rows), REGION)
    boxes: set[int] = set()
    room: list[float] = []
    marks, size = len(pairs), 1.0
    for region, row in zip(regions, rows.tolist(), strict=True):
        ends = [sheets[part[row]] for part in (model.contacts.part_a, model.contacts.part_b)]
        for name, sheet in zip("ab", ends, strict=True):
            region[name], region["many_" + name] = sheet.first, sheet.count
            boxes.update(range(sheet.first, sheet.first + sheet.count))
        region["row"], region["mark"] = row, marks
        one, two = (slice(s.first, s.first + s.count) for s in ends)
        reach = float(radius[one].max() + radius[two].max()) + SKIN
        area = 4.0 * float((half[two, 0] * half[two, 1]).min())
        region["least"] = min(half[one, :2].min(), half[two, :2].min())
        every = ends[0].count * ends[1].count
        room.append(min(every, ends[0].count * (4.0 + ROOM * math.pi * reach**2 / area)))
        marks, size = marks + every, max(size, reach)
    every, listed = with_room(pairs, sum(room))
    count = len(half)
    search = Search(
        regions=regions,
        room=np.array(room, dtype=np.float64),
        listed=listed,
        first=len(pairs),
        boxes=np.array(sorted(boxes), dtype=np.int64),
        place=np.zeros((count, 3)),
        radius=radius,
        rough=np.array(model.bodies.friction),
        size=size,
        head=np.full(1 << max(1, (2 * len(boxes)).bit_length()), -1, np.int64),
        following=np.full(count, -1, np.int64),
        cell=np.zeros((count, 3), np.int64),
    )
    return every, search, marks


def with_room(pairs: np.ndarray, room: float) -> tuple[np.ndarray, np.ndarray]:
    """The pairs with unused rows for those that are searched, and as many rows of LISTED. Rows behind the
    first one that is EMPTY are not written to, so that they take no memory."""
    from mdlgen.backends.lattice.kernels.contact.search import EMPTY

    many = math.ceil(room)
    every, listed = np.zeros(len(pairs) + many, pairs.dtype), np.zeros(many, LISTED)
    every[: len(pairs)] = pairs
    every["kind"][len(pairs) : len(pairs) + 1] = EMPTY
    listed["a"][:1] = EMPTY
    return every, listed


def many_searched(search: Search) -> int:
    """Number of pairs that the last search listed."""
    return int(np.argmax(np.append(search.listed["a"] < 0, True)))
