"""Units of a text, and what bodies are called in it."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import (
    GROUND,
    Model,
)

KG, SECOND = 1e-3, 1e-3  # of a gram, of a millisecond


def body_name(model: Model, body: int) -> str:
    """Name of a body in the MDL file."""
    return "B_Ground" if body == GROUND else f"b_{model.bodies.name[body]}"


def reach(model: Model) -> float:
    """Size of the scene [mm], by which coordinates are measured."""
    size = [max(s.size) for s in model.sheets] + [g.radius + g.length for g in model.guides]
    return float(max(np.abs(model.bodies.position).max(initial=0.0), *size))
