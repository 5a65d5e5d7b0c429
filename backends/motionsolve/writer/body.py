"""Row of one body."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.rows import Body, Cosines, Deck
from mdlgen.backends.motionsolve.writer.units import Triple, per_thousand


def add_body(
    deck: Deck,
    name: str,
    label: str,
    id: int,
    at: Triple,
    axes: Cosines | None,
    mass: float,
    inertia: list[float],
    velocity: tuple[str, ...] | None = None,
) -> None:
    """A body and its markers: where its coordinates start, and its mass centre along the inertia's axes."""
    lprf = deck.marker(f"{name}.lprf", f"{label}-Marker LPRF", id, None)
    cm = deck.marker(f"{name}.cm", f"{label}-Marker CM", id, at, axes)
    x, y, z = (per_thousand(v) for v in inertia)
    deck.bodies.append(Body(name, label, id, cm, lprf, per_thousand(mass), (x, y, z), velocity))
