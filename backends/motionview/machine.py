"""Rows of the machine: rollers, planes, guides, meshes, contacts and the pairs of bodies that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from backends.motionview.cells import rough_boxes
from backends.motionview.rows import (
    Axis,
    ContactView,
    GuideView,
    MeshView,
    Pair,
    PlaneView,
    RollerView,
    Value,
)
from backends.motionview.units import number
from mdlgen.model.tables import Floats, GuidePart, MeshPart, Model, PlanePart, RollerPart


def roller_view(model: Model, roller: RollerPart, given: list[Value]) -> RollerView:
    """One roller; its body has z along the axis."""
    press = roller.press
    return RollerView(
        name=roller.name,
        given=given,
        axis=_axis(f"v_{roller.name}_axis", roller.axis),
        guide=_guide(model.bodies.rotation[roller.body]),
        driven=roller.speed is not None,
        ramped=roller.ramp > 0.0,
        corners=0 if roller.profile is None else len(roller.profile),
        pressed=press is not None,
        press=_components(press.direction if press is not None else np.zeros(3)),
    )


def plane_view(model: Model, plane: PlanePart, given: list[Value]) -> PlaneView:
    """One plane; its body has z along the normal."""
    guide = _guide(model.bodies.rotation[plane.body])
    return PlaneView(plane.name, given, _axis(f"v_{plane.name}_normal", plane.normal), guide)


def guide_view(guide: GuidePart, given: list[Value]) -> GuideView:
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
        axis=_axis(f"v_{guide.name}_axis", guide.axes[:, 2]),
        guide=_guide(guide.axes),
        off={1: "-$s/2", 2: "$s/2", 3: "0"}[guide.sides],
        facets=guide.facets,
    )


def mesh_view(model: Model, mesh: MeshPart, given: list[Value]) -> MeshView:
    """One mesh; what its file says is written as numbers."""
    roller = model.rollers[mesh.on] if mesh.on >= 0 else None
    middle = zip("xyz", mesh.middle, strict=True)
    round_ = zip("xyz", mesh.gyration, strict=True)
    derived = [("scale", "Of the file's numbers to mm", number(mesh.scale))]
    derived += [(f"c_{a}", f"Middle of mass, {a} of the file (mm)", number(v)) for a, v in middle]
    derived += [(f"j_{a}", f"Inertia over mass about axis {a} (mm2)", number(v)) for a, v in round_]
    mass = "$M"
    if mesh.density is not None:
        derived.append(("V", "Volume (mm3)", number(mesh.volume)))
        mass = "$rho*$V"
    return MeshView(
        name=mesh.name,
        given=given,
        derived=derived,
        mass=mass,
        file=mesh.file,
        ground="B_Ground" if roller is None else f"b_{roller.name}",
        on="B_Ground" if roller is None else f"b_{roller.name}",
        slides=roller.name if roller is not None and roller.press is not None else "",
        z=_components(mesh.principal[:, 2]),
        x=_components(mesh.principal[:, 0]),
    )


def guide_graphics(guide: GuidePart) -> list[str]:
    """Names of the boxes that show a guide."""
    return [f"gbox_{guide.name}_{k}" for k in range(guide.facets)]


def _axis(name: str, direction: Floats) -> Axis:
    """The global vector along `direction`, or a vector called `name`."""
    for k, letter in enumerate("XYZ"):
        if np.array_equal(direction, np.eye(3)[k]):
            return Axis(f"V_Global_{letter}", None)
    return Axis(name, _components(direction))


def _components(direction: Floats) -> tuple[str, str, str]:
    x, y, z = (number(v) for v in direction)
    return x, y, z


def _guide(rotation: Floats) -> str:
    """The global vector in the plane of a body's z and x axes, from which ZX gives that x axis."""
    x, y = rotation[:, 0], rotation[:, 1]
    k = min((0, 1), key=lambda k: (abs(y[k]) > 1e-9, -x[k]))
    return f"V_Global_{'XY'[k]}"


def contact_views(model: Model, given: dict[str, list[Value]], written: Sequence[int]) -> list[ContactView]:
    """One row for each entry of the spec's list that made one of the contacts `written`."""
    table = model.contacts
    views = []
    for entry, group in groupby(written, key=lambda row: int(table.entry[row])):
        rows = list(group)
        more = f" and {len(rows) - 1} more" if len(rows) > 1 else ""
        label = f"Contact {entry}: {table.part_a[rows[0]]} / {table.part_b[rows[0]]}{more}"
        name = f"contact_{entry}"
        views.append(ContactView(name, label, given[name], table.share[rows[0]]))
    return views


def pair_rows(model: Model) -> list[Pair]:
    """One row for each pair of bodies that is kept."""
    bodies, table = model.bodies, model.contacts
    graphics = [[f"gbox_{name}"] for name in bodies.name]
    for roller in model.rollers:
        graphics[roller.body] = [f"gcyl_{roller.name}"]
    for guide in model.guides:
        graphics[guide.body] = guide_graphics(guide)
    for mesh in model.meshes:
        graphics[mesh.body] = [f"gcad_{mesh.name}"]
    rubs = [s > 0 or d > 0 for s, d in zip(table.mu_static, table.mu_dynamic, strict=True)]
    rough, rougher = rough_pairs(model), model.pair_friction.tolist()
    data_set = [f"contact_{entry}" for entry in table.entry.tolist()]
    columns = (c.tolist() for c in (model.pairs.contact, model.pairs.a, model.pairs.b))
    return [
        Pair(
            f"con_{bodies.name[a]}_{bodies.name[b]}",
            f"{bodies.label[a]} / {bodies.label[b]}",
            f"b_{bodies.name[a]}",
            graphics[a][0],
            f"b_{bodies.name[b]}",
            graphics[b],
            "ON" if rubs[row] and rougher[k] > 0 else "OFF",
            data_set[row],
            "*".join(rough[body] for body in (a, b) if rough.get(body)),
            rougher[k],
        )
        for k, (row, a, b) in enumerate(zip(*columns, strict=True))
    ]


def rough_pairs(model: Model) -> dict[int, str]:
    """Reference to the friction of each box whose sheet has zones."""
    return {sheet.first + k: text for sheet in model.sheets for k, text in enumerate(rough_boxes(sheet))}
