"""Pairs of sheets and rollers: which rollers face each other across a sheet, and the round that the force of
each is spread as; which boxes are too long to follow a roller.

Each of them presses with k z^1.5 in parallel to the other, so with the same force as deep as k^(-2/3). The
reach sqrt(2 r z) of a pressure of radius r is then the same for all where r goes with k^(2/3); the factor is
the geometric mean of what the rollers' own radii ask for. Rollers that are alike keep their radius, and so
do those that face none.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.model.tables import BOX_CYLINDER, Contacts, Floats, Model, RollerPart, SheetPart

PARALLEL = 0.985  # cosine of 10 degrees
# Greatest gap of a nip, relative to a sheet's thickness: in a wider gap the sheet passes freely.
GAP = 2.0
LEAST = 1e-12


def spreads(sheets: tuple[SheetPart, ...], rollers: tuple[RollerPart, ...], contacts: Contacts) -> Floats:
    """`Contacts.spread` of all rows [mm], (n,)."""
    spread = np.zeros(len(contacts))
    parts = {roller.name: roller for roller in rollers}
    for sheet in sheets:
        rows = [
            row
            for row, name in enumerate(contacts.part_a)
            if name == sheet.name
            and contacts.kind[row] == BOX_CYLINDER
            and contacts.share[row] == "width"
            and contacts.stiffness[row] > 0.0
        ]
        for group in _groups([parts[contacts.part_b[row]] for row in rows], float(sheet.thick.max())):
            own = [rows[member] for member in group]
            hard = contacts.stiffness[own] ** (2 / 3)
            radius = np.array([parts[contacts.part_b[row]].radius for row in own])
            spread[own] = hard * np.exp(np.mean(np.log(radius / hard)))
    return spread


def _groups(rollers: list[RollerPart], thickness: float) -> Iterator[list[int]]:
    """Indices of rollers that face each other, or one another's other ones; of two at least."""
    left = set(range(len(rollers)))
    while left:
        group, new = [], [left.pop()]
        while new:
            one = new.pop()
            group.append(one)
            found = {other for other in left if _face(rollers[one], rollers[other], thickness)}
            left -= found
            new += found
        if len(group) > 1:
            yield sorted(group)


def _face(one: RollerPart, other: RollerPart, thickness: float) -> bool:
    """True if two rollers are parallel, overlap along their axes and may have the sheet between them.

    Two fixed rollers have it between them if their gap is not above GAP times its thickness; neighbours along
    a path, a few millimetres apart, do not. One that moves may be lifted by the smaller one's radius, and has
    to come that near on its slide or arm.
    """
    if abs(float(one.axis @ other.axis)) < PARALLEL:
        return False
    gap = other.center - one.center
    along = float(gap @ one.axis)
    if abs(along) >= 0.5 * (one.width + other.width):
        return False
    radii = one.radius + other.radius
    apart = float(np.linalg.norm(gap - along * one.axis)) - radii
    lifted = apart < thickness + min(one.radius, other.radius)
    return lifted and _nearest(one, other) - radii <= GAP * thickness


def _nearest(one: RollerPart, other: RollerPart) -> float:
    """Least distance of the axes of two parallel rollers on their slides and arms [mm]."""
    moving = [roller for roller in (one, other) if roller.press is not None or roller.arm is not None]
    gap = _across(other.center - one.center, one)
    if not moving:
        return float(np.linalg.norm(gap))
    ways = [_across(roller.press.direction, one) for roller in moving if roller.press is not None]
    if len(moving) == 2 and not (len(ways) == 2 and _parallel(*ways)):
        return 0.0  # two that move on different ways may meet
    first = moving[0]
    if first.arm is not None:
        still = other if first is one else one
        reach = float(np.linalg.norm(_across(first.center - first.arm.pivot, one)))
        return abs(float(np.linalg.norm(_across(still.center - first.arm.pivot, one))) - reach)
    way = ways[0] / max(float(np.linalg.norm(ways[0])), LEAST)
    return float(np.linalg.norm(gap - (gap @ way) * way))


def _across(vector: Floats, roller: RollerPart) -> Floats:
    """The part of a vector that is square to the roller's axis."""
    return vector - (vector @ roller.axis) * roller.axis


def _parallel(one: Floats, other: Floats) -> bool:
    return abs(float(one @ other)) > PARALLEL * float(np.linalg.norm(one) * np.linalg.norm(other))


def nips(model: Model) -> Iterator[tuple[int, SheetPart, RollerPart]]:
    """(row of contacts, sheet, roller) of every sheet-roller pair."""
    sheets = {s.name: s for s in model.sheets}
    rollers = {r.name: r for r in model.rollers}
    for row in np.flatnonzero(model.contacts.kind == BOX_CYLINDER):
        yield int(row), sheets[model.contacts.part_a[row]], rollers[model.contacts.part_b[row]]


def faced(model: Model, roller: RollerPart, sheet: SheetPart) -> list[RollerPart]:
    """Rollers between which and this one the sheet may be."""
    thick = float(sheet.thick.max())
    return [other for other in model.rollers if other is not roller and _face(roller, other, thick)]


def facets(model: Model) -> Iterator[tuple[SheetPart, RollerPart, float]]:
    """(sheet, roller, length of a box [mm]) of every such pair whose flat boxes cannot follow the roller."""
    for _, sheet, roller in nips(model):
        if sheet.count == 1:
            continue
        across = [abs(float(roller.axis @ sheet.rotation[:, k])) for k in range(2)]
        axis = 0 if across[0] <= across[1] else 1
        length = float(2 * model.bodies.half[sheet.first : sheet.first + sheet.count, axis].max())
        if roller.radius < length / 2:
            yield sheet, roller, length
