"""Rows of the sheets: boxes, the grid points that bushings share, bushings, supports and probes."""

from __future__ import annotations

from itertools import islice

import numpy as np

from mdlgen.altair import labels
from mdlgen.altair.curves import straight_points, written
from mdlgen.backends.motionview.writer.bend import bend_view
from mdlgen.backends.motionview.writer.cells import Differences, differences, grid_views, zone_views
from mdlgen.backends.motionview.writer.formula import mdl_formula, units_of
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.sheet_rows import (
    Bush,
    CurveView,
    JointGroup,
    Point,
    ProbeView,
    SheetView,
    SupportView,
)
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.lowering.plate import SHEAR_RATIO
from mdlgen.model.lowering.stiffness import SUPPORT_FACTOR
from mdlgen.model.shape import apart
from mdlgen.model.tables import AXES, CLAMP, GROUND, JOINT_X, SUPPORT, Anchor, Model, SheetPart


def sheet_view(model: Model, index: int, tables: dict[str, list[Value]]) -> SheetView:
    """One sheet with its boxes and bushings; `tables` are the given values by data set."""
    sheet = model.sheets[index]
    given = tables[sheet.name]
    members = slice(sheet.first, sheet.first + sheet.count)
    names, labels = model.bodies.name[members], model.bodies.label[members]
    columns = [_cell(2 * i + 1) for i in range(sheet.n_x)] * sheet.n_y
    rows = [_cell(2 * j + 1) for j in range(sheet.n_y) for _ in range(sheet.n_x)]
    frame = [0] * sheet.count if sheet.bend is None else sheet.bend.frames.box.tolist()
    boxes = [
        Point(name, label, i, j, x, y, (f, f))
        for name, label, (i, x), (j, y), f in zip(names, labels, columns, rows, frame, strict=True)
    ]
    differ = differences(sheet)
    held = model.bodies.fixed[members].tolist()
    free = [box for box, fixed in zip(boxes, held, strict=True) if not fixed]
    nodes, joints = _joints(model, index, differ)
    supported = bool(np.any((model.bushings.sheet == index) & (model.bushings.kind == SUPPORT)))
    return SheetView(
        name=sheet.name,
        given=given,
        n_x=number(sheet.n_x),
        n_y=number(sheet.n_y),
        tiled=sheet.grid == "tiled",
        parts=2 if sheet.layout == "edge_to_edge" else 1,
        rotation=any(v.member == "r_x" for v in given),
        moving=bool(np.any(sheet.velocity) or np.any(sheet.spin)),
        bending=sheet.bending,
        in_plane=sheet.in_plane,
        twist=sheet.twist,
        plate=sheet.layout == "plate",
        ratio=number(SHEAR_RATIO),
        damping=sheet.rotation_damping,
        own_times=any(v.member in ("tau_md", "eta_md") for v in given),
        stiff=bool(joints) or supported,
        graded=sheet.graded,
        grids=grid_views(sheet, tables),
        zones=zone_views(sheet, tables),
        cells=differ.cells,
        hinges=differ.hinges if joints else [],
        bend=bend_view(model, index, tables),
        boxes=boxes,
        lengths=differ.lengths,
        held=[box for box, fixed in zip(boxes, held, strict=True) if fixed],
        free=free,
        nodes=nodes,
        joints=joints,
        curves=_curves(model, index, differ),
        surface=_surface(sheet, names) if sheet.surface else [],
    )


