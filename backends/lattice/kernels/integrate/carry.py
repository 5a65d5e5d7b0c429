"""Carries a state from the middle to the end of a step (see integrate.step)."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.forces import turn_roller
from mdlgen.backends.lattice.kernels.image import reflect
from mdlgen.backends.lattice.kernels.state import OWN_INERTIA
from mdlgen.mechanics.arm import AXIAL, moved
from mdlgen.mechanics.axle import AXLE, acting, behind_at_end
from mdlgen.mechanics.driven import SENSE, prescribed
from mdlgen.mechanics.gate import GATE, shift_gate, went
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import back, exp_rotation, mat, matmul, rotate, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def spun(axles, body, s, u, v, t, dt):
    """Spin of a roller at the end of a step from t: 2 u - v, from the spins u in its middle and v at its
    beginning. It is corrected for a clutch, a motor or a bearing that is stiff for the step. s: see `acting`.

    By the midpoint rule alone the spin would oscillate about that of the shaft. So the change of the spin
    relative to the shaft is reduced. The stiffer the clutch is relative to the roller's inertia, the more.
    """
    h = 0.5 * dt
    does = acting(axles, body, s, u, t + h, h)
    stiff = h * does.damps / body.press[AXIAL]
    if stiff == 0.0:
        return 2.0 * u - v
    added = u - does.pulls * prescribed(body, t + h) - v + does.pulls * prescribed(body, t)
    return 2.0 * u - v - added * stiff * stiff / (1.0 + stiff * stiff)


@njit(cache=True, error_model="numpy", **BORROWS)
def carry(tables, state, t, dt):
    """Carries a state from the middle to the end of a step, of dt [ms] from t."""
    bodies, nodes, images, axles = tables.bodies, tables.nodes, tables.images, tables.shapes.axles
    x, r, v, l, s, vb, u, ub = state
    for n in range(nodes.size):
        b = nodes[n]
        m = matmul(exp_rotation((0.5 * dt * u[n, 3], 0.5 * dt * u[n, 4], 0.5 * dt * u[n, 5])), mat(r, b))
        spin = back(m, (u[n, 3], u[n, 4], u[n, 5]))
        j = three_from(tables.boxes[n], OWN_INERTIA)
        p = rotate(m, (j[0] * spin[0], j[1] * spin[1], j[2] * spin[2]))
        m = matmul(exp_rotation((dt * u[n, 3], dt * u[n, 4], dt * u[n, 5])), mat(r, b))
        for i in range(9):
            r[b, i] = m[i]
        for i in range(3):
            x[b, i] += dt * u[n, i]
            v[n, i] = 2.0 * u[n, i] - v[n, i]
            l[n, i] = 2.0 * p[i] - l[n, i]
    reflect(images, x, r)
    for k in tables.moving:
        if bodies[k].swings >= GATE:
            shift_gate(bodies[k], k, went(bodies[k], t, t + dt), x, r, x, r)
            continue
        slide, spin_at = bodies[k].slide, bodies[k].spin
        if bodies[k].rims > 0 or bodies[k].carries != 0:
            turning = ub[slide] if bodies[k].swings == 2 else 0.0
            if spin_at >= 0:
                turning = bodies[k].ratio * ub[spin_at]
            turn_roller(bodies[k], k, dt, t + dt, turning, r, r)
        if slide >= 0:
            s[slide] += dt * ub[slide]
            at = moved(bodies[k], vec(x, k), dt * ub[slide])
            for i in range(3):
                x[k, i] = at[i]
            vb[slide] = 2.0 * ub[slide] - vb[slide]
        if spin_at >= 0 and bodies[k].coupled != FOLLOWER:
            turns = spun(axles, bodies[k], s[spin_at], ub[spin_at], vb[spin_at], t, dt)
            vb[spin_at] = turns
            if bodies[k].clutch[SENSE] == AXLE:
                s[spin_at] = behind_at_end(axles, bodies[k], s[spin_at], ub[spin_at], turns, t, dt)
