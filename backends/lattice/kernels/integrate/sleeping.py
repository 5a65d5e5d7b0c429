"""How fast sheets on each other are, what a step may leave in those that rest, and what those that sleep miss
(see integrate.sleep)."""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import OWN_REACH
from mdlgen.mechanics.bounds import fastest_place
from mdlgen.program.kernel import BORROWS, njit

# Where sheets lie on each other and move at less than a part 1/SLOW of the greatest speed so far, steps are
# solved to less, down to a part STILL: the rule damps nothing, so what a step leaves in what rests rings on.
SLOW, STILL = 10.0, 0.005


@njit(cache=True, error_model="numpy", **BORROWS)
def note_speeds(boxes, label, u, asleep):
    """Speeds of sheets are those of their fastest places at the velocities u (nodes, 6)."""
    now, speeds = asleep.now, asleep.speeds
    now[:] = 0.0
    for n in range(label.size):
        rate, spin = (u[n, 0], u[n, 1], u[n, 2]), (u[n, 3], u[n, 4], u[n, 5])
        now[label[n]] = max(now[label[n]], fastest_place(boxes[n, OWN_REACH], rate, spin))
    for sheet in range(now.size):
        speeds[sheet] = max(speeds[sheet], now[sheet])


@njit(cache=True, error_model="numpy", **BORROWS)
def part_of(speed, fastest):
    """The part of what a step may leave, for what moves at a speed where the greatest so far is `fastest`."""
    return min(max(STILL, SLOW * speed / fastest), 1.0)


@njit(cache=True, error_model="numpy", **BORROWS)
def be_strict(asleep, fastest, part):
    """Has a step leave less in sheets of islands that are slower than the scene, of which it may leave that
    part."""
    islands, strict, now = asleep.islands, asleep.strict, asleep.now
    for sheet in range(islands.size):
        strict[sheet] = 0.0
    for sheet in range(islands.size):
        strict[islands[sheet]] = max(strict[islands[sheet]], now[sheet])
    for sheet in range(islands.size):
        strict[sheet] = strict[islands[sheet]]
    for sheet in range(islands.size):
        strict[sheet] = max(1.0, part / part_of(strict[sheet], fastest))


@njit(cache=True, error_model="numpy", **BORROWS)
def disturbed(bodies, forces, asleep, dt):
    """A box that sleeps and would miss more than it may, with the forces (bodies, 6) for dt; -1: none."""
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
    """Adds up what boxes that sleep miss of a step of dt."""
    for k in range(asleep.bodies.size):
        for i in range(6):
            asleep.missed[k, i] += dt * forces[asleep.bodies[k], i]
