"""Solves a system of sheets in two colours: those that touch have different ones, as alternate sheets of a
stack.

Then two boxes of one colour are coupled only within their sheet. The first colour and the rollers are
eliminated exactly, by a solve with their bands each time, and conjugate gradients solve for the second colour
alone. That needs half the iterations of a solve for both, at the same cost each.

All loops run sheet by sheet. `_first` solves for the response of the first colour and the rollers to a motion
p of the second, and multiplies it by the couplings; `_step` moves along p; `_turn` computes the next
direction.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.linear.band import solve_single
from mdlgen.backends.lattice.kernels.linear.block import add_product, column, six
from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END, ONE, TWO
from mdlgen.backends.lattice.kernels.linear.dense import cholesky, cholesky_solve
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def corner_of_first(matrix):
    """Factors the corner of the first colour, after the band of all is factored and the border eliminated.
    Where it is not positive all sheets are solved at once; returns False where they have contacts in
    series."""
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
    """Scalar product; four sums at a time, since each addition waits for the one before."""
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
    """Adds to q of a sheet the forces of the other colour where that moves by p."""
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
    """Adds to q of a sheet the part of contacts that is not in its band (see in_series) times p."""
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
    """Vectors of the nodes: residual of the second colour; preconditioned residual and product of the matrix;
    direction; product of the second colour's own matrix; response of the first colour."""
    room = couplings.room
    return room[0, :size], room[1, :size], room[2, :size], room[3, :size], room[4, :size]


