"""Air between sheets in a step: its pressures, their forces on bodies, and its part of an iteration.

The gaps are frozen in a step (see mechanics.film). They are those of its middle at the guessed velocities,
but at least half of those at its beginning. So pressures are linear in the velocities, and the forces are the
gradient of a convex function of the velocities. An iteration with frozen contacts treats each cell of air as
a point (integrate.points); the force of such a point depends on the rates of all cells. The factored matrix
contains each cell without its coupling to the others.

At the end of a step velocities are carried to 2 u - v0. A motion that a film stops within a part of a step
would oscillate, as with joints that have a damping time (integrate.damped). So the same correction is
subtracted here: Y w, where w is the deviation of v0 from a straight course, Y = X/(1 + X), and X = h M^-1 D
of the film. With D = C^T A^-1 C, A of Reynolds' equation and C the closing rates per velocity, Y w =
M^-1 C^T s, where (A + h C M^-1 C^T) s = h C w. Conjugate gradients find s. These forces act at the same
places on both bodies, so momenta are conserved exactly.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import (
    ALONG,
    GROWTH,
    PRESSURES,
)
from mdlgen.backends.lattice.kernels.tuning import AIR_LEFT, AIR_MOST, CELL_ALONE
from mdlgen.mechanics.film import factor, solve, times
from mdlgen.mechanics.film_pairs import clear_films, close_rates, cover_pair, link_films, may_have_air
from mdlgen.mechanics.vector import add, back, cross, dot, mat, rotate, scale, sub, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def lay(work, h):
    """Sets up the air of a step: gaps, areas and matrices in the middle of the step, h [ms] after its
    beginning. Returns True if any film acts."""
    tables, film, motion = work.tables, work.film, work.mid.motion
    clear_films(film)
    for p in range(tables.pairs.size):
        pair = tables.pairs[p]
        if pair.kind < 0:
            break
        if may_have_air(pair) and film.film_of[pair.row] >= 0:
            cover_pair(film, film.film_of[pair.row], tables.bodies, pair, p, motion, h)
    link_films(film)
    for k in range(film.films.size):
        one = film.films[k]
        if one.acts == 0:
            continue
        for i in range(one.cell, one.cell + one.cells):
            for j in range(one.width + 1):
                film.factor[i, j] = film.flow[i, j]
        factor(film.factor, one.cell, one.cells, one.width)
    return film.many[0] > 0


@njit(cache=True, error_model="numpy", **BORROWS)
def _solve(film):
    """Pressures of all films from the rates of their cells."""
    x = film.vectors[PRESSURES]
    for k in range(film.films.size):
        one = film.films[k]
        if one.acts == 0:
            continue
        for i in range(one.cell, one.cell + one.cells):
            x[i] = film.cells[i].area * film.cells[i].rate
        solve(one, film.factor, x)


@njit(cache=True, error_model="numpy", **BORROWS)
def air_forces(work):
    """Adds the forces of air to those of the midpoint. Returns the power that it dissipates."""
    tables, film, motion, f = work.tables, work.film, work.mid.motion, work.mid.forces
    cells, x, lost = film.cells, film.vectors[PRESSURES], 0.0
    close_rates(film, tables.pairs, motion)
    _solve(film)
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        one, two = vec(motion.x, pair.a), vec(motion.x, pair.b)
        while i >= 0:
            own = cells[i]
            own.pressure = x[i]
            at, push = three(own.at), scale(own.area * x[i], three(own.normal))
            turn, far = cross(sub(at, one), push), cross(sub(at, two), push)
            for q in range(3):
                f[pair.a, q] += push[q]
                f[pair.a, 3 + q] += turn[q]
                f[pair.b, q] -= push[q]
                f[pair.b, 3 + q] -= far[q]
            lost += own.area * x[i] * own.rate
            i = own.following
    return lost


@njit(cache=True, error_model="numpy", **BORROWS)
def damping_of(film, i):
    """Damping constant of a cell alone, as in the factored matrix [N ms/mm]."""
    return CELL_ALONE * film.cells[i].area * film.cells[i].area / film.flow[i, 0]


@njit(cache=True, error_model="numpy", **BORROWS)
def air_along(film, frozen):
    """Sets the change of the forces of the points of air along the search direction."""
    cells, x = film.cells, film.vectors[PRESSURES]
    for k in range(film.many[0]):
        i = film.head[film.listed[k]]
        while i >= 0:
            own = cells[i]
            own.rate = 0.0
            if own.point >= 0:
                own.rate = -dot(three_from(frozen.points[own.point], ALONG), three(own.normal))
            i = own.following
    _solve(film)
    for k in range(film.many[0]):
        i = film.head[film.listed[k]]
        while i >= 0:
            own = cells[i]
            if own.point >= 0:
                frozen.points[own.point, GROWTH] = own.area * x[i]
            i = own.following


@njit(cache=True, error_model="numpy", **BORROWS)
def _push(work, end, x, push):
    """Sets push (nodes, 6) to the momenta that impulses x of all cells give boxes at the places `end`."""
    tables, film = work.tables, work.film
    push[:] = 0.0
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        while i >= 0:
            own = film.cells[i]
            force, at = scale(own.area * x[i], three(own.normal)), three(own.at)
            for side in range(2):
                body, sign = (pair.a, 1.0) if side == 0 else (pair.b, -1.0)
                n = tables.bodies[body].node
                if n < 0:
                    continue
                turn = cross(sub(at, vec(end, body)), force)
                for q in range(3):
                    push[n, q] += sign * force[q]
                    push[n, 3 + q] += sign * turn[q]
            i = own.following


@njit(cache=True, error_model="numpy", **BORROWS)
def _moved(work, push):
    """Converts momenta to velocities."""
    tables, r = work.tables, work.mid.motion.r
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        m, j, mass = mat(r, b), tables.bodies[b].inertia, tables.bodies[b].mass
        own = back(m, (push[n, 3], push[n, 4], push[n, 5]))
        spin = rotate(m, (own[0] / j[0], own[1] / j[1], own[2] / j[2]))
        for q in range(3):
            push[n, q] /= mass
            push[n, 3 + q] = spin[q]


@njit(cache=True, error_model="numpy", **BORROWS)
def _closes(work, end, w, y, times_h):
    """Adds to y, for each cell, times_h times the rate at which velocities w (nodes, 6) reduce its volume."""
    tables, film = work.tables, work.film
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        while i >= 0:
            own, rate = film.cells[i], 0.0
            n, at = three(own.normal), three(own.at)
            for side in range(2):
                body, sign = (pair.a, -1.0) if side == 0 else (pair.b, 1.0)
                node = tables.bodies[body].node
                if node >= 0:
                    turn = cross((w[node, 3], w[node, 4], w[node, 5]), sub(at, vec(end, body)))
                    rate += sign * dot(add((w[node, 0], w[node, 1], w[node, 2]), turn), n)
            y[i] += times_h * own.area * rate
            i = own.following


@njit(cache=True, error_model="numpy", **BORROWS)
def _precondition(work, end, h):
    """Factors A plus the diagonal of h C M^-1 C^T."""
    tables, film, r = work.tables, work.film, work.mid.motion.r
    for i in range(film.ends.shape[0]):
        for j in range(film.ends.shape[1]):
            film.ends[i, j] = film.flow[i, j]
    for k in range(film.many[0]):
        pair, i = tables.pairs[film.listed[k]], film.head[film.listed[k]]
        while i >= 0:
            own, gives = film.cells[i], 0.0
            for side in range(2):
                body = tables.bodies[pair.a if side == 0 else pair.b]
                if body.node < 0:
                    continue
                b = tables.nodes[body.node]
                turn = back(mat(r, b), cross(sub(three(own.at), vec(end, b)), three(own.normal)))
                gives += 1.0 / body.mass
                for q in range(3):
                    gives += turn[q] * turn[q] / body.inertia[q]
            film.ends[i, 0] += h * own.area * own.area * gives
            i = own.following
    for k in range(film.films.size):
        one = film.films[k]
        if one.acts != 0:
            factor(film.ends, one.cell, one.cells, one.width)


@njit(cache=True, error_model="numpy", **BORROWS)
def _dot(a, b):
    total = 0.0
    for i in range(a.size):
        total += a[i] * b[i]
    return total


@njit(cache=True, error_model="numpy", **BORROWS)
def _lacks(work, before, ahead, w):
    """Writes into w the deviation of the initial velocities of a step from a straight course to its
    middle."""
    tables, r = work.tables, work.mid.motion.r
    u, v, l = work.state.u, work.state.v, work.state.l
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        m, j = mat(r, b), tables.bodies[b].inertia
        own = back(m, (l[n, 0], l[n, 1], l[n, 2]))
        spin = rotate(m, (own[0] / j[0], own[1] / j[1], own[2] / j[2]))
        for q in range(3):
            w[n, q] = u[n, q] - v[n, q] - ahead * (u[n, q] - before[n, q])
            w[n, 3 + q] = u[n, 3 + q] - spin[q] - ahead * (u[n, 3 + q] - before[n, 3 + q])


@njit(cache=True, error_model="numpy", **BORROWS)
def air_overshoot(work, before, ahead, dt):
    """Sets Film.off, the velocities to subtract because of air. damped.overshoot does the same for joints,
    and is called first: the deviation here is what remains after its correction."""
    film, tables, h = work.film, work.tables, 0.5 * dt
    off, push, end = film.off, film.push, film.place
    s, r, p, q = film.vectors
    off[:] = 0.0
    if film.many[0] == 0:
        return
    _lacks(work, before, ahead, push)
    for b in range(tables.bodies.size):  # places at the end of the step, where `off` is subtracted
        n = tables.bodies[b].node
        for i in range(3):
            end[b, i] = work.state.x[b, i] + (dt * work.state.u[n, i] if n >= 0 else 0.0)
        if n >= 0 and work.damped.joints.size > 0:
            for i in range(6):
                push[n, i] -= work.damped.off[n, i]
    for i in range(s.size):
        s[i] = r[i] = p[i] = q[i] = 0.0
    _closes(work, end, push, r, h)
    _precondition(work, end, h)
    left = first = 0.0
    for iteration in range(AIR_MOST + 1):
        for i in range(q.size):
            q[i] = r[i]
        for k in range(film.films.size):
            if film.films[k].acts != 0:
                solve(film.films[k], film.ends, q)
        after = _dot(r, q)
        if iteration == 0:
            first = after
        turn = after / left if iteration > 0 else 0.0
        left = after
        if not left > AIR_LEFT * first or iteration == AIR_MOST:
            break
        for i in range(p.size):
            p[i] = q[i] + turn * p[i]
            q[i] = 0.0
        for k in range(film.films.size):
            if film.films[k].acts != 0:
                times(film.films[k], film.flow, p, q)
        _push(work, end, p, push)
        _moved(work, push)
        # both faces are pushed apart, which reduces the closing rate
        _closes(work, end, push, q, -h)
        part = left / _dot(p, q)
        for i in range(s.size):
            s[i] += part * p[i]
            r[i] -= part * q[i]
    _push(work, end, s, push)
    _moved(work, push)
    for n in range(off.shape[0]):
        for i in range(6):
            off[n, i] = -push[n, i]
