"""Boxes, round their marker."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.msolve.forms import form
from mdlgen.backends.msolve.reader.frames import frame, label, on
from mdlgen.backends.msolve.reader.shapes.kind import Shape

if TYPE_CHECKING:
    from mdlgen.backends.msolve.reader.standin import Thing


def _record(box: Thing) -> dict[str, Any]:
    center, axes = frame(box.cm)
    lengths = tuple(float(box.given[a]) for a in "xyz")
    record = {"label": label(box), "type": "BOX", "body": on(box.cm)}
    return {**record, "center": center, "axes": axes, "lengths": lengths}


SHAPE = Shape(
    "Box",
    form(
        "box_msapi.htm",
        documented="label:text cm:Marker x:number y:number z:number refinement_level:count",
        needed="cm x y z",
    ),
    _record,
)
