"""Bodies that a text must have, and their velocities as it begins."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import (
    Model,
)
from mdlgen.verify.expected.points import boxes_of
from mdlgen.verify.expected.units import KG, SECOND, reach
from mdlgen.verify.tables import Part, Table, table


def bodies(model: Model) -> Table:
    bodies = model.bodies
    pressed = [r for r in model.rollers if r.press is not None]
    swung = [(r.name, r.arm) for r in model.rollers if r.arm is not None]
    names = [f"b_{n}" for n in bodies.name] + [f"b_{r.name}_carrier" for r in pressed]
    names += [f"b_{name}_arm" for name, _ in swung]
    carrier = np.array([r.press.carrier_mass for r in pressed if r.press is not None])
    radius = np.array([r.radius for r in pressed])
    ball = (0.4 * carrier * radius**2)[:, None] * np.ones(3)  # a solid ball of the roller's radius
    # of an arm the inertia about its own axis counts; the text gives it for all three
    arms = np.array([arm.inertia for _, arm in swung])[:, None] * np.ones(3)
    mass = np.concatenate([bodies.mass, carrier, [arm.mass for _, arm in swung]]) * KG
    inertia = np.concatenate([bodies.inertia, ball, arms.reshape(-1, 3)]) * KG
    places = [bodies.position[r.body][None] for r in pressed] + [arm.center[None] for _, arm in swung]
    position = np.concatenate([bodies.position, *places])
    axes = np.concatenate([bodies.rotation.transpose(0, 2, 1), *(np.eye(3)[None] for _ in places)])
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
    rows = np.array(rows, dtype=int)
    velocity, spin = model.bodies.velocity[rows] / SECOND, model.bodies.spin[rows] / SECOND
    parts: dict[str, Part] = {
        "velocity": (velocity, np.abs(velocity).max(initial=0.0)),
        "spin": (spin, np.abs(spin).max(initial=0.0)),
    }
    return table([f"b_{model.bodies.name[b]}" for b in rows], parts)
