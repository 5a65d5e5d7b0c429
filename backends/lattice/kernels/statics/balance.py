"""Static equilibrium of sheets and pressed rollers: Newton's method on forces at rest.

At rest a contact has its elastic force only. Rollers that can turn keep their angle: nothing turns them.

A step turns the boxes by the Newton step, and then places them as chains (see chain.follow). Where not all
joints can have the gaps of that step, the next iteration balances the excess. That excess does not enter the
stiffness, which is evaluated with the forces that the last step was to reach. Steps end where the force along
them changes its sign.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.kernels.forces import joint_forces, near_pairs, other_forces, pair_forces
from mdlgen.backends.lattice.kernels.linear.band import factor
from mdlgen.backends.lattice.kernels.linear.bordered import eliminate, solve_bordered
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.statics.chain import follow, link, opening
from mdlgen.backends.lattice.kernels.statics.stiffness import (
    contacts_into,
    corners_into,
    rollers_into,
    sheets_into,
)
from mdlgen.backends.lattice.kernels.tuning import (
    BALANCE_MOST,
    BALANCE_STILL,
    BALANCE_TRIES,
    EPSILON,
    FIRST_SHIFT,
    LEAST_SHIFT,
    MOST_SHIFT,
    MOST_TURN,
    NO_WAY_BACK,
    NOISE,
    REST,
    REST_AT_LEAST,
)
from mdlgen.mechanics.arm import FORCE_0, INERTIA, STIFFNESS
from mdlgen.mechanics.corner import corner_forces
from mdlgen.mechanics.frame import Motion
from mdlgen.program.kernel import njit


@njit(cache=True, error_model="numpy")
def _residual(tables, level, place, lists, blank, rest):
    """Writes the forces on the free boxes and on slides into `rest`. Returns the largest [N], where torques
    count over half a box; its body; and how many contacts touch."""
    bodies, gravity, nodes = tables.bodies, tables.gravity, tables.nodes
    x, r, s = place
    touched, results, near = lists
    still, f = blank
    on_boxes, on_slides = rest
    motion = Motion(x, r, still, still)
    f[:] = 0.0
    joint_forces(tables.joints, tables.points, motion, f)
    for k in range(tables.corners.size):
        corner_forces(tables.joints, tables.corners[k], motion, f)
    close = near_pairs(tables, motion, 0.0, 0.0, near)
    count, _, _ = pair_forces(tables, near, close, motion, f, touched, results)
    other_forces(tables, level, motion, f)
    worst, at = 0.0, -1
    for n in range(nodes.size):
        b = nodes[n]
        size = bodies[b].half[0] + bodies[b].half[1]
        for i in range(6):
            on_boxes[6 * n + i] = f[b, i]
            v = abs(f[b, i]) if i < 3 else abs(f[b, i]) / size
            if not v <= worst:
                worst, at = v, b
    for b in range(bodies.size - 1):
        k = bodies[b].slide
        if k < 0:
            continue
        p, force = bodies[b].press, 0.0
        for i in range(3):
            force += bodies[b].way[i] * (f[b, i] + level * p[INERTIA] * gravity[i])
        on_slides[k] = force + p[FORCE_0] - p[STIFFNESS] * s[k]
        if not abs(on_slides[k]) <= worst:
            worst, at = abs(on_slides[k]), b
    return worst, at, count


@njit(cache=True, error_model="numpy")
def _newton(matrix, plain, shift, load, rest, step):
    """Solves for a step. Returns the shift of the diagonal, relative to its largest entry, that makes the
    matrix positive definite: `shift` or more; -1 where none does. `plain`: scratch for copies of the
    matrices."""
    a, b, d, y, corner = matrix
    (on_boxes, on_slides), (moves, slides) = rest, step
    band, square = plain
    copy(band, a)
    copy(square, d)
    ease = twist = load
    for n in range(a.shape[0]):
        for i in range(3):
            ease, twist = max(ease, abs(a[n, i, i])), max(twist, abs(a[n, 3 + i, 3 + i]))
    while shift <= MOST_SHIFT:
        for n in range(a.shape[0]):
            for i in range(3):
                a[n, i, i] += shift * ease
                a[n, 3 + i, 3 + i] += shift * twist
        for k in range(d.shape[0]):
            d[k, k] += shift * ease
        if factor(a) and eliminate(a, b, d, y, corner):
            copy(moves, on_boxes)
            copy(slides, on_slides)
            solve_bordered(a, b, y, corner, moves, slides)
            return shift
        copy(a, band)
        copy(d, square)
        shift = max(10.0 * shift, FIRST_SHIFT)
    return -1.0


@njit(cache=True, error_model="numpy")
def _longest(bodies, joints, nodes, step, reach):
    """Part of a step that may be taken, and the length of the whole step [rad, parts of a box]. `reach` [mm]
    bounds the motion of boxes and slides in scenes with contacts."""
    moves, slides = step
    turned = moved = far = 0.0
    for j in range(joints.size):
        na, nb = -1 if joints[j].a < 0 else bodies[joints[j].a].node, bodies[joints[j].b].node
        for i in range(3, 6):
            one = moves[6 * na + i] if na >= 0 else 0.0
            two = moves[6 * nb + i] if nb >= 0 else 0.0
            turned = max(turned, abs(two - one))
    for n in range(nodes.size):
        half = bodies[nodes[n]].half
        size = half[0] + half[1]
        for i in range(3):
            far = max(far, abs(moves[6 * n + i]), size * abs(moves[6 * n + 3 + i]))
            moved = max(moved, abs(moves[6 * n + i]) / size, abs(moves[6 * n + 3 + i]))
    for k in range(slides.size):
        far, moved = max(far, abs(slides[k])), max(moved, abs(slides[k]))
    return min(1.0, MOST_TURN / max(turned, 1e-300), reach / max(far, 1e-300)), moved


@njit(cache=True, error_model="numpy")
def _along(rest, step):
    """Work of the residual forces along a step [N mm]."""
    total = 0.0
    for k in range(2):
        for i in range(rest[k].size):
            total += rest[k][i] * step[k][i]
    return total


@njit(cache=True, error_model="numpy")
def equilibrium(tables, size, level, load, least, reach, place, lists):
    """Moves a place (x, r, slides s) to balance at a part of weights and loads; springs press fully.

    size: (border, height of the band); lists: scratch for touching pairs, their results, and near pairs.
    `load` [N] scales residuals. `least` is the shift of the diagonal, relative to its largest entry, that is
    always added (for sheets that only contacts hold). `reach` [mm] is the longest step. Returns (True if
    balance was found, iterations, body with the largest residual, that residual relative to the load).
    """
    bodies, joints, loads, nodes, points = (
        tables.bodies,
        tables.joints,
        tables.loads,
        tables.nodes,
        tables.points,
    )
    border, height = size
    x, r, s = place
    touched, _results, _near = lists
    many, unknowns = nodes.size, 6 * nodes.size
    a, links, band = np.zeros((many, 6, height)), np.zeros((many, 6, height)), np.zeros((many, 6, height))
    b, d = np.zeros((border, unknowns)), np.zeros((border, border))
    matrix, plain = (a, b, d, np.zeros(b.shape), np.zeros(d.shape)), (band, np.zeros(d.shape))
    rest, step = (np.zeros(unknowns), np.zeros(border)), (np.zeros(unknowns), np.zeros(border))
    before = x0, r0, s0 = x.copy(), r.copy(), s.copy()
    still = np.zeros(x.shape)
    blank = (still, np.zeros((x.shape[0], 6)))
    gaps, room = np.zeros((joints.size, 3)), np.zeros(unknowns)
    link(bodies, joints, x.shape[0] - 1, links)
    follow(tables, links, 0.0, step, before, place, room, gaps)
    hard = 0.0
    for j in range(joints.size):
        hard = max(hard, joints[j].k[0], joints[j].k[1], joints[j].k[2])
    # forces due to round-off of the positions
    far = 0.0
    for k in range(x.shape[0]):
        for i in range(3):
            far = max(far, abs(x[k, i]))
    noise = 16.0 * EPSILON * hard * far
    worst, at, count = _residual(tables, level, place, lists, blank, rest)
    best, since, shift = worst, 0, least
    for iteration in range(BALANCE_MOST):
        if worst <= REST * load:
            return True, iteration, at, worst / load
        if not worst < NO_WAY_BACK:
            return False, iteration, at, worst / load
        sheets_into(bodies, joints, points, loads, level, gaps, x, r, a)
        if tables.corners.size > 0:
            corners_into(tables, Motion(x, r, still, still), blank[1], a)
        rollers_into(bodies, b, d)
        contacts_into(tables, touched, count, Motion(x, r, still, still), a, b, d)
        shift = _newton(matrix, plain, shift, load, rest, step)
        if shift < 0.0:
            return False, iteration, at, worst / load
        part, moved = _longest(bodies, joints, nodes, step, reach)
        if not moved < NO_WAY_BACK:
            return False, iteration, at, worst / load
        copy(x0, x)
        copy(r0, r)
        copy(s0, s)
        falls = _along(rest, step)
        for _ in range(BALANCE_TRIES):
            follow(tables, links, part, step, before, place, room, gaps)
            worst, at, count = _residual(tables, level, place, lists, blank, rest)
            still_falls = _along(rest, step)
            if part * moved < 1e-6 or still_falls > -0.5 * falls:
                break
            part *= min(0.7, max(0.1, falls / (falls - still_falls)))
        if shift <= least and part * moved <= BALANCE_STILL and worst <= noise:
            return True, iteration + 1, at, worst / load
        shift *= 0.1
        shift = max(shift if shift >= LEAST_SHIFT else 0.0, least)
        if worst < 0.5 * best:
            best, since = worst, 0
        else:
            since += 1
            if since >= 3 and worst <= REST_AT_LEAST * load:
                return True, iteration + 1, at, worst / load
    return worst <= REST_AT_LEAST * load, BALANCE_MOST, at, worst / load


@njit(cache=True, error_model="numpy")
def stands(tables, level, least, slow, place, lists, matrix):
    """True if a balance is stable: its stiffness matrix is positive definite after `slow`^2 [1/ms^2] times
    the inertia, and the round-off error of its entries, are added; `least` as in `equilibrium`.

    That stiffness is left in `matrix`, which is zero before: its band, its border and its corner.
    """
    bodies, joints, loads, nodes, points = (
        tables.bodies,
        tables.joints,
        tables.loads,
        tables.nodes,
        tables.points,
    )
    x, r, _slides = place
    touched, _results, _near = lists
    a, b, d = matrix
    many, size = nodes.size, 6 * nodes.size
    still, f = np.zeros(x.shape), np.zeros((x.shape[0], 6))
    gaps = np.zeros((joints.size, 3))
    for j in range(joints.size):
        one = joints[j].a if joints[j].a >= 0 else x.shape[0] - 1
        gap = opening(joints[j], one, x, r)
        gaps[j, 0], gaps[j, 1], gaps[j, 2] = gap
    rest = (np.zeros(size), np.zeros(d.shape[0]))
    _, _, count = _residual(tables, level, place, lists, (still, f), rest)
    sheets_into(bodies, joints, points, loads, level, gaps, x, r, a)
    if tables.corners.size > 0:
        corners_into(tables, Motion(x, r, still, still), f, a)
    rollers_into(bodies, b, d)
    contacts_into(tables, touched, count, Motion(x, r, still, still), a, b, d)
    ease = twist = 0.0
    for n in range(many):
        for i in range(3):
            ease, twist = max(ease, abs(a[n, i, i])), max(twist, abs(a[n, 3 + i, 3 + i]))
    for n in range(many):
        body = bodies[nodes[n]]
        # least moment of inertia of a box: stability with it implies stability with the others
        turning = min(body.inertia[0], body.inertia[1], body.inertia[2])
        for i in range(3):
            a[n, i, i] += slow * slow * body.mass + least * ease + NOISE * abs(a[n, i, i])
            a[n, 3 + i, 3 + i] += slow * slow * turning + least * twist + NOISE * abs(a[n, 3 + i, 3 + i])
    for k in range(d.shape[0]):
        d[k, k] += least * ease + NOISE * abs(d[k, k])
    band, y, corner = np.zeros(a.shape), np.zeros(b.shape), np.zeros(d.shape)
    copy(band, a)
    return factor(band) and eliminate(band, b, d, y, corner)
