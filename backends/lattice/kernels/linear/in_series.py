"""The preconditioner of the second colour where contacts are stiff: springs in series.

The method of two_colour takes the band of each sheet of the second colour as its preconditioner. In that
band a contact holds a box as if the other box were fixed. But the other box yields: where everything else
holds it with stiffness R, a contact of stiffness K acts as K R/(K + R). Air and stiff contacts hold a box a
hundred times as strongly as its inertia. Two sheets that move together are held by their masses alone. In the
band they would cause 30 to 40 slowly converging modes: 81 iterations for two notes with air, where 11 are
enough with springs in series.

So the part K/(K + R) of a contact's stiffness at a box of the second colour is not in the band, and the
method adds it in its products. R is the inertia of the other box plus all its contacts except those at the
same face, since bodies there usually move with the first box. Bushings are neglected: a motion that they
resist in one sheet they mostly resist in the other as well. K and R are sums over three axes. For any part
below one the matrix stays positive definite; the solution does not depend on the part.
"""

from __future__ import annotations

from mdlgen.backends.lattice.kernels.linear.colouring import ONE, TWO
from mdlgen.mechanics.vector import dot, mat, sub, vec
from mdlgen.program.kernel import BORROWS, njit


@njit(cache=True, error_model="numpy", **BORROWS)
def _face(motion, one, other):
    """Face of a body at which another one is."""
    r, way = mat(motion.r, one), sub(vec(motion.x, other), vec(motion.x, one))
    return 1 if dot(way, (r[2], r[5], r[8])) > 0.0 else 0


@njit(cache=True, error_model="numpy", **BORROWS)
def _take(into, block, first, way, part):
    """Adds a part of a contact's stiffness at one of its boxes. block: its coupling of the two; first: true
    if the rows are of that box; way: vector from there to the other box [mm]."""
    for i in range(6):
        # row of the coupling to the motion of the other box; a common rigid motion yields no force
        if first:
            x, y, z = block[0, i], block[1, i], block[2, i]
            a, b, c = block[3, i], block[4, i], block[5, i]
        else:
            x, y, z = block[i, 0], block[i, 1], block[i, 2]
            a, b, c = block[i, 3], block[i, 4], block[i, 5]
        into[0, i] -= part * x
        into[1, i] -= part * y
        into[2, i] -= part * z
        into[3, i] += part * (y * way[2] - z * way[1] - a)
        into[4, i] += part * (z * way[0] - x * way[2] - b)
        into[5, i] += part * (x * way[1] - y * way[0] - c)


@njit(cache=True, error_model="numpy", **BORROWS)
def in_series(bodies, nodes, motion, matrix):
    """Moves the part K/(K + R) of contacts from the band to an array of the couplings; in global axes, before
    masses and bushings are added."""
    couplings, band = matrix.couplings, matrix.band
    ends, blocks, beside, through = couplings.ends, couplings.blocks, couplings.beside, couplings.through
    colours, many = couplings.colouring, couplings.many[0]
    beside[:] = 0.0
    through[:] = 0.0
    for k in range(many):
        stiff = -(blocks[k, 0, 0] + blocks[k, 1, 1] + blocks[k, 2, 2])
        one, two = ends[k, ONE], ends[k, TWO]
        through[one, _face(motion, nodes[one], nodes[two])] += stiff
        through[two, _face(motion, nodes[two], nodes[one])] += stiff
    for k in range(many):
        first = colours.of[colours.label[ends[k, ONE]]] == 1
        own, far = (ends[k, ONE], ends[k, TWO]) if first else (ends[k, TWO], ends[k, ONE])
        held = 3.0 * bodies[nodes[far]].mass + band[far, 0, 0] + band[far, 1, 1] + band[far, 2, 2]
        part = through[far, _face(motion, nodes[far], nodes[own])] / held
        way = sub(vec(motion.x, nodes[far]), vec(motion.x, nodes[own]))
        _take(beside[own], blocks[k], first, way, part)
    for n in range(nodes.size):
        for c in range(6):
            for r in range(6):
                band[n, c, r] -= beside[n, c, r]
