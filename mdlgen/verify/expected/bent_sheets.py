"""Expected content of an MDL file for the shape of a sheet that is not flat."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.shape import outward
from mdlgen.model.tables import SheetPart


def shape(sheet: SheetPart) -> dict[str, float]:
    """Angles and places of the frames, and what dog-ears are turned about."""
    bend, found = sheet.bend, {}
    if bend is None:
        return found
    frames = bend.frames
    for k in range(1, len(frames.parent)):
        origin, turn = frames.origin[k], frames.rotation[k]
        crease = bend.creases[frames.crease[k]] if frames.crease[k] >= 0 else None
        across = np.eye(3)[bend.axis] if bend.axis >= 0 or crease is None else outward(crease)
        turned = turn @ across
        # from the parent on, since a sheet may turn by more than half a turn in all
        parent = int(frames.parent[k])
        swing = frames.rotation[parent].T @ turned
        before = found[f"a_{parent}"] if parent else 0.0
        found[f"a_{k}"] = before + math.atan2(swing[2], float(across @ swing))
        if bend.axis < 0 and crease is not None:
            found[f"{crease.name}_a"], found[f"{crease.name}_b"] = crease.size
            found[f"e_x_{k}"], found[f"e_y_{k}"] = float(across[0]), float(across[1])
            x, y = crease.line
            found[f"w_{k}"] = float(across[0] * sheet.lines_x[x] + across[1] * sheet.lines_y[y])
        if bend.start == "bent":
            axes = "xyz" if bend.axis < 0 else "xy"[bend.axis] + "z"
            found |= {f"{axis}_{k}": float(origin["xyz".index(axis)]) for axis in axes}
    return {f"ds_{sheet.name}_shape.real_{member}": value for member, value in found.items()}
