"""Sheets at rollers: from when to when they touch, and how fast both are where they do."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mdlgen.model import meshes
from mdlgen.model.tables import BOX_CYLINDER, BOX_MESH, Floats, Ints, RollerPart
from mdlgen.results.contact_line import ContactLine, chosen, contact_line, of_row

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# A force below this part of a contact's greatest is a graze, as in the solvers' account of nips.
GRAZE = 0.05
# A sheet that bounces off for a shorter time has not left [ms], and one that touches for a shorter time
# only grazes.
SHORT = 1.0


@dataclass(frozen=True)
class Stay:
    """A sheet at a roller, from one stored time to another."""

    sheet: int
    roller: RollerPart
    first: int  # stored states
    last: int
    leaves: bool  # before the end of the run
    at: Ints  # the stored states at which it touches
    line: ContactLine  # at these


def stays_of(result: Result) -> list[Stay]:
    """Each time that a sheet is at a roller."""
    model, time = result.model, result.time
    sheets = {sheet.name: k for k, sheet in enumerate(model.sheets)}
    found = []
    for row in np.flatnonzero(model.contacts.kind == BOX_CYLINDER).tolist():
        force = result.contact_force[:, row]
        touching = force > GRAZE * force.max()
        sheet, roller = sheets[model.contacts.part_a[row]], model.roller(model.contacts.part_b[row])
        for first, last in intervals(time, touching, SHORT):
            at = np.flatnonzero(touching[first : last + 1]) + first
            states, lines = of_row(result, row)
            line = chosen(lines, np.searchsorted(states, at))
            found.append(Stay(sheet, roller, first, last, last + 1 < len(time), at, line))
    return found


def stays_at_meshes(result: Result) -> list[Stay]:
    """The same of meshes on driven rollers, each taken for a roller that is as large as it reaches."""
    model, time = result.model, result.time
    sheets = {sheet.name: k for k, sheet in enumerate(model.sheets)}
    parts = {mesh.name: mesh for mesh in model.meshes if mesh.on >= 0 and model.rollers[mesh.on].speed}
    found = []
    for row in np.flatnonzero(model.contacts.kind == BOX_MESH).tolist():
        mesh = parts.get(model.contacts.part_b[row])
        if mesh is None:
            continue
        carrier = model.rollers[mesh.on]
        roller = replace(carrier, name=mesh.name, radius=meshes.reach(mesh, carrier))
        force = result.contact_force[:, row]
        touching = force > GRAZE * force.max()
        boxes = model.pairs.a[model.pairs.contact == row]
        for first, last in intervals(time, touching, SHORT):
            at = np.flatnonzero(touching[first : last + 1]) + first
            line = contact_line(result, boxes, roller, at)
            sheet = sheets[model.contacts.part_a[row]]
            found.append(Stay(sheet, roller, first, last, last + 1 < len(time), at, line))
    return found


def intervals(time: Floats, holds: np.ndarray, short: float) -> list[tuple[int, int]]:
    """First and last state of each interval in which something holds. Breaks shorter than `short` are
    bridged. Intervals shorter than that are then dropped, unless the start or the end of the run cuts them
    off."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    runs = [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
    joined: list[tuple[int, int]] = []
    for first, last in runs:
        if joined and time[first] - time[joined[-1][1]] <= short:
            joined[-1] = (joined[-1][0], last)
        else:
            joined.append((first, last))
    end = len(time) - 1
    step = float(time[-1] - time[0]) / end  # it holds from some time before the first to some after the last
    return [(a, b) for a, b in joined if time[b] - time[a] + step >= short or a == 0 or b == end]
