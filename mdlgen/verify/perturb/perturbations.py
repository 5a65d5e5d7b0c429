"""The values that a text can be turned by: each with what it must make of the Model.

The spec leaves values out that the text has to write (a second ratio of damping, the speeds of friction);
and two sheets may share a material while the text gives each its own. So the scene is pinned first: what is
left out is written as what it stands for. Which boxes may touch what, and where a pressed roller or plate
begins, is in the text as it was found for the scene as written; it stays so here, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from mdlgen.formulas import Amount
from mdlgen.model import grid
from mdlgen.model.lower import lower
from mdlgen.model.parameters.names import FRICTION, OF_USER
from mdlgen.model.parameters.starts import FOLLOWING, found, held
from mdlgen.model.stiffness import SUPPORT_FACTOR
from mdlgen.model.supports import joined, support_bushings
from mdlgen.model.tables import SUPPORT, Anchor, Bushings, Model, Parameter, Press, RollerPart
from mdlgen.spec.grading import Graded, Grading
from mdlgen.spec.parameter import Parameters
from mdlgen.spec.rim import TURN
from mdlgen.spec.scene import Scene
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.smoothing import speeds
from mdlgen.verify.expected.data import FACTORS, factor

STEP = 1.0625  # a value is turned to this many times itself, exactly
# A stiffness is turned far: k_z and k_tz follow the larger of two, and must follow the other one too.
FAR: dict[str, float] = {"MPa": 17.0, "N*mm": 17.0, "N*mm/rad": 17.0}
# and 0 to this, in internal units
FROM_ZERO = {"mm": 0.5, "rad": 0.125, "rad/ms": 0.03125, "mm/ms": 0.25, "N": 0.5, "ms": 0.25, "1": 0.0625}

_BEGINS = ("touch", "start")  # of what is pressed, computed for the scene as it is written

Path = tuple[str | int, ...]


class Perturbation(NamedTuple):
    """A number of a data set: where it stands, what it is turned to, and the Model that must come of it."""

    path: str  # in the text: ds_note.real_L_x
    value: float  # in the unit of the text
    model: Callable[[], Model]


def perturbations(scene: Scene, model: Model) -> Iterator[Perturbation]:
    """All numbers of the data sets of a Model that the spec, or the Model itself, has a value for."""
    base = pinned(scene)
    sheets = {s.name for s in model.sheets}
    for p in model.parameters:
        value = p.value * FAR.get(p.unit, STEP) if p.value else FROM_ZERO.get(p.unit, 0.5)
        if p.path is not None and p.path[-1:] == (0,) and "profile" in p.path:
            value = _later(scene, p)
        if p.path is not None and "sectors" in p.path and p.unit == "rad":
            value = _wider(scene, p)
        where = f"ds_{p.data_set}.real_{p.member}"
        path = _path(p, sheets)
        if p.data_set == OF_USER:
            yield Perturbation(where, value * factor(p.unit), _moved(base, model, p.member, value))
        elif path is not None:
            yield Perturbation(where, value * FACTORS[p.unit], _turned(base, path, value, model))
        elif p.member in _BEGINS:
            yield Perturbation(where, value * FACTORS[p.unit], _begun(model, p.data_set, p.member, value))
    for kind, anchors in (("probes", model.probes), ("supports", model.supports)):
        for k, item in enumerate(anchors):
            if item.edge is not None:
                continue
            key: str | int = item.name if kind == "probes" else k
            data_set = f"probe_{item.name}" if kind == "probes" else item.name
            for axis in range(2):
                value = item.at[axis] / STEP if item.at[axis] else FROM_ZERO["mm"]
                turned = _turned(base, (kind, key, "at", axis), value, model)
                yield Perturbation(f"ds_{data_set}.real_{'xy'[axis]}", value, turned)
    for item in model.supports:
        stiffer = SUPPORT_FACTOR * STEP
        yield Perturbation(f"ds_{item.name}.real_factor", stiffer, _stiffer(model, item.name))


def _moved(scene: Scene, base: Model, name: str, value: float) -> Callable[[], Model]:
    """A parameter that the user named: all that a text has formulas for follows."""

    def model() -> Model:
        own = Amount(value, scene.amounts[name].dimension)
        parameters = Parameters({**scene.parameters, name: own})
        sheets, changed = {s.name for s in base.sheets}, scene.model_copy()
        changed._amounts = parameters.amounts
        for p in base.parameters:
            path = _path(p, sheets)
            if p.formula and p.data_set != OF_USER and path is not None:
                changed = _with(changed, path, parameters.evaluated(p.formula).value)
        for kind, anchors in (("probes", base.probes), ("supports", base.supports)):
            for k, item in enumerate(anchors):
                for axis, text in enumerate(item.formulas):
                    if text:
                        path = (kind, item.name if kind == "probes" else k, "at", axis)
                        changed = _with(changed, path, parameters.evaluated(text).value)
        for sheet in sheets:
            changed = _along(changed, scene, sheet)
        return as_written(changed, base, scene)

    return model


def _later(scene: Scene, time: Parameter) -> float:
    """A time of a corner of a drive, turned to one before the next corner [ms]."""
    assert time.path is not None
    _, name, _, _, k, _ = time.path
    drive = scene.rollers[str(name)].drive
    assert drive is not None and drive.profile is not None and isinstance(k, int)
    after = [corner for corner, _ in drive.profile[k + 1 :]]
    return time.value + 0.25 * (after[0] - time.value) if after else (time.value + FROM_ZERO["ms"]) * STEP


def _wider(scene: Scene, angle: Parameter) -> float:
    """An end of a sector of a rim, turned into a quarter of the gap beyond it, so that there still is one;
    where there is none, into the sector beyond [rad]."""
    assert angle.path is not None
    _, name, _, _, k, end = angle.path
    rim = scene.rollers[str(name)].rim
    assert rim is not None and isinstance(k, int)
    sectors, last = rim.sectors, len(rim.sectors) - 1
    if end == "to":
        after = sectors[k + 1].from_ if k < last else sectors[0].from_ + TURN
        return angle.value + (0.25 * (after - angle.value) or FROM_ZERO["rad"])
    before = sectors[k - 1].to if k > 0 else sectors[last].to - TURN
    return angle.value - (0.25 * (angle.value - before) or FROM_ZERO["rad"])


def pinned(scene: Scene) -> Scene:
    """The same scene with each value that the text writes standing on its own."""
    materials = {}
    for name, sheet in scene.sheets.items():
        material = scene.materials[sheet.material]
        damping = material.damping
        if damping.times is None:
            ratio, ty = damping.zetas
            damping = damping.model_copy(update={"ratio": ratio, "ratio_ty": ty})
        materials[name] = material.model_copy(update={"damping": damping})
    sheets = {
        name: sheet.model_copy(update={"material": name, "grading": _given_lengths(sheet)})
        for name, sheet in scene.sheets.items()
    }
    rollers = {}
    for name, roller in scene.rollers.items():
        press = roller.press
        if press is not None and press.carrier_mass is None:
            press = press.model_copy(update={"carrier_mass": roller.mass / 1000})
        rollers[name] = roller.model_copy(update={"press": press})
    contacts = []
    for contact, (smoothing, slow, fast) in zip(scene.contacts, speeds(scene), strict=True):
        own = {"stiction_velocity": slow, "friction_velocity": fast}
        friction = contact.friction.model_copy(update=own)
        contacts.append(contact.model_copy(update={"friction": friction, "smoothing": smoothing}))
    run = scene.run
    if run.print_step is None:
        run = run.model_copy(update={"print_step": run.duration / 200})
    return scene.model_copy(
        update={
            "materials": materials,
            "sheets": sheets,
            "rollers": rollers,
            "contacts": tuple(contacts),
            "run": run,
        }
    )


def _given_lengths(sheet: Sheet) -> Grading | None:
    """The lengths of boxes that are finer near some places, one by one."""
    if sheet.grading is None:
        return None
    sides = (sheet.grading.x, sheet.grading.y)
    x, y = (
        None if side is None else Graded(sizes=side.relative(count, length))
        for side, count, length in zip(sides, sheet.boxes, sheet.size, strict=True)
    )
    return Grading(x=x, y=y)


def _path(parameter: Parameter, sheets: set[str]) -> Path | None:
    """Where a parameter stands in the pinned scene."""
    path = parameter.path
    if path is None and parameter.member in FRICTION:
        index = int(parameter.data_set.removeprefix("contact_"))
        return ("contacts", index, "friction", FRICTION[parameter.member])
    if path is not None and path[0] == "materials":
        assert parameter.data_set in sheets
        return ("materials", parameter.data_set, *path[2:])
    return path


def _turned(scene: Scene, path: Path, value: float, base: Model) -> Callable[[], Model]:
    def model() -> Model:
        changed = _with(scene, path, value)
        if path[0] == "sheets" and path[2] in ("size", "grading"):
            changed = _along(changed, scene, str(path[1]))
        return as_written(changed, base, scene)

    return model


def _with(owner: Any, path: Path, value: float) -> Any:
    """A copy of `owner` with the value at a path; not validated, since it is the Model that is asked for."""
    if not path:
        return value
    first, rest = path[0], path[1:]
    if isinstance(owner, BaseModel):
        name = next((n for n, f in type(owner).model_fields.items() if f.alias == first), str(first))
        return owner.model_copy(update={name: _with(getattr(owner, name), rest, value)})
    if isinstance(owner, dict):
        return {**owner, first: _with(owner[first], rest, value)}
    assert isinstance(first, int)
    return (*owner[:first], _with(owner[first], rest, value), *owner[first + 1 :])


def _along(scene: Scene, base: Scene, name: str) -> Scene:
    """Clamp and zones go with the lines between boxes: the text has the one in cells, the other in shares."""
    before, sheet = base.sheets[name], scene.sheets[name]
    lines = list(zip(before.lines, sheet.lines, strict=True))

    def moved(side: tuple[float, float], axis: int) -> tuple[float, float]:
        low, high = np.interp(side, *lines[axis]).tolist()
        return low, high

    zones = {
        key: zone.model_copy(update={"x": moved(zone.x, 0), "y": moved(zone.y, 1)})
        for key, zone in sheet.zones.items()
    }
    clamp = sheet.clamp
    if clamp is not None:
        axis, low = "xy".index(clamp.edge[0]), clamp.edge.endswith("min")
        row = before.clamped_rows()
        away = (
            lines[axis][1][row] - lines[axis][1][0] if low else lines[axis][1][-1] - lines[axis][1][-1 - row]
        )
        clamp = clamp.model_copy(update={"length": away})
    shape = sheet.shape
    if shape is not None:
        folds = tuple(
            fold.model_copy(update={"at": moved((fold.at, fold.at), "xy".index(fold.along))[0]})
            for fold in shape.folds
        )
        shape = shape.model_copy(update={"folds": folds})
    sheet = sheet.model_copy(update={"zones": zones, "clamp": clamp, "shape": shape})
    return scene.model_copy(update={"sheets": {**scene.sheets, name: sheet}})


def _begun(model: Model, part: str, member: str, value: float) -> Callable[[], Model]:
    """A pressed roller or plate that begins, or touches, elsewhere."""

    def turned() -> Model:
        starts = _presses(model)
        return _placed(model, {**starts, part: replace(starts[part], **{member: value})})

    return turned


def _presses(model: Model) -> dict[str, Press]:
    parts = (*model.rollers, *model.planes)
    return {part.name: part.press for part in parts if part.press is not None}


def _stiffer(model: Model, support: str) -> Callable[[], Model]:
    def turned() -> Model:
        rows = model.bushings
        mine = np.array([n.rpartition("_")[0] == support for n in rows.name]) & (rows.kind == SUPPORT)
        k, c = rows.k.copy(), rows.c.copy()
        k[mine] *= STEP
        c[mine] *= np.sqrt(STEP)
        return replace(model, bushings=replace(rows, k=k, c=c))

    return turned


def as_written(scene: Scene, base: Model, before: Scene) -> Model:
    """The Model of a scene with what a text keeps as it was written for `base`, that of `before`."""
    made = _begins(lower(scene), scene, base, before)
    probes = tuple(_held(new, old, made) for new, old in zip(made.probes, base.probes, strict=True))
    supports = tuple(_held(new, old, made) for new, old in zip(made.supports, base.supports, strict=True))
    shown = zip(made.guides, base.guides, strict=True)
    guides = tuple(replace(new, facets=old.facets) for new, old in shown)
    rims = zip(made.rollers, base.rollers, strict=True)
    made = replace(made, rollers=tuple(_shown(new, old) for new, old in rims))
    made = replace(made, pairs=base.pairs, probes=probes, supports=supports, guides=guides)
    if not supports:
        return made
    held = support_bushings(scene.supports, supports, made.sheets, made.bodies)
    return replace(made, bushings=joined([_rows(made.bushings, made.bushings.kind != SUPPORT), *held]))


def _begins(made: Model, scene: Scene, base: Model, before: Scene) -> Model:
    """With rollers that begin where the text has it: as it was written, or as it follows for those that are
    held by the contact that held them then."""
    presses, numbers = _presses(base), {}
    for name in {p.data_set for p in base.parameters if p.follows}:
        was = presses[name]
        what = held(before, name, base.sheets, base.contacts, (was.touch, was.start))
        assert what is not None, "so it has formulas"
        numbers[name] = found(scene, what)
        presses[name] = replace(was, **{k: v for k, v in numbers[name].items() if k in _BEGINS})
    rows = [p for p in made.parameters if p.data_set not in presses or p.member not in FOLLOWING]
    for p in base.parameters:
        if p.data_set in presses and p.member in FOLLOWING:
            rows.append(replace(p, value=numbers[p.data_set][p.member]) if p.follows else p)
    return _placed(replace(made, parameters=tuple(rows)), presses)


def _shown(new: RollerPart, old: RollerPart) -> RollerPart:
    """A roller whose rim is shown by as many boxes."""
    if new.rim is None or old.rim is None:
        return new
    return replace(new, rim=replace(new.rim, facets=old.rim.facets))


def _rows(table: Bushings, keep: NDArray[np.bool_]) -> Bushings:
    rows = np.flatnonzero(keep)
    arrays = [getattr(table, f.name)[rows] for f in fields(Bushings)[2:]]
    name, label = (tuple(column[row] for row in rows.tolist()) for column in (table.name, table.label))
    return Bushings(name, label, *arrays)


def _placed(model: Model, starts: dict[str, Press]) -> Model:
    """Pressed rollers and plates that touch and begin where `starts` has it."""
    if not starts:
        return model
    position = model.bodies.position.copy()
    rollers = []
    for roller in model.rollers:
        if roller.press is not None:
            start, roller_start = starts[roller.name], roller.press.start
            press = replace(roller.press, touch=start.touch, start=start.start)
            position[roller.body] = roller.center + press.direction * press.start
            for mesh in model.meshes:
                if mesh.on >= 0 and model.rollers[mesh.on].name == roller.name:
                    position[mesh.body] += press.direction * (press.start - roller_start)
            roller = replace(roller, press=press)
        rollers.append(roller)
    planes = []
    for plane in model.planes:
        if plane.press is not None:
            press = replace(plane.press, touch=starts[plane.name].touch, start=starts[plane.name].start)
            position[plane.body] = plane.center + press.direction * press.start
            plane = replace(plane, press=press)
        planes.append(plane)
    parameters = tuple(
        replace(p, value=getattr(starts[p.data_set], p.member))
        if p.data_set in starts and p.member in _BEGINS
        else p
        for p in model.parameters
    )
    bodies = replace(model.bodies, position=position)
    parts = {"rollers": tuple(rollers), "planes": tuple(planes)}
    return replace(model, **parts, bodies=bodies, parameters=parameters)


def _held(new: Anchor, old: Anchor, model: Model) -> Anchor:
    """An anchor on the boxes that it was written for, at its place now."""
    sheet = model.sheets[old.sheet]
    row, column = np.divmod(old.body - sheet.first, sheet.n_x)
    centers = grid.local(sheet, 2.0 * column + 1, 2.0 * row + 1)
    local = np.array([*new.at, 0.0]) - centers
    return replace(new, body=old.body, local=local, share=old.share, node=old.node)
