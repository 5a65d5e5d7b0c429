"""Graphics: boxes, cylinders (cut cones) and spheres with their numbers; others by their type alone."""

from __future__ import annotations

import math
from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.orientation import Directions
from mdlgen.backends.motionview.reader.things.solids import Mass, box, frustum, sphere
from mdlgen.backends.motionview.reader.things.thing import Thing
from mdlgen.backends.motionview.reader.things.vectors import (
    GLOBAL,
    Axes,
    along,
    minus,
    round_axes,
    two_axes,
    unit,
)
from mdlgen.backends.motionview.reader.world import Vector

CAPS = {"CAPBOTH", "CAPBEGIN", "CAPEND", "CAPNONE"}


class Graphic(Thing):
    """`*Graphic( name, label, type, body, ... )`."""

    kind = "Graphic"

    @property
    def shape(self) -> str:
        """BOX, CYLINDER, SPHERE or another word."""
        return self.statement.arg(2).upper()

    def p_body(self) -> Any:
        if self.shape in ("BOX", "CYLINDER", "SPHERE", "FILE", "CADGRAPHIC", "TIRE"):
            return self.related(3, "Body")
        return None

    def p_solid(self) -> Mass | None:
        """Mass properties of the solid, of steel."""
        if self.shape == "BOX":
            return box(self.ask("origin"), self.ask("axes"), self.ask("lengths"))
        if self.shape == "SPHERE":
            return sphere(self.ask("origin"), GLOBAL, self.ask("r1"))
        if self.shape == "CYLINDER":
            return frustum(
                self.ask("origin"), self.ask("axes"), self.ask("r1"), self.ask("r2"), self.ask("length")
            )
        return None

    # -- place

    def p_origin(self) -> Vector:
        """Centre of a box or a sphere, start of a cylinder."""
        if self.shape == "SPHERE":
            return self.position(4)
        if self.shape == "CYLINDER":
            return along(self.position(4), self.ask("axes")[2], self.number(10))
        if self.shape == "BOX":
            return self.ask("box")[0]
        raise Trouble("property", f"{self} has no origin that is known", severity="warning")

    def p_axes(self) -> Axes:
        if self.shape == "BOX":
            return self.ask("box")[1]
        if self.shape == "CYLINDER":
            z = unit(self._reader(5, self.position(4)).direction())
            return round_axes(z)
        return GLOBAL

    # -- sizes

    def p_lengths(self) -> Vector:
        """Lengths of a box along its own axes [mm]."""
        return self.ask("box")[2]

    def p_r1(self) -> float:
        """Radius of a sphere, or of a cylinder where it starts [mm]."""
        return self.number(7 if self.shape == "CYLINDER" else 5)

    p_radius = p_r1

    def p_r2(self) -> float:
        """Radius where a cylinder ends [mm]."""
        return self.number(8)

    def p_length(self) -> float:
        """Of a cylinder; left out, it is the distance of the two points [mm]."""
        if self.statement.arg(9) or self.statement.arg(5).upper() != "POINT":
            return self.number(9)
        return math.hypot(*minus(self.position(6), self.position(4)))

    def p_offset(self) -> float:
        return self.number(10)

    def p_box(self) -> tuple[Vector, Axes, Vector]:
        """Centre, axes and lengths of a box: by its centre, a corner, or the middles of two faces."""
        word = self.statement.arg(4).upper()
        code = self.statement.arg(6).upper()
        if word in ("CENTER", "CORNER"):
            origin = self.position(5)
            arguments = self.statement.args[6:]
            if "POINT" in arguments:
                axes, lengths = self._by_center(code, origin)
            else:
                key = ("box", arguments)
                axes, lengths = self.shared(self.scope, key, lambda: self._by_center(code, origin))
            if word == "CORNER":
                for axis, length in zip(axes, lengths, strict=True):
                    origin = along(origin, axis, length / 2)
            return origin, axes, lengths
        if word == "FACE":
            first, second = self.position(5), self.position(7)
            axis = minus(second, first)
            reader = self._reader(8, first)
            axes = self._two_axes(code, axis, reader.direction(), 7)
            across = [reader.number(), reader.number()]
            sizes = [0.0, 0.0, 0.0]
            main = "XYZ".index(code[0])
            sizes[main] = math.hypot(*axis)
            for k in range(3):
                if k != main:
                    sizes[k] = across.pop(0)
            x, y, z = ((a + b) / 2 for a, b in zip(first, second, strict=True))
            return (x, y, z), axes, (sizes[0], sizes[1], sizes[2])
        raise Trouble("keyword", f"CENTER, CORNER or FACE is due in a box, not {word}")

    def _by_center(self, code: str, origin: Vector) -> tuple[Axes, Vector]:
        reader = self._reader(7, origin)
        axes = self._two_axes(code, reader.direction(), reader.direction(), 7)
        return axes, (reader.number(), reader.number(), reader.number())

    def _two_axes(self, code: str, a: Vector, b: Vector, at: int) -> Axes:
        if len(code) != 2 or code[0] == code[1] or not set(code) <= set("XYZ"):
            raise Trouble("keyword", f"two axes such as ZX are due in a box, not {code}")
        try:
            return two_axes(code, a, b)
        except Trouble as trouble:
            trouble.place = trouble.place or self.statement.place(at)
            raise

    def _reader(self, at: int, origin: Vector) -> Directions:
        return Directions(self, origin, self.statement, self.scope, at)

    def record(self) -> dict[str, Any]:
        body = self.ask("body")
        found: dict[str, Any] = {
            "label": self.ask("label"),
            "type": self.shape,
            "body": body.name if body is not None else None,
        }
        if self.shape in ("BOX", "CYLINDER", "SPHERE"):
            found["refinement"] = self.statement.args[-1]
        if self.shape == "BOX":
            center, axes, lengths = self.ask("box")
            found |= {"center": center, "axes": axes, "lengths": lengths}
        elif self.shape == "CYLINDER":
            found |= {
                "start": self.ask("origin"),
                "axis": self.ask("axes")[2],
                "radii": (self.ask("r1"), self.ask("r2")),
                "length": self.ask("length"),
                "caps": self.statement.arg(11).upper(),
            }
        elif self.shape == "CADGRAPHIC" and self.statement.arg(8).upper() == "MARKER":
            marker = self.related(9, "Marker")
            found |= {
                "file": self.statement.arg(6).strip('"'),
                "origin": marker.ask("origin") if marker is not None else None,
                "axes": marker.ask("axes") if marker is not None else None,
                "moved": tuple(self.number(k) for k in range(10, 16)),
                "scale": tuple(self.number(k) for k in range(16, 19)),
            }
        elif self.shape == "SPHERE":
            found |= {"center": self.ask("origin"), "radius": self.ask("r1")}
        return found
