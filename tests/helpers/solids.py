"""Solids for tests and samples: corners and triangles, and the files that hold them."""

from __future__ import annotations

import struct

import numpy as np


def prism(outline, width):
    """A prism along y with a convex outline (n, 2) in x and z, in its middle."""
    outline = np.asarray(outline, dtype=float)
    count = len(outline)
    ring = np.stack([outline[:, 0], np.zeros(count), outline[:, 1]], axis=1)
    middle = [*ring.mean(axis=0)]
    ends = [np.add(middle, [0, -width / 2, 0]), np.add(middle, [0, width / 2, 0])]
    away = np.array([0, width / 2, 0])
    corners = np.concatenate([ring - away, ring + away, ends])
    one = np.arange(count)
    two = (one + 1) % count
    low, high = np.full(count, 2 * count), np.full(count, 2 * count + 1)
    sides = [(one, two + count, two), (one, one + count, two + count), (one, two, low)]
    sides.append((two + count, one + count, high))
    return corners, np.concatenate([np.stack(side, axis=1) for side in sides])


def cylinder(radius, width, count):
    """A cylinder along y of count sides, 4 count triangles."""
    angles = 2 * np.pi * np.arange(count) / count
    return prism(radius * np.stack([np.cos(angles), np.sin(angles)], axis=1), width)


def halved(corners, triangles):
    """The same surface with each triangle as four."""
    made, number = list(corners), {}

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in number:
            number[key] = len(made)
            made.append((corners[a] + corners[b]) / 2)
        return number[key]

    finer = []
    for a, b, c in triangles.tolist():
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.array(made), np.array(finer)


def brick(x, y, z):
    """A box with these lengths about the origin."""
    return prism([(-x / 2, -z / 2), (x / 2, -z / 2), (x / 2, z / 2), (-x / 2, z / 2)], y)


def flats(radius, width, count, flat):
    """A cylinder along y with two flats opposite of each other, `flat` from its axis."""
    angles = 2 * np.pi * np.arange(count) / count
    outline = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    edge = np.sqrt(radius**2 - flat**2)
    round_ = [p for p in outline if abs(p[0]) < flat - 1e-9]
    ends = [(flat * s, edge * t) for s in (-1, 1) for t in (-1, 1)]
    points = np.array([*round_, *ends])
    return prism(points[np.argsort(np.arctan2(points[:, 1], points[:, 0]))], width)


def binary(corners, triangles):
    """A binary STL file."""
    record = np.zeros(len(triangles), np.dtype([("n", "<f4", 3), ("c", "<f4", 9), ("a", "<u2")]))
    record["c"] = np.asarray(corners)[triangles].reshape(-1, 9)
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + record.tobytes()


def ascii_stl(corners, triangles, name="part"):
    """An ASCII STL file; normals are left to the reader."""
    lines = [f"solid {name}"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(f"{v:.7g}" for v in corners[k]) for k in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])


def obj(corners, triangles):
    """An OBJ file."""
    lines = ["v " + " ".join(f"{v:.9g}" for v in corner) for corner in corners]
    lines += ["f " + " ".join(str(k + 1) for k in triangle) for triangle in triangles]
    return "\n".join([*lines, ""])
