"""Guides, planes and meshes that move: their joints, motions and springs; and stops."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.moving import joint_of, spring_axes
from mdlgen.altair.stops import stop_law, stopped
from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID, body_id
from mdlgen.backends.motionsolve.writer.joints import join
from mdlgen.backends.motionsolve.writer.rows import Bushing, BushingGroup, Clutch, Deck, Motion
from mdlgen.backends.motionsolve.writer.units import number, per_thousand, thousandfold, triples
from mdlgen.mechanics.gate import BLUNT
from mdlgen.model.tables import Floats, GuidePart, MeshPart, Model, MovingPart, PlanePart


def add_gate(deck: Deck, model: Model, part: GuidePart | PlanePart | MeshPart, place: Floats) -> None:
    """The joint of a part that moves, at its pivot or at a place, and its motion or its spring; none of one
    that does not move."""
    moving = part.moving
    if moving is None:
        return
    word, type = joint_of(moving)
    at = moving.pivot if moving.turns else place
    name, label = f"j_{part.name}_{word}", f"{word.capitalize()} of {part.name}"
    joint = join(deck, name, label, type, body_id(part.body), GROUND_ID, at, moving.axis)
    if moving.free:
        _add_spring(deck, model, part.name, moving, at, body_id(part.body))
        return
    times = [per_thousand(t) for t in moving.corners[:, 0].tolist()]
    ways = zip(times[:-1], times[1:], np.diff(moving.corners[:, 1]).tolist(), strict=True)
    law = "+".join(f"STEP(TIME,{begin},0,{end},{number(way)})" for begin, end, way in ways) or "0"
    name, label = f"mot_{part.name}", f"{'Turn' if moving.turns else 'Way'} of {part.name}"
    freedom = "R" if moving.turns else "T"
    deck.motions.append(Motion(name, label, len(deck.motions) + 1, law, joint, "D", freedom))


def _add_spring(deck: Deck, model: Model, name: str, moving: MovingPart, place: Floats, body: int) -> None:
    """The spring of a part that forces move, as a bushing to ground, along z of its axes or about it."""
    if not moving.sprung:
        return
    bush, label = f"bsh_{name}_gate", f"Spring of {name}"
    (at,) = triples(place[None])
    axes = cosines(spring_axes(moving))
    i = deck.marker(f"{bush}.i", f"{label}-Marker I", body, at, axes)
    j = deck.marker(f"{bush}.j", f"{label}-Marker J", GROUND_ID, at, axes)
    own, zero = "tz" if moving.turns else "z", number(0.0)
    law = (number(moving.stiffness), per_thousand(moving.damping), number(moving.force))
    values = []
    for axis in ("x", "y", "z", "tx", "ty", "tz"):
        stiffness, damping, force = law if axis == own else (zero, zero, zero)
        values.append((axis, stiffness, damping, force))
    number_of = len(model.bushings) + len(deck.bushing_groups) + 1  # those of the sheets come later
    deck.bushing_groups.append(BushingGroup(tuple(values), [Bushing(bush, label, number_of, i, j)]))


def add_stops(deck: Deck, model: Model) -> None:
    """Forces and torques of stops, behind all joints."""
    ids = {body.name: body.id for body in deck.bodies}
    for one in stopped(model, BLUNT):
        name, label = f"frc_{one.name}_stops", f"Stops of {one.name}"
        joint = next(j for j in deck.joints if j.name == f"j_{one.name}_{one.joint}")
        marker = deck.markers[joint.i - 1]
        i, three = joint.i, f"{joint.i},{joint.j},{joint.j}"
        place, rate = (
            (f"AZ({i},{joint.j})", f"WZ({three})") if one.turns else (f"DZ({three})", f"VZ({three})")
        )
        low, high = (number(end) for end in one.ends)
        law = stop_law(
            place,
            rate,
            (f"({low})", high),
            number(one.stops.stiffness),
            number(one.share),
            thousandfold(one.blunt),
        )
        deck.clutches.append(
            Clutch(
                name=name,
                label=label,
                id=len(model.loads.body) + len(deck.clutches) + 1,
                marker=deck.marker(f"{name}.i", f"{label}-Marker I", ids[one.body], marker.at),
                along=i,
                torque=law if one.turns else "0",
                force="0" if one.turns else law,
            )
        )
