"""The bend that a sheet keeps where it has yielded: curvature, strain, folds and curl that are left."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mdlgen.model.tables import Floats, Model
from mdlgen.results.result import Result
from mdlgen.results.strain import SheetJoints, sheet_joints


def left(result: Result) -> Floats | None:
    """Curvature that each joint would keep at each stored time if its moment were taken away [1/mm],
    (t, joints), positive where the sheet bends towards its normal; 0 of joints that are elastic. None where
    nothing yields.

    It is the plastic one, but for a joint that yields back before its moment is 0: that keeps M_y/H.
    """
    if result.plastic is None:
        return None
    model, joints = result.model, sheet_joints(result.model)
    found = np.zeros((len(result.plastic), len(joints)))
    rows, of = _rows(model, joints)
    most = (model.plastic.moment / model.plastic.hardening)[rows]
    found[:, of] = np.clip(result.plastic[:, rows], -most, most)
    # towards the normal: about -y for joints along x, about x for joints along y
    return found * (np.where(joints.axis == 0, -1.0, 1.0) * joints.way / joints.length)


def _rows(model: Model, joints: SheetJoints) -> tuple[np.ndarray, np.ndarray]:
    """Rows of Model.plastic, and the joint of each: the bushings of one have the same rotation."""
    number = {int(bushing): k for k, bushing in enumerate(joints.bushing)}
    found = [(k, number[int(b)]) for k, b in enumerate(model.plastic.bushing) if int(b) in number]
    rows = np.array(found, dtype=np.int64).reshape(-1, 2)
    return rows[:, 0], rows[:, 1]


def of_sheet(result: Result, index: int) -> dict[str, Any] | None:
    """Residual deformation of a sheet at the end of a run. It holds the greatest curvature of a joint with
    the strain of its faces there, the sharpest fold, and the curl. None where it does not yield.

    A fold is the mean residual rotation of the joints of one line across the sheet. The curl is the mean
    curvature, the sum over all such lines divided by the length of the sheet.
    """
    curvature, model = left(result), result.model
    joints, sheet = sheet_joints(model), model.sheets[index]
    yields = model.bushings.sheet[model.plastic.bushing] == index
    if curvature is None or not len(curvature) or not yields.any():
        return None
    own = np.flatnonzero(joints.sheet == index)
    last = curvature[-1, own]
    most = own[int(np.argmax(np.abs(last)))]
    thick = sheet.thick[joints.b[most] - sheet.first]
    record: dict[str, Any] = {
        "curvature_per_mm": curvature[-1, most],
        "strain": 0.5 * thick * abs(curvature[-1, most]),
        "along": ("md", "cd")[joints.axis[most]],
        "at_mm": joints.at[most],
        "joint": joints.name[most],
    }
    folds = [fold for axis in (0, 1) for fold in _folds(joints, curvature[-1], own, axis)]
    angle, axis, at = max(folds, key=lambda fold: abs(fold[0]))
    record["fold"] = {"angle_deg": math.degrees(angle), "along": ("md", "cd")[axis], "at_mm": at}
    for axis, way in enumerate(("md", "cd")):
        total = sum(fold[0] for fold in folds if fold[1] == axis)
        record[f"curl_{way}_per_mm"] = total / sheet.outline[axis]
    return record


def _folds(
    joints: SheetJoints, curvature: Floats, own: np.ndarray, axis: int
) -> list[tuple[float, int, float]]:
    """(angle [rad], axis, place along it [mm]) of each line across the sheet between boxes."""
    mine = own[joints.axis[own] == axis]
    lines = np.round(joints.at[mine, axis], 9)
    return [
        (
            float((curvature[mine] * joints.length[mine])[lines == at].mean()),
            axis,
            float(at),
        )
        for at in np.unique(lines)
    ]
