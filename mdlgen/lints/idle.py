"""Lints of parts that do nothing: rollers that nothing turns or touches, sheets that nothing holds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.model.nips import nips
from mdlgen.model.parts.kinds import WITH_SHEET, kind_of
from mdlgen.model.tables import (
    BOX_BOX,
    SUPPORT,
    Floats,
    Model,
    SheetPart,
)


def idle_roller(model: Model) -> Iterator[Lint]:
    contacts = model.contacts
    rubs = (contacts.mu_static > 0.0) | (contacts.mu_dynamic > 0.0)
    for roller in model.rollers:
        own = np.array(
            [roller.name in pair for pair in zip(contacts.part_a, contacts.part_b, strict=True)], bool
        )
        if roller.speed is None and np.any(own) and not np.any(rubs & own):
            row = int(np.argmax(own))
            yield Lint(
                "W126",
                f"contacts.{contacts.called(row)}.friction",
                f"{roller.name} turns freely and none of its contacts has friction, so nothing turns it",
                "give friction, as friction: 0.5, or a drive",
            )


def idle_drive(model: Model) -> Iterator[Lint]:
    by_rules = model.reactions.ordered("speed")
    for roller in model.rollers:
        ordered = by_rules.get(roller.name, [])
        where = f"rollers.{roller.name}.drive"
        if roller.speed == 0.0 and not any(ordered):
            yield Lint(
                "W108",
                f"{where}.{'speed' if roller.profile is None else 'profile'}",
                "the drive holds the roller still (speed 0)",
                "leave drive out for a roller that turns freely, or give a speed",
            )
        elif roller.speed is not None and roller.ramp > model.run.duration and model.run.analysis != "static":
            yield Lint(
                "W113",
                f"{where}.ramp",
                f"the ramp of {roller.ramp:g} ms is longer than the run of {model.run.duration:g} ms",
                "run longer, or ramp faster",
            )
        way = roller.one_way
        senses = np.sign([*roller.corners[:, 1], *ordered])
        if way is not None and roller.speed is not None and np.any(senses == -way.direction):
            yield Lint(
                "W117",
                f"rollers.{roller.name}.one_way.direction",
                f"the drive turns in sense {-way.direction}, in which the clutch only holds the roller back: "
                "it never drives",
                "give the direction the sign of the speed",
            )
        late = [] if roller.profile is None else roller.profile[:, 0] > model.run.duration
        if np.any(late) and model.run.analysis != "static":
            first = int(np.argmax(late))
            yield Lint(
                "W113",
                f"{where}.profile.{first}",
                f"the corner at {roller.corners[first, 0]:g} ms is after the end, {model.run.duration:g} ms",
                "run longer, or leave out what comes after the run",
            )


def untouched(model: Model) -> Iterator[Lint]:
    parts = {*model.contacts.part_a, *model.contacts.part_b}
    parts |= {model.rollers[m.on].name for m in model.meshes if m.on >= 0 and m.name in parts}
    if not (model.machine or model.externals):
        return
    for sheet in model.sheets:
        if sheet.name not in parts:
            yield Lint(
                "W109",
                f"sheets.{sheet.name}",
                "the sheet has no contact with any roller, plane or guide of the scene",
                f"add to contacts like {{between: [{sheet.name}, ...], stiffness: 300 N/mm^1.5, "
                "friction: 0.5}",
            )
    machine = (
        *((kind_of(part).table, part) for part in model.machine),
        *(("parts", external) for external in model.externals),
    )
    for kind, part in machine:
        if part.name not in parts:
            yield Lint(
                "W111",
                f"{kind}.{part.name}",
                "the part has no contact, so it does nothing",
                "add a contact, or leave the part out",
            )


def free_static(model: Model) -> Iterator[Lint]:
    if model.run.analysis != "static":
        return
    for index, sheet in enumerate(model.sheets):
        held = _held(model, index, sheet)
        if sheet.clamp is None and held is not None and (free := 6 - held) > 0:
            yield Lint(
                "W110",
                f"sheets.{sheet.name}",
                f"in a static run the sheet is free to move in {free} of 6 ways as a rigid body",
                "clamp an edge, or support enough points",
            )


def _held(model: Model, index: int, sheet: SheetPart) -> int | None:
    """Rigid-body motions of a sheet that supports and contacts hold: the rank of their directions; None where
    it touches what is not known to hold it or not."""
    rows: list[Floats] = []

    def hold(point: Floats, direction: Floats) -> None:
        arm = (point - sheet.center) / max(sheet.size)
        rows.append(np.concatenate([direction, np.cross(arm, direction)]))

    bushings = model.bushings
    for k in np.flatnonzero((bushings.kind == SUPPORT) & (bushings.sheet == index)):
        for axis in np.flatnonzero(bushings.k[k, :3]):
            hold(bushings.origin[k], bushings.axes[k][:, axis])
    for _, part, roller in nips(model):
        if part is sheet:
            for end in (-0.5, 0.5):
                hold(
                    model.bodies.position[roller.body] + end * roller.width * roller.axis,
                    sheet.rotation[:, 2],
                )
    parts, table = {part.name: part for part in model.machine}, model.contacts
    for name, other, kind in zip(table.part_a, table.part_b, table.kind.tolist(), strict=True):
        if name != sheet.name or kind == BOX_BOX:
            continue
        held = WITH_SHEET[kind].constraints(model, sheet, parts[other]) if kind in WITH_SHEET else None
        if held is None:
            return None
        for point, way in held:
            hold(point, way)
    return int(np.linalg.matrix_rank(np.array(rows), tol=1e-9)) if rows else 0
