"""Joints that a text must have."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Model
from mdlgen.verify.expected.parts.kind import Joint
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.units import reach
from mdlgen.verify.tables import Part, Table, table


def joints(model: Model) -> Table:
    found = []
    for body in np.flatnonzero(model.bodies.fixed).tolist():
        name = model.bodies.name[body]
        at = model.bodies.position[body]
        found.append(Joint(f"j_{name}", "FIXED", f"b_{name}", "B_Ground", at, np.zeros(3)))
    found += [joint for part in model.machine for joint in kind_of(part).joints(model, part)]
    parts: dict[str, Part] = {
        "origin": (np.array([joint.origin for joint in found]).reshape(-1, 3), reach(model)),
        "axis": (np.array([joint.axis for joint in found]).reshape(-1, 3), 1.0),
    }
    words = [(joint.type, joint.one, joint.two) for joint in found]
    return table([joint.name for joint in found], parts, words)
