"""A hierarchy of bounding volumes over the triangles of a mesh, and its queries.

Each node has the least box round its triangles, in the file's axes, and one round their outward normals.
Nodes are in the order of a visit, each with the node that follows where it is skipped: a query needs no
stack, and allocates nothing.
"""

from __future__ import annotations

import math

import numpy as np

from mdlgen.mechanics.vector import add, cross, dot, scale, sub, three
from mdlgen.model.tables import Floats, Ints
from mdlgen.program.kernel import CALLED, njit

LEAF = 8  # triangles
# Columns of the bounds of a node: least and greatest coordinates, least and greatest normals.
LOW, HIGH, LEAST, MOST = 0, 3, 6, 9
# Columns of its links: first triangle, number of them (0: there are nodes below), next node if it is skipped.
FIRST, COUNT, AFTER = 0, 1, 2
# Columns of a triangle: corners (9), outward normal (3), depth up to which it is the nearest side, area, and
# the triangles beyond its sides, from its first corner on (3), -1: none.
NORMAL, THICK, AREA, NEXT, WIDTH = 9, 12, 13, 14, 17


def build_tree(corners: Floats, triangles: Ints, most: float) -> tuple[Floats, Ints, Floats]:
    """Bounds (nodes, 12) and links (nodes, 3) of the tree, and its triangles (m, WIDTH), of a closed surface;
    triangles without an area are omitted.

    The depth of a triangle is half of the thickness of the part behind it, and at most `most`.
    """
    places = corners[triangles]
    normals = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    kept = np.flatnonzero(sizes > 1e-12 * np.ptp(corners, axis=0).max() ** 2)
    table = np.empty((len(kept), WIDTH))
    table[:, :NORMAL] = places[kept].reshape(-1, 9)
    table[:, NORMAL:THICK] = normals[kept] / sizes[kept, None]
    table[:, AREA] = 0.5 * sizes[kept]
    order, links = _split(places[kept].mean(axis=1))
    table = table[order]
    table[:, NEXT:] = _neighbours(triangles[kept[order]])
    bounds = _bounds(table, links)
    set_thickness(bounds, links, table, most)
    return bounds, links, table


def _neighbours(triangles: Ints) -> Ints:
    """Which triangle is beyond each side of each (m, 3), from its first corner on; -1: none, or several."""
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    _, side, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(side.ravel(), kind="stable")
    found = np.full(len(sides), -1)
    two = count[side.ravel()[order]] == 2
    one, other = order[two][::2], order[two][1::2]
    found[one], found[other] = other // 3, one // 3
    return found.reshape(-1, 3)


def _split(middles: Floats) -> tuple[Ints, Ints]:
    """Order of triangles, and links of nodes in the order of a visit, by halves along the longest side."""
    order, links = np.arange(len(middles)), []

    def grow(begin: int, end: int) -> None:
        me = len(links)
        links.append([begin, end - begin, 0])
        if end - begin > LEAF:
            links[me][COUNT] = 0
            mine = order[begin:end]
            there = middles[mine]
            axis, half = int((there.max(axis=0) - there.min(axis=0)).argmax()), (end - begin) // 2
            order[begin:end] = mine[there[:, axis].argpartition(half)]
            grow(begin, begin + half)
            grow(begin + half, end)
        links[me][AFTER] = len(links)

    grow(0, len(order))
    return order, np.array(links, dtype=np.int64)


