"""The jacobian of the forces of a System, by difference quotients of its elements: blocks of bushings,
corners, pairs, slides, clutches, loads, and contact patches."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.exudyn_local.bristles import held_element, release, weigh_patches
from mdlgen.backends.exudyn_local.forces import (
    axle_force,
    bush_forces,
    corner_at,
    load_forces,
    pair_forces,
    slide_force,
)
from mdlgen.backends.exudyn_local.place import place_all, place_owner
from mdlgen.mechanics.driven import SENSE
from mdlgen.mechanics.over_time import set_to
from mdlgen.program.kernel import njit

# Perturbations of the difference quotients: positions and Euler parameters, velocities [SI]. A static run
# takes central quotients: a joint bends 1e5 times easier than it stretches, and a one-sided quotient of the
# stretching part would hide the bending; in a transient run the mass dominates.
_E_POSITION, _E_VELOCITY = 1e-9, 1e-6
_E_CENTRAL = 1e-7


@njit(cache=True, error_model="numpy")
def _element(tables, block_start, element, at, level, work):
    """Generalised forces of one element, added to those of `work`. Returns False where a pair does not
    touch."""
    bodies, pairs = tables.bodies, tables.pairs
    motion, out, f = work.motion, work.out, work.forces
    q, v = at.q, at.v
    blocks = block_start.size - 1
    if element < blocks:
        for i in range(block_start[element], block_start[element + 1]):
            bush_forces(tables, tables.bushings[i], q, motion, f)
        return True
    element -= blocks
    if element < tables.corners.size:
        corner_at(tables, tables.corners[element], q, work)
        return True
    element -= tables.corners.size
    if element < pairs.size:
        if tables.stick.patch_of[element] >= 0:
            return held_element(tables, element, at, motion, f)
        return pair_forces(tables, pairs[element], q, motion, f, out)
    element -= pairs.size
    for body in range(bodies.size - 1):
        if bodies[body].slide >= 0:
            if element == 0:
                slide_force(tables, body, at, f, level)
                return True
            element -= 1
    for body in range(bodies.size - 1):
        if bodies[body].clutch[SENSE] != 0.0:
            if element == 0:
                f[bodies[body].spin] += axle_force(tables, body, at)
                return True
            element -= 1
    if element < tables.loads.size:
        load_forces(bodies, tables.loads[element], q, motion.r, f, level)
        return True
    release(tables, element - tables.loads.size, v, f)
    return True


@njit(cache=True, error_model="numpy")
def jacobian(tables, elements, at, level, by, central, owner, work, data):
    """data = -(by[0] dF/dq + by[1] dF/dv) in the slots of the pattern, by difference quotients.

    One quotient per coordinate yields both parts: q and v are perturbed together in the ratio of `by`.
    """
    block_start, dofs, dof_start, slots, slot_start = elements
    bodies, motion, f, (by_q, by_v) = tables.bodies, work.motion, work.forces, by
    q, v = at.q, at.v
    set_to(tables.changes, tables.loads, tables.gravity, at.t, at.t)
    place_all(bodies, at, motion)
    if tables.stick.pairs.size > 0:
        weigh_patches(tables, at, motion)
    data[:] = 0.0
    step = 1e30
    if by_q != 0.0:
        step = (_E_CENTRAL if central else _E_POSITION) / abs(by_q)
    if by_v != 0.0:
        step = min(step, _E_VELOCITY / abs(by_v))
    base = np.empty(32)
    for element in range(dof_start.size - 1):
        begin, end = dof_start[element], dof_start[element + 1]
        if begin == end:
            continue
        count = end - begin
        for i in range(begin, end):
            f[dofs[i]] = 0.0
        if not _element(tables, block_start, element, at, level, work):
            continue
        for i in range(count):
            base[i] = f[dofs[begin + i]]
        slot = slot_start[element]
        width = 2.0 * step if central else step
        for j in range(count):
            dof = dofs[begin + j]
            body = owner[dof]
            kept_q, kept_v = q[dof], v[dof]
            if central:
                q[dof] -= step * by_q
                v[dof] -= step * by_v
                place_owner(bodies, body, at, motion)
                for i in range(begin, end):
                    f[dofs[i]] = 0.0
                _element(tables, block_start, element, at, level, work)
                for i in range(count):
                    base[i] = f[dofs[begin + i]]
                q[dof], v[dof] = kept_q, kept_v
            q[dof] += step * by_q
            v[dof] += step * by_v
            place_owner(bodies, body, at, motion)
            for i in range(begin, end):
                f[dofs[i]] = 0.0
            _element(tables, block_start, element, at, level, work)
            q[dof], v[dof] = kept_q, kept_v
            place_owner(bodies, body, at, motion)
            for i in range(count):
                data[slots[slot + i * count + j]] -= (f[dofs[begin + i]] - base[i]) / width
