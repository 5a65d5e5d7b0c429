"""Triangles as STL (binary or ASCII) and Wavefront OBJ files have them.

Bytes of strangers: how many triangles there are, and how long a line is, is looked at before either is taken
apart, so that no file takes more than some ten times its size.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Iterator
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from mdlgen.spec.strict import fail

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# Raises the error for so many triangles, if that is too many; named as what they are counted.
Few = Callable[[int, str], None]

MOST_LINES = 10  # of an OBJ file for each triangle that is allowed
MOST_IN_LINE = 100_000  # bytes
MOST_IN_WORD = 64  # letters
_HEAD, _EACH = 84, 50  # bytes of a binary STL file: header and count, each triangle
_AT_ONCE = 2000  # triangles in ASCII whose words are parsed together, to save memory
_WORDS = {0: b"facet", 1: b"normal", 5: b"outer", 6: b"loop", 7: b"vertex", 11: b"vertex", 15: b"vertex"}
_WORDS |= {19: b"endloop"}
_FACET = 20  # words of a triangle in ASCII before its endfacet
_CORNERS = [8, 9, 10, 12, 13, 14, 16, 17, 18]
_LINE = re.compile(rb"[^\r\n]*(?:\r\n?|\n|\Z)")
# keywords of an OBJ file without effect on the surface
_IGNORED = frozenset((b"vn", b"vt", b"vp", b"o", b"g", b"s", b"mtllib", b"usemtl", b"l", b"p"))


def stl(raw: bytes, name: str, few: Few) -> tuple[Floats, Ints]:
    """Corners (n, 3) and triangles (m, 3), each with corners of its own."""
    claimed = struct.unpack_from("<I", raw, _HEAD - 4)[0] if len(raw) >= _HEAD else 0
    if raw[:5].lower() == b"solid" and b"facet" in raw[:4096] and len(raw) != _HEAD + _EACH * claimed:
        corners = _ascii(raw, name, few)
    else:
        if len(raw) < _HEAD:
            raise fail(f"{name}: {len(raw)} bytes are too few for an STL file")
        if len(raw) != _HEAD + _EACH * claimed:
            raise fail(
                f"{name}: claims {claimed} triangles, which are {_HEAD + _EACH * claimed} bytes; "
                f"the file has {len(raw)}"
            )
        few(claimed, "triangles")
        kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("attribute", "<u2")])
        table = np.frombuffer(raw, kind, claimed, _HEAD)["corners"]
        with np.errstate(invalid="ignore"):  # what is no number is reported later
            corners = table.astype(float).reshape(-1, 3)
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)


def _ascii(raw: bytes, name: str, few: Few) -> Floats:
    text = raw.lower()
    begin, end = text.find(b"\n"), text.rfind(b"endsolid")
    if begin < 0 or end < begin:
        raise fail(f"{name}: begins with solid and has no endsolid")
    few(text.count(b"endfacet", begin, end), "triangles")
    *facets, rest = text[begin:end].split(b"endfacet")
    parts = [np.zeros((0, 9))]
    for first in range(0, len(facets), _AT_ONCE):
        some = [facet.split(None, _FACET) for facet in facets[first : first + _AT_ONCE]]
        for number, words in enumerate(some, first):
            if len(words) != _FACET:
                raise fail(
                    f"{name}: facet {number}: not one solid of facets with three corners each (ASCII STL)"
                )
        if max(map(len, chain.from_iterable(some))) > MOST_IN_WORD:
            raise fail(f"{name}: a word of more than {MOST_IN_WORD} letters (ASCII STL)")
        table = np.array(some)
        for column, word in _WORDS.items():
            wrong = np.flatnonzero(table[:, column] != word)
            if len(wrong):
                raise fail(f"{name}: facet {first + int(wrong[0])}: {word.decode()!r} is due (ASCII STL)")
        try:
            parts.append(np.array([_number(w) for w in table[:, _CORNERS].ravel().tolist()]).reshape(-1, 9))
        except ValueError:
            raise fail(f"{name}: a coordinate of an ASCII STL file is not a number") from None
    if rest.strip():
        raise fail(f"{name}: not one solid of facets with three corners each (ASCII STL)")
    return np.concatenate(parts).reshape(-1, 3)


def _number(word: bytes) -> float:
    """Raises ValueError, also for 1_000, which Python reads."""
    if b"_" in word:
        raise ValueError(word)
    return float(word)


def obj(raw: bytes, name: str, few: Few) -> tuple[Floats, Ints]:
    """Vertices (n, 3) and triangles (m, 3); faces of more than three corners as fans."""
    few((raw.count(b"\n") + raw.count(b"\r")) // MOST_LINES, f"lines, {MOST_LINES} to a triangle")
    vertices = faces = 0
    for _, words in _lines(raw, name):
        vertices += words[0] == b"v"
        faces += len(words) - 3 if words[0] == b"f" else 0
    few(max(faces, vertices // 3), "triangles, or thirds of vertices")
    corners: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    for here, words in _lines(raw, name):
        if words[0] in _IGNORED:
            continue
        try:
            if words[0] == b"v" and len(words) >= 4:
                corners.append([_number(w) for w in words[1:4]])
                continue
            if words[0] == b"f" and len(words) >= 4:
                triangles += _fan(words[1:], len(corners), f"{name}:{here}")
                continue
        except ValueError as error:
            if hasattr(error, "context"):
                raise
            raise fail(f"{name}:{here}: a number is due") from None
        what = words[0][:20].decode("ascii", "replace")
        raise fail(f"{name}:{here}: {what!r} is not read; v and f are")
    return np.array(corners, dtype=float).reshape(-1, 3), np.array(triangles, dtype=np.int64).reshape(-1, 3)


def _lines(raw: bytes, name: str) -> Iterator[tuple[int, list[bytes]]]:
    """Number and words of each line that has some."""
    for number, found in enumerate(_LINE.finditer(raw), 1):
        if found.end() - found.start() > MOST_IN_LINE:
            raise fail(f"{name}:{number}: a line of more than {MOST_IN_LINE} bytes")
        words = found[0].split(b"#", 1)[0].split()
        if words:
            yield number, words


def _fan(words: list[bytes], count: int, here: str) -> list[tuple[int, int, int]]:
    """Triangles of a face, whose corners are numbered from 1, or from the last vertex back."""
    if any(b"_" in w for w in words):
        raise ValueError(words)
    face = [int(w.split(b"/", 1)[0]) for w in words]
    face = [k - 1 if k > 0 else count + k for k in face]
    if min(face) < 0 or max(face) >= count:
        raise fail(f"{here}: a face names a vertex that is not there")
    return [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
