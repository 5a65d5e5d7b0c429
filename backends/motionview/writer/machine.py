"""Rows of the machine: rollers, planes, guides, meshes, contacts and the pairs of bodies that may touch."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np

from mdlgen.altair.rims import DEEP, Side, graphics, meetings
from mdlgen.backends.motionview.writer.cells import rough_boxes
from mdlgen.backends.motionview.writer.rows import (
    ArmView,
    Axis,
    ContactView,
    GuideView,
    MeshView,
    Pair,
    PlaneView,
    RollerView,
    SectorView,
    Value,
)
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import Floats, GuidePart, MeshPart, Model, PlanePart, RimPart, RollerPart


def roller_view(model: Model, roller: RollerPart, given: list[Value]) -> RollerView:
    """One roller; its body has z along the axis."""
    press = roller.press
    rim, derived = _rim(roller.rim) if roller.rim is not None else ([], [])
    members, axis = {value.member for value in given}, _axis(f"v_{roller.name}_axis", roller.axis)
    arm = None
    if roller.arm is not None:
        x, y, z = (f"$g_{a}" if "g_x" in members else f"($a_{a}+${a})/2" for a in "xyz")
        arm = ArmView((x, y, z), roller.arm.sprung)
        if "I_a" not in members:
            derived = [("I_a", "Inertia of the arm, a rod (kg mm2)", _rod(axis.vector)), *derived]
    return RollerView(
        name=roller.name,
        given=given,
        axis=axis,
        guide=_guide(model.bodies.rotation[roller.body]),
        driven=roller.speed is not None,
        ramped=roller.ramp > 0.0,
        corners=0 if roller.profile is None else len(roller.profile),
        pressed=press is not None,
        press=_components(press.direction if press is not None else np.zeros(3)),
        arm=arm,
        rim=rim,
        derived=derived,
    )


def _rod(axis: str) -> str:
    """Inertia of a rod from the pivot of an arm to the roller, about the middle along the axis."""
    along = "+".join(f"(${a}-$a_{a})*{axis}.{a}" for a in "xyz")
    square = "+".join(f"(${a}-$a_{a})^2" for a in "xyz")
    return f"$M_a*({square}-({along})^2)/12"


def _rim(rim: RimPart) -> tuple[list[SectorView], list[tuple[str, str, str]]]:
    """The sectors of a rim, and what is computed of them; the number of their boxes is fixed in a text."""
    views, derived = [], []
    given = [name for name in rim.name if name[0] == "s"]
    for k, (name, own, facets) in enumerate(zip(rim.name, rim.own, rim.facets, strict=True)):
        number_of = int(name[1:])
        begin, end = f"$s{number_of}_from", f"$s{number_of}_to"
        if name[0] == "g":
            begin = end
            end = f"$s{number_of + 1}_from" if number_of + 1 < len(given) else "($s0_from+360)"
        radius = f"${name}_radius" if own else "$R"
        what = f"Sector {number_of}" if name[0] == "s" else f"Behind sector {number_of}"
        derived += [
            (f"{name}_n", f"{what} : boxes that show it; fixed in this text", str(facets)),
            (f"{name}_turn", f"{what} : angle of one of them", f"({end}-{begin})*PI/180/${name}_n"),
            (f"{name}_deep", f"{what} : thickness of a box (mm)", f"{number(DEEP)}*{radius}"),
            (f"{name}_chord", f"{what} : length of a box (mm)", f"2*{radius}*tan(${name}_turn/2)"),
        ]
        # within a turn either way, as people write angles
        turns = 360 * round(np.degrees(0.5 * (rim.begin[k] + rim.end[k])) / 360)
        views.append(SectorView(name, f"({begin}-({turns}))" if turns else begin, radius, facets))
    return views, derived


def plane_view(model: Model, plane: PlanePart, given: list[Value]) -> PlaneView:
    """One plane; its body has z along the normal."""
    press = plane.press
    return PlaneView(
        name=plane.name,
        given=given,
        normal=_axis(f"v_{plane.name}_normal", plane.normal),
        guide=_guide(model.bodies.rotation[plane.body]),
        pressed=press is not None,
        press=_components(press.direction if press is not None else np.zeros(3)),
        mass="($M+$M_c)" if any(value.member == "M_c" for value in given) else "$M",
    )


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
    """One row for each pair of bodies that is kept, and for each sector of a rim in it."""
    bodies, table = model.bodies, model.contacts
    shown = [[f"gbox_{name}"] for name in bodies.name]
    for guide in model.guides:
        shown[guide.body] = guide_graphics(guide)
    for mesh in model.meshes:
        shown[mesh.body] = [f"gcad_{mesh.name}"]
    rollers = {roller.body: roller for roller in model.rollers}
    rubs = [s > 0 or d > 0 for s, d in zip(table.mu_static, table.mu_dynamic, strict=True)]
    rough, rougher = rough_pairs(model), model.pair_friction.tolist()
    data_set = [f"contact_{entry}" for entry in table.entry.tolist()]
    rows, one, two = (c.tolist() for c in (model.pairs.contact, model.pairs.a, model.pairs.b))

    def of(body: int, side: Side) -> list[str]:
        return graphics(rollers[body], side) if body in rollers else shown[body]

    made = []
    for met in meetings(model):
        row, a, b = rows[met.pair], one[met.pair], two[met.pair]
        own = [(body, side) for body, side in ((a, met.a), (b, met.b)) if side.sector >= 0]
        label = f"{bodies.label[a]} / {bodies.label[b]}{met.suffix.replace('_', ' ')}"
        name = f"con_{bodies.name[a]}_{bodies.name[b]}{met.suffix}"
        one_graphic, two_graphics = of(a, met.a), of(b, met.b)
        first, second = (a, b)
        if len(one_graphic) > 1:  # a statement has one graphic on its first side
            first, second, one_graphic, two_graphics = b, a, two_graphics, one_graphic
        factors = [_sector_values(rollers[body], side) for body, side in own]
        made.append(
            Pair(
                name,
                label,
                f"b_{bodies.name[first]}",
                one_graphic[0],
                f"b_{bodies.name[second]}",
                two_graphics,
                "ON" if rubs[row] and rougher[met.pair] * met.friction > 0 else "OFF",
                data_set[row],
                "*".join(v for v in (rough.get(a, ""), rough.get(b, ""), *(f[0] for f in factors)) if v),
                rougher[met.pair] * met.friction,
                "*".join(f[1] for f in factors if f[1]),
                met.stiffness,
                "".join(f[2] for f in factors),
                None if not any(f[2] for f in factors) else met.restitution(0.0),
            )
        )
    return made


def _sector_values(roller: RollerPart, side: Side) -> tuple[str, str, str]:
    """References to friction, stiffness and restitution of a sector; empty where it has none of its own."""
    assert roller.rim is not None
    name = roller.rim.name[side.sector]
    if name[0] == "g":
        return "", "", ""
    base = f"ds_{roller.name}.real_{name}_%s.value"
    bouncy = "" if np.isnan(side.restitution) else base % "restitution"
    return base % "friction", base % "stiffness", bouncy


def rough_pairs(model: Model) -> dict[int, str]:
    """Reference to the friction of each box whose sheet has zones."""
    return {sheet.first + k: text for sheet in model.sheets for k, text in enumerate(rough_boxes(sheet))}