def _bounds(table: Floats, links: Ints) -> Floats:
    """Bounds of nodes: those of leaves from their triangles, then of what is above, level by level."""
    bounds = np.empty((len(links), 12))
    leaves = np.flatnonzero(links[:, COUNT] > 0)
    starts = links[leaves, FIRST]
    places = table[:, :NORMAL].reshape(-1, 3, 3)
    columns = ((LOW, np.minimum, places.min(axis=1)), (HIGH, np.maximum, places.max(axis=1)))
    normals = table[:, NORMAL:THICK]
    columns += ((LEAST, np.minimum, normals), (MOST, np.maximum, normals))
    for column, extreme, values in columns:
        bounds[leaves, column : column + 3] = extreme.reduceat(values, starts)
    level = np.zeros(len(links), dtype=np.int64)
    inner = np.flatnonzero(links[:, COUNT] == 0)
    for node in inner.tolist():
        level[[node + 1, links[node + 1, AFTER]]] = level[node] + 1
    for depth in range(int(level.max()), -1, -1):
        mine = inner[level[inner] == depth]
        one, two = mine + 1, links[mine + 1, AFTER]
        for column, extreme, _ in columns:
            part = slice(column, column + 3)
            bounds[mine, part] = extreme(bounds[one, part], bounds[two, part])
    return bounds


@njit(cache=True, error_model="numpy")
def set_thickness(bounds, links, triangles, most):
    """Sets the depth of each triangle: half of the thickness behind its middle and behind three points near
    its corners."""
    for t in range(triangles.shape[0]):
        c, normal = triangles[t], three(triangles[t, NORMAL:])
        middle = scale(1 / 3, (c[0] + c[3] + c[6], c[1] + c[4] + c[7], c[2] + c[5] + c[8]))
        thick = 2.0 * most
        for k in range(4):
            at = middle
            if k < 3:
                at = add(scale(0.2, middle), scale(0.8, (c[3 * k], c[3 * k + 1], c[3 * k + 2])))
            thick, _ = behind(bounds, links, triangles, 0, links.shape[0], at, scale(-1.0, normal), thick)
        triangles[t, THICK] = 0.5 * thick


@njit(cache=True, error_model="numpy")
def behind(bounds, links, triangles, first, end, at, way, far):
    """Distance from a point of the surface along `way` to where the ray leaves the part, and the triangle
    there; `far` and -1 where that is farther."""
    found, by, n = far, -1, first
    last = add(at, scale(far, way))
    while n < end:
        box = bounds[n]
        apart = False
        for i in range(3):
            low, high = min(at[i], last[i]), max(at[i], last[i])
            apart = apart or high < box[LOW + i] or low > box[HIGH + i]
        if apart:
            n = links[n, AFTER]
            continue
        for t in range(links[n, FIRST], links[n, FIRST] + links[n, COUNT]):
            c, normal = triangles[t], three(triangles[t, NORMAL:])
            along = dot(normal, way)
            if along <= 1e-9:  # the ray would enter by this triangle
                continue
            a = (c[0], c[1], c[2])
            distance = dot(normal, sub(a, at)) / along
            if distance <= 1e-9 * far or distance >= found:
                continue
            hit, inside = add(at, scale(distance, way)), True
            for k in range(3):
                p = (c[3 * k], c[3 * k + 1], c[3 * k + 2])
                l = 3 * ((k + 1) % 3)
                side = sub((c[l], c[l + 1], c[l + 2]), p)
                inside = inside and dot(cross(side, sub(hit, p)), normal) >= -1e-9 * dot(side, side)
            if inside:
                found, by = distance, t
        n += 1
    return found, by


@njit(cache=True, error_model="numpy", forceinline=True)
def closest(c, at):
    """The point of a triangle (nine numbers) that is nearest to a point (Ericson, Real-Time Collision
    Detection, 5.1.5)."""
    p, q, r = (c[0], c[1], c[2]), (c[3], c[4], c[5]), (c[6], c[7], c[8])
    pq, pr, ap = sub(q, p), sub(r, p), sub(at, p)
    d1, d2 = dot(pq, ap), dot(pr, ap)
    if d1 <= 0.0 and d2 <= 0.0:
        return p
    bp = sub(at, q)
    d3, d4 = dot(pq, bp), dot(pr, bp)
    if d3 >= 0.0 and d4 <= d3:
        return q
    if d1 * d4 - d3 * d2 <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return add(p, scale(d1 / (d1 - d3), pq))
    cp = sub(at, r)
    d5, d6 = dot(pq, cp), dot(pr, cp)
    if d6 >= 0.0 and d5 <= d6:
        return r
    if d5 * d2 - d1 * d6 <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return add(p, scale(d2 / (d2 - d6), pr))
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        return add(q, scale((d4 - d3) / ((d4 - d3) + (d5 - d6)), sub(r, q)))
    vb, vc = d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    total = va + vb + vc
    return add(p, add(scale(vb / total, pq), scale(vc / total, pr)))


