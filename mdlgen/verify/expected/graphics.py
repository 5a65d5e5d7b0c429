"""Expected graphics: boxes and surfaces; cylinders and meshes are with the parts that they show."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.points import boxes_of
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Part, Table, table


def boxes(model: Model) -> Table:
    bodies = model.bodies
    rows = np.array([b for s in model.sheets for b in boxes_of(model, s)], dtype=int)
    shown = [box for part in model.machine for box in kind_of(part).boxes(model, part)]
    names = [f"gbox_{bodies.name[b]}" for b in rows] + [box.name for box in shown]
    words = [(f"b_{bodies.name[b]}",) for b in rows] + [(box.body,) for box in shown]
    turned = np.array([*bodies.rotation[rows], *(box.rotation for box in shown)]).reshape(-1, 3, 3)
    parts: dict[str, Part] = {
        "center": (np.array([*bodies.position[rows], *(box.center for box in shown)]), reach(model)),
        "axes": (turned.transpose(0, 2, 1), 1.0),
        "lengths": (np.array([*2 * bodies.half[rows], *(box.lengths for box in shown)]), None),
    }
    return table(names, parts, words)


def surfaces(model: Model) -> Table:
    names, words = [], []
    for sheet in model.sheets:
        if sheet.surface:
            names.append(f"defsur_{sheet.name}")
            boxes = [f"m_{model.bodies.name[b]}" for b in boxes_of(model, sheet)]
            words.append(("NATURAL", f"{sheet.n_y} rows", *boxes))
    return table(names, {}, words)
