"""A beam through points: MotionView makes a body at each point, and beam forces between them."""

from __future__ import annotations

import math
from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.bodies import Body
from mdlgen.backends.motionview.reader.things.geometry import PartMarker
from mdlgen.backends.motionview.reader.things.solids import Mass
from mdlgen.backends.motionview.reader.things.thing import Thing
from mdlgen.backends.motionview.reader.things.vectors import GLOBAL, Axes, minus, unit
from mdlgen.backends.motionview.reader.world import Vector


class PolyBeam(Thing):
    """`*PolyBeam( name, label, point_1, point_2, ... )`."""

    kind = "PolyBeam"

    def p_points(self) -> list[Vector]:
        return [self.position(k) for k in range(2, len(self.statement.args))]

    def p_body(self) -> PolyBeam:
        """`beam.body@point` names one of the bodies."""
        return self

    def p_bodies(self) -> list[BeamBody]:
        return [BeamBody(self, k) for k in range(len(self.statement.args) - 2)]

    def markers(self) -> list[PartMarker]:
        """i and j of each stretch."""
        bodies, points = self.ask("bodies"), self.ask("points")
        return [
            BeamMarker(self, k, word, bodies[at], points[at])
            for k in range(len(points) - 1)
            for word, at in (("i", k), ("j", k + 1))
        ]

    def at(self, point: Any) -> BeamBody:
        """The body at a point."""
        where = self.world.vector(self.own(point))
        for body, place in zip(self.ask("bodies"), self.ask("points"), strict=True):
            if math.dist(place, where) < 1e-9:
                return body
        raise Trouble("evaluate", f"{self} does not pass that point")

    def p_section(self) -> tuple[float, float, float] | None:
        """Density [kg/mm3], outer and inner radius [mm] of a round section; None for others."""
        found = self.settings("setpolybeamprops")
        if not found or found[-1].statement.arg(1).upper() != "CIRCULAR":
            return None
        statement, scope = found[-1].statement, found[-1].scope
        numbers = [self.number(k, statement, scope) for k in (2, 5, 6)]
        return (numbers[0], numbers[1] / 2, numbers[2] / 2)


class BeamMarker(PartMarker):
    """An end of a stretch. Its axes follow the bends of the beam by a rule that is not known."""

    def __init__(self, beam: PolyBeam, stretch: int, word: str, body: BeamBody, origin: Vector):
        title = f"Beam {stretch}-Marker {word.upper()}"
        super().__init__(beam, f"beam{stretch}.{word}", title, lambda: body, lambda: origin)

    def record(self) -> dict[str, Any]:
        return {
            "label": self.ask("label"),
            "body": self.ask("body").name,
            "origin": self.ask("origin"),
            "axes": None,
        }


class BeamBody(Body):
    """One of its bodies: the halves of the stretches on both sides, about the point."""

    def __init__(self, beam: PolyBeam, index: int):
        super().__init__(beam.world, beam.declaration, beam.side)
        self.beam = beam
        self.index = index
        self.call(f"{beam.base}.body{index}")

    def p_label(self) -> str:
        return f"{self.beam.ask('label')}-Body {self.index}"

    def p_from_graphics(self) -> bool:
        return False

    def p_cm_axes(self) -> Axes:
        return GLOBAL

    def _cm_point(self) -> Vector:
        return self.beam.ask("points")[self.index]

    def _reference(self) -> Vector:
        return (0.0, 0.0, 0.0)

    def p_properties(self) -> Mass | None:
        section = self.beam.ask("section")
        if section is None:
            return None
        density, outer, inner = section
        points: list[Vector] = self.beam.ask("points")
        own = points[self.index]
        mass, moments = 0.0, [[0.0] * 3 for _ in range(3)]
        for other in (self.index - 1, self.index + 1):
            if not 0 <= other < len(points):
                continue
            stretch = minus(points[other], own)
            half = math.hypot(*stretch) / 2
            axis = unit(stretch)
            part = density * math.pi * (outer**2 - inner**2) * half
            across = (outer**2 + inner**2) / 4
            mass += part
            for i in range(3):
                for j in range(3):
                    moments[i][j] += part * (half**2 / 3 - across) * axis[i] * axis[j]
                moments[i][i] += part * across
        xx, yy, zz = moments[0][0], moments[1][1], moments[2][2]
        products = (moments[0][1], moments[1][2], moments[0][2])
        return Mass(mass, own, (yy + zz, xx + zz, xx + yy, *products))
