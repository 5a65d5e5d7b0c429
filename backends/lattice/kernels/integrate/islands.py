"""Islands of parts that touch, and the speed and energy of each that scale the errors of a step.

A part is a sheet, or a body that turns or slides. Parts that touch form an island, since a motion passes from
one to the other. Fixed and driven bodies transmit none: two sheets on one plate are two islands. A driven
surface counts with its speed where it touches, because it gives that speed to the sheet.

A part has limits on changes in the last iteration, on missed guesses and on the energy error of contacts.
They are relative to the speed and the energy of its island in the last step. So no fast body elsewhere, and
no earlier motion, makes a step of a slow one coarser.
"""

from __future__ import annotations

import math

from mdlgen.backends.lattice.kernels.contact.swept import MISSES
from mdlgen.backends.lattice.kernels.state import (
    FACE_POINTS,
    FACE_STORED,
    OWN_INERTIA,
    OWN_MASS,
)
from mdlgen.backends.lattice.kernels.tuning import EPSILON, FOLLOWED, STILL, UNITS
from mdlgen.mechanics.arm import AXIAL, INERTIA, way_of
from mdlgen.mechanics.driven import prescribed
from mdlgen.mechanics.frame import RADIUS
from mdlgen.mechanics.gate import GATE, fastest_of_gate
from mdlgen.mechanics.point import STORED
from mdlgen.mechanics.records import FOLLOWER
from mdlgen.mechanics.vector import back, dot, mat, three_from, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _top(top, part):
    while top[part] != part:
        part = top[part]
    return part


@njit(cache=True, error_model="numpy", **BORROWS)
def _speeds_of_sheets(work):
    """Computes kinetic energies of sheets, and their root mean square speeds by mass."""
    boxes, nodes, label = work.tables.boxes, work.tables.nodes, work.free.label
    r, u, islands = work.mid.motion.r, work.state.u, work.islands
    for n in range(nodes.size):
        j = three_from(boxes[n], OWN_INERTIA)
        w = back(mat(r, nodes[n]), (u[n, 3], u[n, 4], u[n, 5]))
        square = u[n, 0] * u[n, 0] + u[n, 1] * u[n, 1] + u[n, 2] * u[n, 2]
        turning = j[0] * w[0] * w[0] + j[1] * w[1] * w[1] + j[2] * w[2] * w[2]
        islands.energy[label[n]] += 0.5 * (boxes[n, OWN_MASS] * square + turning)
    for n in range(nodes.size):
        part = label[n]
        if islands.mass[part] > 0.0:
            islands.speed[part] = math.sqrt(2.0 * islands.energy[part] / islands.mass[part])


@njit(cache=True, error_model="numpy", **BORROWS)
def _speeds_of_moving(work, t):
    """The same for bodies that turn or slide: the speed of the rim plus that of the slide."""
    bodies, x, ub, islands = work.tables.bodies, work.mid.motion.x, work.state.ub, work.islands
    for b in work.tables.moving:
        body, part = bodies[b], islands.part[b]
        if body.swings >= GATE:
            islands.speed[part] = fastest_of_gate(body, x, b, t)
            continue
        turns = body.ratio * ub[body.spin] if body.spin >= 0 else prescribed(body, t)
        speed = abs(turns) * body.size[RADIUS]
        if body.spin >= 0:
            islands.energy[part] += 0.5 * body.press[AXIAL] * turns * turns
        if body.slide >= 0:
            way, rate = way_of(body, vec(x, b)), ub[body.slide]
            speed += abs(rate) * math.sqrt(dot(way, way))
            islands.energy[part] += 0.5 * body.press[INERTIA] * rate * rate
        islands.speed[part] = max(islands.speed[part], speed) if body.coupled == FOLLOWER else speed


@njit(cache=True, error_model="numpy", **BORROWS)
def _join(islands, one, two):
    """Joins the islands of two parts that touch; -1: a body that does not move."""
    if one < 0 or two < 0:
        return
    if islands.answers[one] and islands.answers[two]:
        islands.top[_top(islands.top, one)] = _top(islands.top, two)
    elif islands.answers[one]:
        islands.given[one] = max(islands.given[one], islands.speed[two])
    else:
        islands.given[two] = max(islands.given[two], islands.speed[one])


@njit(cache=True, error_model="numpy", **BORROWS)
def _join_touching(work, count):
    """Joins the parts of pairs that touch or have air between them; adds the stored energy of contacts."""
    tables, mid, film, islands = work.tables, work.mid, work.film, work.islands
    pairs, listed, part = tables.pairs, tables.listed, islands.part
    first = pairs.size - listed.size
    last = -2, -2
    for k in range(count + film.many[0]):
        p = mid.touched[k] if k < count else film.listed[k - count]
        if p >= first:
            one, two = part[listed[p - first].a], part[listed[p - first].b]
        else:
            one, two = part[pairs[p].a], part[pairs[p].b]
        if k < count and max(one, two) >= 0:
            stored = 0.0
            if p < first or mid.faces[k, FACE_POINTS] > 0.0:
                stored = mid.results[mid.rows[k], STORED]
            else:
                stored = mid.faces[k, FACE_STORED]
            islands.energy[one if one >= 0 else two] += stored
        if one == last[0] and two == last[1]:  # frequent: two sheets have many pairs of boxes
            continue
        last = one, two
        _join(islands, one, two)


