"""Units of a text, and what bodies are called in it."""

from __future__ import annotations

from mdlgen.model.tables import (
    GROUND,
    Model,
)

KG, SECOND = 1e-3, 1e-3  # of a gram, of a millisecond


def body_name(model: Model, body: int) -> str:
    """Of a body in the text."""
    return "B_Ground" if body == GROUND else f"b_{model.bodies.name[body]}"
