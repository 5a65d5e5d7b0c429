"""Bristles of the contact patches where friction sticks: see mechanics.bristle."""

from __future__ import annotations

import numpy as np

from mdlgen.mechanics.bristle import BRISTLE, HELD
from mdlgen.mechanics.patch import patches_of
from mdlgen.model.tables import Ints, Model


def bristles_of(model: Model, bodies: np.ndarray, pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """BRISTLE of each patch, HELD of each pair of boxes and parts in one; stores these numbers in `pairs`.

    All begin without force.
    """
    patches = patches_of(model, bodies, pairs, pairs["row"])
    pairs["held"] = 0
    pairs["held"][patches.pairs] = 1 + np.arange(len(patches.pairs))
    bristles, held = np.zeros(len(patches.k), BRISTLE), np.zeros(len(patches.pairs), HELD)
    for name in ("row", "a", "b", "k", "axis"):
        bristles[name] = getattr(patches, name)
    held["bristle"], held["pair"] = patches.patch, patches.pairs
    return bristles, held


def cuts(bristles: np.ndarray, image: Ints) -> bool:
    """True if a plane in which bodies have these images cuts a patch of a sheet on a roller. Half of a patch
    would turn with the sheet, but the whole does not."""
    rolls = (bristles["axis"] != 0.0).any(axis=1)
    return bool((rolls & (image[bristles["b"]] == bristles["b"])).any())


def halved(
    bristles: np.ndarray, held: np.ndarray, pairs: np.ndarray, near: np.ndarray, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Bristles and held pairs of one side of a scene, whose `pairs` are those `near` of the whole; `own`:
    true for each body that is its own image. Two such bodies have half of their contact on this side."""
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
    """The bristles `new` of a System, with the states of those of another one; added ones begin without."""
    places = {tuple(key): k for k, key in enumerate(old[["row", "a", "b"]].tolist())}
    found = new.copy()
    for k, key in enumerate(new[["row", "a", "b"]].tolist()):
        if tuple(key) in places:
            found[k] = old[places[tuple(key)]]
    return found
