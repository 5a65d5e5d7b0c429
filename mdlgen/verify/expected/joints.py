"""Joints that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import (
    Floats,
    Model,
)
from mdlgen.verify.expected.graphics import under
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Part, Table, table


def joints(model: Model) -> Table:
    names, words, origins, axes = [], [], [], []

    def add(name: str, kind: str, a: str, b: str, origin: Floats, axis: Floats) -> None:
        names.append(name)
        words.append((kind, a, b))
        origins.append(origin)
        axes.append(axis)

    none = np.zeros(3)
    for body in np.flatnonzero(model.bodies.fixed).tolist():
        name = model.bodies.name[body]
        add(f"j_{name}", "FIXED", f"b_{name}", "B_Ground", model.bodies.position[body], none)
    for roller in model.rollers:
        name, at, on = roller.name, model.bodies.position[roller.body], "B_Ground"
        if roller.press is not None:
            on = f"b_{name}_carrier"
            add(f"j_{name}_slide", "TRANSLATIONAL", on, "B_Ground", at, roller.press.direction)
        if roller.arm is not None:
            on = f"b_{name}_arm"
            add(f"j_{name}_pivot", "REVOLUTE", on, "B_Ground", roller.arm.pivot, roller.axis)
        add(f"j_{name}", "REVOLUTE", f"b_{name}", on, at, roller.axis)
    for plate, press in model.plates:
        name, at = plate.name, model.bodies.position[plate.body]
        add(f"j_{name}_slide", "TRANSLATIONAL", f"b_{name}", "B_Ground", at, press.direction)
    for mesh in model.meshes:
        if mesh.on >= 0:
            at, name = model.bodies.position[mesh.body], mesh.name
            add(f"j_{name}", "FIXED", f"b_{name}", under(model, mesh), at, none)
    parts: dict[str, Part] = {
        "origin": (np.array(origins).reshape(-1, 3), reach(model)),
        "axis": (np.array(axes).reshape(-1, 3), 1.0),
    }
    return table(names, parts, words)
