"""Conservation of the momentum of free sheets in each Newton iteration.

The forces inside a sheet have zero sum and zero moment in any state. So the linear and the angular momentum
of a change of velocities must equal those of the residual. A factor of an earlier state violates that, since
boxes have turned in the meantime. The difference is subtracted as a rigid motion of the sheet. Sheets that
touch only each other conserve their momentum together. In a halved scene, the force between a half of a sheet
and its mirror image has no component along the plane, and no moment about its normal. So these components
of the momentum are conserved.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.linear.colouring import BEGIN, END
from mdlgen.backends.lattice.kernels.state import OWN_INERTIA, OWN_MASS, Free
from mdlgen.mechanics.vector import add, back, cross, dot, mat, rotate, scale, sub, three, three_from, vec
from mdlgen.program.kernel import njit


def empty(system) -> Free:
    """Record of the free sheets of a System."""
    bodies, joints, nodes = system.bodies, system.joints, system.nodes
    label = system.sheets
    ends = [np.where(joints[end] >= 0, bodies["node"][joints[end]], -1) for end in "ab"]
    loose = np.zeros(int(label.max(initial=-1)) + 1, np.bool_)
    loose[label] = True  # a sheet that sleeps has no nodes
    cut, image = np.zeros_like(loose), np.isin(np.arange(len(bodies)), system.images["body"])
    seen = [image[joints[end]] for end in "ab"]
    for one, two, mirrored in ((*ends, seen[1]), (*ends[::-1], seen[0])):
        held = (one >= 0) & (two < 0)
        loose[label[one[held & ~mirrored]]] = False
        cut[label[one[held & mirrored]]] = True
    parts = len(loose)
    sheet = np.full(len(bodies), -1, np.int32)
    sheet[nodes] = label
    return Free(
        label.astype(np.int64),
        sheet,
        loose,
        np.zeros(parts, np.bool_),
        np.zeros(parts, np.bool_),
        np.zeros(6 * len(nodes)),
        np.arange(parts),
        cut,
        system.mirror.normal.copy() if system.mirror is not None else np.zeros(3),
        np.zeros((2, len(np.unique(label)) + system.border)),
    )


@njit(cache=True, error_model="numpy")
def _inertia(into, mass, arm):
    """Adds the inertia of a mass at an arm."""
    square = dot(arm, arm)
    for i in range(3):
        into[i, i] += mass * square
        for j in range(3):
            into[i, j] -= mass * arm[i] * arm[j]


@njit(cache=True, error_model="numpy")
def _solved(a, b):
    """Solves a symmetric 3 x 3 system; zero where it is singular (a single line of mass)."""
    c0 = (a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1], a[1, 2] * a[2, 0] - a[1, 0] * a[2, 2])
    c2 = a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0]
    det = a[0, 0] * c0[0] + a[0, 1] * c0[1] + a[0, 2] * c2
    if not abs(det) > 0.0:
        return (0.0, 0.0, 0.0)
    r0, r1, r2 = vec(a, 0), vec(a, 1), vec(a, 2)
    # rows are columns: b over the triple product
    x = add(scale(b[0], cross(r1, r2)), add(scale(b[1], cross(r2, r0)), scale(b[2], cross(r0, r1))))
    return scale(1.0 / det, x)


@njit(cache=True, error_model="numpy")
def _top(one_with, part):
    while one_with[part] != part:
        part = one_with[part]
    return part


@njit(cache=True, error_model="numpy")
def _tie(tables, touched, count, film, free):
    """Groups sheets that touch each other, or have air between them, and marks groups that are held or touch
    another kind of body."""
    pairs, listed, sheet = tables.pairs, tables.listed, free.sheet
    loose, busy, one_with, first = free.loose, free.busy, free.one_with, pairs.size - listed.size
    last = -1, -1
    for part in range(loose.size):
        one_with[part] = part
        busy[part], free.alone[part] = not loose[part], loose[part]
    for k in range(count + film.many[0]):
        p = touched[k] if k < count else film.listed[k - count]
        if p >= first:
            one, two = int(sheet[listed[p - first].a]), int(sheet[listed[p - first].b])
        else:
            one, two = int(sheet[pairs[p].a]), -1
        if one == last[0] and two == last[1]:  # frequent: two sheets have many pairs of boxes
            continue
        last = one, two
        if one >= 0:
            free.alone[one] = False
        if two >= 0:
            free.alone[two] = False
        if one >= 0 and two >= 0:
            one_with[_top(one_with, one)] = _top(one_with, two)
        elif one >= 0 or two >= 0:
            busy[max(one, two)] = True
    for part in range(loose.size):
        top = _top(one_with, part)
        one_with[part] = top
        busy[top] = busy[top] or busy[part]


@njit(cache=True, error_model="numpy")
def keep(tables, touched, count, film, free, motion, change):
    """Subtracts from `change` (6 nodes,), global axes, its excess momentum over the residual's; motion:
    places and rotations of the residual."""
    x, r = motion
    label, loose, busy, residual, one_with = free.label, free.loose, free.busy, free.residual, free.one_with
    across = three(free.normal)
    bodies, nodes = tables.bodies, tables.nodes
    _tie(tables, touched, count, film, free)
    for part in range(loose.size):
        if busy[part] or one_with[part] != part:
            continue
        total, half = 0.0, False
        centre, linear = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for n in range(nodes.size):
            if one_with[label[n]] == part:
                b, k = nodes[n], 6 * n
                mass = bodies[b].mass
                total, half = total + mass, half or free.cut[label[n]]
                centre = add(centre, scale(mass, vec(x, b)))
                moved = (change[k], change[k + 1], change[k + 2])
                wanted = (residual[k], residual[k + 1], residual[k + 2])
                linear = add(linear, sub(scale(mass, moved), wanted))
        centre = scale(1.0 / total, centre)
        drift = scale(1.0 / total, linear)
        if half:
            drift = sub(drift, scale(dot(drift, across), across))
        angular = (0.0, 0.0, 0.0)
        inertia = np.zeros((3, 3))
        for n in range(nodes.size):
            if one_with[label[n]] == part:
                b, k = nodes[n], 6 * n
                mass, j, m = bodies[b].mass, bodies[b].inertia, mat(r, b)
                arm = sub(vec(x, b), centre)
                _inertia(inertia, mass, arm)
                for a in range(3):
                    for c in range(3):
                        for i in range(3):
                            inertia[a, c] += m[3 * a + i] * j[i] * m[3 * c + i]
                moved = (change[k] - drift[0], change[k + 1] - drift[1], change[k + 2] - drift[2])
                wanted = (residual[k], residual[k + 1], residual[k + 2])
                angular = add(angular, cross(arm, sub(scale(mass, moved), wanted)))
                own = back(m, (change[k + 3], change[k + 4], change[k + 5]))
                spun = rotate(m, (j[0] * own[0], j[1] * own[1], j[2] * own[2]))
                angular = add(angular, sub(spun, (residual[k + 3], residual[k + 4], residual[k + 5])))
        turn = _solved(inertia, angular)
        if half:
            about = (dot(vec(inertia, 0), across), dot(vec(inertia, 1), across), dot(vec(inertia, 2), across))
            turn = scale(dot(angular, across) / dot(about, across), across)
        for n in range(nodes.size):
            if one_with[label[n]] == part:
                k = 6 * n
                off = add(drift, cross(turn, sub(vec(x, nodes[n]), centre)))
                for i in range(3):
                    change[k + i] -= off[i]
                    change[k + 3 + i] -= turn[i]


@njit(cache=True, error_model="numpy")
def let_go(work, push, pushb, into):
    """Velocity that the residual momentum would give each sheet and each roller if nothing held it.

    push (6 nodes,): momentum of the nodes, in global axes; pushb (border,): that of slides and spins.
    into (sheets + border,): speeds of the sheets as rigid bodies [mm/ms], of slides [mm/ms], of arms and
    spins [rad/ms], times `strict` of their islands; zero for a sheet that a joint holds. Returns the greatest
    of them.
    """
    boxes, nodes, free = work.tables.boxes, work.tables.nodes, work.free
    spans, own, x = work.matrix.couplings.colouring.spans, work.matrix.own, work.mid.motion.x
    across, greatest = three(free.normal), 0.0
    for row in range(spans.shape[0]):
        low, high = spans[row, BEGIN], spans[row, END]
        sheet = free.label[low]
        into[row] = 0.0
        if not free.loose[sheet]:
            continue
        total = inertia = 0.0
        centre = linear = angular = (0.0, 0.0, 0.0)
        first = vec(x, nodes[low])
        for n in range(low, high):
            k, mass, arm = 6 * n, boxes[n, OWN_MASS], sub(vec(x, nodes[n]), first)
            force = (push[k], push[k + 1], push[k + 2])
            about = three_from(boxes[n], OWN_INERTIA)
            # its own polar moment about its centre: half of the three about axes together
            inertia += mass * dot(arm, arm) + 0.5 * (about[0] + about[1] + about[2])
            total += mass
            centre, linear = add(centre, scale(mass, arm)), add(linear, force)
            angular = add(angular, add(cross(arm, force), (push[k + 3], push[k + 4], push[k + 5])))
        centre = scale(1.0 / total, centre)
        inertia -= total * dot(centre, centre)
        angular = sub(angular, cross(centre, linear))
        if free.cut[sheet]:
            linear = sub(linear, scale(dot(linear, across), across))
            angular = scale(dot(angular, across), across)
        turns = dot(angular, angular) / (inertia * total) if inertia > 0.0 else 0.0
        moves = max(dot(linear, linear) / (total * total), turns)
        into[row] = work.islands.strict[sheet] * math.sqrt(moves)
        greatest = max(greatest, into[row])
    for i in range(pushb.size):
        part = work.islands.of_border[i]
        into[spans.shape[0] + i] = work.islands.strict[part] * abs(pushb[i]) / own[i, i]
        greatest = max(greatest, into[spans.shape[0] + i])
    return greatest
