"""Sheets in two colours, so that those which touch each other differ: every other one of a stack.

Then no two boxes of one colour are coupled but through their own sheet. What the first colour and the rollers
do is eliminated exactly, a solve with their bands each time, and the method of conjugate gradients looks for
the second colour alone. It needs half the iterations that it needs for both at once, which are no dearer.

All of it is done sheet by sheet, in jobs that threads share: FIRST and BACK solve for what the first colour
does where the second moves by p, ACROSS has what that does to the second, STEP goes that way, TURN finds the
next.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels import parallel
from mdlgen.backends.lattice.kernels.linear.band import solve_single
from mdlgen.backends.lattice.kernels.linear.block import add_product, column, six
from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END, ONE, TWO
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve
from mdlgen.backends.lattice.kernels.parallel import begin, finish, take
from mdlgen.program.kernel import BORROWS, njit

# Of Pool.given: how far the method goes, how much of the last direction the next one keeps, and whether the
# first colour starts from the right-hand side.
LENGTH, KEPT, START = 0, 1, 2


@njit(cache=True, error_model="numpy", **BORROWS)
def corner_of_first(matrix):
    """Factors the corner of the first colour, where the band of all is factored and the border eliminated.
    Where it is not positive all sheets are solved at once; returns False where contacts stand in series."""
    b, d, y, colours = matrix.border, matrix.corner, matrix.eliminated, matrix.couplings.colouring
    corner = colours.corner
    if colours.found[0] == 0:
        return True
    for i in range(d.shape[0]):
        for j in range(i + 1):
            v = d[i, j]
            for sheet in range(colours.of.size):
                if colours.of[sheet] == 0:
                    for l in range(colours.reached[sheet, i, BEGIN], colours.reached[sheet, i, END]):
                        v -= b[i, l] * y[j, l]
            corner[i, j] = v
    if cholesky(corner):
        return True
    colours.found[0] = 0
    return colours.series[0] == 0


@njit(cache=True, error_model="numpy", **BORROWS)
def _dot(p, q):
    """Four sums at a time, since each addition waits for the one before."""
    one = two = three = four = 0.0
    whole = p.size - p.size % 4
    for l in range(0, whole, 4):
        one += p[l] * q[l]
        two += p[l + 1] * q[l + 1]
        three += p[l + 2] * q[l + 2]
        four += p[l + 3] * q[l + 3]
    for l in range(whole, p.size):
        one += p[l] * q[l]
    return (one + two) + (three + four)


@njit(cache=True, error_model="numpy", **BORROWS)
def _across(couplings, sheet, p, q):
    """Adds to q of a sheet what the other colour does to it where that moves by p."""
    colours, ends, blocks = couplings.colouring, couplings.ends, couplings.single
    label = colours.label
    for at in range(colours.begins[sheet], colours.begins[sheet + 1]):
        k = colours.own[at]
        one, two = 6 * ends[k, ONE], 6 * ends[k, TWO]
        if label[ends[k, TWO]] == sheet:
            add_product(blocks[k, TWO], p, one, q, two)
        else:
            add_product(blocks[k, ONE], p, two, q, one)


@njit(cache=True, error_model="numpy", **BORROWS)
def _beside(couplings, span, p, q):
    """Adds to q of a sheet what stands beside its band."""
    for n in range(span[BEGIN], span[END]):
        block, i = couplings.beside[n], 6 * n
        x = six(p, i)
        q[i] += column(block, 0, x)
        q[i + 1] += column(block, 1, x)
        q[i + 2] += column(block, 2, x)
        q[i + 3] += column(block, 3, x)
        q[i + 4] += column(block, 4, x)
        q[i + 5] += column(block, 5, x)


@njit(cache=True, error_model="numpy", **BORROWS)
def _rows(couplings, size):
    """Vectors of the nodes: what is left of the second colour, what is solved for, the direction, what the
    second colour makes of it, what the first does where the second moves."""
    room = couplings.room
    return room[0, :size], room[1, :size], room[2, :size], room[3, :size], room[4, :size]


@njit(cache=True, error_model="numpy", **BORROWS)
def first_part(pool, matrix, sheet):
    """Solves a sheet of the first colour for what the second does to it, or for the right-hand side; what
    each sheet does to the rollers."""
    couplings, b = matrix.couplings, matrix.border
    _, _, p, _, w = _rows(couplings, matrix.res.size)
    span, start = couplings.colouring.spans[sheet], pool.given[START] != 0.0
    low, high = 6 * span[BEGIN], 6 * span[END]
    x = p
    if couplings.colouring.of[sheet] == 0:
        x = w
        for l in range(low, high):
            w[l] = matrix.res[l] if start else 0.0
        if not start:
            _across(couplings, sheet, p, w)
        solve_single(matrix.single_factor[span[BEGIN] : span[END]], w[low:high], couplings.short[low:high])
    elif start:
        return
    for j in range(b.shape[0]):
        low, high = couplings.colouring.reached[sheet, j]
        pool.shares[sheet, j, 0] = _dot(b[j, low:high], x[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def back_part(matrix, sheet):
    """Takes off a sheet of the first colour what the rollers do to it."""
    couplings, y = matrix.couplings, matrix.eliminated
    size, span = matrix.res.size, couplings.colouring.spans[sheet]
    w, rollers = couplings.room[4, :size], couplings.room[4, size:]
    if couplings.colouring.of[sheet] != 0:
        return
    for j in range(rollers.size):
        v, reached = rollers[j], couplings.colouring.reached[sheet, j]
        if reached[BEGIN] < reached[END]:
            for l in range(6 * span[BEGIN], 6 * span[END]):
                w[l] -= y[j, l] * v


@njit(cache=True, error_model="numpy", **BORROWS)
def across_part(pool, matrix, sheet):
    """What a sheet of the second colour makes of its move, less what the first colour and the rollers do to
    it then."""
    couplings, b, size = matrix.couplings, matrix.border, matrix.res.size
    colours = couplings.colouring
    _, q, p, own, w = _rows(couplings, size)
    rollers, span = couplings.room[4, size:], colours.spans[sheet]
    low, high = 6 * span[BEGIN], 6 * span[END]
    if colours.of[sheet] != 1:
        return
    for l in range(low, high):
        q[l] = 0.0
    _across(couplings, sheet, w, q)
    for j in range(rollers.size):
        far, reached = rollers[j], colours.reached[sheet, j]
        for l in range(reached[BEGIN], reached[END]):
            q[l] += b[j, l] * far
    for l in range(low, high):
        q[l] = own[l] - q[l]
    if colours.series[0] == 1 and pool.given[START] == 0.0:
        _beside(couplings, span, p, q)
    pool.shares[sheet, 0, 0] = _dot(p[low:high], q[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def split_part(pool, matrix, sheet):
    """Begins the method: what is left of the second colour, and its first direction."""
    couplings, res, size = matrix.couplings, matrix.res, matrix.res.size
    r, z, p, own, w = _rows(couplings, size)
    span = couplings.colouring.spans[sheet]
    low, high = 6 * span[BEGIN], 6 * span[END]
    if couplings.colouring.of[sheet] != 1:
        for l in range(low, high):
            res[l] = w[l]
        return
    for l in range(low, high):
        r[l] = own[l] = z[l]
        res[l] = 0.0
    solve_single(matrix.single_factor[span[BEGIN] : span[END]], z[low:high], couplings.short[low:high])
    for l in range(low, high):
        p[l] = z[l]
    pool.shares[sheet, 0, 0] = _dot(r[low:high], z[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def step_part(pool, matrix, sheet):
    """Goes in the direction of the method, and solves for what is left of the second colour."""
    couplings, res = matrix.couplings, matrix.res
    r, z, p, _, w = _rows(couplings, res.size)
    span, part = couplings.colouring.spans[sheet], pool.given[LENGTH]
    low, high = 6 * span[BEGIN], 6 * span[END]
    if couplings.colouring.of[sheet] != 1:
        for l in range(low, high):
            res[l] -= part * w[l]
        return
    for l in range(low, high):
        r[l] -= part * z[l]
        res[l] += part * p[l]
        z[l] = r[l]
    solve_single(matrix.single_factor[span[BEGIN] : span[END]], z[low:high], couplings.short[low:high])
    pool.shares[sheet, 0, 0] = _dot(r[low:high], z[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def turn_part(pool, matrix, sheet):
    """The next direction of the method."""
    couplings = matrix.couplings
    r, z, p, own, _ = _rows(couplings, matrix.res.size)
    span, turn = couplings.colouring.spans[sheet], pool.given[KEPT]
    if couplings.colouring.of[sheet] != 1:
        return
    for l in range(6 * span[BEGIN], 6 * span[END]):
        p[l] = z[l] + turn * p[l]
        own[l] = r[l] + turn * own[l]


@njit(cache=True, error_model="numpy", **BORROWS)
def part_of(pool, matrix, kind, sheet):
    """Does the part of a sheet in a job of one of these kinds."""
    if kind == parallel.FIRST:
        first_part(pool, matrix, sheet)
    elif kind == parallel.BACK:
        back_part(matrix, sheet)
    elif kind == parallel.ACROSS:
        across_part(pool, matrix, sheet)
    elif kind == parallel.SPLIT:
        split_part(pool, matrix, sheet)
    elif kind == parallel.STEP:
        step_part(pool, matrix, sheet)
    elif kind == parallel.TURN:
        turn_part(pool, matrix, sheet)


@njit(cache=True, error_model="numpy", **BORROWS)
def _each(pool, matrix, kind):
    """Does a job."""
    many = pool.failed.size
    begin(pool, kind, many)
    sheet = take(pool)
    while sheet >= 0:
        part_of(pool, matrix, kind, sheet)
        sheet = take(pool)
    finish(pool, many)


@njit(cache=True, error_model="numpy", **BORROWS)
def _sum(pool, colours):
    """Of what the sheets of the second colour left."""
    total = 0.0
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1:
            total += pool.shares[sheet, 0, 0]
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def _enough(pool, colours):
    """Whether what is left of each sheet of the second colour is as little as it may be."""
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1 and not pool.shares[sheet, 0, 0] <= colours.enough[sheet]:
            return False
    return True


@njit(cache=True, error_model="numpy", **BORROWS)
def _first(pool, matrix, rollers, start):
    """What the first colour and the rollers do where the second moves, or at the right-hand side, and what
    that does to the second. `rollers`: what they begin with."""
    colours = matrix.couplings.colouring
    pool.given[START] = 1.0 if start else 0.0
    _each(pool, matrix, parallel.FIRST)
    if rollers.size > 0:
        for j in range(rollers.size):
            if not start:
                for sheet in range(colours.of.size):
                    if colours.of[sheet] == 1:
                        rollers[j] += pool.shares[sheet, j, 0]
            for sheet in range(colours.of.size):
                if colours.of[sheet] == 0:
                    rollers[j] -= pool.shares[sheet, j, 0]
        cholesky_solve(colours.corner, rollers)
        _each(pool, matrix, parallel.BACK)
    _each(pool, matrix, parallel.ACROSS)


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_coloured(pool, matrix, most, least):
    """Solves band, border and couplings in place, where the sheets have two colours.

    The method ends after `most` iterations, or where the square of the residual, measured with the
    preconditioner, is `least` of what it was, or in each sheet no more than enough.
    """
    couplings, res, resb = matrix.couplings, matrix.res, matrix.resb
    colours, size = couplings.colouring, res.size
    own, rollers = couplings.room[3], couplings.room[4, size:]
    # the first colour as if the second stood still, and what that does to the second
    for l in range(size):
        own[l] = res[l]
    for j in range(resb.size):
        rollers[j] = resb[j]
    _first(pool, matrix, rollers, True)
    for j in range(resb.size):
        resb[j] = rollers[j]
    _each(pool, matrix, parallel.SPLIT)
    left = _sum(pool, colours)
    first = left
    for _ in range(most):
        if not left > least * first or _enough(pool, colours):
            break
        # what the first colour does where the second moves by p, and what that does to the second
        for j in range(resb.size):
            rollers[j] = 0.0
        _first(pool, matrix, rollers, False)
        along = _sum(pool, colours)
        if not along > 0.0:
            break
        pool.given[LENGTH] = left / along
        for j in range(resb.size):
            resb[j] -= pool.given[LENGTH] * rollers[j]
        _each(pool, matrix, parallel.STEP)
        after = _sum(pool, colours)
        pool.given[KEPT], left = after / left, after
        _each(pool, matrix, parallel.TURN)
