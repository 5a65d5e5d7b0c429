"""Sheets: those whose boxes are all alike as a grid, others box by box and bushing by bushing."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mdlgen.altair.classes import box_classes
from mdlgen.altair.curves import straight_points, written
from mdlgen.backends.msolve.writer.units import Row, axes, per_thousand, row, same, thousandfold
from mdlgen.model.lowering.joints import Joints, find_joints
from mdlgen.model.tables import CLAMP, GROUND, JOINT_X, JOINT_Y, SUPPORT, Floats, Ints, Model, SheetPart

_LETTER = {JOINT_X: "x", JOINT_Y: "y", CLAMP: "c"}
_CLOSE = 1e-12  # of the sheet's length: lines this near to even ones are those of a grid

Table = dict[str, Any]


class Curved(NamedTuple):
    """The curve that bushings follow."""

    names: list[str]
    follows: Ints  # (bushings,), -1: none


def curved(model: Model) -> Curved:
    """The curve of each bushing."""
    found, follows = written(model)
    return Curved([curve.name for curve in found], follows)


def curves(model: Model) -> Table:
    """Elongation [mm] and force [N] of one bushing, by curve."""
    found: Table = {}
    for curve in written(model)[0]:
        strain, stress = straight_points(model.curves, curve.number)
        found[curve.name] = (row(curve.length * strain), row(curve.area * stress))
    return found


def sheets(model: Model) -> tuple[Table, Table]:
    """Grids, and the sheets that are listed, by name."""
    grids: Table = {}
    listed: Table = {}
    curve = curved(model)
    for index, sheet in enumerate(model.sheets):
        if _even(model, sheet):
            grids[sheet.name] = _grid(model, index, curve)
        else:
            listed[sheet.name] = _listed(model, index, curve)
    return grids, listed


def _even(model: Model, sheet: SheetPart) -> bool:
    """True if the sheet is flat, all its boxes are alike, and its lines are evenly spaced."""
    if not sheet.uniform or sheet.bend is not None:
        return False
    for lines, pitch in ((sheet.lines_x, sheet.d_x), (sheet.lines_y, sheet.d_y)):
        even = (np.arange(len(lines)) - (len(lines) - 1) / 2) * pitch
        if np.abs(lines - even).max() > _CLOSE * max(sheet.size):
            return False
    return True


def _common(model: Model, sheet: SheetPart) -> Table:
    """Values that a sheet has in both forms."""
    boxes = range(sheet.first, sheet.first + sheet.count)
    table: Table = {"held": [model.bodies.name[b] for b in boxes if model.bodies.fixed[b]]}
    if np.any(sheet.velocity) or np.any(sheet.spin):
        table["velocity"] = row(sheet.velocity, thousandfold)
        table["spin"] = row(sheet.spin, thousandfold)
    return table


def _box(model: Model, body: int) -> Table:
    table = model.bodies
    return {
        "mass": per_thousand(table.mass[body]),
        "inertia": row(table.inertia[body], per_thousand),
        "lengths": row(2.0 * table.half[body]),
    }


def _grid(model: Model, index: int, curve: Curved) -> Table:
    sheet = model.sheets[index]
    joints = [group for kind in find_joints(sheet) for group in _joints(model, index, kind, curve)]
    return {
        "center": row(sheet.center),
        "axes": axes(sheet.rotation),
        "boxes": [sheet.n_x, sheet.n_y],
        "pitch": [same(sheet.d_x), same(sheet.d_y)],
        **_box(model, sheet.first),
        **_common(model, sheet),
        "joints": joints,
    }


def _joints(model: Model, index: int, joints: Joints, curve: Curved) -> list[Table]:
    """Bushings of one kind, those of rows or columns side by side with one law together: the columns and rows
    of the boxes that they are named by, and where in its box each sits. A plate has others at its edges."""
    sheet, table = model.sheets[index], model.bushings
    mine = np.flatnonzero((table.sheet == index) & (table.kind == joints.kind))
    letter = _LETTER[joints.kind]
    row_of, column = np.divmod(joints.one, sheet.n_x)
    strips = (row_of if joints.along_x else column).tolist()
    found: list[Table] = []
    laws: dict[int, Table] = {}
    for strip, bushing in zip(strips, mine.tolist(), strict=True):
        law = _law(model, bushing, curve)
        assert laws.setdefault(strip, law) == law, "joints side by side are alike in an even sheet"
    at: dict[str, list[int]] = {}
    for name, node, i, j in zip(joints.name, joints.node.tolist(), column, row_of, strict=True):
        end = name.removeprefix(f"{sheet.name}_{letter}_{i}_{j}")
        at[end] = [int(node[0] - 2 * i), int(node[1] - 2 * j)]
    ends = [[int(v.min()), int(v.max()) + 1] for v in (column, row_of)] if joints.name else []
    for strip in sorted(laws):
        if not found or _law_of(found[-1]) != laws[strip]:
            group: Table = {"kind": letter, "columns": [*ends[0]], "rows": [*ends[1]], "at": at}
            group["rows" if joints.along_x else "columns"][0] = strip
            found.append(group | laws[strip])
        found[-1]["rows" if joints.along_x else "columns"][1] = strip + 1
    return found


def _law_of(group: Table) -> Table:
    return {key: value for key, value in group.items() if key not in ("kind", "columns", "rows", "at")}


def _law(model: Model, bushing: int, curve: Curved) -> Table:
    """k, c, kt, ct, a preload torque where there is one, and the curve that is followed."""
    table, follows = model.bushings, int(curve.follows[bushing])
    k, c = row(table.k[bushing]), row(table.c[bushing], per_thousand)
    law: Table = {}
    if follows >= 0:
        axis = int(model.curves.axis[bushing])
        k[axis] = 0.0
        times = (
            2 if table.kind[bushing] == CLAMP else 1
        )  # half a cell has its strain at half of the elongation
        law = {"curve": curve.names[follows], "along": "XY"[axis], "times": times}
    law = {"k": k[:3], "c": c[:3], "kt": k[3:], "ct": c[3:], **law}
    # on the first body, which the second one is to turn away from
    torque = row(-table.k[bushing, 3:] * table.rest[bushing])
    return {**law, "torque": torque} if any(torque) else law


def _listed(model: Model, index: int, curve: Curved) -> Table:
    sheet, bodies, table = model.sheets[index], model.bodies, model.bushings
    classes, of = box_classes(sheet)
    kinds = {c.name: _box(model, sheet.first + c.first) for c in classes}
    boxes = [
        (bodies.name[body], classes[kind].name, row(bodies.position[body]), axes(bodies.rotation[body]))
        for body, kind in zip(range(sheet.first, sheet.first + sheet.count), of.tolist(), strict=True)
    ]
    laws: dict[str, str] = {}
    found: dict[str, Table] = {}
    bushings = []
    for bushing in np.flatnonzero((table.sheet == index) & (table.kind != SUPPORT)).tolist():
        law = _law(model, bushing, curve)
        name = laws.setdefault(repr(law), f"law_{len(laws)}")
        found[name] = law
        a, b = (_part(model, int(ends[bushing])) for ends in (table.a, table.b))
        place, turned = row(table.origin[bushing]), axes(table.axes[bushing])
        bushings.append((table.name[bushing], name, a, b, place, turned))
    own = _common(model, sheet)
    return {
        "center": row(sheet.center),
        **own,
        "kinds": kinds,
        "laws": found,
        "boxes": boxes,
        "bushings": bushings,
    }


def _part(model: Model, body: int) -> str:
    return "ground" if body == GROUND else model.bodies.name[body]


def supports(model: Model) -> list[tuple[Any, ...]]:
    """Name, box, place, k and c of each bushing that holds a point."""
    table = model.bushings
    return [
        (
            table.name[k],
            _part(model, int(table.b[k])),
            row(table.origin[k]),
            row(table.k[k, :3]),
            row(table.c[k, :3], per_thousand),
        )
        for k in np.flatnonzero(table.kind == SUPPORT).tolist()
    ]


def loads(model: Model) -> list[tuple[Any, ...]]:
    """Name, box, place, force and moment of each load."""
    table, bodies = model.loads, model.bodies
    arms = (bodies.rotation[table.body] @ table.local[:, :, None])[:, :, 0]
    places: Floats = bodies.position[table.body] + arms
    return [
        (f"frc_{k}", bodies.name[body], row(places[k]), row(table.force[k]), row(table.moment[k]))
        for k, body in enumerate(table.body.tolist())
    ]


def load_factors(model: Model) -> dict[str, list[Row]]:
    """Corners [s, 1] of the factor over time of each load that has one."""
    table = model.loads
    return {
        f"frc_{k}": [[per_thousand(time), same(factor)] for time, factor in table.profiles[entry].tolist()]
        for k, entry in enumerate(table.entry.tolist())
        if entry in table.changing
    }


def probes(model: Model) -> Table:
    """Boxes that each probe lies on, with the place."""
    bodies = model.bodies
    found: Table = {}
    for probe in model.probes:
        arms = (bodies.rotation[probe.body] @ probe.local[:, :, None])[:, :, 0]
        places = bodies.position[probe.body] + arms
        found[probe.name] = [
            (bodies.name[body], row(place)) for body, place in zip(probe.body.tolist(), places, strict=True)
        ]
    return found
