"""Velocities at the end of a step where joints have a damping time of their own.

The midpoint rule carries the velocity v0 to 2 u - v0. If damping stops a motion in a fraction of a step, u is
nearly the final velocity. But v alternates about u from step to step, and hardly decays. Positions and
contacts depend on u alone and are right. The reported velocities, at the end of the step, would be wrong.

The deviation of v0 from a straight course is w = u - v0 - (u - u') dt/(dt + dt'), with u' and dt' of the step
before. Y w is subtracted from v, where Y = X/(1 + X), X = h M^-1 C, and C is the damping of these joints. For
a motion that the step resolves, w is of second order in the step and Y of first, so the rule stays of second
order. For other motions v approaches the straight course. The correction is stable at any step: for
oscillators of any frequency and damping time the spectral radius is below 1. The same joints would dissipate
the removed energy within the step. C does not act on rigid motions, so linear and angular momentum of a sheet
are conserved.
"""

from __future__ import annotations

import numpy as np

from mdlgen.backends.lattice.kernels.integrate.momentum import keep
from mdlgen.backends.lattice.kernels.integrate.tangent import in_box_axes, joints_into, masses
from mdlgen.backends.lattice.kernels.linear.band import empty as no_band
from mdlgen.backends.lattice.kernels.linear.band import factor, solve_single
from mdlgen.backends.lattice.kernels.linear.dense import copy
from mdlgen.backends.lattice.kernels.state import DISSIPATED, Damped
from mdlgen.backends.lattice.kernels.tuning import DAMPERS_LAST
from mdlgen.mechanics.vector import back, mat, rotate
from mdlgen.program.kernel import BORROWS, njit

MADE_FOR, AGE = 0, 1  # columns of Damped.made
# Rows of Damped.vectors: momentum of the deviation from a straight course, in box axes, and the part of it
# that remains after the dampers.
PUSH, LEFT = 0, 1


