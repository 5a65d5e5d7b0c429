"""Lints of rollers that turn the wrong way or touch nothing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.parts.roller import FLAT
from mdlgen.model.press import balance
from mdlgen.model.tables import (
    BOX_CYLINDER,
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
                    f"its surface moves {sheet.name} along {shown(way)}, and that of {first.name} along "
                    f"{shown(lead)}",
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
                    f"its surface moves {sheet.name} along {shown(way)}, and that comes along "
                    f"{shown(sheet.velocity)}",
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
                f"its surface moves {sheet.name} along {shown(way)}, away from {', '.join(behind[:3])}; "
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
    """True if two rollers are as near as in a nip, or one of them may move."""
    one, two = (model.roller(table[row]) for table in (model.contacts.part_a, model.contacts.part_b))
    if any(roller.arm is not None for roller in (one, two)):
        return True
    way = two.center - one.center
    across = _size(way - float(way @ one.axis) * one.axis)
    along = abs(float(way @ one.axis))
    nip = one.reach + two.reach + 0.5 * min(one.radius, two.radius)
    return across < nip and along < 0.5 * (one.width + two.width)


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
        on = not begin or balance.covered_shares(sheet, center, roller.axis, roller.width, True)
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

    A part beyond its leading edge counts as ahead, one beyond its trailing edge as behind.
    """
    table = model.contacts
    names = {table.part_b[k] for k in range(len(table)) if table.part_a[k] == sheet.name}
    half = np.array([*sheet.outline, sheet.thickness]) / 2
    edge = float(np.abs(sheet.rotation.T @ way) @ half)
    behind = []
    for part in model.machine:
        if part.name not in names:
            continue
        ahead = kind_of(part).reach(part, model.bodies, way) - float(sheet.center @ way)
        if ahead > edge:
            return []
        if ahead < -edge:
            behind.append(part.name)
    # bodies of the user's own model may lie anywhere
    unknown = any(
        kind == EXTERNAL and a == sheet.name for kind, a in zip(table.kind, table.part_a, strict=True)
    )
    return [] if unknown else behind


def _size(way: Floats) -> float:
    return float(np.linalg.norm(way))


def _opposite(one: Floats, other: Floats) -> bool:
    return float(one @ other) < OPPOSITE * _size(one) * _size(other)


def shown(way: Floats) -> str:
    """A direction: an axis where it is nearly one, else a vector."""
    unit = way / _size(way)
    axis = int(np.argmax(np.abs(unit)))
    if abs(unit[axis]) > 0.99:
        return f"{'+' if unit[axis] > 0 else '-'}{'xyz'[axis]}"
    return f"[{', '.join(f'{value + 0.0:.2g}' for value in unit)}]"
