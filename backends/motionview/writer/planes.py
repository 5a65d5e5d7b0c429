"""Rows of planes."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.motionview.writer.axes import axis_of, components, zx_vector
from mdlgen.backends.motionview.writer.rows import PlaneView, Value
from mdlgen.model.tables import Model, PlanePart


def plane_view(model: Model, plane: PlanePart, given: list[Value]) -> PlaneView:
    """One plane; its body has z along the normal."""
    press = plane.press
    return PlaneView(
        name=plane.name,
        given=given,
        normal=axis_of(f"v_{plane.name}_normal", plane.normal),
        guide=zx_vector(model.bodies.rotation[plane.body]),
        pressed=press is not None,
        press=components(press.direction if press is not None else np.zeros(3)),
        mass="($M+$M_c)" if any(value.member == "M_c" for value in given) else "$M",
    )


def plane_graphics(plane: PlanePart) -> list[str]:
    """Name of the box that shows a plane."""
    return [f"gbox_{plane.name}"]
