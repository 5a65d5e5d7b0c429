"""Which outer sides of a box stand before an end of a plate: what a pair remembers (see mechanics.edge)."""

from __future__ import annotations

from mdlgen.mechanics.edge import corner_of, end_of, rounded, station
from mdlgen.mechanics.frame import ARC_RADIUS
from mdlgen.mechanics.guide import arc_side
from mdlgen.mechanics.plate import flat_side
from mdlgen.mechanics.vector import back, dot, scale, sub
from mdlgen.program.kernel import njit

FACES = 0.35  # cosine of the angle to an end at which a side may come to stand before it


@njit(cache=True, error_model="numpy")
def stands(a, box, b, plate):
    """Which outer sides of box a stand before which end of plate b, with what was known (see mechanics.edge).

    A side is over the top of the round of the face that the box is on. One that is over the round of the
    other face, as where the end of a sheet slides down past an end, stands before the end until it is clear:
    the face would find it as deep as the plate is thick.
    """
    half, exposed = box
    ends, edge, beside = plate.ends, plate.edge, plate.beside
    thick = 2.0 * plate.half[2]
    at, upright = back(b.r, sub(a.x, b.x)), back(b.r, (a.r[2], a.r[5], a.r[8]))
    arc = plate.shape[ARC_RADIUS] > 0.0
    meets = arc_side(at, upright, plate) if arc else flat_side(at, upright, plate)
    found = 0
    for side in range(4):
        if exposed & (1 << side) == 0:
            continue
        p, sign = side // 2, 1.0 if side % 2 == 1 else -1.0
        known = (beside >> (3 * side)) & 7
        faces = scale(sign, (a.r[p], a.r[3 + p], a.r[6 + p]))
        which, most = known - 1, FACES
        if known == 0:
            for i in range(2 if arc else 4):
                if ends & (1 << i) != 0:
                    end = end_of(i, b, plate)
                    if -dot(faces, end.out) > most:
                        which, most = i, -dot(faces, end.out)
        if which < 0:
            continue
        end = end_of(which, b, plate)
        first, last = station(a, half, p, sign, end)
        if last - first <= 1e-9:
            continue
        inside, above, below = -1e300, 1e300, -1e300
        over, before = False, False
        for corner in range(4):
            t, face = first if corner % 2 == 0 else last, 1.0 if corner < 2 else -1.0
            _at, u, h = corner_of(a, half, p, sign, t, face, end)
            inside, above, below = max(inside, u), min(above, h), max(below, h)
            depth, along, _down = rounded(u, h, thick, edge)
            round_of = 1.0 if h <= 0.5 * thick else -1.0
            over = over or (depth > 0.0 and along == 0.0 and round_of == meets)
            before = before or (depth > 0.0 and along != 0.0)
        clear = below <= 0.0 or above >= thick
        # of a twisted side one corner may be over the top of the round while another stands far below it
        if not clear and (inside <= 0.0 or (known > 0 and (before or not over))):
            found |= (which + 1) << (3 * side)
    return found
