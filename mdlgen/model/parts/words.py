"""Directions and speeds of parts as a reader sees them."""

from __future__ import annotations

from mdlgen.geometry.arrays import Floats


def direction(way: Floats) -> str:
    """A direction as a scene has it."""
    for axis, part in zip("xyz", way.tolist(), strict=True):
        if abs(part) > 1.0 - 1e-9:
            return axis if part > 0.0 else f"-{axis}"
    return "[" + ", ".join(f"{round(part, 3) + 0.0:g}" for part in way.tolist()) + "]"