def _cell(node: int) -> tuple[str, tuple[int, ...]]:
    """Cell coordinate of a half-cell node (1 is 0.5), and the line, or lines, that it lies on or between."""
    return number(node / 2), (node // 2,) if node % 2 == 0 else (node // 2, node // 2 + 1)


def _curves(model: Model, index: int, differ: Differences) -> list[CurveView]:
    """The curves of a sheet, by class where its joints are not all alike."""
    found = []
    for curve in (c for c in written(model)[0] if c.sheet == index):
        points = [
            (number(strain), number(stress))
            for strain, stress in zip(*straight_points(model.curves, curve.number), strict=True)
        ]
        name = model.curves.name[curve.number]
        label = f"{name.replace('_', ' ')}: force (N) over elongation (mm) of one bushing"
        own = f"ds_{model.sheets[index].name}_joints.real_%s_{curve.joints}.value" if differ.cells else "$%s"
        area = own % ("A" if differ.cells else f"A_{curve.axis}")
        found.append(CurveView(f"crv_{curve.name}", label, curve.axis, own % f"d_{curve.axis}", area, points))
    return found


def _joints(model: Model, index: int, differ: Differences) -> tuple[list[Point], list[JointGroup]]:
    """The grid points that a sheet's bushings share, and the bushings by their values."""
    sheet, table = model.sheets[index], model.bushings
    mine = np.flatnonzero((table.sheet == index) & (table.kind != SUPPORT))
    taken: dict[str, Point] = {}
    groups: dict[tuple[int, str, tuple[int, int], str], list[Bush]] = {}
    body = (*(f"b_{name}" for name in model.bodies.name), "B_Ground")
    assert body[GROUND] == "B_Ground"
    columns = (c[mine].tolist() for c in (table.kind, table.a, table.b, table.node, table.frames))
    curves, follows = written(model)
    first = dict(zip((table.name[row] for row in mine.tolist()), mine.tolist(), strict=True))
    owners = differ.owners or ["$%s"] * len(mine)
    clamped_x = sheet.clamp is not None and sheet.clamp.edge[0] == "x"
    for row, own, kind, a, b, (x, y), (one, two) in zip(mine.tolist(), owners, *columns, strict=True):
        point = labels.node(sheet, x, y, (one, two))
        if point not in taken:
            taken[point] = _node(point, sheet, x, y, (one, two))
        bush = Bush(table.name[row], table.label[row], body[a], body[b], point)
        along_x = kind == JOINT_X or (kind == CLAMP and clamped_x)
        wide = _tributary(sheet, y // 2, along_x) if along_x else _tributary(sheet, x // 2, along_x)
        groups.setdefault((kind, own, (one, two), wide), []).append(bush)
    nodes = sorted(taken.values(), key=lambda point: (point.y, point.x))
    twist = "_twist" if sheet.twist else ""
    shear = "_shear" if sheet.layout == "plate" else ""
    across = "_y" if shear and not differ.owners else ""  # where one data set holds joints of both ways
    made = []
    for (kind, own, frames, wide), bushes in groups.items():
        along_x = kind == JOINT_X or (kind == CLAMP and clamped_x)
        suffixes = ("x", f"y{shear}", f"tx{twist}", "ty", "tz")
        if not along_x:
            suffixes = (f"x{shear}", "y", "tx", f"ty{twist}", f"tz{across}")
        row = follows[first[bushes[0].name]]
        curve = f"crv_{curves[row].name}" if row >= 0 else ""
        x, y = (curve, "") if along_x else ("", curve)
        # a clamp is a half-cell hinge of twice the joint
        factor, more = "2*" if kind == CLAMP else "", (wide, "") if along_x else ("", wide)
        made.append(JointGroup(factor, own, *suffixes, frames, bushes, (x, y), more))
    return nodes, made


def _tributary(sheet: SheetPart, strip: int, along_x: bool) -> str:
    """Factor of the twist of a joint in a row, or a column, of boxes: half a box more at each free edge."""
    if not sheet.twist:
        return ""
    side, strips = ("y", sheet.n_y) if along_x else ("x", sheet.n_x)
    held = "" if sheet.clamp is None else sheet.clamp.edge
    free = (strip == 0 and held != f"{side}_min") + (strip == strips - 1 and held != f"{side}_max")
    return ("", "1.5*", "2*")[free]


def _node(name: str, sheet: SheetPart, x: int, y: int, frames: tuple[int, int]) -> Point:
    (i, along), (j, across) = _cell(x), _cell(y)
    return Point(name, f"{sheet.name} grid point {x / 2:g}, {y / 2:g}", i, j, along, across, frames)


def _surface(sheet: SheetPart, names: tuple[str, ...]) -> list[list[str]]:
    return [[f"m_{n}" for n in names[j * sheet.n_x : (j + 1) * sheet.n_x]] for j in range(sheet.n_y)]


def support_views(model: Model) -> list[SupportView]:
    """Held material points; the bushings of one share a point and a data set."""
    table = model.bushings
    rows = iter(np.flatnonzero(table.kind == SUPPORT).tolist())
    factor = Value("factor", "Stiffness relative to k_z of the sheet", number(SUPPORT_FACTOR), "EDIT")
    views = []
    for support in model.supports:
        parts = list(islice(rows, len(support.body)))
        bodies = [f"b_{model.bodies.name[b]}" for b in support.body.tolist()]
        points = _points(model, support, support.name)
        on = [points[k if len(points) > 1 else 0][0].removeprefix("p_") for k in range(len(parts))]
        x, y, z = (table.k[parts[0], :3] > 0).tolist()
        views.append(
            SupportView(
                name=support.name,
                sheet=model.sheets[support.sheet].name,
                points=points,
                edge=support.edge,
                given=[*_place(model, support), factor],
                count=len(parts),
                fixed=(x, y, z),
                bushes=[
                    Bush(table.name[row], table.label[row], "B_Ground", body, point)
                    for row, body, point in zip(parts, bodies, on, strict=True)
                ],
            )
        )
    return views


def probe_view(model: Model, probe: Anchor) -> ProbeView:
    """A probe, with one marker on each box that it lies on."""
    bodies = [f"b_{model.bodies.name[b]}" for b in probe.body.tolist()]
    ends = [""] if len(bodies) == 1 else [f"_{k}" for k in range(len(bodies))]
    points = _points(model, probe, f"probe_{probe.name}")
    on = [points[k if len(points) > 1 else 0][0] for k in range(len(bodies))]
    return ProbeView(
        name=probe.name,
        sheet=model.sheets[probe.sheet].name,
        points=points,
        edge=probe.edge,
        given=_place(model, probe),
        markers=[(f"m_probe_{probe.name}{e}", b, p) for e, b, p in zip(ends, bodies, on, strict=True)],
    )


def _points(model: Model, anchor: Anchor, name: str) -> list[tuple[str, str]]:
    """(point, frame) of an anchor; one for each of its boxes where they lie in several frames."""
    sheet, bodies = model.sheets[anchor.sheet], anchor.body.tolist()
    if not apart(model, anchor):
        return [(f"p_{name}", frame_of(sheet, bodies[0]))]
    return [(f"p_{name}_{k}", frame_of(sheet, body)) for k, body in enumerate(bodies)]


def frame_of(sheet: SheetPart, body: int) -> str:
    """Marker that a box lies in, without m_."""
    bend = sheet.bend
    frame = 0 if bend is None or bend.start == "flat" else int(bend.frames.box[body - sheet.first])
    return f"{sheet.name}_f{frame}" if frame else sheet.name


def _place(model: Model, anchor: Anchor) -> list[Value]:
    """x and y of a material point, from the sheet's centre in sheet axes; of an edge none."""
    if anchor.edge:
        return []
    units = units_of(model)
    return [
        Value(
            axis,
            f"{axis} from the centre of the sheet (mm)",
            number(round(float(value), 12)),
            "EDIT",
            mdl_formula(formula, "mm", units) if formula else "",
        )
        for axis, value, formula in zip(AXES, anchor.at, anchor.formulas, strict=False)
    ]
