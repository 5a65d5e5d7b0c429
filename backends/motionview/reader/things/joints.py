"""Joints: their markers i and j, as a deck has them.

Rules of the axes were read from decks that MotionView exported: a revolute, translational or cylindrical
joint has Z along its axis on both sides; a universal joint has X along the shaft and Z along the cross pin;
an inline joint has its line as Z of j. With ALLOW_COMPLIANCE, and compliance switched on, the joint is a
bushing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.things.forces import Bush
from mdlgen.backends.motionview.reader.things.geometry import PartMarker
from mdlgen.backends.motionview.reader.things.orientation import Directions
from mdlgen.backends.motionview.reader.things.thing import Thing
from mdlgen.backends.motionview.reader.things.vectors import (
    GLOBAL,
    Axes,
    cross,
    minus,
    one_axis,
    round_axes,
    two_axes,
    unit,
)
from mdlgen.backends.motionview.reader.world import Vector

# kind: (type in the deck, form in which the arguments after the origin define the axes)
JOINTS = {
    "RevJoint": ("REVOLUTE", "axis"),
    "TransJoint": ("TRANSLATIONAL", "axis"),
    "CylJoint": ("CYLINDRICAL", "axis"),
    "PlanarJoint": ("PLANAR", "axis"),
    "FixedJoint": ("FIXED", ""),
    "BallJoint": ("SPHERICAL", ""),
    "UJoint": ("UNIVERSAL", "universal"),
    "CVJoint": ("CONSTANT_VELOCITY", "two"),
    "InlineJoint": ("INLINE", "inline"),
    "PerpAxesJoint": ("PERPENDICULAR", "each"),
    "ParallelAxesJoint": ("PARALLEL_AXES", "axis"),
}


class Joint(Thing):
    """`*...Joint( name, label, body_1, body_2, origin, ... )`."""

    kind = "Joint"

    def p_b1(self) -> Any:
        return self.related(2, "Body")

    def p_b2(self) -> Any:
        return self.related(3, "Body")

    def p_isbush(self) -> bool:
        """True if it is a bushing at present: it may be one, and the model's compliance is on."""
        if self.statement.args[-1].upper() != "ALLOW_COMPLIANCE":
            return False
        return self.scope.value_of("Op_Compliant").attribute("value", "value", 0) == "Yes"

    def p_bush(self) -> Bush:
        return Bush(self.world, self.declaration, self.side, "bush", self)

    def p_type(self) -> str:
        return JOINTS.get(self.declaration.kind, (self.declaration.kind, ""))[0]

    def p_origin(self) -> Vector:
        return self.position(4)

    def p_i(self) -> PartMarker:
        return self.ask("bush").ask("i") if self.ask("isbush") else self.ask("joint_i")

    def p_j(self) -> PartMarker:
        return self.ask("bush").ask("j") if self.ask("isbush") else self.ask("joint_j")

    def p_joint_i(self) -> PartMarker:
        return PartMarker(
            self,
            "joint_i",
            "Marker I",
            lambda: self.ask("b1"),
            lambda: self.ask("origin"),
            lambda: self.ask("sides")[0],
        )

    def p_joint_j(self) -> PartMarker:
        return PartMarker(
            self,
            "joint_j",
            "Marker J",
            lambda: self.ask("b2"),
            lambda: self.ask("origin_j"),
            lambda: self.ask("sides")[1],
        )

    def p_origin_j(self) -> Vector:
        """An inline joint by an origin has j there."""
        if self._layout() == "inline" and self.statement.arg(5).upper() == "ORIGIN":
            return self.position(7)
        return self.ask("origin")

    def p_sides(self) -> tuple[Axes, Axes]:
        """Axes of i and j."""
        layout = self._layout()
        return _LAYOUTS[layout](self) if layout else (GLOBAL, GLOBAL)

    def _layout(self) -> str:
        return JOINTS.get(self.declaration.kind, ("", ""))[1]

    def reader(self, at: int) -> Directions:
        """Directions from an argument on."""
        return Directions(self, self.ask("origin"), self.statement, self.scope, at)

    def markers(self) -> list[PartMarker]:
        """Markers of the joint in the deck."""
        return [self.ask("i"), self.ask("j")]

    def record(self) -> dict[str, Any]:
        free = not self._layout() or self._layout() == "universal"
        i: PartMarker = self.ask("i")
        return {
            "label": self.ask("label"),
            "type": "BUSHING" if self.ask("isbush") else self.ask("type"),
            "statement": self.statement.name,
            "bodies": (self.ask("b1").name, self.ask("b2").name),
            "origin": self.ask("origin"),
            "axis": None if free and not self.ask("isbush") else i.ask("axes")[2],
            "markers": tuple(m.name for m in self.markers()),
        }


def _axis(joint: Joint) -> tuple[Axes, Axes]:
    axes = one_axis("Z", joint.reader(5).direction())
    return axes, axes


def _each(joint: Joint) -> tuple[Axes, Axes]:
    reader = joint.reader(5)
    return one_axis("Z", reader.direction()), one_axis("Z", reader.direction())


def _two(joint: Joint) -> tuple[Axes, Axes]:
    """A constant velocity joint: Z of each side along its shaft. X as of cylinders: seen once, not proven."""
    reader = joint.reader(5)
    return round_axes(unit(reader.direction())), round_axes(unit(reader.direction()))


def _inline(joint: Joint) -> tuple[Axes, Axes]:
    word = joint.statement.arg(5).upper()
    if word == "ORIGIN":
        return GLOBAL, one_axis("Z", minus(joint.ask("origin"), joint.ask("origin_j")))
    if word == "AXIS":
        return GLOBAL, one_axis("Z", joint.reader(6).direction())
    raise Trouble("keyword", f"ORIGIN or AXIS is due in an inline joint, not {word}")


def _universal(joint: Joint) -> tuple[Axes, Axes]:
    """SHAFT or CROSSPIN for each side: a shaft is X of that side, a cross pin Z.

    The cross pin of i is square to both shafts (X_i x X_j), that of j is X_j x Z_i.
    """
    reader = joint.reader(5)
    words: list[str] = []
    vectors: list[Vector] = []
    for _ in range(2):
        words.append(reader.word())
        if words[-1] not in ("SHAFT", "CROSSPIN"):
            raise Trouble("keyword", f"SHAFT or CROSSPIN is due in a universal joint, not {words[-1]}")
        vectors.append(unit(reader.direction()))
    i_shaft, j_shaft = (w == "SHAFT" for w in words)
    if i_shaft and j_shaft:
        z_i = cross(vectors[0], vectors[1])
        if math.hypot(*z_i) < 1e-9:
            z_i = one_axis("X", vectors[0])[2]
        z_i = unit(z_i)
        return two_axes("XZ", vectors[0], z_i), two_axes("XZ", vectors[1], cross(vectors[1], z_i))
    if i_shaft:
        z_i = cross(vectors[0], vectors[1])
        return two_axes("XZ", vectors[0], z_i), two_axes("ZX", vectors[1], z_i)
    if j_shaft:
        z_j = cross(vectors[1], vectors[0])
        return two_axes("ZX", vectors[0], z_j), two_axes("XZ", vectors[1], z_j)
    return two_axes("ZX", vectors[0], vectors[1]), two_axes("ZX", vectors[1], vectors[0])


_LAYOUTS: dict[str, Callable[[Joint], tuple[Axes, Axes]]] = {
    "axis": _axis,
    "each": _each,
    "two": _two,
    "inline": _inline,
    "universal": _universal,
}
