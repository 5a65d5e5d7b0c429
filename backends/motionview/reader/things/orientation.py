"""Axes by *SetOrientation: two axes, one axis or angles, by points, vectors or three numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things.thing import Chosen, Thing, mirrored
from mdlgen.backends.motionview.reader.things.vectors import Axes, minus, one_axis, two_axes
from mdlgen.backends.motionview.reader.world import Vector

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Scope


class Directions:
    """Reads directions from the arguments of a statement, from one argument on."""

    def __init__(self, thing: Thing, origin: Vector, statement: Statement, scope: Scope, at: int):
        self.thing = thing
        self.origin = origin
        self.statement = statement
        self.scope = scope
        self.at = at

    def word(self) -> str:
        """The next argument as a keyword."""
        self.at += 1
        return self.statement.arg(self.at - 1).upper()

    def number(self) -> float:
        """The next argument as a number."""
        self.at += 1
        return self.thing.number(self.at - 1, self.statement, self.scope)

    def direction(self) -> Vector:
        """POINT, p | VECTOR, v | DXDYDZ, x, y, z. Raises Trouble where it has no length."""
        begin = self.at
        kind = self.word()
        if kind == "DXDYDZ":
            found = (self.number(), self.number(), self.number())
        elif kind == "POINT":
            self.at += 1
            found = minus(self.thing.position(self.at - 1, self.statement, self.scope), self.origin)
        elif kind == "VECTOR":
            self.at += 1
            value = self.thing.given(self.at - 1, self.statement, self.scope)
            found = self.thing.world.vector(value)
        else:
            raise self.trouble("keyword", f"POINT, VECTOR or DXDYDZ is due here, not {kind}", begin)
        if not any(found):
            raise self.trouble("direction", "this direction has no length", begin)
        return found

    def trouble(self, code: str, message: str, at: int) -> Trouble:
        """An error at an argument."""
        made = Trouble(code, message)
        made.place = self.statement.place(at)
        return made


def axes(thing: Thing, twin_origin: Vector, origin: Vector, chosen: Chosen) -> Axes:
    """The axes that a SetOrientation sets for `thing`, which is at `origin`.

    A pair that is set on one side has the mirrored directions on the other; the third axis makes both
    right-handed (seen in decks).
    """
    source = thing.twin() if chosen.mirrored else thing
    at = twin_origin if chosen.mirrored else origin
    reader = Directions(source, at, chosen.statement, chosen.scope, chosen.first)
    if chosen.side == "r" and chosen.first == 2 and not chosen.mirrored and not chosen.statement.arg(1):
        _skip_left(reader)
    begin = reader.at
    try:
        if "POINT" in chosen.statement.args:
            return _axes(reader, chosen.mirrored)
        arguments = chosen.statement.args[begin:]
        key = ("axes", chosen.mirrored, arguments)
        return thing.shared(chosen.scope, key, lambda: _axes(reader, chosen.mirrored))
    except Trouble as trouble:
        if trouble.place is None:
            trouble.place = chosen.statement.place(begin)
        raise


def _skip_left(reader: Directions) -> None:
    """Skips the left half of a statement for both sides."""
    mode = reader.word()
    if mode == "ANGLES":
        reader.at += 4
        return
    reader.at += 1
    for _ in range(2 if mode == "TWOAXES" else 1):
        reader.at += 4 if reader.statement.arg(reader.at).upper() == "DXDYDZ" else 2


def _axes(reader: Directions, mirror: bool) -> Axes:
    begin = reader.at
    mode = reader.word()
    if mode == "ANGLES":
        return _angles(reader, mirror)
    code = reader.word()
    if mode == "TWOAXES" and len(code) == 2 and code[0] != code[1] and set(code) <= set("XYZ"):
        a, b = reader.direction(), reader.direction()
        return two_axes(code, mirrored(a), mirrored(b)) if mirror else two_axes(code, a, b)
    if mode == "ONEAXIS" and code in ("X", "Y", "Z"):
        a = reader.direction()
        return one_axis(code, mirrored(a) if mirror else a)
    message = f"TWOAXES, ZX, ... or ONEAXIS, Z, ... or ANGLES, marker, ... is due here, not {mode}, {code}"
    raise reader.trouble("keyword", message, begin)


def _angles(reader: Directions, mirror: bool) -> Axes:
    """Body-fixed 3-1-3 angles in degrees, from the axes of a marker."""
    reader.at += 1
    marker = reader.thing.given(reader.at - 1, reader.statement, reader.scope)
    _, (x, y, z) = reader.thing.world.frame(marker)
    begin = reader.at
    degrees = [reader.number() for _ in range(3)]
    if any(degrees) and all(abs(d) <= 2 * math.pi for d in degrees) and "PI" in _text(reader, begin).upper():
        message = "these angles look like radians; ANGLES are in degrees"
        reader.thing.world.notes.add("warning", "angle", reader.statement.place(begin), message)
    psi, theta, phi = (math.radians(d) for d in degrees)
    x, y = _turned(x, y, psi)
    y, z = _turned(y, z, theta)
    x, y = _turned(x, y, phi)
    if mirror:  # mirrored X and Z; Y so that the axes stay right-handed
        x, z = mirrored(x), mirrored(z)
        return two_axes("ZX", z, x)
    return (x, y, z)


def _turned(a: Vector, b: Vector, angle: float) -> tuple[Vector, Vector]:
    c, s = math.cos(angle), math.sin(angle)
    first = (c * a[0] + s * b[0], c * a[1] + s * b[1], c * a[2] + s * b[2])
    return first, (c * b[0] - s * a[0], c * b[1] - s * a[1], c * b[2] - s * a[2])


def _text(reader: Directions, begin: int) -> str:
    return " ".join(reader.statement.args[begin : begin + 3])
