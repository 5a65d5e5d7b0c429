"""Rows of the rollers: axles, slides, springs, drives, cylinders and what is recorded of them."""

from __future__ import annotations

import numpy as np

from backends.motionsolve.axes import along, cosines
from backends.motionsolve.bodies import GROUND_ID, add_body, body_id, graphic_id
from backends.motionsolve.requests import add_request
from backends.motionsolve.rows import Cylinder, Deck, Motion, Spring
from backends.motionsolve.units import number, per_thousand, thousandfold, triples
from mdlgen.model.tables import Floats, Model, Press, RollerPart


def add_rollers(deck: Deck, model: Model) -> None:
    """All rollers; carriers of the pressed ones follow the bodies of the Model."""
    for roller in model.rollers:
        place = model.bodies.position[roller.body]
        on = GROUND_ID
        if roller.press is not None:
            on = body_id(len(deck.bodies))
            _add_press(deck, roller, roller.press, place, on)
        axle = _joint(
            deck, f"j_{roller.name}", f"Axle of {roller.name}", "REVOLUTE", roller, on, place, roller.axis
        )
        if roller.speed is not None:
            name, label = f"mot_{roller.name}", f"Drive of {roller.name}"
            deck.motions.append(
                Motion(name, label, len(deck.motions) + 1, ramp(roller.speed, roller.ramp), axle)
            )
        _add_cylinder(deck, model, roller, place)
        markers = [deck.bodies[roller.body].cm]
        add_request(
            deck, f"o_{roller.name}", f"Roller {roller.name}: position, spin", "DX DY DZ WX WY WZ", markers
        )


def ramp(speed: float, time: float) -> str:
    """Angular velocity [rad/s] that rises evenly during `time`; from rad/ms and ms."""
    full = thousandfold(speed)
    return f"{full}*(1-MAX(0,1-TIME/{per_thousand(time)}))" if time > 0.0 else full


def _joint(
    deck: Deck,
    name: str,
    label: str,
    type: str,
    roller: RollerPart,
    on: int,
    place: Floats,
    direction: Floats,
    body: int | None = None,
) -> int:
    """A joint with Z of both markers along `direction`; of the roller unless a `body` is given."""
    (at,) = triples(place[None])
    axes = cosines(along(direction))
    i = deck.marker(f"{name}.joint_i", f"{label}-Marker I", body or body_id(roller.body), at, axes)
    j = deck.marker(f"{name}.joint_j", f"{label}-Marker J", on, at, axes)
    return deck.joint(name, label, type, i, j)


def _add_press(deck: Deck, roller: RollerPart, press: Press, place: Floats, carrier: int) -> None:
    """The carrier of a pressed roller, its slide, and the spring to where it is anchored on ground."""
    name = f"b_{roller.name}_carrier"
    inertia = [0.4 * press.carrier_mass * roller.radius**2] * 3  # a ball, as the text has it
    ends = triples(press_ends(roller, press, place))
    add_body(deck, name, f"Carrier of {roller.name}", carrier, ends[0], None, press.carrier_mass, inertia)
    slide, label = f"j_{roller.name}_slide", f"Slide of {roller.name}"
    _joint(deck, slide, label, "TRANSLATIONAL", roller, GROUND_ID, place, press.direction, carrier)
    spring, label = f"cs_{roller.name}", f"Spring of {roller.name}"
    i = deck.marker(f"{spring}.i", f"{label}-Marker I", carrier, ends[0])
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


def press_ends(roller: RollerPart, press: Press, place: Floats) -> Floats:
    """Both ends of a spring: the roller's centre, and the anchor that is its free length from touching."""
    anchor = roller.center + (press.touch - press.free_length) * press.direction
    return np.stack([place, anchor])


def _add_cylinder(deck: Deck, model: Model, roller: RollerPart, place: Floats) -> None:
    """The graphic, whose marker stands where the cylinder starts, with Z along it (seen)."""
    name, label = f"gcyl_{roller.name}", model.bodies.label[roller.body]
    (start,) = triples((place - roller.width / 2 * roller.axis)[None])
    axes = cosines(model.bodies.rotation[roller.body])
    marker = deck.marker(
        f"{name}_center_marker", f"{label} - Center Marker", body_id(roller.body), start, axes
    )
    deck.cylinders.append(
        Cylinder(
            name=name,
            label=label,
            id=graphic_id(roller.body),
            marker=marker,
            radius=number(roller.radius),
            length=number(roller.width),
        )
    )
