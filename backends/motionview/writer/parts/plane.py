"""Rows of planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.backends.motionview.writer.axes import axis_of, components, zx_vector
from mdlgen.backends.motionview.writer.moving import (
    MovingView,
    StopsView,
    moving_derived,
    moving_view,
    stops_derived,
    stops_view,
)
from mdlgen.backends.motionview.writer.parts.kind import Kind, PartView
from mdlgen.backends.motionview.writer.rows import Axis, Value
from mdlgen.model.tables import Model, PlanePart


@dataclass(frozen=True)
class PlaneView(PartView):
    """One plane."""

    template = "plane.mdl.j2"
    moving: MovingView | None
    normal: Axis
    guide: str
    pressed: bool
    press: tuple[str, str, str]
    stops: StopsView | None  # of its press
    derived: list[tuple[str, str, str]]
    mass: str  # formula of all that slides


class _Planes(Kind[PlanePart]):
    def view(self, model: Model, part: PlanePart, given: list[Value]) -> PlaneView:
        """One plane; its body has z along the normal."""
        press, members = part.press, {value.member for value in given}
        mass = "($M+$M_c)" if "M_c" in members else "$M"
        stops = None
        if press is not None and press.stops is not None:
            name = part.name
            stops = stops_view(name, f"j_{name}_slide", False, f"b_{name}", f"p_{name}", "$start")
        return PlaneView(
            name=part.name,
            given=given,
            moving=moving_view(part.name, part.moving, f"p_{part.name}", members, "$M"),
            stops=stops,
            derived=stops_derived(members, mass) if press is not None else moving_derived(members),
            normal=axis_of(f"v_{part.name}_normal", part.normal),
            guide=zx_vector(model.bodies.rotation[part.body]),
            pressed=press is not None,
            press=components(press.direction if press is not None else np.zeros(3)),
            mass=mass,
        )

    def graphics(self, part: PlanePart) -> list[str]:
        return [f"gbox_{part.name}"]


KIND = _Planes()
