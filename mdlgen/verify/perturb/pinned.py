"""A scene in which each value that a text writes stands on its own, and a copy of it with one changed."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import BaseModel

from mdlgen.model.parameters.names import FRICTION
from mdlgen.model.parameters.run import PAPER_STEP
from mdlgen.model.tables import Parameter
from mdlgen.spec.grading import Graded, Grading
from mdlgen.spec.scene import Scene
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.smoothing import speeds

Path = tuple[str | int, ...]


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
    if run.step is None:
        run = run.model_copy(update={"step": min(PAPER_STEP, run.print_step or PAPER_STEP)})
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


def path_of(parameter: Parameter, sheets: set[str]) -> Path | None:
    """Path of a parameter in the pinned scene."""
    path = parameter.path
    if path is None and parameter.member in FRICTION:
        index = int(parameter.data_set.removeprefix("contact_"))
        return ("contacts", index, "friction", FRICTION[parameter.member])
    if path is not None and path[0] == "materials":
        assert parameter.data_set in sheets
        return ("materials", parameter.data_set, *path[2:])
    return path


def with_value(owner: Any, path: Path, value: float) -> Any:
    """A copy of `owner` with the value at a path; not validated, since it is the Model that is asked for."""
    if not path:
        return value
    first, rest = path[0], path[1:]
    if isinstance(owner, BaseModel):
        name = next((n for n, f in type(owner).model_fields.items() if f.alias == first), str(first))
        return owner.model_copy(update={name: with_value(getattr(owner, name), rest, value)})
    if isinstance(owner, dict):
        return {**owner, first: with_value(owner[first], rest, value)}
    assert isinstance(first, int)
    return (*owner[:first], with_value(owner[first], rest, value), *owner[first + 1 :])


def along_lines(scene: Scene, base: Scene, name: str) -> Scene:
    """Clamp and zones follow the lines between boxes: the MDL file has the clamp in cells, zones in
    shares."""
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