def empty(system) -> Damped:
    """The Damped of a System: its joints with a damping time, without their springs, and scratch arrays."""
    joints = system.joints[system.joints["time"] > 0.0].copy()
    joints["k"] = 0.0
    joints["first"] = -1
    nodes, bodies = (len(system.nodes), len(system.bodies)) if len(joints) else (0, 0)
    band = no_band(nodes, system.reach if nodes else 0)
    return Damped(
        joints=joints,
        band=band,
        single=band.astype(np.float32),
        short=np.zeros(6 * nodes, np.float32),
        made=np.zeros(2),
        vectors=np.zeros((2, 6 * nodes)),
        place=np.zeros((bodies, 3)),
        off=np.zeros((nodes, 6)),
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def _momentum(m, j, w):
    """Angular momentum of a box with axes m and inertia j at an angular velocity."""
    own = back(m, w)
    return rotate(m, (j[0] * own[0], j[1] * own[1], j[2] * own[2]))


@njit(cache=True, error_model="numpy")
def _turned(nodes, r, x, inward):
    """Turns a vector of the nodes into box axes, or back."""
    for n in range(nodes.size):
        m = mat(r, nodes[n])
        for k in range(6 * n, 6 * n + 6, 3):
            part = (x[k], x[k + 1], x[k + 2])
            part = back(m, part) if inward else rotate(m, part)
            x[k], x[k + 1], x[k + 2] = part


@njit(cache=True, error_model="numpy", **BORROWS)
def _leave(work):
    """Solves for the momentum of all sheets that the dampers leave: row LEFT of vectors, from row PUSH."""
    spans, damped = work.matrix.couplings.colouring.spans, work.damped
    copy(damped.vectors[LEFT], damped.vectors[PUSH])
    for sheet in range(spans.shape[0]):
        low, high = spans[sheet]
        first, end = 6 * low, 6 * high
        solve_single(damped.single[low:high], damped.vectors[LEFT, first:end], damped.short[first:end])


@njit(cache=True, error_model="numpy")
def overshoot(work, before, ahead, dt):
    """Sets Damped.off, the velocities to subtract at the end of a step. The step is solved, but its state is
    still that at its beginning. `before` (nodes, 6): velocities in the middle of the step before; `ahead`:
    dt/(dt + dt')."""
    bodies, nodes = work.tables.bodies, work.tables.nodes
    joints, band, made, off = work.damped.joints, work.damped.band, work.damped.made, work.damped.off
    push, left, end = work.damped.vectors[PUSH], work.damped.vectors[LEFT], work.damped.place
    x, v, l, u = work.state.x, work.state.v, work.state.l, work.state.u
    xm, rm = work.mid.motion.x, work.mid.motion.r
    if made[MADE_FOR] != dt or made[AGE] >= DAMPERS_LAST:
        masses(bodies, nodes, rm, band)
        joints_into(work.tables, joints, 0.5 * dt, 0.0, xm, rm, band, work.matrix.slots)
        border = np.zeros((0, 6 * nodes.size))
        in_box_axes(nodes, rm, band, border, work.matrix.offsets, work.matrix.slots)
        made[MADE_FOR], made[AGE] = dt, 0.0
        if not factor(band):  # never: masses are positive, dampers not negative
            made[MADE_FOR] = 0.0
            off[:] = 0.0
            return
        copy(work.damped.single, band)
    made[AGE] += 1.0
    for n in range(nodes.size):
        b = nodes[n]
        m, j, mass = mat(rm, b), bodies[b].inertia, bodies[b].mass
        spin = _momentum(m, j, (u[n, 3], u[n, 4], u[n, 5]))
        course = _momentum(m, j, (u[n, 3] - before[n, 3], u[n, 4] - before[n, 4], u[n, 5] - before[n, 5]))
        for i in range(3):
            push[6 * n + i] = mass * (u[n, i] - v[n, i] - ahead * (u[n, i] - before[n, i]))
            push[6 * n + 3 + i] = spin[i] - l[n, i] - ahead * course[i]
    _turned(nodes, rm, push, True)
    _leave(work)
    for n in range(nodes.size):
        j, mass = bodies[nodes[n]].inertia, bodies[nodes[n]].mass
        for i in range(3):
            push[6 * n + i] = push[6 * n + i] / mass - left[6 * n + i]
            push[6 * n + 3 + i] = push[6 * n + 3 + i] / j[i] - left[6 * n + 3 + i]
    _turned(nodes, rm, push, False)
    # remove rigid motions, as `push` must not change momenta. It may contain some: the factor is that of an
    # earlier shape of the sheet, and places at the end of the step differ from those in its middle
    work.free.residual[:] = 0.0
    copy(end, xm)
    for n in range(nodes.size):
        for i in range(3):
            end[nodes[n], i] = x[nodes[n], i] + dt * u[n, i]
    keep(work.tables, work.mid.touched, 0, work.film, work.free, (end, rm), push)
    for n in range(nodes.size):
        for i in range(6):
            off[n, i] = push[6 * n + i]


@njit(cache=True, error_model="numpy", **BORROWS)
def take_off(work, off, energies):
    """Subtracts the velocities `off` from those at the end of a step, and adds their energy to the dissipated
    one: energies (groups, 4)."""
    bodies, nodes, islands, label = work.tables.bodies, work.tables.nodes, work.islands, work.free.label
    rm, r, v, l = work.mid.motion.r, work.state.r, work.state.v, work.state.l
    for n in range(nodes.size):
        b, gone = nodes[n], 0.0
        mass, j = bodies[b].mass, bodies[b].inertia
        less = _momentum(mat(rm, b), j, (off[n, 3], off[n, 4], off[n, 5]))
        m = mat(r, b)
        for sign in (0.5, -0.5):
            own = back(m, (l[n, 0], l[n, 1], l[n, 2]))
            turning = own[0] * own[0] / j[0] + own[1] * own[1] / j[1] + own[2] * own[2] / j[2]
            moving = v[n, 0] * v[n, 0] + v[n, 1] * v[n, 1] + v[n, 2] * v[n, 2]
            gone += sign * (mass * moving + turning)
            if sign > 0.0:
                for i in range(3):
                    v[n, i] -= off[n, i]
                    l[n, i] -= less[i]
        energies[islands.group[label[n]], DISSIPATED] += gone
