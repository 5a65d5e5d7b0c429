"""Contact patches where friction sticks, and the pairs in each: see mechanics.bristle."""

from __future__ import annotations

import numpy as np

from mdlgen.mechanics.bristle import BRISTLE, HELD
from mdlgen.model.tables import BOX_BOX, BOX_CYLINDER, BOX_MESH, Ints, Model


def bristles_of(model: Model, bodies: np.ndarray, pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """BRISTLE of each patch, HELD of each pair of boxes and parts that is in one; notes these in `pairs`.

    A sheet has one patch with a roller, or a mesh on one. Each other pair has a patch of its own. All begin
    without force.
    """
    sticking = model.contacts.sticking[pairs["row"]]
    sticks = (sticking > 0.0) & (pairs["kind"] != BOX_BOX)
    pairs["held"] = 0
    pairs["held"][sticks] = 1 + np.arange(sticks.sum())
    own, k_t = pairs[sticks], sticking[sticks]
    turns = (own["kind"] == BOX_CYLINDER) | ((own["kind"] == BOX_MESH) & (bodies["carries"][own["b"]] == 1))
    sheet_of = np.arange(len(bodies))
    for sheet in model.sheets:
        sheet_of[sheet.first : sheet.first + sheet.count] = sheet.first
    first = np.where(turns, sheet_of[own["a"]], own["a"])
    keys = np.stack([own["row"], first, own["b"]], axis=1)
    _, chosen, numbers = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    bristles, held = np.zeros(len(chosen), BRISTLE), np.zeros(len(own), HELD)
    bristles["row"], bristles["a"], bristles["b"] = keys[chosen].T
    bristles["k"] = k_t[chosen]
    bristles["axis"] = np.where(turns[chosen, None], bodies["axis"][own["b"][chosen]], 0.0)
    held["bristle"], held["pair"] = numbers.reshape(-1), np.flatnonzero(sticks)
    return bristles, held


def cuts(bristles: np.ndarray, image: Ints) -> bool:
    """Tests whether a plane in which bodies have these images cuts a patch of a sheet on a roller. Half of
    the patch would turn with the sheet, which the whole does not."""
    rolls = (bristles["axis"] != 0.0).any(axis=1)
    return bool((rolls & (image[bristles["b"]] == bristles["b"])).any())


def halved(
    bristles: np.ndarray, held: np.ndarray, pairs: np.ndarray, near: np.ndarray, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Bristles and held pairs of one side of a scene, whose `pairs` are those `near` of the whole; `own`: of
    each body, whether it is its own image. Two such bodies have half of their contact on this side."""
    bristles, held = bristles.copy(), held[near[held["pair"]]].copy()
    bristles["k"][own[bristles["a"]] & own[bristles["b"]]] *= 0.5
    held["pair"] = (np.cumsum(near) - 1)[held["pair"]]
    pairs["held"] = 0
    pairs["held"][held["pair"]] = 1 + np.arange(len(held))
    return bristles, held


def begin(bristles: np.ndarray) -> None:
    """Resets them for a new run."""
    for name in ("stretch", "turn", "centre", "normal", "force", "eases", "rate", "energy"):
        bristles[name] = 0.0


def moved(old: np.ndarray, new: np.ndarray) -> np.ndarray:
    """The bristles `new` of a System, in the states that those of another one have; new ones have none."""
    places = {tuple(key): k for k, key in enumerate(old[["row", "a", "b"]].tolist())}
    found = new.copy()
    for k, key in enumerate(new[["row", "a", "b"]].tolist()):
        if tuple(key) in places:
            found[k] = old[places[tuple(key)]]
    return found
