"""Rows of rollers: axles, carriers, arms, drives, torques, cylinders, rims and what is recorded."""

from __future__ import annotations

import numpy as np

from mdlgen.altair import refinement
from mdlgen.altair.axles import pieces
from mdlgen.altair.rims import rim_facets
from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.body import add_body
from mdlgen.backends.motionsolve.writer.facets import Shown
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID, body_id, graphic_id
from mdlgen.backends.motionsolve.writer.joints import add_slide, join
from mdlgen.backends.motionsolve.writer.over_time import linear
from mdlgen.backends.motionsolve.writer.parts.kind import Kind
from mdlgen.backends.motionsolve.writer.requests import add_request
from mdlgen.backends.motionsolve.writer.rows import (
    Bushing,
    BushingGroup,
    Clutch,
    Deck,
    Joint,
    Motion,
    Solid,
)
from mdlgen.backends.motionsolve.writer.units import number, per_thousand, thousandfold, triples
from mdlgen.model.tables import ArmPart, Floats, Model, OneWay, Press, RollerPart
from mdlgen.model.tables.axle import LIMITER, OPEN, AxlePart

_CONVERT = ((0, per_thousand), (1, thousandfold))  # the columns of a profile


class _Rollers(Kind[RollerPart]):
    rank = 2

    def add_frame(self, deck: Deck, model: Model, part: RollerPart) -> None:
        """The axes of a rim, on ground."""
        if part.rim is not None:
            (at,) = triples(model.bodies.position[part.body][None])
            axes = cosines(model.bodies.rotation[part.body])
            deck.marker(f"m_{part.name}", f"Axes of {part.name}", GROUND_ID, at, axes)

    def shown(self, model: Model, part: RollerPart) -> list[Shown]:
        """The boxes that show a rim."""
        made, table = [], model.bodies
        for name, facet in rim_facets(part, table.position[part.body], table.rotation[part.body]):
            pieces = name.removeprefix(f"{part.name}_").split("_")
            made.append(Shown(f"gbox_{name}", f"{part.name}, {pieces[0]}, part {pieces[1]}", facet))
        return made

    def add_joints(self, deck: Deck, model: Model, part: RollerPart) -> None:
        """Axle, drive, cylinder and what is recorded; a carrier, or an arm, follows the Model's bodies."""
        place = model.bodies.position[part.body]
        on = GROUND_ID
        if part.press is not None:
            on = body_id(len(deck.bodies))
            _add_press(deck, part, part.press, place, on)
        if part.arm is not None:
            on = body_id(len(deck.bodies))
            _add_arm(deck, model, part, part.arm, on)
        body = body_id(part.body)
        axle = join(deck, f"j_{part.name}", f"Axle of {part.name}", "REVOLUTE", body, on, place, part.axis)
        if part.one_way is not None:
            _add_clutch(deck, model, part, part.one_way, deck.joints[-1])
        elif part.axle is not None:
            _add_torques(deck, model, part, part.axle, deck.joints[-1])
        elif part.speed is not None:
            name, label = f"mot_{part.name}", f"Drive of {part.name}"
            deck.motions.append(Motion(name, label, len(deck.motions) + 1, law(part), axle))
        _add_cylinder(deck, model, part, place)
        markers = [deck.bodies[part.body].cm]
        add_request(
            deck, f"o_{part.name}", f"Roller {part.name}: position, spin", "DX DY DZ WX WY WZ", markers
        )


def law(roller: RollerPart) -> str:
    """Angular velocity [rad/s] of a driven roller over time, in the form that the text has: a ramp, or the
    sum of what each piece of a profile adds."""
    if roller.profile is None:
        assert roller.speed is not None, "asked only of a driven roller"
        full = thousandfold(roller.speed)
        return f"{full}*(1-MAX(0,1-TIME/{per_thousand(roller.ramp)}))" if roller.ramp > 0.0 else full
    times, speeds = ([convert(v) for v in roller.profile[:, k].tolist()] for k, convert in _CONVERT)
    return linear(times, speeds)


def _add_clutch(deck: Deck, model: Model, roller: RollerPart, way: OneWay, axle: Joint) -> None:
    """The torque of a clutch, 2 torque s^2 / (1 + s) of the relative speed s against the free sense."""
    shaft = f"({law(roller)})" if roller.speed is not None else "0"
    sense = way.direction
    s = f"MAX(0,{sense}*({shaft}-{_spin(axle)})/{thousandfold(way.creep)})"
    torque = f"{number(2 * sense * way.torque)}*{s}*{s}/(1+{s})"
    _add_torque(deck, model, roller, axle, ("clutch", f"Clutch of {roller.name}"), torque)


