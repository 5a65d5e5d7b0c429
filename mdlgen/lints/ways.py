"""Lints of what parts do to a sheet: rollers that turn the wrong way or touch nothing, and soft contacts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model import press
from mdlgen.model.parts.guide import bounds
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.tables import (
    BOX_CYLINDER,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    EXTERNAL,
    Floats,
    Model,
    RollerPart,
    SheetPart,
)

RETARDS = 0.6  # a roller that is slower than this part of the others' speed may hold a sheet back on purpose
OPPOSITE = -0.5  # cosine between the ways of two surfaces, or of a surface and a sheet
NEAR = 3.0  # a roller is at a sheet if its surface is within so many thicknesses of its face

NARROW = 2.0  # a plane that is so many times as tall as wide, and a sheet so many times as wide as it

Driven = list[tuple[RollerPart, Floats]]


def against(model: Model) -> Iterator[Lint]:
    """Driven rollers that move a sheet opposite ways: the fewer, or the slower, are named."""
    named: set[str] = set()
    for sheet in model.sheets:
        fast = _fast(_driven(model, sheet))
        if not fast:
            continue
        total = np.sum([way for _, way in fast], axis=0)
        first, lead = max(fast, key=lambda item: float(item[1] @ total))
        for roller, way in fast:
            if _opposite(way, lead) and roller.name not in named:
                named.add(roller.name)
                yield Lint(
                    "W123",
                    f"rollers.{roller.name}.drive",
                    f"its surface moves {sheet.name} along {_shown(way)}, and that of {first.name} along "
                    f"{_shown(lead)}",
                    "turn one of them the other way",
                )


def away(model: Model) -> Iterator[Lint]:
    """Driven rollers that move a sheet against its own speed, or away from all that it could come to."""
    for sheet in model.sheets:
        fast = _fast(_driven(model, sheet, begin=True))
        for roller, way in fast:
            if _opposite(way, sheet.velocity):
                yield Lint(
                    "W124",
                    f"rollers.{roller.name}.drive",
                    f"its surface moves {sheet.name} along {_shown(way)}, and that comes along "
                    f"{_shown(sheet.velocity)}",
                    "turn it the other way",
                )
        if not fast or any(_opposite(way, fast[0][1]) for _, way in fast):
            continue
        roller, way = fast[0]
        behind = _left_behind(model, sheet, way / _size(way))
        if behind:
            yield Lint(
                "W124",
                f"rollers.{roller.name}.drive",
                f"its surface moves {sheet.name} along {_shown(way)}, away from {', '.join(behind[:3])}; "
                "nothing that it has a contact with lies ahead",
                "turn it the other way",
            )


def apart(model: Model) -> Iterator[Lint]:
    """Rollers that contacts name and that come to nothing in this run."""
    table = model.contacts
    met = {*model.pairs.contact.tolist(), *model.pairs.searched.tolist()}
    met -= {row for row in np.flatnonzero(table.kind == CYLINDER_CYLINDER).tolist() if not _near(model, row)}
    carrying = {model.rollers[mesh.on].name for mesh in model.meshes if mesh.on >= 0}
    pairs = list(zip(table.part_a, table.part_b, strict=True))
    for roller in model.rollers:
        rows = {row for row, pair in enumerate(pairs) if roller.name in pair}
        if rows and roller.name not in carrying and not met & rows:
            others = sorted({name for row in rows for name in pairs[row]} - {roller.name})
            yield Lint(
                "W129",
                f"rollers.{roller.name}.center",
                f"it comes to none of what it has a contact with: {', '.join(others[:3])}",
                "move it, or leave it out",
            )


def _near(model: Model, row: int) -> bool:
    """Whether two rollers are as near as in a nip, or one of them may move."""
    one, two = (model.roller(table[row]) for table in (model.contacts.part_a, model.contacts.part_b))
    if any(roller.arm is not None for roller in (one, two)):
        return True
    way = two.center - one.center
    across = _size(way - float(way @ one.axis) * one.axis)
    along = abs(float(way @ one.axis))
    nip = one.reach + two.reach + 0.5 * min(one.radius, two.radius)
    return across < nip and along < 0.5 * (one.width + two.width)


def sinks(model: Model) -> Iterator[Lint]:
    """Sheets that lie on a plane so soft that their weight alone pushes them through it."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    table = model.contacts
    for row in np.flatnonzero(table.kind == BOX_PLANE).tolist():
        sheet, plane = sheets[table.part_a[row]], planes[table.part_b[row]]
        boxes = slice(sheet.first, sheet.first + sheet.count)
        weight = float(model.bodies.mass[boxes].sum()) * max(0.0, -float(model.gravity @ plane.normal))  # N
        each = weight / sheet.count
        depth = (each / float(table.stiffness[row])) ** (2 / 3)
        if depth > sheet.thickness:
            yield Lint(
                "W133",
                f"contacts.{table.called(row)}.stiffness",
                f"its weight of {weight:.3g} N pushes {sheet.name} {depth:.3g} mm into {plane.name}, more "
                f"than its thickness of {sheet.thickness:g} mm",
                f"give {each / (0.1 * sheet.thickness) ** 1.5:.2g} N/mm^1.5 or more: a tenth of that",
            )


