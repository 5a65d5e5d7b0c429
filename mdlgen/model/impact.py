"""How long a rigid block is in contact: what a solver's step is measured by."""

from __future__ import annotations

import math

from mdlgen.model.tables import Model, PlanePart, SheetPart


def impact_time(model: Model, row: int, mass: float) -> float:
    """Duration of an undamped impact [ms] at the greatest speed that the scene can give:
    T = 3.21806546 (m^2 / (k^2 v))^(1/5). Against a box of another sheet, or a pressed plate, the reduced
    mass counts."""
    sheet = next(s for s in model.sheets if s.name == model.contacts.part_a[row])
    parts = (*model.rollers, *model.planes, *model.guides, *model.meshes, *model.sheets)
    part = next(p for p in parts if p.name == model.contacts.part_b[row])
    gravity, start = math.hypot(*model.gravity), math.hypot(*sheet.velocity)
    if isinstance(part, SheetPart):
        mass = mass * part.derived["m"] / (mass + part.derived["m"])
        start += math.hypot(*part.velocity)
    if isinstance(part, PlanePart) and part.press is not None:
        mass = mass * part.sliding_mass / (mass + part.sliding_mass)
    fall = math.dist(part.center, sheet.center)
    speed = max(
        min(start + gravity * model.run.duration, math.hypot(start, math.sqrt(2 * gravity * fall))), 1e-6
    )
    return 3.21806546 * (mass**2 / (float(model.contacts.stiffness[row]) ** 2 * speed)) ** 0.2
