"""Solids from files, checked as they are read.

A file that is too large, or no plain file, is refused before it is read. One whose size differs from that in
its header, or that has more triangles than are allowed, is refused before it is parsed. Then these are
refused: numbers that are not finite, and triangles without a neighbour on a side (the surface is not
watertight) or with reversed orientation. Also refused is a size that no part of a paper machine has: it is
the sign of a wrong unit. Corners that are exactly equal are merged. Corners without a triangle, and triangles
with two corners in one place, are left out.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mdlgen.spec.limits import Tally
from mdlgen.spec.strict import fail
from mdlgen.spec.triangles import Floats, Ints, obj, stl

BYTES = 250  # of a file for each triangle that is allowed
MOST_FLAT = 0.01  # part of the triangles that may have two corners in one place
SIZES = (0.5, 3000.0)  # of the longest side that a part of a machine has [mm]
SCALES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

_FILE = re.compile(r"[A-Za-z0-9_.-]{1,100}(?:/[A-Za-z0-9_.-]{1,100}){0,9}")


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed surface of triangles, corners counter-clockwise as seen from outside; the file's unit."""

    corners: Floats  # (n, 3)
    triangles: Ints  # corners of each, (m, 3)
    flat: int  # triangles that were left out
    digest: str  # of the file

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Solid) and self.digest == other.digest

    __hash__ = None  # type: ignore[assignment]


def read_solid(name: Any, folder: Any, unit: str, tally: Tally) -> Solid:
    """The solid in a file in the folder of the spec or below, counted in `tally`. Raises an error that names
    the fault."""
    raw = _bytes(name, folder, tally)
    found = solid(raw, name, unit, tally)
    tally.add("triangles", len(found.triangles) + found.flat)
    return found


def solid(raw: bytes, name: str, unit: str, tally: Tally) -> Solid:
    """The solid in the bytes of a file. Raises an error that names the fault."""

    def few(count: int, what: str) -> None:
        if message := tally.exceeded("triangles", count, f"{name}: {what}"):
            raise fail(message)

    corners, triangles = (obj if name.lower().endswith(".obj") else stl)(raw, name, few)
    if not len(triangles):
        raise fail(f"{name}: no triangles in it")
    if not np.isfinite(corners).all():
        bad = int(np.flatnonzero(~np.isfinite(corners).all(axis=1))[0])
        raise fail(f"{name}: corner {bad} is not finite")
    corners, triangles, flat = _merged(corners, triangles)
    if flat > MOST_FLAT * (len(triangles) + flat):
        raise fail(f"{name}: {flat} of {len(triangles) + flat} triangles have two corners in one place")
    _sized(corners, unit, name)
    _closed(corners, triangles, name)
    if signed_volume(corners, triangles) < 0.0:  # all of it is inside out
        triangles = triangles[:, ::-1].copy()
    if signed_volume(corners, triangles) <= 1e-9 * np.ptp(corners, axis=0).max() ** 3:
        raise fail(f"{name}: the surface is closed, but has no volume inside")
    if np.linalg.eigvalsh(moments(corners, triangles)[2]).min() <= 0.0:
        raise fail(f"{name}: the surface goes through itself: what is inside has no inertia")
    corners.setflags(write=False)
    triangles.setflags(write=False)
    return Solid(corners, triangles, flat, hashlib.sha256(raw).hexdigest())


def signed_volume(corners: Floats, triangles: Ints) -> float:
    """Volume inside a closed surface; negative where its triangles are seen clockwise from outside."""
    a, b, c = (corners[triangles[:, k]] - corners[triangles[0, 0]] for k in range(3))
    return float(np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0)


def moments(corners: Floats, triangles: Ints) -> tuple[float, Floats, Floats]:
    """Volume, its middle (3,), and the mean of r r^T over it about the middle (3, 3), of a closed surface.

    Sums over the tetrahedra of each triangle and the first corner. A tetrahedron with corners 0, a, b, c and
    volume V has the integral of r of V s/4, s = a + b + c; that of r r^T is
    V/20 (s s^T + a a^T + b b^T + c c^T).
    """
    base = corners[triangles[0, 0]]
    a, b, c = (corners[triangles[:, k]] - base for k in range(3))
    parts = np.einsum("ni,ni->n", a, np.cross(b, c)) / 6.0
    volume, s = float(parts.sum()), a + b + c
    middle = np.asarray(parts @ s) / (4.0 * volume)
    squares = sum(np.einsum("n,ni,nj->ij", parts, v, v) for v in (s, a, b, c)) / (20.0 * volume)
    place = base + middle
    place[np.abs(place) < 1e-12 * np.ptp(corners, axis=0).max()] = 0.0  # round-off of what is symmetric
    return volume, place, np.asarray(squares) - np.outer(middle, middle)


