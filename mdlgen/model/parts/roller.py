"""Rollers: cylinders that are driven or free, fixed, pressed by a spring or carried by an arm."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.rods import Rod
from mdlgen.geometry.solids import BOX, CORNERS, Solid, cylinder, slice_
from mdlgen.model.frames import frame
from mdlgen.model.parts.kind import SLACK, BodyRow, Boxes, Drawn
from mdlgen.model.press import balance
from mdlgen.model.press.before import Before
from mdlgen.model.press.springs import roller_press
from mdlgen.model.rims import lower_rim
from mdlgen.model.tables import (
    BOX_CYLINDER,
    CYLINDER_CYLINDER,
    ArmPart,
    Bodies,
    Model,
    OneWay,
    Press,
    RollerPart,
    SheetPart,
)
from mdlgen.spec.machine import Drive, Roller
from mdlgen.spec.scene import Scene

FLAT = 0.1  # a roller is parallel to a sheet while |axis . normal| is below this
MARK = 0.12  # breadth of the mark on a roller, in times its radius
PROUD = 0.01  # how far the mark stands out, in times the radius


class _Rollers:
    name, table, part = RollerPart.kind, "rollers", RollerPart
    with_sheet, with_roller = BOX_CYLINDER, CYLINDER_CYLINDER
    leads = False

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[RollerPart, ...]:
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
                    one_way=OneWay(**dict(roller.one_way)) if roller.one_way else None,
                    press=roller_press(scene, name, before) if roller.press else None,
                    rim=lower_rim(roller),
                    arm=_arm(roller) if roller.arm else None,
                )
            )
        return tuple(parts)

    def face(self, scene: Scene, name: str, at: Floats, roller: str) -> None:
        """None: two rollers meet along a line."""

    def body(self, part: RollerPart, rollers: tuple[RollerPart, ...]) -> BodyRow:
        start = part.press.start * part.press.direction if part.press else np.zeros(3)
        inertia = np.array([part.inertia_transverse, part.inertia_transverse, part.inertia_axial])
        return BodyRow(part.center + start, frame(part.axis), part.mass, inertia, False, np.zeros(3))

    def bounds(
        self, part: RollerPart, bodies: Bodies, rollers: tuple[RollerPart, ...]
    ) -> tuple[Floats, Floats]:
        """A pressed one may move by its radius along its slide."""
        center = bodies.position[part.body]
        extent = np.abs(part.axis) * part.width / 2 + part.reach * np.sqrt(np.maximum(0, 1 - part.axis**2))
        if part.press is not None:
            extent = extent + part.reach * np.abs(part.press.direction) + SLACK
        if part.arm is not None:
            extent = extent + swing(part) + SLACK
        return center - extent, center + extent

    def reach(self, part: RollerPart, bodies: Bodies, way: Floats) -> float:
        across = part.reach * float(np.linalg.norm(np.cross(part.axis, way)))
        along = 0.5 * part.width * abs(float(part.axis @ way))
        return float(bodies.position[part.body] @ way) + across + along

    def press(self, part: RollerPart) -> Press | None:
        return part.press

    def carrier(self, part: RollerPart) -> int:
        return -1

    def overlap(self, part: RollerPart, position: Floats, rotation: Floats) -> Callable[[Rod], float]:
        raise NotImplementedError("two rollers overlap in their contact")

    def inside(
        self, part: RollerPart, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats:
        """Of a rim the least radius counts, wherever that stands."""
        arms = points - position
        along = arms @ part.axis
        radius = part.radius if part.rim is None else float(part.rim.radius.min())
        away = np.linalg.norm(arms - along[..., None] * part.axis, axis=-1)
        return np.minimum(radius - away, part.width / 2 - np.abs(along))

    def depth_at_start(self, model: Model, sheet: SheetPart, part: RollerPart) -> float:
        normal, center = sheet.rotation[:, 2], model.bodies.position[part.body]
        if abs(float(part.axis @ normal)) > FLAT or sheet.count == 1:
            return 0.0
        if not balance.covered_shares(sheet, center, part.axis, part.width, True):
            return 0.0
        return part.radius + sheet.thickness / 2 - abs(float((center - sheet.center) @ normal))

    def place(self, part: RollerPart) -> str:
        return f"rollers.{part.name}.center"

    def depths(self, part: RollerPart, boxes: Boxes, at: Floats) -> Floats:
        """From the point of each box's middle plane that is nearest to the axis, kept on the box."""
        offset = np.einsum("tnij,tni->tnj", boxes.turn, at[:, None] - boxes.place)
        along = np.einsum("tnij,i->tnj", boxes.turn, part.axis)
        reach = np.clip(-np.einsum("tnk,tnk->tn", offset, along), -part.width / 2, part.width / 2)
        near = offset + reach[..., None] * along
        beside = np.abs(near[..., :2]) - boxes.half[:, :2]
        away = np.hypot(np.maximum(beside[..., 0], 0.0), np.maximum(beside[..., 1], 0.0))
        return part.radius - np.hypot(away, np.maximum(np.abs(near[..., 2]) - boxes.half[:, 2], 0.0))

    def drawn(self, part: RollerPart, half: Floats) -> list[Drawn]:
        """A cylinder about the z axis of its body, or the sectors of its rim, and a bar across both ends from
        the axis to the rim, which shows how it turns."""
        return _drawn(part)


def _drawn(roller: RollerPart) -> list[Drawn]:
    half, radius, rim = roller.width / 2, roller.radius, roller.rim
    if rim is None:
        found = [Drawn(roller.name, "roller", cylinder(radius, -half, half))]
    else:
        found = []
        for name, begin, end, own in zip(rim.name, rim.begin, rim.end, rim.radius, strict=True):
            kind = "sector" if name.startswith("s") else "roller"
            solid = slice_(float(own), float(begin), float(end), half)
            found.append(Drawn(f"{roller.name} {name}", kind, solid))
            if (0.5 * np.pi - begin) % (2.0 * np.pi) <= end - begin:  # where the mark is
                radius = float(own)
    size = np.array([0.5 * MARK * radius, 0.5 * (1.0 + PROUD) * radius, half + PROUD * radius])
    mark = Solid(CORNERS * size + [0.0, size[1], 0.0], BOX)
    found.append(Drawn(roller.name, "mark", mark))
    return found


def swing(roller: RollerPart) -> Floats:
    """How far a roller on an arm may go either way, by its radius in any direction across its axis [mm]."""
    return roller.reach * np.sqrt(np.maximum(0, 1 - roller.axis**2))


def _speed(drive: Drive) -> float:
    """The speed of a drive, of a profile the greatest in size [rad/ms]."""
    if drive.profile is not None:
        return max((speed for _, speed in drive.profile), key=abs)
    assert drive.speed is not None, "the spec has one of the two"
    return drive.speed


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


ROLLER = _Rollers()
