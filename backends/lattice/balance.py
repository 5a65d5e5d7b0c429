"""Static equilibrium of sheets under weight and loads: Newton's method on forces at rest.

The matrix is the exact stiffness of every joint, by central differences of its force, made symmetric. Where
it is not positive (a sheet about to buckle, or far from balance) a multiple of its diagonal is added.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from backends.lattice.band import factor, solve
from backends.lattice.forces import joint_forces, other_forces
from mdlgen.mechanics.vector import exp_rotation, mat, matmul

# Perturbations of the differences [mm], [rad]: a joint bends 1e5 times easier than it stretches, so they are
# central, and large enough for round-off.
_MOVE, _TURN = 1e-4, 1e-4
MOST_ROUNDS = 60
MOST_TURN = 0.3  # rad in a round
REST = 1e-9  # residual that ends the rounds, relative to the load
_STALLED = 1e-6  # residual that is good enough where it falls no more


@njit(cache=True, error_model="numpy")
def _moved(x, r, b, axis, amount):
    """Moves (axis 0-2) or turns (3-5) one body."""
    if axis < 3:
        x[b, axis] += amount
        return
    turn = (
        amount if axis == 3 else 0.0,
        amount if axis == 4 else 0.0,
        amount if axis == 5 else 0.0,
    )
    m = matmul(exp_rotation(turn), mat(r, b))
    for i in range(9):
        r[b, i] = m[i]


@njit(cache=True, error_model="numpy")
def stiffness(bodies, joints, loads, level, x, r, u, w, f, a):
    """Sets the band to minus the derivative of all forces."""
    a[:] = 0.0
    last = x.shape[0] - 1
    kept_x, kept_r = np.empty(3), np.empty(9)
    forces = np.empty((2, 2, 6))
    for j in range(joints.size):
        one, two = joints[j].a, joints[j].b
        if one < 0:
            one = last
        for which in range(2):
            b = one if which == 0 else two
            node = bodies[b].node
            if node < 0:
                continue
            kept_x[:], kept_r[:] = x[b], r[b]
            for c in range(6):
                step = _MOVE if c < 3 else _TURN
                for side in range(2):
                    _moved(x, r, b, c, step if side == 0 else -step)
                    f[one] = 0.0
                    f[two] = 0.0
                    joint_forces(joints[j : j + 1], x, r, u, w, f)
                    forces[side, 0], forces[side, 1] = f[one], f[two]
                    x[b], r[b] = kept_x, kept_r
                for end in range(2):
                    other = bodies[one if end == 0 else two].node
                    if other < 0:
                        continue
                    for i in range(6):
                        v = -(forces[0, end, i] - forces[1, end, i]) / (2.0 * step)
                        if other == node:
                            a[node, c, i] += 0.5 * v
                            a[node, i, c] += 0.5 * v
                        elif other > node:
                            a[node, c, 6 * (other - node) + i] += 0.5 * v
                        else:
                            a[other, i, 6 * (node - other) + c] += 0.5 * v
    for k in range(loads.size):  # a dead load turns its body the less the further it has turned
        b = loads[k].body
        node = bodies[b].node
        if node < 0:
            continue
        kept_r[:] = r[b]
        for c in range(3, 6):
            for side in range(2):
                _moved(x, r, b, c, _TURN if side == 0 else -_TURN)
                f[b] = 0.0
                other_forces(bodies, loads[k : k + 1], np.zeros(3), level, r, u, w, f)
                forces[side, 0] = f[b]
                r[b] = kept_r
            for i in range(6):
                v = -(forces[0, 0, i] - forces[1, 0, i]) / (2.0 * _TURN)
                a[node, c, i] += 0.5 * v
                a[node, i, c] += 0.5 * v


@njit(cache=True, error_model="numpy")
def _residual(bodies, joints, loads, gravity, nodes, level, x, r, u, w, f, res):
    """Forces on the free boxes into res; returns the largest, with torques over half a box."""
    f[:] = 0.0
    joint_forces(joints, x, r, u, w, f)
    other_forces(bodies, loads, gravity, level, r, u, w, f)
    worst = 0.0
    for n in range(nodes.size):
        b = nodes[n]
        size = bodies[b].half[0] + bodies[b].half[1]
        for i in range(6):
            res[6 * n + i] = f[b, i]
            worst = max(worst, abs(f[b, i]) if i < 3 else abs(f[b, i]) / size)
    return worst


@njit(cache=True, error_model="numpy")
def equilibrium(bodies, joints, loads, gravity, nodes, level, load, x, r, u, w, f, a, res):
    """Moves x and r to balance at a part of the load; `load` [N] is what residuals are measured by.

    Returns (residual relative to the load, rounds); the residual is above _STALLED where it was not found.
    """
    worst = _residual(bodies, joints, loads, gravity, nodes, level, x, r, u, w, f, res)
    best, since, shift = worst, 0, 0.0
    for rounds in range(MOST_ROUNDS):
        if worst <= REST * load:
            return worst / load, rounds
        stiffness(bodies, joints, loads, level, x, r, u, w, f, a)
        plain = a.copy()
        while True:
            if shift > 0.0:
                for n in range(nodes.size):
                    for i in range(6):
                        a[n, i, i] += shift * abs(a[n, i, i])
            if factor(a):
                break
            a[:] = plain
            shift = max(10.0 * shift, 1e-8)
            if shift > 1e3:
                return 1e30, rounds
        worst = _residual(bodies, joints, loads, gravity, nodes, level, x, r, u, w, f, res)
        solve(a, res)
        most = 0.0
        for n in range(nodes.size):
            for i in range(3, 6):
                most = max(most, abs(res[6 * n + i]))
        if not most < 1e30:
            return 1e30, rounds
        part = min(1.0, MOST_TURN / most) if most > 0.0 else 1.0
        for n in range(nodes.size):
            b, k = nodes[n], 6 * n
            turn = (part * res[k + 3], part * res[k + 4], part * res[k + 5])
            m = matmul(exp_rotation(turn), mat(r, b))
            for i in range(9):
                r[b, i] = m[i]
            for i in range(3):
                x[b, i] += part * res[k + i]
        worst = _residual(bodies, joints, loads, gravity, nodes, level, x, r, u, w, f, res)
        shift *= 0.1
        if shift < 1e-12:
            shift = 0.0
        if worst < 0.5 * best:
            best, since = worst, 0
        else:
            since += 1
            if since >= 2 and worst <= _STALLED * load:
                break
    return worst / load, MOST_ROUNDS
