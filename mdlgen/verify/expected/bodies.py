"""Bodies that a text must have, and their velocities as it begins."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.masses import masses
from mdlgen.model.tables import Model
from mdlgen.verify.expected.parts.kinds import kind_of
from mdlgen.verify.expected.points import boxes_of
from mdlgen.verify.expected.units import KG, SECOND, reach
from mdlgen.verify.tables import Part, Table, table


def bodies(model: Model) -> Table:
    bodies = model.bodies
    more = [body for part in model.machine for body in kind_of(part).bodies(model, part)]
    names = [f"b_{n}" for n in bodies.name] + [body.name for body in more]
    own = masses(model)
    mass = np.concatenate([own.mass, [body.mass for body in more]]) * KG
    inertia = np.array([*own.inertia, *(body.inertia for body in more)]) * KG
    position = np.array([*own.place, *(body.place for body in more)])
    axes = np.array([*bodies.rotation.transpose(0, 2, 1), *(np.eye(3) for _ in more)])
    products = np.zeros_like(inertia)
    parts: dict[str, Part] = {
        "mass": (mass, None),
        "inertia": (inertia, None),
        "products": (products, inertia.max(axis=1, keepdims=True)),
        "cm": (position, reach(model)),
        "axes": (axes, 1.0),
    }
    return table(names, parts)


def velocities(model: Model) -> Table:
    rows = [
        b
        for s in model.sheets
        if np.any(s.velocity) or np.any(s.spin)
        for b in boxes_of(model, s)
        if not model.bodies.fixed[b]
    ]
    spun = [roller for roller in model.rollers if roller.first_spin != 0.0]
    still, turned = np.zeros((len(spun), 3)), [roller.first_spin * roller.axis for roller in spun]
    boxes, rows = np.array(rows, dtype=int), [*rows, *(roller.body for roller in spun)]
    velocity = np.concatenate([model.bodies.velocity[boxes], still]) / SECOND
    spin = np.concatenate([model.bodies.spin[boxes], np.reshape(turned, (-1, 3))]) / SECOND
    parts: dict[str, Part] = {
        "velocity": (velocity, np.abs(velocity).max(initial=0.0)),
        "spin": (spin, np.abs(spin).max(initial=0.0)),
    }
    return table([f"b_{model.bodies.name[b]}" for b in rows], parts)
