"""Bristles of contact patches: the input of pairs in an iteration, and the end of a step.

A step begins with the fields of stretch that the last step left (mechanics.bristle). Iterations do not change
them. The normal force of a patch, and the speed through it, are those of the iteration before.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.state import DISSIPATED, ELASTIC
from mdlgen.mechanics.bristle import (
    CURVED,
    DEEPEST,
    N,
    end,
    gather,
    lay,
    middle_of,
    release,
    turn_of,
    weigh,
    weighed,
)
from mdlgen.mechanics.pair import rolls
from mdlgen.mechanics.point import DEPTH
from mdlgen.mechanics.vector import dot, three
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def lay_bristles(tables, motion, h):
    """Sets the input of all pairs that a bristle holds, for a step of 2 h [ms]."""
    pairs, bristles, held = tables.pairs, tables.bristles, tables.held
    for k in range(held.size):
        pair = pairs[held[k].pair]
        lay(held[k], bristles[held[k].bristle], motion, pair.a, pair.b, h)


@njit(cache=True, error_model="numpy", **BORROWS)
def _cleared(bristles):
    for k in range(bristles.size):
        bristles[k].sums[:] = 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def weigh_patches(tables, mid, count):
    """Updates the normal forces of all patches, and the speeds through them; `count`: how many pairs
    touch."""
    bodies, bristles, held = tables.bodies, tables.bristles, tables.held
    _cleared(bristles)
    for k in range(count):
        pair = tables.pairs[mid.touched[k]]
        if pair.held > 0:
            bristle, out = bristles[held[pair.held - 1].bristle], mid.results[mid.rows[k]]
            own_axis = three(bodies[pair.a].axis)
            roller = pair.a if dot(own_axis, own_axis) > 0.0 else pair.b
            axis, curved = rolls(bodies, pair, tables.shapes, mid.motion)
            weigh(bristle, out, mid.motion, pair.a, pair.b, roller, axis, curved)
    for k in range(bristles.size):
        weighed(bristles[k])


@njit(cache=True, error_model="numpy", **BORROWS)
def end_patches(work, count, h, energies):
    """Ends a step of 2 h: changes all fields; `count`: how many pairs touch in its middle. The work of
    friction counts as dissipated, and the energy that bristles store is subtracted: energies (groups, 4)."""
    tables, mid, groups = work.tables, work.mid, work.islands.group_of_row
    bodies, pairs, bristles, held = tables.bodies, tables.pairs, tables.bristles, tables.held
    _cleared(bristles)
    for k in range(count):
        pair = pairs[mid.touched[k]]
        if pair.held <= 0:
            continue
        own, out = held[pair.held - 1], mid.results[mid.rows[k]]
        bristle = bristles[own.bristle]
        gather(bristle, own, out, mid.motion, h)
        _, curved = rolls(bodies, pair, tables.shapes, mid.motion)
        bristle.sums[DEEPEST] = max(bristle.sums[DEEPEST], out[DEPTH])
        bristle.sums[CURVED] = curved
    for k in range(bristles.size):
        if not middle_of(bristles[k]) and bristles[k].energy > 0.0:
            energies[groups[bristles[k].row], DISSIPATED] += release(bristles[k])
    for k in range(count):
        pair = pairs[mid.touched[k]]
        if pair.held > 0:
            own = held[pair.held - 1]
            turn_of(bristles[own.bristle], own, mid.results[mid.rows[k]], mid.motion, h)
    for k in range(bristles.size):
        if bristles[k].sums[N] > 0.0:
            energies[groups[bristles[k].row], DISSIPATED] -= end(bristles[k])
        else:
            bristles[k].force = 0.0


@njit(cache=True, error_model="numpy", **BORROWS)
def patch_energies(tables, groups, energies):
    """Adds the energy of all bristles to energies (groups, 3) [N mm]; `groups`: of each contact."""
    for k in range(tables.bristles.size):
        energies[groups[tables.bristles[k].row], ELASTIC] += tables.bristles[k].energy
