"""Speeds of sheets on each other, and impulses that sleeping sheets miss (see integrate.sleep)."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import OWN_REACH
from mdlgen.mechanics.bounds import fastest_place
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def note_speeds(boxes, label, u, asleep):
    """Updates the speeds of sheets: those of their fastest places at the velocities u (nodes, 6)."""
    for n in range(label.size):
        rate, spin = (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5])
        fast = fastest_place(boxes[n, OWN_REACH], rate, spin)
        asleep.speeds[label[n]] = max(asleep.speeds[label[n]], fast)


@njit(cache=True, error_model="numpy", **BORROWS)
def disturbed(bodies, forces, asleep, dt):
    """Sleeping box whose missed impulses would exceed the limit with the forces (bodies, 6) for dt; -1:
    none."""
    for k in range(asleep.bodies.size):
        b = asleep.bodies[k]
        inertia = min(bodies[b].inertia[0], bodies[b].inertia[1], bodies[b].inertia[2])
        size = bodies[b].half[0] + bodies[b].half[1]
        for i in range(6):
            missed = abs(asleep.missed[k, i] + dt * forces[b, i])
            moves = missed / bodies[b].mass if i < 3 else size * missed / inertia
            if not moves <= asleep.may[0]:
                return b
    return -1


@njit(cache=True, error_model="numpy", **BORROWS)
def miss(forces, asleep, dt):
    """Adds the impulses on sleeping boxes in a step of dt."""
    for k in range(asleep.bodies.size):
        for i in range(6):
            asleep.missed[k, i] += dt * forces[asleep.bodies[k], i]