def crosswise(model: Model) -> Iterator[Lint]:
    """Planes that stand in a sheet's way, as a stop does, on their narrow side: tall, and not wide."""
    sheets, planes = {s.name: s for s in model.sheets}, {p.name: p for p in model.planes}
    table = model.contacts
    named: set[str] = set()
    for row in np.flatnonzero(table.kind == BOX_PLANE).tolist():
        sheet, plane = sheets[table.part_a[row]], planes[table.part_b[row]]
        normal = sheet.rotation[:, 2]
        if abs(float(plane.normal @ normal)) > FLAT or plane.name in named:
            continue
        sides = model.bodies.rotation[plane.body].T
        across = np.cross(normal, plane.normal)
        wide, tall = (float(np.abs(sides[:2] @ way) @ np.array(plane.size[:2])) for way in (across, normal))
        width = float(np.abs(sheet.rotation[:, :2].T @ across) @ np.array(sheet.outline))
        if tall > NARROW * wide and wide < width / NARROW:
            named.add(plane.name)
            yield Lint(
                "W135",
                f"planes.{plane.name}.size",
                f"it stands in the way of {sheet.name}, {tall:.3g} mm tall and {wide:.3g} mm wide; that is "
                f"{width:.3g} mm wide there",
                "swap the two lengths, or name the side that the first one lies along: along: "
                f"{_shown(across).lstrip('+-')}",
            )


def _driven(model: Model, sheet: SheetPart, begin: bool = False) -> Driven:
    """Rollers at the plane of a sheet that have friction with it, and how fast they move it there [mm/ms];
    `begin`: only those that it is under as the run begins."""
    table, found = model.contacts, []
    rollers = {roller.name: roller for roller in model.rollers}
    normal = sheet.rotation[:, 2]
    for row in np.flatnonzero(table.kind == BOX_CYLINDER).tolist():
        roller = rollers[table.part_b[row]]
        if table.part_a[row] != sheet.name or not roller.speed or not table.mu_static[row]:
            continue
        center = model.bodies.position[roller.body]
        height = float((sheet.center - center) @ normal)
        gap = abs(height) - roller.reach - sheet.thickness / 2
        on = not begin or press.covered_shares(sheet, center, roller.axis, roller.width, True)
        if abs(float(roller.axis @ normal)) < FLAT and on and abs(gap) < NEAR * sheet.thickness:
            found.append(
                (roller, np.cross(roller.speed * roller.axis, np.sign(height) * roller.radius * normal))
            )
    return found


def _fast(driven: Driven) -> Driven:
    """Those that are not much slower than most of them."""
    sizes = sorted(_size(way) for _, way in driven)
    # of numpy's median the first call loads a tenth of numpy
    usual = 0.5 * (sizes[(len(sizes) - 1) // 2] + sizes[len(sizes) // 2]) if sizes else 0.0
    return [(roller, way) for roller, way in driven if _size(way) > RETARDS * usual]


def _left_behind(model: Model, sheet: SheetPart, way: Floats) -> list[str]:
    """Parts of the machine that a sheet has contacts with and that lie behind it; none where one lies ahead.

    What reaches beyond its leading edge counts as ahead, what lies beyond its trailing edge as behind.
    """
    table = model.contacts
    names = {table.part_b[k] for k in range(len(table)) if table.part_a[k] == sheet.name}
    half = np.array([*sheet.outline, sheet.thickness]) / 2
    edge = float(np.abs(sheet.rotation.T @ way) @ half)
    behind = []
    for name, end in _ends(model, way):
        ahead = end - float(sheet.center @ way)
        if name in names and ahead > edge:
            return []
        if name in names and ahead < -edge:
            behind.append(name)
    # bodies of the user's own model may lie anywhere
    unknown = any(
        kind == EXTERNAL and a == sheet.name for kind, a in zip(table.kind, table.part_a, strict=True)
    )
    return [] if unknown else behind


def _ends(model: Model, way: Floats) -> Iterator[tuple[str, float]]:
    """How far each part of the machine reaches along a unit vector, by name [mm]."""
    for roller in model.rollers:
        across = roller.reach * _size(np.cross(roller.axis, way))
        along = 0.5 * roller.width * abs(float(roller.axis @ way))
        yield roller.name, float(model.bodies.position[roller.body] @ way) + across + along
    for plane in model.planes:
        half = np.array(plane.size) / 2
        reach = float(np.abs(model.bodies.rotation[plane.body].T @ way) @ half)
        yield plane.name, float(model.bodies.position[plane.body] @ way) + reach
    for guide in model.guides:
        low, high = bounds(guide)
        yield guide.name, float(np.where(way > 0, high, low) @ way)
    for mesh in model.meshes:
        yield mesh.name, float(((mesh.center + mesh.corners @ mesh.axes.T) @ way).max())


def _size(way: Floats) -> float:
    return float(np.linalg.norm(way))


def _opposite(one: Floats, other: Floats) -> bool:
    return float(one @ other) < OPPOSITE * _size(one) * _size(other)


def _shown(way: Floats) -> str:
    """A direction: an axis where it is nearly one, else a vector."""
    unit = way / _size(way)
    axis = int(np.argmax(np.abs(unit)))
    if abs(unit[axis]) > 0.99:
        return f"{'+' if unit[axis] > 0 else '-'}{'xyz'[axis]}"
    return f"[{', '.join(f'{value + 0.0:.2g}' for value in unit)}]"
