"""Rows of the sheets: boxes, the grid points that bushings share, bushings, supports and probes."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice

import numpy as np

from backends.motionview.rows import (
    Bush,
    CurveView,
    JointGroup,
    Point,
    ProbeView,
    SheetView,
    SupportView,
    Value,
)
from backends.motionview.units import number
from mdlgen.model.curves import WAYS, straight_points
from mdlgen.model.stiffness import SUPPORT_FACTOR
from mdlgen.model.tables import AXES, CLAMP, GROUND, JOINT_X, JOINT_Y, SUPPORT, Anchor, Model, SheetPart


def sheet_view(model: Model, index: int, given: list[Value]) -> SheetView:
    """One sheet with its boxes and bushings."""
    sheet = model.sheets[index]
    members = slice(sheet.first, sheet.first + sheet.count)
    names, labels = model.bodies.name[members], model.bodies.label[members]
    columns = _cell(range(1, 2 * sheet.n_x, 2)) * sheet.n_y
    rows = [c for c in _cell(range(1, 2 * sheet.n_y, 2)) for _ in range(sheet.n_x)]
    boxes = [Point(*row) for row in zip(names, labels, columns, rows, strict=True)]
    held = model.bodies.fixed[members].tolist()
    free = [box for box, fixed in zip(boxes, held, strict=True) if not fixed]
    nodes, joints = _joints(model, index)
    supported = bool(np.any((model.bushings.sheet == index) & (model.bushings.kind == SUPPORT)))
    return SheetView(
        name=sheet.name,
        given=given,
        n_x=number(sheet.n_x),
        n_y=number(sheet.n_y),
        tiled=sheet.grid == "tiled",
        parts=2 if sheet.layout == "edge_to_edge" else 1,
        rotation=any(v.member == "r_x" for v in given),
        turned=any(sheet.angles),
        moving=bool(np.any(sheet.velocity) or np.any(sheet.spin)),
        bending=sheet.bending,
        in_plane=sheet.in_plane,
        twist=sheet.twist,
        damping=sheet.rotation_damping,
        stiff=bool(joints) or supported,
        boxes=boxes,
        held=[box for box, fixed in zip(boxes, held, strict=True) if fixed],
        free=free,
        nodes=nodes,
        joints=joints,
        curves=_curves(model, sheet),
        surface=_surface(sheet, names) if sheet.surface else [],
    )


def _curves(model: Model, sheet: SheetPart) -> list[CurveView]:
    found = []
    for index, name in enumerate(model.curves.name):
        for axis, way in zip(AXES, WAYS, strict=False):
            if name == f"{sheet.name}_{way}":
                points = zip(*straight_points(model.curves, index), strict=True)
                label = f"{sheet.name} {way.upper()}: force (N) over elongation (mm) of one bushing"
                rows = [(number(strain), number(stress)) for strain, stress in points]
                found.append(CurveView(f"crv_{name}", label, axis, rows))
    return found


def _cell(nodes: Iterable[int]) -> list[str]:
    """Cell coordinates of half-cell nodes: 1 is 0.5."""
    return [number(n / 2) for n in nodes]


def _joints(model: Model, index: int) -> tuple[list[Point], list[JointGroup]]:
    """The grid points that a sheet's bushings share, and the bushings by their values."""
    sheet, table = model.sheets[index], model.bushings
    mine = np.flatnonzero((table.sheet == index) & (table.kind != SUPPORT))
    taken: dict[tuple[int, int], str] = {}
    groups: dict[int, list[Bush]] = {JOINT_X: [], JOINT_Y: [], CLAMP: []}
    body = (*(f"b_{name}" for name in model.bodies.name), "B_Ground")
    assert body[GROUND] == "B_Ground"
    columns = (c[mine].tolist() for c in (table.kind, table.a, table.b, table.node))
    for row, kind, a, b, (x, y) in zip(mine.tolist(), *columns, strict=True):
        point = taken.setdefault((x, y), f"{sheet.name}_node_{x}_{y}")
        groups[kind].append(Bush(table.name[row], table.label[row], body[a], body[b], point))
    nodes = [
        Point(name, f"{sheet.name} grid point {x / 2:g}, {y / 2:g}", number(x / 2), number(y / 2))
        for (x, y), name in sorted(taken.items(), key=lambda item: (item[0][1], item[0][0]))
    ]
    twist = "_twist" if sheet.twist else ""
    clamped_x = sheet.clamp is not None and sheet.clamp.edge[0] == "x"
    made = []
    for kind, bushes in groups.items():
        along_x = kind == JOINT_X or (kind == CLAMP and clamped_x)
        suffixes = (f"tx{twist}", "ty") if along_x else ("tx", f"ty{twist}")
        if bushes:  # a clamp is a half-cell hinge of twice the joint
            own = [f"{sheet.name}_{way}" for way in WAYS]
            x, y = (f"crv_{n}" if n in model.curves.name and along_x == (n == own[0]) else "" for n in own)
            made.append(JointGroup("2*" if kind == CLAMP else "", *suffixes, bushes, (x, y)))
    return nodes, made


def _surface(sheet: SheetPart, names: tuple[str, ...]) -> list[list[str]]:
    return [[f"m_{n}" for n in names[j * sheet.n_x : (j + 1) * sheet.n_x]] for j in range(sheet.n_y)]


def support_views(model: Model) -> list[SupportView]:
    """Held material points; the bushings of one share a point and a data set."""
    table = model.bushings
    rows = iter(np.flatnonzero(table.kind == SUPPORT).tolist())
    factor = Value("factor", "Stiffness in times k_z of the sheet", number(SUPPORT_FACTOR), "EDIT")
    views = []
    for support in model.supports:
        parts = list(islice(rows, len(support.body)))
        bodies = [f"b_{model.bodies.name[b]}" for b in support.body.tolist()]
        x, y, z = (table.k[parts[0], :3] > 0).tolist()
        views.append(
            SupportView(
                name=support.name,
                sheet=model.sheets[support.sheet].name,
                edge=support.edge,
                given=[*([] if support.edge else _place(*support.at)), factor],
                count=len(parts),
                fixed=(x, y, z),
                bushes=[
                    Bush(table.name[row], table.label[row], "B_Ground", body, support.name)
                    for row, body in zip(parts, bodies, strict=True)
                ],
            )
        )
    return views


def probe_view(model: Model, probe: Anchor) -> ProbeView:
    """A probe, with one marker on each box that it lies on."""
    bodies = [f"b_{model.bodies.name[b]}" for b in probe.body.tolist()]
    ends = [""] if len(bodies) == 1 else [f"_{k}" for k in range(len(bodies))]
    return ProbeView(
        name=probe.name,
        sheet=model.sheets[probe.sheet].name,
        edge=probe.edge,
        given=[] if probe.edge else _place(*probe.at),
        markers=[(f"m_probe_{probe.name}{end}", body) for end, body in zip(ends, bodies, strict=True)],
    )


def _place(x: float, y: float) -> list[Value]:
    """x and y of a material point, from the sheet's centre in sheet axes."""
    return [
        Value(axis, f"{axis} from the centre of the sheet (mm)", number(round(float(v), 12)), "EDIT")
        for axis, v in zip(AXES, (x, y), strict=False)
    ]
