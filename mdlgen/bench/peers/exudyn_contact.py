"""Contact in the Exudyn script, out of the items that Exudyn has.

It has none of a box and a cylinder. So a roller is one sphere of its radius over each row of boxes that it
covers, against two triangles on the box's face; rollers meet as spheres, and a box meets the plane by a small
sphere in its middle. The items have the exponent 1.5 and models of restitution, in place of Eq. 11; friction
rises linearly up to the smoothing speed.
"""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any

import numpy as np

from mdlgen.bench.peers.scene import lanes
from mdlgen.model.tables import BOX_CYLINDER, BOX_PLANE, CYLINDER_CYLINDER, Floats, Model

MM, GRAM, MS = 1e-3, 1e-3, 1e-3
HERTZ = 1e3**1.5  # N/mm^1.5 in SI
IMPACT = 2  # Gonthier, Carvalho and Martins: the most accurate restitution of the three that there are
# That model damps with the speed over the speed of the impact. A sphere that rolls from one triangle to the
# next meets it at no speed, so the least that counts must be a real impact's [m/s]; at 0.02 contact pulls.
SLOW = 0.5
# A box's triangles reach over its neighbours [mm]. Without, a sphere over a fold is nearest to an edge and
# loses both boxes; with the edges themselves in contact both would push at once over 2 mm.
OVERLAP = 0.1
# Edges of the triangles (0, 1, 2) and (0, 2, 3) of a face that are its ends along x, as Exudyn's flags.
LAST, FIRST = 2, 4


def contacts(mbs: Any, model: Model, boxes: list[Any], rollers: dict[str, Any], ground: Any) -> None:
    """Add an item for every contact of the Model; `boxes`, `rollers` and `ground` are Exudyn's bodies."""
    item, table, sheet = import_module("exudyn.itemInterface"), model.contacts, model.sheets[0]
    centers = [_marker(mbs, box) for box in boxes]
    for row in range(len(table)):
        kind, other = table.kind[row], table.part_b[row]
        if kind == CYLINDER_CYLINDER:
            names = (table.part_a[row], other)
            markers = [_marker(mbs, rollers[name]) for name in names]
            radii = [model.roller(name).radius * MM for name in names]
            _add(mbs, model, row, item.ObjectContactSphereSphere, markers, spheresRadii=radii)
        elif kind == BOX_PLANE:
            points, held = _plane(model, other), _marker(mbs, ground)
            for center in centers:
                _triangle(mbs, model, row, [center, held], sheet.thickness / 2, points)
        elif kind == BOX_CYLINDER:
            roller = model.roller(other)
            side = math.copysign(1.0, roller.center[2] - sheet.center[2])
            for lane in lanes(model, roller):
                sphere = _marker(mbs, rollers[other], (0.0, 0.0, lane.offset))
                for column in range(sheet.n_x):
                    box = sheet.body(column, lane.row)
                    first, last = column == 0, column == sheet.n_x - 1
                    faces = _face(model.bodies.half[box], side, first, last)
                    for points, edges in zip(faces, (last * LAST, first * FIRST), strict=True):
                        pair = [sphere, centers[box]]
                        _triangle(mbs, model, row, pair, roller.radius, points, lane.share, edges)


def _marker(mbs: Any, body: Any, at: Any = (0.0, 0.0, 0.0)) -> Any:
    kind = import_module("exudyn.itemInterface").MarkerBodyRigid
    return mbs.AddMarker(kind(bodyNumber=body, localPosition=np.array(at) * MM))


def _triangle(
    mbs: Any,
    model: Model,
    row: int,
    markers: list[Any],
    radius: float,
    points: list[Floats],
    share: float = 1.0,
    edges: int = 0,
) -> None:
    """A sphere and a triangle; `points` in axes of the second marker [mm]."""
    _add(
        mbs,
        model,
        row,
        import_module("exudyn.itemInterface").ObjectContactSphereTriangle,
        markers,
        share,
        sphereRadius=radius * MM,
        trianglePoints=import_module("exudyn").Vector3DList([point * MM for point in points]),
        includeEdges=edges,
    )


def _add(
    mbs: Any, model: Model, row: int, kind: Any, markers: list[Any], share: float = 1.0, **shape: Any
) -> None:
    """An item with the constants of a row of the Model's contacts."""
    data, table = import_module("exudyn.itemInterface").NodeGenericData, model.contacts
    mbs.AddObject(
        kind(
            markerNumbers=markers,
            nodeNumber=mbs.AddNode(data(numberOfDataCoordinates=4, initialCoordinates=[MM, 0.0, 0.0, 0.0])),
            contactStiffness=table.stiffness[row] * share * HERTZ,
            contactStiffnessExponent=1.5,
            restitutionCoefficient=table.restitution[row],
            minimumImpactVelocity=SLOW,
            impactModel=IMPACT,
            dynamicFriction=table.mu_dynamic[row],
            frictionProportionalZone=table.stiction_velocity[row] * MM / MS,
            **shape,
        )
    )


def _plane(model: Model, name: str) -> list[Floats]:
    """One triangle that is larger than the plane [mm]."""
    plane = next(plane for plane in model.planes if plane.name == name)
    face, far = plane.center + plane.normal * plane.size[2] / 2, 2 * max(plane.size)
    return [face + far * np.array(at) for at in ((-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (0.0, 1.0, 0.0))]


def _face(half: Floats, side: float, first: bool, last: bool) -> tuple[list[Floats], list[Floats]]:
    """The two triangles of a box's upper (side 1) or lower face (-1), in box axes [mm]."""
    low, high = -half[0] - OVERLAP * (not first), half[0] + OVERLAP * (not last)
    y, z = half[1], half[2] * side
    a, b, c, d = np.array([(low, -y, z), (high, -y, z), (high, y, z), (low, y, z)])
    return [a, b, c], [a, c, d]
