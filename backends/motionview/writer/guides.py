"""Rows of guides, and the names of the boxes that show them."""

from __future__ import annotations

from mdlgen.backends.motionview.writer.axes import axis_of, zx_vector
from mdlgen.backends.motionview.writer.rows import GuideView, Value
from mdlgen.model.tables import GuidePart, Model


def guide_view(model: Model, guide: GuidePart, given: list[Value]) -> GuideView:
    """One guide; the number of its boxes is fixed in a text."""
    straight = guide.radius == 0.0
    if straight:
        way = "($x_1-$x_0)^2+($y_1-$y_0)^2+($z_1-$z_0)^2"
        derived = [("L", "Length (mm)", f"sqrt({way})")]
    else:
        beyond = {1: "+$s", 2: "", 3: "+$s/2"}[guide.sides]
        derived = [
            ("n", "Boxes that show it; fixed in this text", str(guide.facets)),
            ("turn", "Angle of one of them", "($to-$from)*PI/180/$n"),
            ("R_o", "Greater radius of the plate (mm)", f"$R{beyond}"),
            ("chord", "Length of a box (mm)", "2*$R_o*tan($turn/2)"),
        ]
    return GuideView(
        name=guide.name,
        given=given,
        derived=derived,
        straight=straight,
        axis=axis_of(f"v_{guide.name}_axis", guide.axes[:, 2]),
        guide=zx_vector(guide.axes),
        off={1: "-$s/2", 2: "$s/2", 3: "0"}[guide.sides],
        facets=guide.facets,
    )


def guide_graphics(guide: GuidePart) -> list[str]:
    """Names of the boxes that show a guide."""
    return [f"gbox_{guide.name}_{k}" for k in range(guide.facets)]