def _bytes(name: Any, folder: Any, tally: Tally) -> bytes:
    """Contents of a plain file; a device, a pipe or a folder is refused without waiting for it."""
    if not isinstance(name, str) or not _FILE.fullmatch(name) or ".." in name.split("/"):
        raise fail(
            f"{str(name)[:80]!r} is not a file in the folder of the spec or below; allowed: letters, digits, "
            "_ . - in each name, and / between"
        )
    if not name.lower().endswith((".stl", ".obj")):
        raise fail(f"{name}: neither .stl nor .obj")
    if folder is None:
        raise fail(f"{name}: only a scene that is itself read from a file can name one")
    try:
        inside = Path(folder).resolve()
        found = (inside / name).resolve()
        if not found.is_relative_to(inside):
            raise fail(f"{name}: leads out of the folder of the spec")
        handle = os.open(found, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with os.fdopen(handle, "rb") as stream:
            message = os.fstat(stream.fileno())
            if not stat.S_ISREG(message.st_mode):
                raise fail(f"{name}: is not a plain file")
            what = f"{name}: {message.st_size} bytes, {BYTES} to a triangle"
            if much := tally.exceeded("triangles", message.st_size, what, BYTES):
                raise fail(much)
            tally.add("triangles", message.st_size, BYTES)
            raw = stream.read(message.st_size + 1)
    except (OSError, RuntimeError) as error:  # RuntimeError: a link that leads to itself
        raise fail(f"{name}: cannot read: {getattr(error, 'strerror', None) or error}"[:300]) from None
    if len(raw) > message.st_size:
        raise fail(f"{name}: grows while it is read")
    return raw


def _sized(corners: Floats, unit: str, name: str) -> None:
    with np.errstate(over="ignore"):
        longest = float(np.ptp(corners, axis=0).max()) * SCALES[unit]
    low, high = SIZES
    if low <= longest <= high:
        return
    meant = [u for u, scale in SCALES.items() if low <= longest / SCALES[unit] * scale <= high]
    hint = f"; did you mean units: {meant[0]}?" if meant else ""
    raise fail(f"{name}: {longest:.4g} mm long in units: {unit}; allowed {low:g} to {high:g} mm{hint}")


def _merged(corners: Floats, triangles: Ints) -> tuple[Floats, Ints, int]:
    """Corners in one place as one, without those of no triangle, triangles that have two in one place left
    out, and how many those are."""
    corners = corners + 0.0  # no negative zeros
    order = np.lexsort(corners.T)
    ranked = corners[order]
    new = np.concatenate([[True], (ranked[1:] != ranked[:-1]).any(axis=1)])
    of = np.empty(len(corners), dtype=np.int64)
    of[order] = np.cumsum(new) - 1
    triangles = of[triangles]
    a, b, c = triangles.T
    whole = (a != b) & (b != c) & (c != a)
    used, triangles = np.unique(triangles[whole], return_inverse=True)
    return ranked[new][used], triangles.reshape(-1, 3), int((~whole).sum())


def _closed(corners: Floats, triangles: Ints, name: str) -> None:
    """Each side of a triangle must be that of one other, which has it the other way round."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = np.int64(len(corners))
    there, back = sides[:, 0] * count + sides[:, 1], sides[:, 1] * count + sides[:, 0]
    one, times = np.unique(there, return_counts=True)
    alone = ~np.isin(there, back)
    if alone.any():
        at = ", ".join(f"{v:.4g}" for v in corners[sides[np.argmax(alone)]].mean(axis=0))
        raise fail(
            f"{name}: not watertight: {int(alone.sum())} sides of triangles have no neighbour that is turned "
            f"the same way, one of them at {at}"
        )
    if (times > 1).any():
        side = divmod(int(one[np.argmax(times > 1)]), int(count))
        at = ", ".join(f"{v:.4g}" for v in corners[list(side)].mean(axis=0))
        raise fail(f"{name}: more than two triangles meet at one side, at {at}")
