"""Meshes that scenes of the campaign use, as texts of OBJ and STL files; lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

Faces = Sequence[tuple[int, ...]]
Points = Sequence[tuple[float, float, float]]

BLOCK: Faces = ((3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
PRISM: Faces = ((0, 3, 2, 1), (1, 2, 5, 4), (0, 4, 5, 3), (0, 1, 4), (3, 5, 2))


def block(length: float, width: float, height: float) -> tuple[Points, Faces]:
    """A block whose upper face is at z = 0."""
    x, y = length / 2, width / 2
    flat = ((-x, -y), (x, -y), (x, y), (-x, y))
    return [(a, b, z) for z in (-height, 0.0) for a, b in flat], BLOCK


def prism(length: float, width: float, height: float, ridge: float) -> tuple[Points, Faces]:
    """A roof along y whose ridge is at x = `ridge`, z = 0; at one end of its length it is a ramp."""
    x, y = length / 2, width / 2
    low = [(-x, -y, -height), (x, -y, -height), (x, y, -height), (-x, y, -height)]
    return [*low, (ridge, -y, 0.0), (ridge, y, 0.0)], PRISM


def triangles(faces: Faces) -> list[tuple[int, int, int]]:
    """Each face as a fan, turned outward."""
    return [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]


def obj(points: Points, faces: Faces) -> str:
    """The text of an OBJ file, whose indices begin with 1."""
    lines = [f"v {x:g} {y:g} {z:g}" for x, y, z in points]
    return "\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles(faces)), ""])


def stl(points: Points, faces: Faces) -> str:
    """The text of an STL file."""
    lines = ["solid part"]
    for corners in triangles(faces):
        a, b, c = (np.array(points[k]) for k in corners)
        normal = np.cross(b - a, c - a)
        normal = normal / np.linalg.norm(normal)
        lines += ["facet normal {:g} {:g} {:g}".format(*normal), "outer loop"]
        lines += ["vertex {:g} {:g} {:g}".format(*points[k]) for k in corners]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part", ""])