@njit(cache=True, error_model="numpy", **BORROWS)
def _solve_first(matrix, sheet, start):
    """Solves a sheet of the first colour for the forces of the second; `start`: for the right-hand side."""
    couplings = matrix.couplings
    _, _, p, _, w = _rows(couplings, matrix.res.size)
    span = couplings.colouring.spans[sheet]
    low, high = 6 * span[BEGIN], 6 * span[END]
    for l in range(low, high):
        w[l] = matrix.res[l] if start else 0.0
    if not start:
        _across(couplings, sheet, p, w)
    solve_single(matrix.single_factor[span[BEGIN] : span[END]], w[low:high], couplings.short[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def _on_rollers(matrix, sheet, x, sign, rollers):
    """Adds to the rollers the forces of a sheet that moves by x, times a sign."""
    for j in range(rollers.size):
        low, high = matrix.couplings.colouring.reached[sheet, j]
        rollers[j] += sign * _dot(matrix.border[j, low:high], x[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def _back(matrix, sheet, rollers):
    """Subtracts from a sheet of the first colour its response to the rollers."""
    couplings, y = matrix.couplings, matrix.eliminated
    span, w = couplings.colouring.spans[sheet], couplings.room[4, : matrix.res.size]
    for j in range(rollers.size):
        v, reached = rollers[j], couplings.colouring.reached[sheet, j]
        if reached[BEGIN] < reached[END]:
            for l in range(6 * span[BEGIN], 6 * span[END]):
                w[l] -= y[j, l] * v


@njit(cache=True, error_model="numpy", **BORROWS)
def _second(matrix, sheet, rollers, start):
    """Multiplies a sheet of the second colour by the reduced matrix: its own matrix, less the response of the
    first colour and the rollers. Returns the scalar product with the direction."""
    couplings, b = matrix.couplings, matrix.border
    colours = couplings.colouring
    _, q, p, own, w = _rows(couplings, matrix.res.size)
    span = colours.spans[sheet]
    low, high = 6 * span[BEGIN], 6 * span[END]
    for l in range(low, high):
        q[l] = 0.0
    _across(couplings, sheet, w, q)
    for j in range(rollers.size):
        far, reached = rollers[j], colours.reached[sheet, j]
        for l in range(reached[BEGIN], reached[END]):
            q[l] += b[j, l] * far
    for l in range(low, high):
        q[l] = own[l] - q[l]
    if colours.series[0] == 1 and not start:
        _beside(couplings, span, p, q)
    return _dot(p[low:high], q[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def _first(matrix, rollers, start):
    """Multiplies the direction of the second colour by the reduced matrix, or reduces the right-hand side
    (`start`). Solves for the response of the first colour and the rollers, then for each sheet of the second.
    Returns the scalar product with the direction. `rollers`: their right-hand side."""
    colours = matrix.couplings.colouring
    _, _, p, _, w = _rows(matrix.couplings, matrix.res.size)
    if not start:
        for sheet in range(colours.of.size):
            if colours.of[sheet] == 1:
                _on_rollers(matrix, sheet, p, 1.0, rollers)
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 0:
            _solve_first(matrix, sheet, start)
            _on_rollers(matrix, sheet, w, -1.0, rollers)
    if rollers.size > 0:
        cholesky_solve(colours.corner, rollers)
        for sheet in range(colours.of.size):
            if colours.of[sheet] == 0:
                _back(matrix, sheet, rollers)
    total = 0.0
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1:
            total += _second(matrix, sheet, rollers, start)
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def _precondition(matrix, sheet):
    """Solves a sheet of the second colour for its residual, with the band as preconditioner; returns the
    square of the residual in that norm."""
    couplings = matrix.couplings
    r, z, _, _, _ = _rows(couplings, matrix.res.size)
    span = couplings.colouring.spans[sheet]
    low, high = 6 * span[BEGIN], 6 * span[END]
    for l in range(low, high):
        z[l] = r[l]
    solve_single(matrix.single_factor[span[BEGIN] : span[END]], z[low:high], couplings.short[low:high])
    return _dot(r[low:high], z[low:high])


@njit(cache=True, error_model="numpy", **BORROWS)
def _split(matrix):
    """Begins the method: sets the residual of the second colour and the first direction. Returns the square
    of the residual, and True if that of each sheet is below its limit."""
    res, colours = matrix.res, matrix.couplings.colouring
    r, z, p, own, w = _rows(matrix.couplings, res.size)
    total, enough = 0.0, True
    for sheet in range(colours.of.size):
        low, high = 6 * colours.spans[sheet, BEGIN], 6 * colours.spans[sheet, END]
        if colours.of[sheet] != 1:
            for l in range(low, high):
                res[l] = w[l]
            continue
        for l in range(low, high):
            r[l] = own[l] = z[l]
            res[l] = 0.0
        left = _precondition(matrix, sheet)
        for l in range(low, high):
            p[l] = z[l]
        total, enough = total + left, enough and left <= colours.enough[sheet]
    return total, enough


@njit(cache=True, error_model="numpy", **BORROWS)
def _step(matrix, far):
    """Moves by `far` times the direction, and solves for the remaining residual of the second colour. Returns
    the same as _split."""
    res, colours = matrix.res, matrix.couplings.colouring
    r, z, p, _, w = _rows(matrix.couplings, res.size)
    total, enough = 0.0, True
    for sheet in range(colours.of.size):
        low, high = 6 * colours.spans[sheet, BEGIN], 6 * colours.spans[sheet, END]
        if colours.of[sheet] != 1:
            for l in range(low, high):
                res[l] -= far * w[l]
            continue
        for l in range(low, high):
            r[l] -= far * z[l]
            res[l] += far * p[l]
        left = _precondition(matrix, sheet)
        total, enough = total + left, enough and left <= colours.enough[sheet]
    return total, enough


@njit(cache=True, error_model="numpy", **BORROWS)
def _turn(matrix, turn):
    """Computes the next direction: the preconditioned residual plus `turn` times the last direction."""
    colours = matrix.couplings.colouring
    r, z, p, own, _ = _rows(matrix.couplings, matrix.res.size)
    for sheet in range(colours.of.size):
        if colours.of[sheet] == 1:
            for l in range(6 * colours.spans[sheet, BEGIN], 6 * colours.spans[sheet, END]):
                p[l] = z[l] + turn * p[l]
                own[l] = r[l] + turn * own[l]


@njit(cache=True, error_model="numpy", **BORROWS)
def solve_coloured(matrix, most, least):
    """Solves band, border and couplings in place, where the sheets have two colours.

    The method ends after `most` iterations, or where the squared residual, in the norm of the preconditioner,
    is below `least` of its initial value, or below Colouring.enough in each sheet.
    """
    couplings, res, resb = matrix.couplings, matrix.res, matrix.resb
    size = res.size
    own, rollers = couplings.room[3], couplings.room[4, size:]
    # the first colour with the second one fixed, and its forces on the second
    for l in range(size):
        own[l] = res[l]
    for j in range(resb.size):
        rollers[j] = resb[j]
    _first(matrix, rollers, True)
    for j in range(resb.size):
        resb[j] = rollers[j]
    left, enough = _split(matrix)
    first = left
    for _ in range(most):
        if not left > least * first or enough:
            break
        # response of the first colour to a motion p of the second, and its forces on the second
        for j in range(resb.size):
            rollers[j] = 0.0
        along = _first(matrix, rollers, False)
        if not along > 0.0:
            break
        far = left / along
        for j in range(resb.size):
            resb[j] -= far * rollers[j]
        after, enough = _step(matrix, far)
        _turn(matrix, after / left)
        left = after
