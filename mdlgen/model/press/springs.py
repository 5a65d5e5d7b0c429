"""Rollers and plates that springs press, in static equilibrium as the run begins."""

from __future__ import annotations

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model import meshes, over_time
from mdlgen.model.frames import frame
from mdlgen.model.moved import lower_stops
from mdlgen.model.press import balance
from mdlgen.model.press.before import Before
from mdlgen.model.press.faces import (
    Face,
    Wheel,
    faces_of_plate,
    onto,
    onto_plate,
)
from mdlgen.model.rims import lower_rim, touched, towards
from mdlgen.model.tables import (
    CYLINDER_CYLINDER,
    ON_PARTS,
    Contacts,
    Floats,
    Press,
)
from mdlgen.spec.machine import Press as PressSpec
from mdlgen.spec.machine import Roller
from mdlgen.spec.scene import Scene


def roller_press(scene: Scene, name: str, before: Before) -> Press:
    """The press of a roller. Raises SpecError where its counterpart is pressed, too."""
    sheets, contacts = before.sheets, before.contacts
    roller = scene.rollers[name]
    spec = roller.press
    assert spec is not None
    center, axis, direction = np.array(roller.center), np.array(roller.axis), np.array(spec.direction)
    carrier = spec.carrier_mass if spec.carrier_mass is not None else roller.mass / 1000
    mass = roller.mass + carrier
    mine = {name, *(key for key, mesh in scene.meshes.items() if mesh.on == name)}
    others, forces, faces = [], [], []
    own_radius, own_factor = _profile(roller, direction)
    for row in range(len(contacts)):
        parts = (contacts.part_a[row], contacts.part_b[row])
        if not mine & set(parts):
            continue
        other = parts[0] if parts[1] in mine else parts[1]
        stiffness = float(contacts.stiffness[row]) * own_factor
        if contacts.kind[row] == CYLINDER_CYLINDER:
            partner: Roller = scene.rollers[other]
            if partner.press is not None:
                raise SpecError(
                    f"{name} and {other} are pressed against each other; give one of them a fixed axis",
                    ("rollers", name, "press"),
                )
            radius, factor = _profile(partner, center - np.array(partner.center))
            cylinder = balance.Cylinder(np.array(partner.center), radius, partner.width, stiffness * factor)
            others.append(cylinder)
            forces.append(balance.cylinder_contact(cylinder, axis, own_radius, roller.width))
        elif contacts.kind[row] in ON_PARTS:
            face = before.face(other, center, name)
            if face is not None:
                wheel = _wheel(
                    roller, -face.ways[:, 2] if isinstance(face, Face) else direction, contacts, row
                )
                faces.append(face.touch(wheel, direction))
                forces.append(onto(face, wheel))
        else:
            # a mesh on the roller counts as the roller's own round here: the run finds the rest
            sheet = next(s for s in sheets if s.name == other)
            if sheet.enters != 0.0:
                continue  # it is not there yet
            shared = contacts.share[row] == "width"
            forces.append(balance.sheet_contact(sheet, axis, own_radius, roller.width, stiffness, shared))
    touch = balance.touch_offset(center, axis, direction, own_radius, roller.width, others, faces)
    heavy = mass + sum(meshes.mass_of(mesh) for mesh in scene.meshes.values() if mesh.on == name)
    weight = heavy * float(_begun_gravity(scene) @ direction)

    def spring(offset: float) -> float:
        return spec.preload - spec.stiffness * (offset - touch) + weight

    start = balance.equilibrium(center, direction, spring, forces, own_radius, touch)
    return _slide(spec, mass, carrier, touch, start)


def _begun_gravity(scene: Scene) -> Floats:
    """Gravity as the run begins [mm/ms^2], (3,)."""
    return over_time.factor(over_time.corners(scene.gravity_profile), 0.0) * np.array(scene.gravity)


def _wheel(roller: Roller, towards: Floats, contacts: Contacts, row: int) -> Wheel:
    """A roller as a part that lies in a direction meets it."""
    radius, factor = _profile(roller, towards)
    stiffness = float(contacts.stiffness[row]) * factor
    return Wheel(np.array(roller.center), np.array(roller.axis), radius, roller.width, stiffness)


def _slide(spec: PressSpec, mass: float, carrier: float, touch: float, balance: float) -> Press:
    """The slide of a part in balance at a place, which begins there unless the user has given a start."""
    if spec.stops is not None:  # the spring may push it onto one
        balance = min(max(balance, spec.stops.low), spec.stops.high)
    return Press(
        direction=np.array(spec.direction),
        stiffness=spec.stiffness,
        damping=2.0 * spec.damping_ratio * float(np.sqrt(spec.stiffness * mass)),
        damping_ratio=spec.damping_ratio,
        preload=spec.preload,
        free_length=spec.free_length,
        carrier_mass=carrier,
        touch=touch,
        start=balance if spec.start is None else touch + spec.start,
        begins=spec.start,
        speed=spec.start_speed,
        balance=None if spec.start is None else balance,
        stops=lower_stops(spec.stops),
    )


def plate_press(scene: Scene, name: str, before: Before) -> Press:
    """The press of a plate; the preload is that where it is given."""
    sheets, contacts = before.sheets, before.contacts
    plane = scene.planes[name]
    spec = plane.press
    assert spec is not None
    center, direction = np.array(plane.center), np.array(spec.direction)
    carrier = spec.carrier_mass if spec.carrier_mass is not None else 0.0
    mass, axes = plane.mass + carrier, frame(np.array(plane.normal))
    of = {sheet.name: sheet for sheet in sheets}
    mine = [row for row in range(len(contacts)) if contacts.part_b[row] == name]
    forces = []
    for row in mine:
        one, k = contacts.part_a[row], float(contacts.stiffness[row])
        if one in of and of[one].enters != 0.0:
            continue
        if one in of:
            forces.append(balance.plate_contact(of[one], axes, plane.size, center, k))
            continue
        roller = scene.rollers[one]
        face = faces_of_plate(center, axes, plane.size, np.array(roller.center))
        forces.append(onto_plate(face, _wheel(roller, -face.ways[:, 2], contacts, row), center))
    weight = mass * float(_begun_gravity(scene) @ direction)

    def spring(offset: float) -> float:
        return spec.preload - spec.stiffness * offset + weight

    far = spec.free_length  # a spring does not become shorter than that
    start, left = balance.plate_balance(center, direction, spring, forces, far)
    if left != 0.0:
        way = "with" if left > 0.0 else "against"
        raise SpecError(
            f"the spring does not hold the plate within its free_length of {far:g} mm: {abs(left):.3g} N are "
            f"left there, {way} its direction; give a stiffness, preload or free_length that balance its "
            "weight and the sheets in its way",
            ("planes", name, "press"),
        )
    return _slide(spec, mass, carrier, 0.0, start)


def _profile(roller: Roller, direction: Floats) -> tuple[float, float]:
    """Radius of a roller along a direction as the run begins [mm], and stiffness relative to the
    contact's."""
    rim = lower_rim(roller)
    if rim is None:
        return roller.radius, 1.0
    radius, sector, _ = touched(rim, towards(frame(np.array(roller.axis)), direction))
    return radius, float(rim.stiffness[sector])
