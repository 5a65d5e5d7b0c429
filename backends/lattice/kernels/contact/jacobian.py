"""The growth of contact impulses with velocities, and Newton's matrix of the boxes that touch."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.contact.condensed import ACTIVE
from mdlgen.backends.lattice.kernels.contact.slopes import (
    core,
    core_stretched,
    couple_growth,
    hat_left,
    hat_right,
    numbers_of,
    outer,
)
from mdlgen.backends.lattice.kernels.linear.dense import lu_solve_transposed
from mdlgen.mechanics.arm import turn_of, way_of
from mdlgen.mechanics.axle import acting
from mdlgen.mechanics.measured import STRETCH, is_stretched
from mdlgen.mechanics.point import AT, AXIS, COUPLE, KIND, LINE, NORMAL, OF_NIP, OUT, POINT, POINTS, SLIP, WAY
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import add, back, cross, dot, mat, scale, sub, three, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def activate(bodies, pairs, count, condensed):
    """Lists the active boxes, which touch something now. Returns True if they are those of the last call."""
    active, rank, kept = condensed.active, condensed.rank, condensed.kept
    found, same = 0, True
    for i in range(kept[ACTIVE]):
        rank[active[i]] = -1
    for k in range(count):
        node = bodies[pairs[condensed.touched[k]].a].node
        if node >= 0 and rank[condensed.place_of[node]] < 0:
            place = condensed.place_of[node]
            same = same and found < kept[ACTIVE] and active[found] == place
            active[found] = place
            rank[place] = found
            found += 1
    same = same and found == kept[ACTIVE]
    kept[ACTIVE] = found
    return same


@njit(cache=True, error_model="numpy", forceinline=True)
def _put(g, row, column, sign, t):
    """Adds a 3 x 3 matrix."""
    for i in range(3):
        for j in range(3):
            g[row + i, column + j] += sign * t[3 * i + j]


@njit(cache=True, error_model="numpy", **BORROWS)
def _rollers(body, x, arm, axes, sign, first, direction, index, found):
    """Lists a roller's unknowns that move it against a box, each as a velocity and an angular velocity at the
    box's centre; `arm` is the vector from there to the roller's centre x."""
    if body.slide >= 0:
        turn = back(axes, turn_of(body))
        way = add(back(axes, way_of(body, x)), cross(arm, turn))
        for c in range(3):
            direction[found, c], direction[found, 3 + c] = sign * way[c], sign * turn[c]
        index[found] = first + body.slide
        found += 1
    if body.spin >= 0:
        axis = back(axes, scale(body.ratio, three(body.axis)))
        swing = cross(arm, axis)
        for c in range(3):
            direction[found, c], direction[found, 3 + c] = sign * swing[c], sign * axis[c]
        index[found] = first + body.spin
        found += 1
    return found


@njit(cache=True, error_model="numpy", **BORROWS)
def _point_growth(growth, t, arm):
    """Adds the decrease of a force at an arm per velocity there: t, in the axes of the box."""
    right = hat_right(t, arm)
    _put(growth, 0, 0, 1.0, t)
    _put(growth, 0, 3, -1.0, right)
    _put(growth, 3, 0, 1.0, hat_left(arm, t))
    _put(growth, 3, 3, -1.0, hat_left(arm, right))


@njit(cache=True, error_model="numpy", forceinline=True)
def _add_outer(growth, force, torque, way, turn):
    """Adds a force and a torque per velocity along `way` and per angular velocity along `turn`."""
    for i in range(3):
        for j in range(3):
            growth[i, j] += force[i] * way[j]
            growth[i, 3 + j] += force[i] * turn[j]
            growth[3 + i, j] += torque[i] * way[j]
            growth[3 + i, 3 + j] += torque[i] * turn[j]


@njit(cache=True, error_model="numpy", **BORROWS)
def _pair_growth(pair, out, axes, h, motion, chord, growth):
    """Sums the slopes of all points of a pair: a 6 x 6 matrix for the motion of one body against the other,
    about the centre of the first, in the axes of the box."""
    x, u, w = motion.x, motion.u, motion.w
    for i in range(6):
        for j in range(6):
            growth[i, j] = 0.0
    stretch = is_stretched(out)
    for point in range(int(out[POINTS])):
        at = OUT + 1 + POINT * point
        if out[at + KIND] == COUPLE:
            axis = back(axes, three_from(out, at + AXIS))
            _put(growth, 3, 3, couple_growth(out, at, h, pair.law, chord), outer(axis, axis))
            continue
        normal = back(axes, three_from(out, at + NORMAL))
        slip = back(axes, three_from(out, at + SLIP))
        square = back(axes, three_from(out, at + WAY)) if out[at + KIND] == OF_NIP else normal
        numbers, pull = numbers_of(out, at, pair.law), slip
        if stretch:
            g = back(axes, three_from(out, STRETCH))
            g = sub(g, scale(dot(g, square), square))
            t, damping, phi = core_stretched(numbers, normal, square, slip, g, h, chord, True)
            pull = add(slip, scale(dot(g, slip), g))
        else:
            t, damping, phi = core(numbers, normal, square, slip, h, chord, True)
        arm = back(axes, sub(three_from(out, at + AT), vec(x, pair.a)))
        _point_growth(growth, t, arm)
        if damping != 0.0:
            line = back(axes, sub(three_from(out, at + LINE), vec(x, pair.a)))
            way = back(axes, three_from(out, at + WAY))
            force = scale(damping, sub(normal, scale(phi, pull)))
            # the direction along which a passing sheet closes turns with the face; a roller's own rotation is
            # perpendicular to it wherever the contact line is
            passing = sub(
                add(back(axes, vec(u, pair.a)), cross(back(axes, vec(w, pair.a)), line)),
                back(axes, vec(u, pair.b)),
            )
            turn = add(cross(line, way), scale(h, cross(way, passing)))
            _add_outer(growth, force, cross(arm, force), way, turn)


@njit(cache=True, error_model="numpy", **BORROWS)
def gradient(tables, h, motion, count, condensed, acting, many, chord):
    """Growth of the contact impulses with the velocities of the boxes that touch and of the rollers."""
    bodies, pairs, x = tables.bodies, tables.pairs, motion.x
    growth, one, direction, index = condensed.growth, condensed.pair, condensed.direction, condensed.which
    for i in range(many):
        for j in range(many):
            growth[i, j] = 0.0
    for k in range(count):
        pair, out = pairs[condensed.touched[k]], condensed.results[k]
        node = bodies[pair.a].node
        axes = mat(condensed.axes, pair.a)
        _pair_growth(pair, out, axes, h, motion, chord, one)
        moving, first = 0, 0
        if node >= 0:
            first = 6 * condensed.rank[condensed.place_of[node]]
            for i in range(6):
                for j in range(6):
                    growth[first + i, first + j] += one[i, j]
        else:
            still = (0.0, 0.0, 0.0)
            moving = _rollers(
                bodies[pair.a], vec(x, pair.a), still, axes, 1.0, 6 * acting, direction, index, moving
            )
        far = back(axes, sub(vec(x, pair.b), vec(x, pair.a)))
        moving = _rollers(
            bodies[pair.b], vec(x, pair.b), far, axes, -1.0, 6 * acting, direction, index, moving
        )
        for j in range(moving):
            d = direction[j]
            for i in range(6):
                v = across = 0.0
                for c in range(6):
                    v += one[i, c] * d[c]
                    across += one[c, i] * d[c]
                if node >= 0:
                    growth[first + i, index[j]] += v
                    growth[index[j], first + i] += across
                for l in range(moving):
                    growth[index[l], index[j]] += direction[l, i] * v


@njit(cache=True, error_model="numpy", **BORROWS)
def clutches(tables, h, t, state, condensed, m, active):
    """Adds the decrease of the impulses of clutches and motors per angular velocity of their rollers."""
    bodies, axles = tables.bodies, tables.shapes.axles
    for b in condensed.rollers:
        spin = bodies[b].spin
        if spin >= 0 and bodies[b].coupled != FOLLOWER:
            at, rate = 6 * active + spin, state.ub[spin] + condensed.z[6 * m + spin]
            condensed.growth[at, at] += h * acting(axles, bodies[b], state.s[spin], rate, t, h).growth


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, boundscheck=False, **BORROWS)
def newton_matrix(condensed, acting, many):
    """1 + W growth of the boxes that touch and of the rollers, transposed. Columns are sums of rows of W,
    which is symmetric."""
    growth, w, part, jac, active, own = (
        condensed.growth,
        condensed.w,
        condensed.part,
        condensed.jac,
        condensed.active,
        condensed.own,
    )
    boxes = 6 * acting
    for j in range(acting):
        for k in range(acting):
            for p in range(6):
                for q in range(6):
                    part[6 * j + p, 6 * k + q] = w[6 * active[j] + p, 6 * active[k] + q]
    for c in range(many):
        row = jac[c, :boxes]
        row[:] = 0.0
        first, last = (c // 6, c // 6 + 1) if c < boxes else (0, acting)
        for j in range(first, last):
            k = 6 * j
            g0, g1, g2 = growth[k, c], growth[k + 1, c], growth[k + 2, c]
            g3, g4, g5 = growth[k + 3, c], growth[k + 4, c], growth[k + 5, c]
            if g0 == 0.0 and g1 == 0.0 and g2 == 0.0 and g3 == 0.0 and g4 == 0.0 and g5 == 0.0:
                continue  # a roller that does not touch this box
            w0, w1, w2 = part[k, :boxes], part[k + 1, :boxes], part[k + 2, :boxes]
            w3, w4, w5 = part[k + 3, :boxes], part[k + 4, :boxes], part[k + 5, :boxes]
            for i in range(boxes):
                row[i] += g0 * w0[i] + g1 * w1[i] + g2 * w2[i] + g3 * w3[i] + g4 * w4[i] + g5 * w5[i]
        for i in range(boxes, many):
            jac[c, i] = own[i - boxes] * growth[i, c]
        jac[c, c] += 1.0


@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"}, **BORROWS)
def newton(condensed, m, acting, many):
    """Computes a Newton step of all chosen boxes and the rollers with the factored matrix; `push` is the
    decrease of the impulses on the boxes."""
    growth, w, active, gap = condensed.growth, condensed.w, condensed.active, condensed.gap
    short, push, step = condensed.short, condensed.push, condensed.step
    boxes = 6 * acting
    for j in range(acting):
        for c in range(6):
            short[6 * j + c] = -gap[6 * active[j] + c]
    for i in range(boxes, many):
        short[i] = -gap[6 * m + i - boxes]
    lu_solve_transposed(condensed.jac, condensed.swaps, short, many)
    push[: 6 * m] = 0.0
    for i in range(boxes):
        row, v = growth[i], 0.0
        for j in range(many):
            v += row[j] * short[j]
        push[6 * active[i // 6] + i % 6] = v
    for i in range(6 * m):
        row, v = w[i], -gap[i]
        for j in range(6 * m):
            v -= row[j] * push[j]
        step[i] = v
    for i in range(boxes, many):
        step[6 * m + i - boxes] = short[i]
