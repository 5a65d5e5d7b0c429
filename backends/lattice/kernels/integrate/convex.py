"""An iteration of a step's equations where contacts are in its matrix: a convex problem.

The geometry of contacts is frozen, and friction is limited by the normal forces at the beginning of the
iteration. Then the change d of the velocities minimises a convex function (integrate.points): half d A d,
with A the masses and bushings, plus res d, plus the functions of the points. Newton's method minimises it
with a factored matrix of an earlier state and a line search along each direction. Without that search,
contacts that open and close, and friction that changes its direction, can make the iterations oscillate
(Castro et al., arXiv 2110.10107).

The next iteration evaluates all forces again, so the frozen geometry leaves no error.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.condensed import INSIDE, forget
from mdlgen.backends.lattice.kernels.integrate.along import look_along, pull, slope
from mdlgen.backends.lattice.kernels.integrate.change import greatest
from mdlgen.backends.lattice.kernels.integrate.corners import corners_into
from mdlgen.backends.lattice.kernels.integrate.hinges import hinges_into
from mdlgen.backends.lattice.kernels.integrate.momentum import let_go
from mdlgen.backends.lattice.kernels.integrate.points import gather
from mdlgen.backends.lattice.kernels.integrate.points_matrix import points_into
from mdlgen.backends.lattice.kernels.integrate.tangent import (
    in_box_axes,
    joints_into,
    masses,
    rollers_into,
    turn_nodes,
)
from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END, colour
from mdlgen.backends.lattice.kernels.linear.coupled import couplings_in_box_axes, solve_coupled
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.linear.in_series import in_series
from mdlgen.backends.lattice.kernels.linear.product import times
from mdlgen.backends.lattice.kernels.linear.sheets import eliminate_sheets, factor_sheets
from mdlgen.backends.lattice.kernels.linear.two_colour import corner_of_first
from mdlgen.backends.lattice.kernels.state import (
    AFTER,
    BEFORE,
    CHANGE,
    DIRECTION,
    FACTORS,
    GRADIENT,
    MADE_FOR,
    OF_CHANGE,
    OF_DIRECTION,
    OWN_MASS,
    RESIDUAL,
    SOLVES,
    SPENT,
    STALE,
    WHERE,
)
from mdlgen.backends.lattice.kernels.tuning import (
    AIR_FINE,
    CONVEX_CHORD,
    CONVEX_FACTOR_WORTH,
    CONVEX_MOST,
    CONVEX_MOST_WITH_AIR,
    CONVEX_ROUGH,
    CURED,
    FACTOR_SERVES,
    FIRST_DIRECTION,
    LINEAR_LEFT,
    LINEAR_LEFT_WITH_AIR,
    SEARCH_DOUBLED,
    SEARCH_LOOKS,
    SLOPE_FOUND,
    SLOPE_WHOLE,
    SOLVED,
)
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy")
def _make_matrix(work, h, lag, renew):
    """Factors the matrix with the frozen points; `renew`: recompute masses and bushings, too. Returns False
    where it is singular."""
    tables, matrix, motion = work.tables, work.matrix, work.mid.motion
    a, b, d = matrix.band, matrix.border, matrix.corner
    if renew:
        masses(tables.bodies, tables.nodes, motion.r, matrix.inner)
        joints_into(tables, tables.joints, h, lag, motion.x, motion.r, matrix.inner, matrix.inner_slots)
        if tables.hinges.size > 0:
            hinges_into(tables, h, motion.r, matrix.inner, matrix.inner_slots)
        corners_into(tables, h, motion.x, motion.r, matrix.inner, matrix.inner_slots)
        in_box_axes(tables.nodes, motion.r, matrix.inner, b, matrix.offsets, matrix.inner_slots)
        copy(matrix.single_inner, matrix.inner)
    for n in range(a.shape[0]):  # points fill the diagonal blocks alone
        for c in range(6):
            for r in range(6):
                a[n, c, r] = 0.0
    b[:] = 0.0
    copy(d, matrix.own)
    points_into(work, h, CONVEX_CHORD)
    couplings = matrix.couplings
    if colour(couplings) and work.film.many[0] > 0:
        in_series(tables.bodies, tables.nodes, motion, matrix)
        in_box_axes(tables.nodes, motion.r, couplings.beside, b[:0], matrix.offsets[:1], matrix.slots)
        couplings.colouring.series[0] = 1
    couplings_in_box_axes(tables.nodes, motion.r, couplings)
    in_box_axes(tables.nodes, motion.r, a, b, matrix.offsets[:1], matrix.slots)
    forget(work.condensed)
    if not factor_sheets(matrix, True) or not eliminate_sheets(matrix):
        return False
    return corner_of_first(matrix)


@njit(cache=True, error_model="numpy", **BORROWS)
def _how_far(work, h, falls, linear, square, level):
    """Line search: returns the factor on the direction. `falls`: slope of the function at factor 0; linear +
    s square: slope of its masses and bushings at the factor s; `level`: see SLOPE_WHOLE."""
    low, high, at_low = 0.0, 1.0, falls
    at_high = linear + square + slope(work, h, 1.0, True)
    if abs(at_high) <= level * abs(falls):
        return 1.0
    for _ in range(SEARCH_DOUBLED):
        if at_high >= 0.0:
            break
        low, at_low = high, at_high
        high *= 2.0
        at_high = linear + high * square + slope(work, h, high, False)
    if at_high <= 0.0:
        return high
    part = high
    for _ in range(SEARCH_LOOKS):
        part = low - at_low * (high - low) / (at_high - at_low)
        part = min(max(part, low + 0.05 * (high - low)), high - 0.05 * (high - low))
        found = linear + part * square + slope(work, h, part, False)
        if abs(found) <= SLOPE_FOUND * abs(falls):
            break
        if found > 0.0:
            high, at_high = part, found
        else:
            low, at_low = part, found
    return part


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, **BORROWS)
def _dot(a, b):
    total = 0.0
    for i in range(a.size):
        total += a[i] * b[i]
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def _gradient(work, h, axes, part):
    """Moves the points by `part` times the direction, and writes the gradient of the function there into row
    GRADIENT of the vectors."""
    frozen, matrix, nodes = work.frozen, work.matrix, work.tables.nodes
    res, resb, own = frozen.vectors[RESIDUAL], frozen.border[RESIDUAL], matrix.own
    g, gb = frozen.vectors[GRADIENT], frozen.border[GRADIENT]
    g[:] = 0.0
    for i in range(resb.size):
        gb[i] = resb[i] + _dot(own[i], frozen.border[CHANGE])
    pull(work, h, part, g, gb)
    turn_nodes(nodes, axes, g, True)
    for i in range(res.size):
        g[i] += res[i] + frozen.vectors[OF_CHANGE, i]


@njit(cache=True, error_model="numpy", **BORROWS)
def _product(work):
    """Multiplies the direction by the matrix of masses and bushings, sheet by sheet."""
    matrix, vectors = work.matrix, work.frozen.vectors
    spans = matrix.couplings.colouring.spans
    for sheet in range(spans.shape[0]):
        low, high = spans[sheet]
        x, y = vectors[DIRECTION, 6 * low : 6 * high], vectors[OF_DIRECTION, 6 * low : 6 * high]
        times(matrix.single_inner[low:high], matrix.offsets, x, y)


@njit(cache=True, error_model="numpy", **BORROWS)
def _direction(work, axes, h):
    """Evaluates points, masses and bushings along the direction. Returns the slope of the latter at its
    beginning, and their curvature."""
    frozen, matrix = work.frozen, work.matrix
    p, pb, product = frozen.vectors[DIRECTION], frozen.border[DIRECTION], frozen.vectors[OF_DIRECTION]
    copy(product, p)
    turn_nodes(work.tables.nodes, axes, product, False)
    look_along(work, h)
    _product(work)
    linear = _dot(p, frozen.vectors[RESIDUAL]) + _dot(p, frozen.vectors[OF_CHANGE])
    square = _dot(p, product)
    for i in range(pb.size):
        linear += pb[i] * (frozen.border[RESIDUAL, i] + _dot(matrix.own[i], frozen.border[CHANGE]))
        square += pb[i] * _dot(matrix.own[i], pb)
    return linear, square


@njit(cache=True, error_model="numpy", **BORROWS)
def _cured(work, h, axes, part, least):
    """True if the change, with `part` times the last direction, removes enough residual momentum. Checks each
    sheet and roller that the residual would give a speed above `least` if it were free (momentum.let_go)."""
    g, lets = work.frozen.vectors[GRADIENT], work.free.lets
    _gradient(work, h, axes, part)
    turn_nodes(work.tables.nodes, axes, g, False)
    let_go(work, g, work.frozen.border[GRADIENT], lets[AFTER])
    for k in range(lets.shape[1]):
        if lets[BEFORE, k] > least and lets[AFTER, k] > CURED * lets[BEFORE, k]:
            return False
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _say_enough(work, limit):
    """Sets the squared residual at which linear solves of each sheet end: its mass times the square of the
    allowed error of its velocity. That error is smaller for sheets of slow islands."""
    boxes, colours = work.tables.boxes, work.matrix.couplings.colouring
    for sheet in range(colours.enough.size):
        low, high = colours.spans[sheet, BEGIN], colours.spans[sheet, END]
        rate, mass = SOLVED * limit / work.islands.strict[work.free.label[low]], 0.0
        for n in range(low, high):
            mass += boxes[n, OWN_MASS]
        colours.enough[sheet] = mass * rate * rate


@njit(cache=True, error_model="numpy")
def solve_convex(work, t, h, lag, counts, limit, control, renew, whole):
    """Replaces the residual, in box axes, by the change of velocities to subtract. Returns the number of
    iterations; 0: singular or not descending, -1: not converged. `counts`: numbers of pairs that touch and
    that are near; `renew`: a new factor recomputes masses and bushings; `whole`: do not stop after the first
    direction, see FIRST_DIRECTION."""
    tables, matrix, frozen = work.tables, work.matrix, work.frozen
    factored, counters = control.factored, control.counters
    z, zb, axes = matrix.res, matrix.resb, work.condensed.axes
    change, of_change = frozen.vectors[CHANGE], frozen.vectors[OF_CHANGE]
    g, gb = frozen.vectors[GRADIENT], frozen.border[GRADIENT]
    p, pb, changeb = frozen.vectors[DIRECTION], frozen.border[DIRECTION], frozen.border[CHANGE]
    change[:] = 0.0
    of_change[:] = 0.0
    changeb[:] = 0.0
    rollers_into(tables, h, t, work.state, matrix.own)
    copy(frozen.vectors[RESIDUAL], z)
    copy(frozen.border[RESIDUAL], zb)
    before, along, part, gathered = 1e300, 0.0, 0.0, False
    iteration, converged, renewed = 0, False, False
    air = work.film.many[0] > 0
    least = FIRST_DIRECTION * limit
    doubtful = False
    if not air:
        moves = let_go(work, work.free.residual, frozen.border[RESIDUAL], work.free.lets[BEFORE])
        doubtful = moves > least
    if air:
        limit *= AIR_FINE
    _say_enough(work, limit)
    begins = renew
    if begins and factored[SPENT] >= FACTOR_SERVES and not air:
        factored[STALE] = 1.0
    for iteration in range(CONVEX_MOST_WITH_AIR if air else CONVEX_MOST):
        if iteration == 0:
            copy(g, z)
            copy(gb, zb)
        else:
            _gradient(work, h, axes, part)
        part = 0.0
        made = factored[MADE_FOR] != 2.0 * h or factored[STALE] != 0.0 or factored[WHERE] != INSIDE
        if made:
            if not gathered:
                gather(work, counts, h, False)
                gathered = True
            counters[FACTORS] += 1
            if not _make_matrix(work, h, lag, renew):
                return 0
            factored[MADE_FOR], factored[STALE], factored[WHERE] = 2.0 * h, 0.0, INSIDE
            factored[SPENT] = 0.0
            renew, renewed = False, True
        crossing = _dot(g, z) + _dot(gb, zb) if iteration > 0 and not made else 0.0
        copy(z, g)
        copy(zb, gb)
        counters[SOLVES] += 1
        factored[SPENT] += 0.0 if begins and iteration == 0 else 1.0
        solve_coupled(matrix, LINEAR_LEFT_WITH_AIR if air else LINEAR_LEFT)
        # conjugate directions, by Polak and Ribiere: they compensate for a factor of an earlier state
        square = _dot(g, z) + _dot(gb, zb)
        turn = max(0.0, (square - crossing) / along) if iteration > 0 and not made and along > 0.0 else 0.0
        along = square
        for i in range(p.size):
            p[i] = turn * p[i] - z[i]
        for i in range(pb.size):
            pb[i] = turn * pb[i] - zb[i]
        moved = greatest(work, p, pb, control)
        if iteration == 0 and moved <= limit and (made or not doubtful):
            copy(change, p)
            copy(changeb, pb)
            converged = True
            break
        if not gathered:
            gather(work, counts, h, False)
            gathered = True
        falls = _dot(g, p) + _dot(gb, pb)
        if not falls < 0.0:
            # with a factor of an earlier state the function may rise along the direction
            if made and iteration == 0:
                return 0
            if made:
                break
            factored[STALE] = 1.0
            continue
        linear, square = _direction(work, axes, h)
        part = _how_far(work, h, falls, linear, square, 0.0 if air else SLOPE_WHOLE)
        for i in range(p.size):
            of_change[i] += part * frozen.vectors[OF_DIRECTION, i]
            change[i] += part * p[i]
        for i in range(pb.size):
            changeb[i] += part * pb[i]
        # `moved` is the change of the whole direction: a small `part` of it does not mean a small residual
        rate = moved / before
        first = not whole and iteration == 0 and part == 1.0 and moved <= FIRST_DIRECTION * limit
        converged = first or moved <= CONVEX_ROUGH * limit
        if before < 1e299 and part == 1.0 and rate < 0.5:
            converged = converged or moved * rate / (1.0 - rate) <= CONVEX_ROUGH * limit
        if converged and doubtful and not renewed and not _cured(work, h, axes, part, least):
            converged, part, before, factored[STALE] = False, 0.0, 1e300, 1.0
            continue
        if converged:
            break
        if (
            before < 1e299
            and not (air and renewed)
            and (
                rate >= 0.7
                or math.log(CONVEX_ROUGH * limit / moved) < CONVEX_FACTOR_WORTH * math.log(max(rate, 1e-6))
            )
        ):
            factored[STALE] = 1.0
        before = moved
    for i in range(z.size):
        z[i] = -change[i]
    for i in range(zb.size):
        zb[i] = -changeb[i]
    return iteration + 1 if converged else -1
