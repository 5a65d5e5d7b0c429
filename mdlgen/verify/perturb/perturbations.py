"""The values of an MDL file that can be changed: each with the change of the Model that it must cause.

The spec leaves out values that the file has to write (a second ratio of damping, the speeds of friction). Two
sheets may also share a material while the file gives each its own. So the scene is pinned first: values that
are left out are written with their defaults. The pairs of boxes that may touch, and the start of a pressed
roller or plate, are in the file as they were found for the scene as written; they stay so here, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from pydantic import BaseModel

from mdlgen.formulas import Amount
from mdlgen.model.lowering.stiffness import SUPPORT_FACTOR
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.parameters.run import RUN
from mdlgen.model.tables import SUPPORT, Model, Parameter
from mdlgen.spec.parameter import Parameters
from mdlgen.spec.rim import TURN
from mdlgen.spec.scene import Scene
from mdlgen.verify.expected.data import FACTORS, factor
from mdlgen.verify.perturb.pinned import Path, along_lines, path_of, pinned, with_value
from mdlgen.verify.perturb.written import BEGINS, as_written, placed, presses

STEP = 1.0625  # a value is changed to this many times itself, exactly
# A stiffness is changed far: k_z and k_tz follow the larger of two, and must follow the other one too.
FAR: dict[str, float] = {"MPa": 17.0, "N*mm": 17.0, "N*mm/rad": 17.0}
# and 0 to this, in internal units
FROM_ZERO = {"mm": 0.5, "rad": 0.125, "rad/ms": 0.03125, "mm/ms": 0.25, "N": 0.5, "ms": 0.25, "1": 0.0625}
FROM_ZERO |= {"mm/ms^2": 2.0**-9}

# Lists whose rows begin with numbers that increase.
RISING = ("profile", "voltage", "table")


class Perturbation(NamedTuple):
    """A number of a data set: where it stands, what it is changed to, and the Model that must come of it."""

    path: str  # in the text: ds_note.real_L_x
    value: float  # in the unit of the text
    model: Callable[[], Model]


def perturbations(scene: Scene, model: Model) -> Iterator[Perturbation]:
    """All numbers of the data sets of a Model that the spec, or the Model itself, has a value for."""
    base = pinned(scene)
    sheets = {s.name for s in model.sheets}
    for p in model.parameters:
        value = p.value * FAR.get(p.unit, STEP) if p.value else FROM_ZERO.get(p.unit, 0.5)
        if p.path is not None and _rises(p.path):
            value = _later(scene, p.path, value)
        if p.path is not None and "sectors" in p.path and p.unit == "rad":
            value = _wider(scene, p)
        where = f"ds_{p.data_set}.real_{p.member}"
        path = path_of(p, sheets)
        if p.data_set == OF_USER:
            yield Perturbation(where, value * factor(p.unit), _moved(base, model, p.member, value))
        elif path is not None:
            yield Perturbation(where, value * FACTORS[p.unit], _perturbed(base, path, value, model))
        elif p.data_set == RUN:
            yield Perturbation(where, value * FACTORS[p.unit], _set(model, p, value))
        elif p.member in BEGINS:
            yield Perturbation(where, value * FACTORS[p.unit], _begun(model, p.data_set, p.member, value))
    for kind, anchors in (("probes", model.probes), ("supports", model.supports)):
        for k, item in enumerate(anchors):
            if item.edge is not None:
                continue
            key: str | int = item.name if kind == "probes" else k
            data_set = f"probe_{item.name}" if kind == "probes" else item.name
            for axis in range(2):
                value = item.at[axis] / STEP if item.at[axis] else FROM_ZERO["mm"]
                perturbed = _perturbed(base, (kind, key, "at", axis), value, model)
                yield Perturbation(f"ds_{data_set}.real_{'xy'[axis]}", value, perturbed)
    for item in model.supports:
        stiffer = SUPPORT_FACTOR * STEP
        yield Perturbation(f"ds_{item.name}.real_factor", stiffer, _stiffer(model, item.name))


def _set(model: Model, parameter: Parameter, value: float) -> Callable[[], Model]:
    """A value that no spec has, and that nothing follows from but what is written."""
    rows = tuple(replace(p, value=value) if p == parameter else p for p in model.parameters)
    return lambda: replace(model, parameters=rows)


def _moved(scene: Scene, base: Model, name: str, value: float) -> Callable[[], Model]:
    """A parameter that the user named: all that a text has formulas for follows."""

    def model() -> Model:
        own = Amount(value, scene.amounts[name].dimension)
        parameters = Parameters({**scene.parameters, name: own})
        sheets, changed = {s.name for s in base.sheets}, scene.model_copy()
        changed._amounts = parameters.amounts
        for p in base.parameters:
            path = path_of(p, sheets)
            if p.formula and p.data_set != OF_USER and path is not None:
                changed = with_value(changed, path, parameters.evaluated(p.formula).value)
        for kind, anchors in (("probes", base.probes), ("supports", base.supports)):
            for k, item in enumerate(anchors):
                for axis, text in enumerate(item.formulas):
                    if text:
                        path = (kind, item.name if kind == "probes" else k, "at", axis)
                        changed = with_value(changed, path, parameters.evaluated(text).value)
        for sheet in sheets:
            changed = along_lines(changed, scene, sheet)
        return as_written(changed, base, scene)

    return model


def _rises(path: Path) -> bool:
    """Whether it is the first number of a row of a list whose rows rise with it."""
    return len(path) > 3 and path[-1] == 0 and isinstance(path[-2], int) and path[-3] in RISING


def _later(scene: Scene, path: Path, value: float) -> float:
    """The first number of a corner, as a time, changed to one before that of the next corner."""
    corners: Any = scene
    for step in path[:-2]:
        corners = getattr(corners, str(step)) if isinstance(corners, BaseModel) else corners[step]
    k = int(path[-2])
    here, after = corners[k][0], [first for first, _ in corners[k + 1 :]]
    return here + 0.25 * (after[0] - here) if after else value


def _wider(scene: Scene, angle: Parameter) -> float:
    """An end of a sector of a rim, moved into a quarter of the gap beyond it, so that there still is one;
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


def _perturbed(scene: Scene, path: Path, value: float, base: Model) -> Callable[[], Model]:
    def model() -> Model:
        changed = with_value(scene, path, value)
        if path[0] == "sheets" and path[2] in ("size", "grading"):
            changed = along_lines(changed, scene, str(path[1]))
        return as_written(changed, base, scene)

    return model


def _begun(model: Model, part: str, member: str, value: float) -> Callable[[], Model]:
    """A pressed roller or plate that begins, or touches, elsewhere."""

    def perturbed() -> Model:
        starts = presses(model)
        return placed(model, {**starts, part: replace(starts[part], **{member: value})})

    return perturbed


def _stiffer(model: Model, support: str) -> Callable[[], Model]:
    def perturbed() -> Model:
        rows = model.bushings
        mine = np.array([n.rpartition("_")[0] == support for n in rows.name]) & (rows.kind == SUPPORT)
        k, c = rows.k.copy(), rows.c.copy()
        k[mine] *= STEP
        c[mine] *= np.sqrt(STEP)
        return replace(model, bushings=replace(rows, k=k, c=c))

    return perturbed
