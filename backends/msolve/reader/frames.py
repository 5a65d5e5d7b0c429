"""Properties of one object of a script: its name, the place of a marker, and its body."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlgen.backends.msolve.reader.standin import Thing

Vector = tuple[float, float, float]
GLOBAL: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def label(thing: Thing) -> str:
    """The label of an object, which is its name here."""
    return str(thing.given.get("label", ""))


def frame(marker: Thing) -> tuple[Vector, tuple[Vector, Vector, Vector]]:
    """Origin and axes: z goes to `zp`, x lies in the plane of z and `xp`, on its side."""
    given = marker.given
    x, y, z = (float(v) for v in given.get("qp", (0.0, 0.0, 0.0)))
    origin = (x, y, z)
    if "zp" not in given or "xp" not in given:
        return origin, GLOBAL
    up = _unit([p - o for p, o in zip(given["zp"], origin, strict=True)])
    way = [p - o for p, o in zip(given["xp"], origin, strict=True)]
    over = sum(a * b for a, b in zip(way, up, strict=True))
    a = _unit([v - over * w for v, w in zip(way, up, strict=True)])
    b = (up[1] * a[2] - up[2] * a[1], up[2] * a[0] - up[0] * a[2], up[0] * a[1] - up[1] * a[0])
    return origin, (a, b, up)


def _unit(way: list[float]) -> Vector:
    size = math.sqrt(sum(v * v for v in way))
    x, y, z = (v / size if size else math.nan for v in way)
    return x, y, z


def on(marker: Thing) -> str:
    """The part that a marker is on."""
    return label(marker.part)
