"""Rows of rollers and pressed plates: axles, slides, springs, drives, cylinders and what is recorded."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mdlgen.backends.motionsolve.writer.axes import along, cosines
from mdlgen.backends.motionsolve.writer.bodies import GROUND_ID, add_body, body_id, graphic_id
from mdlgen.backends.motionsolve.writer.requests import add_request
from mdlgen.backends.motionsolve.writer.rows import (
    Bushing,
    BushingGroup,
    Clutch,
    Cylinder,
    Deck,
    Joint,
    Motion,
    Spring,
)
from mdlgen.backends.motionsolve.writer.units import number, per_thousand, thousandfold, triples
from mdlgen.model.tables import ArmPart, Floats, Model, OneWay, PlanePart, Press, RollerPart

_CONVERT = ((0, per_thousand), (1, thousandfold))  # the columns of a profile


def add_rollers(deck: Deck, model: Model) -> None:
    """All rollers; carriers of the pressed ones, and arms, follow the bodies of the Model."""
    for roller in model.rollers:
        place = model.bodies.position[roller.body]
        on = GROUND_ID
        if roller.press is not None:
            on = body_id(len(deck.bodies))
            _add_press(deck, roller, roller.press, place, on)
        if roller.arm is not None:
            on = body_id(len(deck.bodies))
            _add_arm(deck, model, roller, roller.arm, on)
        body = body_id(roller.body)
        axle = _joint(
            deck, f"j_{roller.name}", f"Axle of {roller.name}", "REVOLUTE", body, on, place, roller.axis
        )
        if roller.one_way is not None:
            _add_clutch(deck, model, roller, roller.one_way, deck.joints[-1])
        elif roller.speed is not None:
            name, label = f"mot_{roller.name}", f"Drive of {roller.name}"
            deck.motions.append(Motion(name, label, len(deck.motions) + 1, law(roller), axle))
        _add_cylinder(deck, model, roller, place)
        markers = [deck.bodies[roller.body].cm]
        add_request(
            deck, f"o_{roller.name}", f"Roller {roller.name}: position, spin", "DX DY DZ WX WY WZ", markers
        )


def add_plates(deck: Deck, model: Model) -> None:
    """Slides and springs of the pressed plates, which stand on their slides themselves."""
    for plate, press in model.plates:
        _add_slide(deck, plate, press, model.bodies.position[plate.body], body_id(plate.body))
        markers, label = [deck.bodies[plate.body].cm], f"Plane {plate.name}: position, velocity"
        add_request(deck, f"o_{plate.name}", label, "DX DY DZ VX VY VZ", markers)


def law(roller: RollerPart) -> str:
    """Angular velocity [rad/s] of a driven roller over time, in the form that the text has: a ramp, or the
    sum of what each piece of a profile adds."""
    if roller.profile is None:
        assert roller.speed is not None, "asked only of a driven roller"
        full = thousandfold(roller.speed)
        return f"{full}*(1-MAX(0,1-TIME/{per_thousand(roller.ramp)}))" if roller.ramp > 0.0 else full
    times, speeds = ([convert(v) for v in roller.profile[:, k].tolist()] for k, convert in _CONVERT)
    parts = [speeds[0]]
    for (t, w), (t_end, w_end) in pairwise(zip(times, speeds, strict=True)):
        parts.append(f"({w_end}-({w}))*MAX(0,1-MAX(0,({t_end}-TIME)/({t_end}-{t})))")
    return "+".join(parts)


def _add_clutch(deck: Deck, model: Model, roller: RollerPart, way: OneWay, axle: Joint) -> None:
    """The torque of a clutch, 2 torque s^2 / (1 + s) of the relative speed s against the free sense."""
    shaft = f"({law(roller)})" if roller.speed is not None else "0"
    sense = way.direction
    s = f"MAX(0,{sense}*({shaft}-WZ({axle.i},{axle.j},{axle.j}))/{thousandfold(way.creep)})"
    deck.clutches.append(
        Clutch(
            name=f"frc_{roller.name}_clutch",
            label=f"Clutch of {roller.name}",
            id=len(model.loads.body) + len(deck.clutches) + 1,
            i=axle.i,
            j=axle.j,
            torque=f"{number(2 * sense * way.torque)}*{s}*{s}/(1+{s})",
        )
    )


def _joint(
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


def _add_press(deck: Deck, roller: RollerPart, press: Press, place: Floats, carrier: int) -> None:
    """The carrier of a pressed roller, on its slide."""
    name = f"b_{roller.name}_carrier"
    inertia = [0.4 * press.carrier_mass * roller.radius**2] * 3  # a ball, as the text has it
    (at,) = triples(place[None])
    add_body(deck, name, f"Carrier of {roller.name}", carrier, at, None, press.carrier_mass, inertia)
    _add_slide(deck, roller, press, place, carrier)


def _add_slide(deck: Deck, part: RollerPart | PlanePart, press: Press, place: Floats, body: int) -> None:
    """The slide of a body, and its spring to where that is anchored on ground."""
    slide, label = f"j_{part.name}_slide", f"Slide of {part.name}"
    _joint(deck, slide, label, "TRANSLATIONAL", body, GROUND_ID, place, press.direction)
    ends = triples(press_ends(part, press, place))
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


def _add_arm(deck: Deck, model: Model, roller: RollerPart, arm: ArmPart, id: int) -> None:
    """The arm of a roller, its pivot, and its torsional spring as a bushing to ground."""
    pivot, center = triples(np.stack([arm.pivot, arm.center]))
    name = f"b_{roller.name}_arm"
    add_body(deck, name, f"Arm of {roller.name}", id, center, None, arm.mass, [arm.inertia] * 3)
    joint, label = f"j_{roller.name}_pivot", f"Pivot of {roller.name}"
    _joint(deck, joint, label, "REVOLUTE", id, GROUND_ID, arm.pivot, roller.axis)
    if not arm.sprung:
        return
    bush, label = f"bsh_{roller.name}_arm", f"Spring of the arm of {roller.name}"
    axes = cosines(model.bodies.rotation[roller.body])
    i = deck.marker(f"{bush}.i", f"{label}-Marker I", id, pivot, axes)
    j = deck.marker(f"{bush}.j", f"{label}-Marker J", GROUND_ID, pivot, axes)
    zero = number(0.0)
    values = [(axis, zero, zero, zero) for axis in ("x", "y", "z", "tx", "ty")]
    values.append(("tz", number(arm.stiffness), per_thousand(arm.damping), number(arm.torque)))
    number_of = len(model.bushings) + len(deck.bushing_groups) + 1  # those of the sheets come later
    deck.bushing_groups.append(BushingGroup(tuple(values), [Bushing(bush, label, number_of, i, j)]))


def press_ends(part: RollerPart | PlanePart, press: Press, place: Floats) -> Floats:
    """Both ends of a spring: the part's centre, and the anchor that is its free length from touching."""
    anchor = part.center + (press.touch - press.free_length) * press.direction
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