def _add_torques(deck: Deck, model: Model, roller: RollerPart, own: AxlePart, axle: Joint) -> None:
    """The torques of a motor that runs by its voltage, a limiter and a bearing."""
    spin, torque = _spin(axle), ""
    if own.kind == OPEN:
        slow = f"({law(roller)}-{spin})"
        (_, first), *others = [(thousandfold(s), per_thousand(more)) for s, more in pieces(own)]
        torque = f"{first}*{slow}"
        torque += "".join(f"+({more})*(MAX(0,{slow}-{s})-MAX(0,-{slow}-{s}))" for s, more in others)
    elif own.kind == LIMITER:
        rate = f"{law(roller)}-{spin}" if roller.speed is not None else f"-{spin}"
        torque = f"{number(own.limit)}*{_smooth(rate, own.creep)}"
    if own.friction or own.drag:
        torque += f"-{number(own.friction)}*{_smooth(spin, own.ease)}-{per_thousand(own.drag)}*{spin}"
    _add_torque(deck, model, roller, axle, ("axle", f"Torque on {roller.name}"), torque or "0")


def _spin(axle: Joint) -> str:
    return f"WZ({axle.i},{axle.j},{axle.j})"


def _smooth(rate: str, over: float) -> str:
    """-1 to 1 over a speed [rad/ms] either way."""
    width = thousandfold(over)
    return f"STEP({rate},-{width},-1,{width},1)"


def _add_torque(
    deck: Deck, model: Model, roller: RollerPart, axle: Joint, called: tuple[str, str], torque: str
) -> None:
    """A torque on a roller about its axle."""
    word, label = called
    name = f"frc_{roller.name}_{word}"
    (at,) = triples(model.bodies.position[roller.body][None])
    deck.clutches.append(
        Clutch(
            name=name,
            label=label,
            id=len(model.loads.body) + len(deck.clutches) + 1,
            marker=deck.marker(f"{name}.i", f"{label}-Marker I", body_id(roller.body), at),
            along=axle.i,
            torque=torque,
        )
    )


def _add_press(deck: Deck, roller: RollerPart, press: Press, place: Floats, carrier: int) -> None:
    """The carrier of a pressed roller, on its slide."""
    name = f"b_{roller.name}_carrier"
    inertia = [0.4 * press.carrier_mass * roller.radius**2] * 3  # a ball, as the text has it
    (at,) = triples(place[None])
    add_body(deck, name, f"Carrier of {roller.name}", carrier, at, None, press.carrier_mass, inertia)
    add_slide(deck, roller, press, place, carrier)


def _add_arm(deck: Deck, model: Model, roller: RollerPart, arm: ArmPart, id: int) -> None:
    """The arm of a roller, its pivot, and its torsional spring as a bushing to ground."""
    pivot, center = triples(np.stack([arm.pivot, arm.center]))
    name = f"b_{roller.name}_arm"
    add_body(deck, name, f"Arm of {roller.name}", id, center, None, arm.mass, [arm.inertia] * 3)
    joint, label = f"j_{roller.name}_pivot", f"Pivot of {roller.name}"
    join(deck, joint, label, "REVOLUTE", id, GROUND_ID, arm.pivot, roller.axis)
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


def _add_cylinder(deck: Deck, model: Model, roller: RollerPart, place: Floats) -> None:
    """The graphic, whose marker is at the start of the cylinder, with Z along it (seen)."""
    name, label = f"gcyl_{roller.name}", model.bodies.label[roller.body]
    (start,) = triples((place - roller.width / 2 * roller.axis)[None])
    axes = cosines(model.bodies.rotation[roller.body])
    marker = deck.marker(
        f"{name}_center_marker", f"{label} - Center Marker", body_id(roller.body), start, axes
    )
    radius = number(roller.radius)
    sizes = {"top_radius": radius, "bottom_radius": radius, "length": number(roller.width)}
    sizes["ends_type"] = "CLOSED"
    id, level = graphic_id(roller.body), refinement.CYLINDER
    deck.solids.append(Solid(name, label, id, marker, "Frustum", sizes, level))


KIND = _Rollers()
