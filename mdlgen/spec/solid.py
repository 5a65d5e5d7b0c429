"""Solids from files: STL (binary or ASCII) and Wavefront OBJ, checked as they are read.

A file is refused before it is read where it is too large, no plain file, or does not have the size that its
header claims; then where a number is not finite, a triangle has no neighbour on a side (the surface is not
watertight) or is turned against it, and where the size is not that of a part of a paper machine, which tells
of a wrong unit. Corners that are exactly the same are one. Triangles with two corners in one place carry
nothing and are left out.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.spec.fields import fail

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_BYTES = 25_000_000
MOST_TRIANGLES = 100_000
MOST_FLAT = 0.01  # part of the triangles that may have two corners in one place
SIZES = (0.5, 3000.0)  # of the longest side that a part of a machine has [mm]
SCALES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

_HEAD, _EACH = 84, 50  # bytes of a binary STL file: header and count, each triangle
_FACET = 21  # words of a triangle in ASCII
_AT_ONCE = 2000  # triangles whose words are looked at together, to save memory
_WORDS = {0: b"facet", 1: b"normal", 5: b"outer", 6: b"loop", 7: b"vertex", 11: b"vertex", 15: b"vertex"}
_WORDS |= {19: b"endloop", 20: b"endfacet"}
_CORNERS = [8, 9, 10, 12, 13, 14, 16, 17, 18]
_FILE = re.compile(r"[A-Za-z0-9_.-]{1,100}(?:/[A-Za-z0-9_.-]{1,100}){0,9}")
# of an OBJ file, what says nothing of the surface
_IGNORED = frozenset((b"vn", b"vt", b"vp", b"o", b"g", b"s", b"mtllib", b"usemtl", b"l", b"p"))


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


def read_solid(name: Any, folder: Any, unit: str) -> Solid:
    """The solid in a file beside the spec or below. Raises the error that says what is wrong with it."""
    raw = _bytes(name, folder)
    if name.lower().endswith(".obj"):
        corners, triangles = _obj(raw, name)
    else:
        corners, triangles = _stl(raw, name)
    if not len(triangles):
        raise fail(f"{name}: no triangles in it")
    if not np.isfinite(corners).all():
        bad = int(np.flatnonzero(~np.isfinite(corners).all(axis=1))[0])
        raise fail(f"{name}: corner {bad} is not finite")
    _sized(corners, unit, name)
    corners, triangles, flat = _merged(corners, triangles)
    if flat > MOST_FLAT * (len(triangles) + flat):
        raise fail(f"{name}: {flat} of {len(triangles) + flat} triangles have two corners in one place")
    _closed(corners, triangles, name)
    if signed_volume(corners, triangles) < 0.0:  # all of it is inside out
        triangles = triangles[:, ::-1].copy()
    if signed_volume(corners, triangles) <= 1e-9 * np.ptp(corners, axis=0).max() ** 3:
        raise fail(f"{name}: the surface is closed, but has no volume inside")
    corners.setflags(write=False)
    triangles.setflags(write=False)
    return Solid(corners, triangles, flat, hashlib.sha256(raw).hexdigest())


def signed_volume(corners: Floats, triangles: Ints) -> float:
    """Volume inside a closed surface; negative where its triangles are seen clockwise from outside."""
    a, b, c = (corners[triangles[:, k]] - corners[triangles[0, 0]] for k in range(3))
    return float(np.einsum("ni,ni->", a, np.cross(b, c)) / 6.0)


def _bytes(name: Any, folder: Any) -> bytes:
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
            told = os.fstat(stream.fileno())
            if not stat.S_ISREG(told.st_mode):
                raise fail(f"{name}: is not a plain file")
            if told.st_size > MOST_BYTES:
                raise fail(f"{name}: {told.st_size} bytes; allowed are {MOST_BYTES}")
            raw = stream.read(MOST_BYTES + 1)
    except (OSError, RuntimeError) as error:  # RuntimeError: a link that leads to itself
        raise fail(f"{name}: cannot read: {getattr(error, 'strerror', None) or error}"[:300]) from None
    if len(raw) > MOST_BYTES:
        raise fail(f"{name}: more than {MOST_BYTES} bytes")
    return raw


def _few(count: int, name: str) -> None:
    if count > MOST_TRIANGLES:
        raise fail(f"{name}: {count} triangles; allowed are {MOST_TRIANGLES}")


def _stl(raw: bytes, name: str) -> tuple[Floats, Ints]:
    """Corners and triangles, each with corners of its own."""
    claimed = struct.unpack_from("<I", raw, _HEAD - 4)[0] if len(raw) >= _HEAD else 0
    if raw[:5].lower() == b"solid" and b"facet" in raw[:4096] and len(raw) != _HEAD + _EACH * claimed:
        corners = _ascii(raw, name)
    else:
        if len(raw) < _HEAD:
            raise fail(f"{name}: {len(raw)} bytes are too few for an STL file")
        if len(raw) != _HEAD + _EACH * claimed:
            raise fail(
                f"{name}: claims {claimed} triangles, which are {_HEAD + _EACH * claimed} bytes; "
                f"the file has {len(raw)}"
            )
        _few(claimed, name)
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("attribute", "<u2")])
        corners = np.frombuffer(raw, kind, claimed, _HEAD)["corners"].astype(float).reshape(-1, 3)
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)


def _ascii(raw: bytes, name: str) -> Floats:
    text = raw.lower()
    begin, end = text.find(b"\n"), text.rfind(b"endsolid")
    if text.count(b"facet normal") > MOST_TRIANGLES:
        _few(text.count(b"facet normal"), name)
    if begin < 0 or end < begin:
        raise fail(f"{name}: begins with solid and has no endsolid")
    words = text[begin:end].split()
    if len(words) % _FACET or b"solid" in words:
        raise fail(f"{name}: not one solid of facets with three corners each (ASCII STL)")
    parts = [np.zeros((0, 9))]
    for first in range(0, len(words), _FACET * _AT_ONCE):
        table = np.array(words[first : first + _FACET * _AT_ONCE], dtype="S32").reshape(-1, _FACET)
        for column, word in _WORDS.items():
            wrong = np.flatnonzero(table[:, column] != word)
            if len(wrong):
                facet = first // _FACET + int(wrong[0])
                raise fail(f"{name}: facet {facet}: {word.decode()!r} is due (ASCII STL)")
        try:
            parts.append(table[:, _CORNERS].astype(float))
        except ValueError:
            raise fail(f"{name}: a coordinate of an ASCII STL file is not a number") from None
    return np.concatenate(parts).reshape(-1, 3)


def _obj(raw: bytes, name: str) -> tuple[Floats, Ints]:
    """Vertices and faces; faces of more than three corners as fans."""
    corners: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    for number, line in enumerate(raw.splitlines(), 1):
        words = line.split(b"#", 1)[0].split()
        if not words or words[0] in _IGNORED:
            continue
        here = f"{name}:{number}"
        try:
            if words[0] == b"v" and len(words) >= 4:
                corners.append([float(w) for w in words[1:4]])
                continue
            if words[0] == b"f" and len(words) >= 4:
                face = [int(w.split(b"/", 1)[0]) for w in words[1:]]
                face = [k - 1 if k > 0 else len(corners) + k for k in face]
                if min(face) < 0 or max(face) >= len(corners):
                    raise fail(f"{here}: a face names a vertex that is not there")
                triangles += [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
                _few(len(triangles), name)
                continue
        except (ValueError, OverflowError) as error:
            if hasattr(error, "context"):
                raise
            raise fail(f"{here}: a number is due") from None
        raise fail(f"{here}: {words[0][:20].decode('ascii', 'replace')!r} is not read; v and f are")
    return np.array(corners, dtype=float).reshape(-1, 3), np.array(triangles, dtype=np.int64).reshape(-1, 3)


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
    """Corners in one place as one, triangles that have two in one place left out, and how many those are."""
    corners = corners + 0.0  # no negative zeros
    order = np.lexsort(corners.T)
    ranked = corners[order]
    new = np.concatenate([[True], (np.diff(ranked, axis=0) != 0.0).any(axis=1)])
    of = np.empty(len(corners), dtype=np.int64)
    of[order] = np.cumsum(new) - 1
    triangles = of[triangles]
    a, b, c = triangles.T
    whole = (a != b) & (b != c) & (c != a)
    return ranked[new], triangles[whole], int((~whole).sum())


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
