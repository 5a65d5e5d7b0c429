"""Rollers and planes: Scene -> tables, with what is pressed in static equilibrium."""

from __future__ import annotations

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model import meshes, press
from mdlgen.model.rims import lower_rim, touched, towards
from mdlgen.model.tables import (
    CYLINDER_CYLINDER,
    ArmPart,
    Contacts,
    Floats,
    OneWay,
    PlanePart,
    Press,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.machine import Drive, Roller
from mdlgen.spec.scene import Scene


def frame(z: Floats, guide: Floats | None = None) -> Floats:
    """A right-handed frame (columns x, y, z) with the given z; x near `guide`, or near global x or y."""
    near: Floats = np.eye(3)[1 if abs(z[0]) > 0.9 else 0] if guide is None else guide
    x = near - z * (near @ z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def lower_rollers(
    scene: Scene, sheets: tuple[SheetPart, ...], contacts: Contacts, first: int
) -> tuple[RollerPart, ...]:
    parts = []
    for index, name in enumerate(sorted(scene.rollers)):
        roller = scene.rollers[name]
        axial = 0.5 * roller.mass * roller.radius**2
        transverse = roller.mass * (3 * roller.radius**2 + roller.width**2) / 12
        parts.append(
            RollerPart(
                name=name,
                body=first + index,
                center=np.array(roller.center),
                axis=np.array(roller.axis),
                radius=roller.radius,
                width=roller.width,
                mass=roller.mass,
                inertia_axial=axial,
                inertia_transverse=transverse,
                speed=_speed(roller.drive) if roller.drive else None,
                ramp=roller.drive.ramp if roller.drive else 0.0,
                profile=np.array(roller.drive.profile) if roller.drive and roller.drive.profile else None,
                one_way=OneWay(**roller.one_way.model_dump()) if roller.one_way else None,
                press=_press(scene, name, sheets, contacts) if roller.press else None,
                rim=lower_rim(roller),
                arm=_arm(roller) if roller.arm else None,
            )
        )
    return tuple(parts)


def _speed(drive: Drive) -> float:
    """The speed of a drive, of a profile the greatest in size [rad/ms]."""
    if drive.profile is not None:
        return max((speed for _, speed in drive.profile), key=abs)
    assert drive.speed is not None, "the spec has one of the two"
    return drive.speed


def _press(scene: Scene, name: str, sheets: tuple[SheetPart, ...], contacts: Contacts) -> Press:
    roller = scene.rollers[name]
    spec = roller.press
    assert spec is not None
    center, axis, direction = np.array(roller.center), np.array(roller.axis), np.array(spec.direction)
    carrier = spec.carrier_mass if spec.carrier_mass is not None else roller.mass / 1000
    mass = roller.mass + carrier
    mine = {name, *(key for key, mesh in scene.meshes.items() if mesh.on == name)}
    others, forces = [], []
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
            cylinder = press.Cylinder(np.array(partner.center), radius, partner.width, stiffness * factor)
            others.append(cylinder)
            forces.append(press.cylinder_contact(cylinder, axis, own_radius, roller.width))
        else:
            # a mesh on the roller counts as the roller's own round here: the run settles the rest
            sheet = next(s for s in sheets if s.name == other)
            shared = contacts.share[row] == "width"
            forces.append(press.sheet_contact(sheet, axis, own_radius, roller.width, stiffness, shared))
    touch = press.touch_offset(center, axis, direction, own_radius, roller.width, others)
    heavy = mass + sum(meshes.mass_of(mesh) for mesh in scene.meshes.values() if mesh.on == name)
    weight = heavy * float(np.array(scene.gravity) @ direction)

    def spring(offset: float) -> float:
        return spec.preload - spec.stiffness * (offset - touch) + weight

    return Press(
        direction=direction,
        stiffness=spec.stiffness,
        damping=2.0 * spec.damping_ratio * float(np.sqrt(spec.stiffness * mass)),
        damping_ratio=spec.damping_ratio,
        preload=spec.preload,
        free_length=spec.free_length,
        carrier_mass=carrier,
        touch=touch,
        start=press.equilibrium(
            center, direction, spring, forces, (2 * own_radius, own_radius, own_radius / 16), touch
        ),
    )


def _plate_press(scene: Scene, name: str, sheets: tuple[SheetPart, ...], contacts: Contacts) -> Press:
    """The press of a plate. Only sheets touch it, so it has no counterpart: the preload is that where it is
    given."""
    plane = scene.planes[name]
    spec = plane.press
    assert spec is not None
    center, direction = np.array(plane.center), np.array(spec.direction)
    carrier = spec.carrier_mass if spec.carrier_mass is not None else 0.0
    mass, axes = plane.mass + carrier, frame(np.array(plane.normal))
    of = {sheet.name: sheet for sheet in sheets}
    mine = [row for row in range(len(contacts)) if contacts.part_b[row] == name]
    stiff = [(of[contacts.part_a[row]], float(contacts.stiffness[row])) for row in mine]
    forces = [press.plate_contact(sheet, axes, plane.size, center, k) for sheet, k in stiff]
    weight = mass * float(np.array(scene.gravity) @ direction)

    def spring(offset: float) -> float:
        return spec.preload - spec.stiffness * offset + weight

    far = spec.free_length  # a spring does not become shorter than that
    start, left = press.plate_balance(center, direction, spring, forces, far)
    if left != 0.0:
        way = "with" if left > 0.0 else "against"
        raise SpecError(
            f"the spring does not hold the plate within its free_length of {far:g} mm: {abs(left):.3g} N are "
            f"left there, {way} its direction; give a stiffness, preload or free_length that balance its "
            "weight and the sheets in its way",
            ("planes", name, "press"),
        )
    return Press(
        direction=direction,
        stiffness=spec.stiffness,
        damping=2.0 * spec.damping_ratio * float(np.sqrt(spec.stiffness * mass)),
        damping_ratio=spec.damping_ratio,
        preload=spec.preload,
        free_length=spec.free_length,
        carrier_mass=carrier,
        touch=0.0,
        start=start,
    )


def _arm(roller: Roller) -> ArmPart:
    spec = roller.arm
    assert spec is not None
    pivot, end = np.array(spec.pivot), np.array(roller.center)
    length = float(np.linalg.norm(np.cross(np.array(roller.axis), end - pivot)))
    return ArmPart(
        pivot=pivot,
        center=0.5 * (pivot + end) if spec.center is None else np.array(spec.center),
        mass=spec.mass,
        inertia=spec.mass * length**2 / 12 if spec.inertia is None else spec.inertia,
        torque=spec.torque,
        stiffness=spec.stiffness,
        damping=spec.damping,
        sprung=spec.sprung,
    )


def _profile(roller: Roller, direction: Floats) -> tuple[float, float]:
    """Radius of a roller along a direction as the run begins [mm], and stiffness in times the contact's."""
    rim = lower_rim(roller)
    if rim is None:
        return roller.radius, 1.0
    radius, sector, _ = touched(rim, towards(frame(np.array(roller.axis)), direction))
    return radius, float(rim.stiffness[sector])


def lower_planes(
    scene: Scene, sheets: tuple[SheetPart, ...], contacts: Contacts, first: int
) -> tuple[PlanePart, ...]:
    return tuple(
        PlanePart(
            name=name,
            body=first + index,
            center=np.array(plane.center),
            normal=np.array(plane.normal),
            size=plane.size,
            mass=plane.mass,
            press=_plate_press(scene, name, sheets, contacts) if plane.press else None,
        )
        for index, (name, plane) in enumerate(sorted(scene.planes.items()))
    )
