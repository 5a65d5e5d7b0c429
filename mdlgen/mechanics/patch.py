"""Contact patches where friction sticks, and the pairs in each: see mechanics.bristle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.model.tables import BOX_BOX, BOX_CYLINDER, BOX_MESH, Floats, Ints, Model


class Patches(NamedTuple):
    """Patches in the order of their contacts and bodies, and the pairs in them."""

    row: Ints  # of the contacts
    a: Ints  # first body, of a sheet that rolls its first box; and the second
    b: Ints
    k: Floats  # k_t [N/mm]
    axis: Floats  # of the roller that a sheet rolls on, 0: none, (patches, 3)
    pairs: Ints  # that are in a patch, ascending
    patch: Ints  # of each of these


def patches_of(model: Model, bodies: np.ndarray, pairs: np.ndarray, rows: Ints) -> Patches:
    """The patches of pairs of boxes and parts; rows: of each pair, its contact.

    A sheet has one patch with a roller, or a mesh on one. Each other pair has a patch of its own.
    """
    sticking = model.contacts.sticking[rows]
    sticks = np.flatnonzero((sticking > 0.0) & (pairs["kind"] != BOX_BOX))
    own, k_t = pairs[sticks], sticking[sticks]
    turns = (own["kind"] == BOX_CYLINDER) | ((own["kind"] == BOX_MESH) & (bodies["carries"][own["b"]] == 1))
    sheet_of = np.arange(len(bodies))
    for sheet in model.sheets:
        sheet_of[sheet.first : sheet.first + sheet.count] = sheet.first
    first = np.where(turns, sheet_of[own["a"]], own["a"])
    keys = np.stack([rows[sticks], first, own["b"]], axis=1)
    _, chosen, numbers = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return Patches(
        *keys[chosen].T,
        k=k_t[chosen],
        axis=np.where(turns[chosen, None], bodies["axis"][own["b"][chosen]], 0.0),
        pairs=sticks,
        patch=numbers.reshape(-1),
    )
