"""Arrays of a run for its contact patches with friction that sticks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.exudyn_local.state import WIDE
from mdlgen.mechanics.pack import Units
from mdlgen.mechanics.patch import patches_of
from mdlgen.model.tables import Floats, Ints, Model

# Coordinates of a patch: its stretch, global or along and across a round (and one unused), and its turn.
FIELD = 4
# Rates of these coordinates are a stretch [m] or turn [rad] over FINE. The jacobian moves rates by 1e-6, that
# is 1e-9 m of a stretch of micrometres.
FINE = 1e-3
# Newton's method weights residuals of rates by this time [s], which converts them to forces. At the speeds of
# sheets they are then as large as the forces of contacts.
WEIGHT = 1e-3

PATCH = np.dtype(
    [
        ("a", "i8"),  # first body (for a sheet that rolls, its first box), and the second.
        ("b", "i8"),
        ("k", "f8"),  # k_t [N/m].
        ("alone", "b1"),  # true where it has one pair.
        ("axis", "f8", 3),  # axis of the roller on which a sheet rolls, 0: none.
        # The following fields are those of the state that was evaluated last.
        ("force", "f8"),  # N, 0: nothing touches [N].
        ("centre", "f8", 3),  # c from the centre of the second body, global [m].
        ("normal", "f8", 3),  # normal to the first body.
        ("arms", "f8"),  # mean square of the distances from c, weighted by normal forces [m^2].
        ("rate", "f8"),  # r, at which rolling releases the stretch [1/s].
        ("sums", "f8", 16),  # over points, columns as in mechanics.bristle
    ]
)


class Sticking(NamedTuple):
    """Arrays of the patches of a run; no patches: friction sticks nowhere."""

    patches: np.ndarray  # PATCH
    pairs: Ints  # that are in a patch
    patch_of: Ints  # of each pair, -1: in none
    rows: Floats  # what touching pairs do, with their points, (pairs in patches, WIDE); one more to work in
    touched: Ints  # the pair of each row
    many: Ints  # how many touch, (1,)
    first: Ints  # coordinate of the first patch, (1,)
    lag: Floats  # by which springs are damped [s], (1,)


def sticking_of(model: Model, bodies: np.ndarray, pairs: np.ndarray, first: int, units: Units) -> Sticking:
    """The patches of a Model, with coordinates from `first` on; none in a static run, where nothing moves."""
    found = patches_of(model, bodies, pairs, model.pairs.contact)
    moves = model.run.analysis == "transient"
    patches = np.zeros(len(found.k) if moves else 0, PATCH)
    within = found.pairs if moves else found.pairs[:0]
    patch_of = np.full(len(pairs), -1, np.int64)
    if moves:
        patches["a"], patches["b"], patches["axis"] = found.a, found.b, found.axis
        patches["k"] = found.k * units.per_mm
        patches["alone"] = np.bincount(found.patch, minlength=len(patches)) == 1
        patch_of[within] = found.patch
    return Sticking(
        patches=patches,
        pairs=within.astype(np.int64),
        patch_of=patch_of,
        rows=np.zeros((len(within) + 1 if len(within) else 0, WIDE)),
        touched=np.zeros(len(within), np.int64),
        many=np.zeros(1, np.int64),
        first=np.array([first], np.int64),
        lag=np.ones(1),
    )


def masses(stick: Sticking) -> Floats:
    """Returns the masses of all coordinates of patches."""
    return np.repeat(FINE * WEIGHT * stick.patches["k"], FIELD)