@njit(cache=True, error_model="numpy", **BORROWS)
def measure(work, t, count):
    """Updates the islands, speeds and energies for the last step, or for the start; t: its middle [ms],
    `count`: how many pairs touched in it."""
    islands = work.islands
    top, speed, energy = islands.top, islands.speed, islands.energy
    for part in range(top.size):
        top[part] = part
        speed[part] = energy[part] = islands.given[part] = 0.0
    _speeds_of_sheets(work)
    _speeds_of_moving(work, t)
    _join_touching(work, count)
    scale, least = islands.scale, islands.least
    for part in range(top.size):
        top[part] = _top(top, part)
        scale[part] = 0.0
    for part in range(top.size):
        own = max(speed[part], islands.given[part])
        scale[top[part]] = max(scale[top[part]], own)
    for part in range(top.size):
        speed[part] = scale[top[part]]
    for part in range(top.size):
        scale[part] = max(speed[part], least[part])
        energy[part] += 0.5 * islands.mass[part] * scale[part] * scale[part]
        if top[part] != part:
            energy[top[part]] += energy[part]
    if work.search.regions.size > 0:
        for part in range(top.size):
            low = max(STILL * least[part], min(FOLLOWED * speed[part], least[part]))
            scale[part] = max(speed[part], low)


@njit(cache=True, error_model="numpy", **BORROWS)
def greatest_scale(islands):
    """Greatest speed that scales the errors of a part [mm/ms]."""
    found = 0.0
    for part in range(islands.scale.size):
        if islands.answers[part]:
            found = max(found, islands.scale[part])
    return found


@njit(cache=True, error_model="numpy", **BORROWS)
def be_strict(islands, greatest, most):
    """Sets `strict`: the limit of a step in each part is smaller in proportion to the scale of its island,
    relative to the `greatest`; but not below 1/`most`, which is round-off."""
    for part in range(islands.scale.size):
        slower = greatest / islands.scale[part] if islands.scale[part] > 0.0 else 1.0
        islands.strict[part] = max(1.0, min(slower, most))


@njit(cache=True, error_model="numpy", **BORROWS)
def round_off(work, h):
    """Velocity [mm/ms] below which changes are round-off of places, where h [ms] is half of the step.

    A change of the velocities moves places by h times the change. A round-off error e of places changes the
    velocities of stiff parts by e/h, and those of soft parts by less. So changes cannot fall below e/h in
    double precision, at any mass and stiffness.
    """
    tables, x, u = work.tables, work.state.x, work.state.u
    far = fast = 0.0
    for n in range(tables.nodes.size):
        b = tables.nodes[n]
        for i in range(3):
            far, fast = max(far, abs(x[b, i])), max(fast, abs(u[n, i]))
    for b in tables.moving:
        for i in range(3):
            far = max(far, abs(x[b, i]))
    return UNITS * EPSILON * (far / h + fast)


@njit(cache=True, error_model="numpy", **BORROWS)
def missed_guess(work, guess, floor):
    """Difference between the velocities of a step and their guess: root mean square by mass, relative to the
    scale of the sheet, of the sheet with the largest. Differences below `floor` count as zero."""
    boxes, u, label, islands = work.tables.boxes, work.state.u, work.free.label, work.islands
    sums, found = islands.sums, 0.0
    sums[:] = 0.0
    for n in range(boxes.shape[0]):
        for i in range(3):
            sums[label[n]] += boxes[n, OWN_MASS] * (u[n, i] - guess[n, i]) ** 2
    for part in range(sums.size):
        if islands.mass[part] > 0.0 and sums[part] > islands.mass[part] * floor * floor:
            found = max(found, math.sqrt(sums[part] / islands.mass[part]) / islands.scale[part])
    return found


@njit(cache=True, error_model="numpy", **BORROWS)
def may_make(islands, part, allowed):
    """Sets the allowed energy error of contacts in a step [N mm], (contacts,): `part` times the energy of
    their islands. Returns the least of them."""
    least = 1e300
    for row in range(allowed.size):
        of = islands.of_row[row]
        allowed[row] = part * islands.energy[islands.top[of]] if of >= 0 else 1e300
        least = min(least, allowed[row])
    return least


@njit(cache=True, error_model="numpy", **BORROWS)
def made_too_much(islands, made, allowed):
    """Greatest ratio of the energy error that the contacts of an island `made` in a step (contacts,
    swept.MISSES) to the allowed one."""
    sums, found = islands.sums, 0.0
    sums[:] = 0.0
    for row in range(made.shape[0]):
        if islands.of_row[row] >= 0:
            sums[islands.top[islands.of_row[row]]] += made[row, MISSES]
    for row in range(made.shape[0]):
        of = islands.of_row[row]
        if of >= 0 and sums[islands.top[of]] > 0.0:
            found = max(found, sums[islands.top[of]] / allowed[row])
    return found
