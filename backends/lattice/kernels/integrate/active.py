"""The active set of an iteration with frozen contacts: the sheets whose velocities it still changes.

In a pile under a roller nearly all that an iteration changes after its first direction is in the few sheets
near the roller. A sheet is left out where the last direction changed it by less than the iteration may leave,
and where the same holds of all sheets that it touches. The others then move as if it stood still, which is
the same convex problem with fewer unknowns. A sheet that touches what rolls or slides stays in. Each
iteration begins with all sheets, so what one that is left out should have done is found there.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import DIRECTION
from mdlgen.program.kernel import BORROWS, njit

# Of Frozen.sheets, in place of a sheet: a body that does not move, and one that is an unknown of the border.
FIXED, ROLLS = -1, -2
# A sheet in Colouring.active: solved for, left out, left out from the next direction on.
OUT, IN, LEAVES = 0, 1, 2


@njit(cache=True, error_model="numpy", **BORROWS)
def all_in(colouring):
    """All sheets are solved for."""
    for sheet in range(colouring.active.size):
        colouring.active[sheet] = IN


@njit(cache=True, error_model="numpy", forceinline=True)
def _side(body, label):
    if body.node >= 0:
        return label[body.node]
    return ROLLS if body.slide >= 0 or body.spin >= 0 else FIXED


@njit(cache=True, error_model="numpy", **BORROWS)
def of_sheets(tables, frozen, label):
    """Notes for all points between which sheets they are."""
    last, one, two = -1, FIXED, FIXED
    for k in range(frozen.many[0]):
        p = frozen.pair[k]
        if p != last:
            pair = tables.pairs[p]
            one, two = _side(tables.bodies[pair.a], label), _side(tables.bodies[pair.b], label)
            last = p
        frozen.sheets[k, 0], frozen.sheets[k, 1] = one, two


@njit(cache=True, error_model="numpy", forceinline=True)
def rolls(frozen, k):
    """Whether a point is on a body that is an unknown of the border."""
    return frozen.sheets[k, 0] == ROLLS or frozen.sheets[k, 1] == ROLLS


@njit(cache=True, error_model="numpy", forceinline=True)
def still(frozen, active, k):
    """Whether a point is between sheets that are left out, or one such and what does not move."""
    if rolls(frozen, k):
        return False
    one, two = frozen.sheets[k, 0], frozen.sheets[k, 1]
    return (one == FIXED or active[one] == OUT) and (two == FIXED or active[two] == OUT)


@njit(cache=True, error_model="numpy", **BORROWS)
def _greatest(bodies, nodes, span, p):
    """As change.greatest of the nodes of a sheet."""
    change = 0.0
    for n in range(span[0], span[1]):
        half = bodies[nodes[n]].half
        size = half[0] + half[1]
        for i in range(6):
            change = max(change, abs(p[6 * n + i]) if i < 3 else size * abs(p[6 * n + i]))
    return change


@njit(cache=True, error_model="numpy", **BORROWS)
def leave(work, enough):
    """Marks the sheets which LEAVE: a direction changes them, and what they touch, by `enough` [mm/ms] at
    most."""
    bodies, nodes, frozen = work.tables.bodies, work.tables.nodes, work.frozen
    colouring, p = work.matrix.couplings.colouring, frozen.vectors[DIRECTION]
    active = colouring.active
    for sheet in range(active.size):
        if active[sheet] == IN and _greatest(bodies, nodes, colouring.spans[sheet], p) <= enough:
            active[sheet] = LEAVES
    # what a sheet that stays in touches stays, too: two passes, so that it does not go on from there
    colouring.stays[:] = False
    for k in range(frozen.many[0]):
        one, two = frozen.sheets[k, 0], frozen.sheets[k, 1]
        if one >= 0 and active[one] == LEAVES and (two == ROLLS or (two >= 0 and active[two] == IN)):
            colouring.stays[one] = True
        if two >= 0 and active[two] == LEAVES and (one == ROLLS or (one >= 0 and active[one] == IN)):
            colouring.stays[two] = True
    for sheet in range(active.size):
        if colouring.stays[sheet]:
            active[sheet] = IN


@njit(cache=True, error_model="numpy", **BORROWS)
def left(work, z):
    """The sheets that LEAVE have left: neither the direction nor `z` (6 nodes,) has a part in them."""
    colouring, vectors = work.matrix.couplings.colouring, work.frozen.vectors
    for sheet in range(colouring.active.size):
        if colouring.active[sheet] != LEAVES:
            continue
        colouring.active[sheet] = OUT
        for l in range(6 * colouring.spans[sheet, 0], 6 * colouring.spans[sheet, 1]):
            z[l] = vectors[DIRECTION, l] = 0.0