@njit(cache=True, error_model="numpy", **CALLED)
def depth_at(bounds, links, triangles, first, end, at, most):
    """Depth of a point below the nearest triangle, and the number of that; negative: the point is outside, or
    farther than `most`.

    Where triangles are equally near (at an edge, or a corner), the one whose plane is farthest from the point
    decides on which side it is.
    """
    near2, best, deep, n = most * most, -1, -1.0, first
    while n < end:
        box, gap2 = bounds[n], 0.0
        for i in range(3):
            gap = max(box[LOW + i] - at[i], at[i] - box[HIGH + i], 0.0)
            gap2 += gap * gap
        if gap2 > near2:
            n = links[n, AFTER]
            continue
        for t in range(links[n, FIRST], links[n, FIRST] + links[n, COUNT]):
            away = sub(at, closest(triangles[t], at))
            square, over = dot(away, away), dot(away, three(triangles[t, NORMAL:]))
            if square > near2 * (1.0 + 1e-9):
                continue
            if best < 0 or square < near2 * (1.0 - 1e-9) or abs(over) > abs(deep):
                best, deep = t, -over
            near2 = min(near2, square)
        n += 1
    return (math.sqrt(near2) if deep > 0.0 else -1.0), best


@njit(cache=True, error_model="numpy")
def next_at(bounds, links, triangles, first, end, at, most, normal):
    """Distance of a point from the nearest triangle across an outward edge of 60 to 120 deg, and its number;
    -1: none is nearer than `most`. `normal`: that of the triangle on the other side of the edge."""
    near2, best, n = most * most, -1, first
    while n < end:
        box, gap2 = bounds[n], 0.0
        for i in range(3):
            gap = max(box[LOW + i] - at[i], at[i] - box[HIGH + i], 0.0)
            gap2 += gap * gap
        if gap2 >= near2:
            n = links[n, AFTER]
            continue
        for t in range(links[n, FIRST], links[n, FIRST] + links[n, COUNT]):
            own = three(triangles[t, NORMAL:])
            if abs(dot(own, normal)) > 0.5:
                continue
            away = sub(at, closest(triangles[t], at))
            square = dot(away, away)
            # across an inward edge the nearest point is that of the first triangle
            if square < near2 and dot(away, own) <= 0.0 and -dot(away, normal) <= 0.6 * math.sqrt(square):
                near2, best = square, t
        n += 1
    return math.sqrt(near2), best


@njit(cache=True, error_model="numpy", forceinline=True)
def span(bounds, n, way):
    """Middle of a node's box along a direction, and how far it reaches to either side."""
    middle = reach = 0.0
    for i in range(3):
        middle += way[i] * 0.5 * (bounds[n, LOW + i] + bounds[n, HIGH + i])
        reach += abs(way[i]) * 0.5 * (bounds[n, HIGH + i] - bounds[n, LOW + i])
    return middle, reach


@njit(cache=True, error_model="numpy")
def overlaps(bounds, links, first, end, middle, axes, half):
    """True if a box (middle, axes as a matrix from its own to the file's, half lengths) may meet a leaf."""
    n = first
    while n < end:
        apart = False
        for k in range(3):
            way = (axes[k], axes[3 + k], axes[6 + k])
            away, reach = span(bounds, n, way)
            apart = apart or abs(away - dot(way, middle)) > half[k] + reach
        if apart:
            n = links[n, AFTER]
            continue
        if links[n, COUNT] > 0:
            return True
        n += 1
    return False
