"""Rows of guides, and the names of the boxes that show them."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.backends.motionview.writer.axes import axis_of, zx_vector
from mdlgen.backends.motionview.writer.moving import MovingView, moving_derived, moving_view
from mdlgen.backends.motionview.writer.parts.kind import Kind, PartView
from mdlgen.backends.motionview.writer.rows import Axis, Value
from mdlgen.model.tables import GuidePart, Model


@dataclass(frozen=True)
class GuideView(PartView):
    """One guide."""

    template = "guide.mdl.j2"
    moving: MovingView | None
    derived: list[tuple[str, str, str]]
    straight: bool
    axis: Axis
    guide: str  # global vector that fixes where the angles of an arc are counted from
    off: str  # middle of a straight plate, along its normal
    facets: int


class _Guides(Kind[GuidePart]):
    def view(self, model: Model, part: GuidePart, given: list[Value]) -> GuideView:
        """One guide; the number of its boxes is fixed in a text."""
        straight, members = part.radius == 0.0, {value.member for value in given}
        moving = moving_view(part.name, part.moving, f"p_{part.name}", members, "$M")
        if straight:
            way = "($x_1-$x_0)^2+($y_1-$y_0)^2+($z_1-$z_0)^2"
            derived = [("L", "Length (mm)", f"sqrt({way})")]
        else:
            beyond = {1: "+$s", 2: "", 3: "+$s/2"}[part.sides]
            derived = [
                ("n", "Boxes that show it; fixed in this text", str(part.facets)),
                ("turn", "Angle of one of them", "($to-$from)*PI/180/$n"),
                ("R_o", "Greater radius of the plate (mm)", f"$R{beyond}"),
                ("chord", "Length of a box (mm)", "2*$R_o*tan($turn/2)"),
            ]
        derived += moving_derived(members)
        return GuideView(
            name=part.name,
            given=given,
            moving=moving,
            derived=derived,
            straight=straight,
            axis=axis_of(f"v_{part.name}_axis", part.axes[:, 2]),
            guide=zx_vector(part.axes),
            off={1: "-$s/2", 2: "$s/2", 3: "0"}[part.sides],
            facets=part.facets,
        )

    def graphics(self, part: GuidePart) -> list[str]:
        return [f"gbox_{part.name}_{k}" for k in range(part.facets)]


KIND = _Guides()
