"""The Model of a scene with what a text keeps: as it was written for another scene."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from mdlgen.model import grid
from mdlgen.model.lower import lower
from mdlgen.model.lowering.supports import joined, support_bushings
from mdlgen.model.parameters.starts import FOLLOWING, found, held
from mdlgen.model.tables import SUPPORT, Anchor, Bushings, Loads, MachinePart, Model, Press, RollerPart
from mdlgen.spec.scene import Scene

BEGINS = ("touch", "start")  # of pressed parts, computed for the scene as it is written


def as_written(scene: Scene, base: Model, before: Scene) -> Model:
    """The Model of a scene with what a text keeps as it was written for `base`, that of `before`."""
    made = _begins(lower(scene), scene, base, before)
    probes = tuple(_held(new, old, made) for new, old in zip(made.probes, base.probes, strict=True))
    supports = tuple(_held(new, old, made) for new, old in zip(made.supports, base.supports, strict=True))
    shown = zip(made.guides, base.guides, strict=True)
    guides = [replace(new, facets=old.facets) for new, old in shown]
    rims = zip(made.rollers, base.rollers, strict=True)
    made = made.with_parts([*guides, *(_shown(new, old) for new, old in rims)])
    loads = _loaded(made, base, scene)
    made = replace(made, pairs=base.pairs, probes=probes, supports=supports, loads=loads)
    if not supports:
        return made
    held = support_bushings(scene.supports, supports, made.sheets, made.bodies)
    return replace(made, bushings=joined([rows_of(made.bushings, made.bushings.kind != SUPPORT), *held]))


def _begins(made: Model, scene: Scene, base: Model, before: Scene) -> Model:
    """With rollers that begin where the text has it: as it was written, or as it follows for those that are
    held by the contact that held them then."""
    begun, numbers = presses(base), {}
    for name in {p.data_set for p in base.parameters if p.follows}:
        was = begun[name]
        what = held(before, name, base.sheets, base.contacts, (was.touch, was.start))
        assert what is not None, "so it has formulas"
        numbers[name] = found(scene, what)
        begun[name] = replace(was, **{k: v for k, v in numbers[name].items() if k in BEGINS})
    rows = [p for p in made.parameters if p.data_set not in begun or p.member not in FOLLOWING]
    for p in base.parameters:
        if p.data_set in begun and p.member in FOLLOWING:
            rows.append(replace(p, value=numbers[p.data_set][p.member]) if p.follows else p)
    return placed(replace(made, parameters=tuple(rows)), begun)


def _loaded(made: Model, base: Model, scene: Scene) -> Loads:
    """Loads on the boxes that they were written for."""
    was, now, turn = base.loads, made.loads, {s.name: s for s in made.sheets}
    rows = {pair: k for k, pair in enumerate(zip(now.entry.tolist(), now.body.tolist(), strict=True))}
    count = dict(zip(*np.unique(was.entry, return_counts=True), strict=True))
    local, force, moment = np.zeros((3, len(was.body), 3))
    for k, (entry, body) in enumerate(zip(was.entry.tolist(), was.body.tolist(), strict=True)):
        load = scene.loads[entry]
        if load.at is None:
            row = rows[entry, body]
            local[k], force[k], moment[k] = now.local[row], now.force[row], now.moment[row]
            continue
        assert load.force is not None
        sheet = turn[load.sheet]
        row, column = divmod(body - sheet.first, sheet.n_x)
        local[k] = np.array([*load.at, 0.0]) - grid.local(sheet, 2.0 * column + 1, 2.0 * row + 1)
        force[k] = sheet.rotation @ np.array(load.force) / count[entry]
    return replace(was, local=local, force=force, moment=moment, profiles=now.profiles)


def _shown(new: RollerPart, old: RollerPart) -> RollerPart:
    """A roller whose rim is shown by as many boxes."""
    if new.rim is None or old.rim is None:
        return new
    return replace(new, rim=replace(new.rim, facets=old.rim.facets))


def rows_of(table: Bushings, keep: NDArray[np.bool_]) -> Bushings:
    rows = np.flatnonzero(keep)
    arrays = [getattr(table, f.name)[rows] for f in fields(Bushings)[2:]]
    name, label = (tuple(column[row] for row in rows.tolist()) for column in (table.name, table.label))
    return Bushings(name, label, *arrays)


def placed(model: Model, starts: dict[str, Press]) -> Model:
    """Pressed rollers and plates that touch and begin where `starts` has it."""
    if not starts:
        return model
    position = model.bodies.position.copy()
    parts: list[MachinePart] = []
    for roller in model.rollers:
        if roller.press is not None:
            start, roller_start = starts[roller.name], roller.press.start
            press = replace(roller.press, touch=start.touch, start=start.start)
            position[roller.body] = roller.center + press.direction * press.start
            for mesh in model.meshes:
                if mesh.on >= 0 and model.rollers[mesh.on].name == roller.name:
                    position[mesh.body] += press.direction * (press.start - roller_start)
            parts.append(replace(roller, press=press))
    for plane, spring in model.plates:
        press = replace(spring, touch=starts[plane.name].touch, start=starts[plane.name].start)
        position[plane.body] = plane.center + press.direction * press.start
        parts.append(replace(plane, press=press))
    parameters = tuple(
        replace(p, value=getattr(starts[p.data_set], p.member))
        if p.data_set in starts and p.member in BEGINS
        else p
        for p in model.parameters
    )
    bodies = replace(model.bodies, position=position)
    return replace(model.with_parts(parts), bodies=bodies, parameters=parameters)


def _held(new: Anchor, old: Anchor, model: Model) -> Anchor:
    """An anchor on the boxes that it was written for, at its place now."""
    sheet = model.sheets[old.sheet]
    row, column = np.divmod(old.body - sheet.first, sheet.n_x)
    centers = grid.local(sheet, 2.0 * column + 1, 2.0 * row + 1)
    local = np.array([*new.at, 0.0]) - centers
    return replace(new, body=old.body, local=local, share=old.share, node=old.node)


def presses(model: Model) -> dict[str, Press]:
    parts = (*model.rollers, *model.planes)
    return {part.name: part.press for part in parts if part.press is not None}
