"""Directions and speeds of parts as a reader sees them."""

from __future__ import annotations

from mdlgen.geometry.arrays import Floats
from mdlgen.model.tables import Press
from mdlgen.units import PER_SECOND


def direction(way: Floats) -> str:
    """A direction as a scene has it."""
    for axis, part in zip("xyz", way.tolist(), strict=True):
        if abs(part) > 1.0 - 1e-9:
            return axis if part > 0.0 else f"-{axis}"
    return "[" + ", ".join(f"{round(part, 3) + 0.0:g}" for part in way.tolist()) + "]"


def begins(press: Press) -> list[str]:
    """Initial place and speed of a pressed part in words, as far as they were given."""
    found = []
    if press.begins is not None:
        found.append(f"begins {press.begins:.4g} mm from where its spring has that force")
    if press.speed != 0.0:
        found.append(f"begins at {PER_SECOND * press.speed:.4g} mm/s")
    return found
