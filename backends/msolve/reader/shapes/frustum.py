"""Cylinders, from their marker along its z."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mdlgen.backends.msolve.forms import form
from mdlgen.backends.msolve.reader.frames import frame, label, on
from mdlgen.backends.msolve.reader.shapes.kind import Shape

if TYPE_CHECKING:
    from mdlgen.backends.msolve.reader.standin import Thing

_CAPS = {"CLOSED": "CAPBOTH"}


def _record(cylinder: Thing) -> dict[str, Any]:
    start, axes = frame(cylinder.cm)
    return {
        "label": label(cylinder),
        "type": "CYLINDER",
        "body": on(cylinder.cm),
        "start": start,
        "axis": axes[2],
        "radii": (float(cylinder.bottom), float(cylinder.top)),
        "length": float(cylinder.length),
        "caps": _CAPS.get(cylinder.given.get("end_caps", ""), ""),
    }


SHAPE = Shape(
    "Frustum",
    form(
        "frustrum_msapi.htm",
        documented="label:text cm:Marker top:number bottom:number length:number end_caps:CLOSED "
        "refinement_level:count",
        needed="cm top bottom length",
    ),
    _record,
)
