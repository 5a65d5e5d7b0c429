"""Finds the contacts that a scene can need: pairs of a box and a part that may touch during the run.

A sheet's boxes are swept by what can move them. That is their initial velocity, gravity, the surface speed of
every driven roller that touches the sheet, and the speed of a sheet that touches it. A touching sheet may
also pass on its velocity. Different speeds across the sheet may turn it. A stated margin is added.

A solver watches the bounds: a box whose centre leaves them ends the run, so that no contact is missed
silently. A sheet that meets an external part may be moved by it in any way: all of its pairs are stored. A
sheet that meets a guide or a fixed mesh, itself or over such a sheet, may be led in any direction, as far as
the parts that move it go. One that meets a pressed plate may be carried by it as far as the plate goes.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model import meshes
from mdlgen.model.parts.kind import SLACK
from mdlgen.model.parts.kinds import kind_of
from mdlgen.model.sheet_pairs import linked, meeting
from mdlgen.model.tables import (
    BOX_BOX,
    EXTERNAL,
    OF_MACHINE,
    Bodies,
    Contacts,
    Floats,
    MachinePart,
    MeshPart,
    Pairs,
    RollerPart,
    RunSettings,
    SheetPart,
)
from mdlgen.spec.limits import DEFAULT, Limits

_TURN_STEPS = 33
_STATIONS = 65  # times in a run at which the ways of two drives are compared


def find_pairs(
    gravity: Floats,
    sheets: tuple[SheetPart, ...],
    machine: tuple[MachinePart, ...],
    bodies: Bodies,
    contacts: Contacts,
    run: RunSettings,
    prune: bool,
    margin: float,
    limits: Limits = DEFAULT,
) -> Pairs:
    """Possible pairs, those stored, and the bounds of each box (see the module).

    Raises SpecError where more would be stored than the limits allow.
    """
    parts = {p.name: p for p in machine}
    by_name = {s.name: s for s in sheets}
    rollers = tuple(p for p in machine if isinstance(p, RollerPart))
    low = np.full((len(bodies.name), 3), -np.inf)
    high = np.full((len(bodies.name), 3), np.inf)
    extents: dict[str, tuple[Floats, Floats]] = {}
    possible = 0
    kept: list[tuple[int, int, int]] = []
    searched: list[int] = []
    if prune:
        drives: dict[str, _Drives] = {}
        groups = linked([s.name for s in sheets], contacts)
        for sheet in sheets:
            group = groups[sheet.name]
            rows = [r for r, a in enumerate(contacts.part_a) if a in group]
            if not rows or EXTERNAL in contacts.kind[rows]:
                continue
            touched = [
                (by_name[contacts.part_a[r]], part)
                for r in rows
                if contacts.kind[r] != BOX_BOX
                for part in _moving([parts[contacts.part_b[r]]], rollers)
            ]
            boxes = slice(sheet.first, sheet.first + sheet.count)
            others = [by_name[name] for name in group if name != sheet.name]
            found = drives.get(group[0])  # sheets of one group have the same
            if found is None:
                found = drives[group[0]] = _drives(touched, run)
            least, most, reach = _swept(gravity, sheet, touched, found, others, bodies, run)
            low[boxes], high[boxes] = least - margin, most + margin
            extents[sheet.name] = (low[boxes] - reach - SLACK, high[boxes] + reach + SLACK)
    for part in machine:
        watched = kind_of(part).centre_bounds(part, bodies.position[part.body], margin if prune else None)
        if watched is not None:
            low[part.body], high[part.body] = watched
    for row in np.flatnonzero(contacts.kind != EXTERNAL).tolist():
        if contacts.kind[row] == BOX_BOX:
            pair = by_name[contacts.part_a[row]], by_name[contacts.part_b[row]]
            possible += pair[0].count * pair[1].count
            found = meeting(*pair, extents)
            if found is None:
                searched.append(row)
            else:
                kept.extend((row, a, b) for a, b in found)
            continue
        other = parts[contacts.part_b[row]]
        if contacts.kind[row] in OF_MACHINE:
            possible += 1
            kept.append((row, parts[contacts.part_a[row]].body, other.body))
            continue
        sheet = by_name[contacts.part_a[row]]
        possible += sheet.count
        boxes = np.arange(sheet.first, sheet.first + sheet.count)
        if sheet.name in extents:
            part_low, part_high = kind_of(other).bounds(other, bodies, rollers)
            box_low, box_high = extents[sheet.name]
            boxes = boxes[np.all((box_low <= part_high) & (box_high >= part_low), axis=1)]
        if message := limits.exceeded("pairs", len(kept) + len(boxes), "pairs of bodies kept"):
            raise SpecError(message, ("contacts", int(contacts.entry[row])))
        kept.extend((row, int(box), other.body) for box in boxes)
    table = np.array(kept, dtype=np.int64).reshape(-1, 3)
    return Pairs(
        table[:, 0].copy(),
        table[:, 1].copy(),
        table[:, 2].copy(),
        possible,
        margin,
        low,
        high,
        np.array(searched, dtype=np.int64),
    )


class _Drives(NamedTuple):
    """Motions that driven rollers may give a sheet."""

    ends: list[Floats]  # distance that each may move it, in both directions of each axis [mm], (3,)
    twist: float  # angle by which their differences may turn it in its plane [rad]


def _drives(touched: list[tuple[SheetPart, MachinePart]], run: RunSettings) -> _Drives:
    """Motions by the driven rollers among the parts that a sheet, or a sheet linked with it, touches."""
    if run.analysis == "static":
        return _Drives([], 0.0)
    driven = [
        (own, part if part.speed else replace(part, speed=part.spin))
        for own, part in touched
        if isinstance(part, RollerPart) and (part.speed or part.spin)
    ]
    corners = [part.corners[:, 0] for _, part in driven]
    stations = np.concatenate([np.linspace(0.0, run.duration, _STATIONS), *corners]).clip(0.0, run.duration)
    times = np.array(sorted(set(stations.tolist())))
    found = [_drive(own, part, times) for own, part in driven]
    ends = [end for path, _ in found for end in (path.min(0), path.max(0))]
    return _Drives(ends, _twist([path for path, _ in found], [near for _, near in found]))


def _swept(
    gravity: Floats,
    sheet: SheetPart,
    touched: list[tuple[SheetPart, MachinePart]],
    drives: _Drives,
    others: list[SheetPart],
    bodies: Bodies,
    run: RunSettings,
) -> tuple[Floats, Floats, Floats]:
    """Bounds of each box centre (low, high), (count, 3), and the boxes' half extents, without margin.

    `touched` are the parts that the sheet, or one of the `others` that it is linked with, has a contact with.
    """
    boxes = slice(sheet.first, sheet.first + sheet.count)
    centers = bodies.position[boxes]
    size = np.array(sheet.outline)
    diagonal = float(np.hypot(*size))
    if run.analysis == "static":
        reach = np.full(3, float(np.linalg.norm(bodies.half[boxes], axis=1).max()))
        return centers - diagonal, centers + diagonal, reach
    time = run.duration
    fall = 0.5 * gravity * time**2
    shift = sheet.velocity * time
    # a heavy sheet throws a light one forward with up to twice its own velocity
    thrown = [2.0 * (other.velocity - sheet.velocity) * time for other in others]
    lifts = {part.name: kind_of(part).carry(part) for _, part in touched}
    lift = sum(lifts.values(), np.zeros(3))
    moves = np.array([fall, shift, *drives.ends])
    if any(kind_of(part).leads for _, part in touched):
        paths = np.linalg.norm(moves, axis=1)
        way = float(paths[:2].sum() + paths[2:].max(initial=0.0) + sum(map(np.linalg.norm, thrown)))
        way += float(np.linalg.norm(lift))
        if sheet.count > 1:
            way += 0.5 * float(size.max())
        turned = _turn(sheet, drives.twist, time) * diagonal
        reach = np.full(3, float(np.linalg.norm(bodies.half[boxes], axis=1).max()))
        return centers - way - min(turned, diagonal), centers + way + min(turned, diagonal), reach
    # velocity and fall act together with one drive at a time
    least = np.minimum(moves[:2], 0).sum(0) + np.minimum(moves[2:], 0).min(0, initial=0.0)
    most = np.maximum(moves[:2], 0).sum(0) + np.maximum(moves[2:], 0).max(0, initial=0.0)
    for way in thrown:
        least, most = least + np.minimum(way, 0), most + np.maximum(way, 0)
    least, most = least - lift, most + lift
    if sheet.count > 1:
        # a flexible sheet may flap out of its plane as far as its length allows
        normal = np.abs(sheet.rotation[:, 2]) * 0.5 * float(size.max())
        least, most = least - normal, most + normal
    arms = centers - sheet.center
    turn = _turn(sheet, drives.twist, time)
    around, extent = _turned(sheet, arms, turn, bodies.half[boxes].max(axis=0))
    if sheet.bend is not None:  # boxes stand at angles of their own
        extent = np.full(3, float(np.linalg.norm(bodies.half[boxes], axis=1).max()))
    return sheet.center + around[0] + least, sheet.center + around[1] + most, extent


def _moving(touched: list[MachinePart], rollers: tuple[RollerPart, ...]) -> list[MachinePart]:
    """The parts that a sheet touches; of meshes on rollers these rollers, as large as what is on them."""
    return [
        replace(rollers[p.on], radius=meshes.reach(p, rollers[p.on]))
        if isinstance(p, MeshPart) and p.on >= 0
        else p
        for p in touched
    ]


def _drive(sheet: SheetPart, roller: RollerPart, times: Floats) -> tuple[Floats, Floats]:
    """Path of a driven roller's surface where it faces the sheet, at some times [mm], (t, 3), and its nearest
    place on the sheet."""
    normal = sheet.rotation[:, 2]
    height = float((roller.center - sheet.center) @ normal)
    toward = -float(np.copysign(roller.reach, height)) * normal
    toward = toward - roller.axis * (toward @ roller.axis)
    way = np.cross(roller.axis, toward)
    return np.outer(roller.turned(times), way), roller.center - height * normal


def _turn(sheet: SheetPart, twist: float, time: float) -> float:
    """Angle by which the sheet may turn in its plane [rad]: its spin, and what drives twist it by."""
    turn = abs(float(sheet.spin @ sheet.rotation[:, 2])) * time
    off_plane = sheet.spin - sheet.rotation[:, 2] * (sheet.spin @ sheet.rotation[:, 2])
    return np.inf if np.any(off_plane != 0.0) else turn + twist


def _twist(paths: list[Floats], places: list[Floats]) -> float:
    """Angle by which drives may turn a sheet [rad]: what two differ by across their distance, over that."""
    most, every, near = 0.0, np.array(paths), np.array(places)
    for k in range(1, len(paths)):
        gaps = near[k] - near[:k]
        far = np.linalg.norm(gaps, axis=1)
        apart = np.flatnonzero(far > 0.0)
        way = every[k] - every[apart]
        along = (gaps[apart] / far[apart, None])[:, None]
        across = np.stack([
            way[..., i - 2] * along[..., i - 1] - way[..., i - 1] * along[..., i - 2] for i in range(3)
        ])  # fmt: skip
        size = np.sqrt((across**2).sum(axis=0)).max(axis=1)
        most = max(most, float((size / far[apart]).max(initial=0.0)))
    return most


def _turned(
    sheet: SheetPart, arms: Floats, turn: float, half: Floats
) -> tuple[tuple[Floats, Floats], Floats]:
    """Bounds of `arms` (n, 3) turned in the sheet's plane by up to +-turn, and half extents of a box."""
    if sheet.count == 1:
        # a rigid block may tumble: its corners reach as far as its diagonal
        half = np.full(3, float(np.linalg.norm(half)))
    if turn >= np.pi:
        radius = np.linalg.norm(arms, axis=1)[:, None] * np.ones(3)
        return (-radius, radius), np.full(3, float(np.linalg.norm(half)))
    angles = np.linspace(-turn, turn, _TURN_STEPS)
    flat = arms @ sheet.rotation
    lows, highs, extent = [], [], np.zeros(3)
    for angle in angles:
        c, s = np.cos(angle), np.sin(angle)
        spun = sheet.rotation @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        turned = flat @ spun.T
        lows.append(turned)
        highs.append(turned)
        extent = half if sheet.count == 1 else np.maximum(extent, np.abs(spun) @ half)
    # between two sampled angles a point strays from them by at most its radius times this
    sag = (1 - np.cos(turn / (_TURN_STEPS - 1))) * np.linalg.norm(arms, axis=1)[:, None]
    return (np.min(lows, axis=0) - sag, np.max(highs, axis=0) + sag), extent
