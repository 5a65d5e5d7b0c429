"""Joints of parts of the machine: fixed ones, axles and pivots, and slides with their springs."""

from __future__ import annotations

import numpy as np

from mdlgen.backends.motionsolve.writer.axes import along, cosines
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID
from mdlgen.backends.motionsolve.writer.rows import Deck, Spring
from mdlgen.backends.motionsolve.writer.units import Triple, number, per_thousand, triples
from mdlgen.model.tables import Floats, PlanePart, Press, RollerPart


def fix(deck: Deck, name: str, label: str, body: int, at: Triple, on: int = GROUND_ID) -> None:
    """A fixed joint to ground or another body, along the global axes."""
    i = deck.marker(f"{name}.joint_i", f"{label}-Marker I", body, at)
    j = deck.marker(f"{name}.joint_j", f"{label}-Marker J", on, at)
    deck.joint(name, label, "FIXED", i, j)


def join(
    deck: Deck,
    name: str,
    label: str,
    type: str,
    body: int,
    on: int,
    place: Floats,
    direction: Floats,
) -> int:
    """A joint between two bodies (ids) with Z of both markers along `direction`."""
    (at,) = triples(place[None])
    axes = cosines(along(direction))
    i = deck.marker(f"{name}.joint_i", f"{label}-Marker I", body, at, axes)
    j = deck.marker(f"{name}.joint_j", f"{label}-Marker J", on, at, axes)
    return deck.joint(name, label, type, i, j)


def add_slide(deck: Deck, part: RollerPart | PlanePart, press: Press, place: Floats, body: int) -> None:
    """The slide of a body, and its spring to where that is anchored on ground."""
    slide, label = f"j_{part.name}_slide", f"Slide of {part.name}"
    join(deck, slide, label, "TRANSLATIONAL", body, GROUND_ID, place, press.direction)
    ends = triples(_ends(part, press, place))
    spring, label = f"cs_{part.name}", f"Spring of {part.name}"
    i = deck.marker(f"{spring}.i", f"{label}-Marker I", body, ends[0])
    j = deck.marker(f"{spring}.j", f"{label}-Marker J", GROUND_ID, ends[1])
    deck.springs.append(
        Spring(
            name=spring,
            label=label,
            id=len(deck.springs) + 1,
            i=i,
            j=j,
            stiffness=number(press.stiffness),
            damping=per_thousand(press.damping),
            force=number(press.preload),
            length=number(press.free_length),
        )
    )


def _ends(part: RollerPart | PlanePart, press: Press, place: Floats) -> Floats:
    """Both ends of a spring: the part's centre, and the anchor that is its free length from touching."""
    anchor = part.center + (press.touch - press.free_length) * press.direction
    return np.stack([place, anchor])
