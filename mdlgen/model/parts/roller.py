"""Rollers: cylinders that are driven or free, fixed, pressed by a spring or carried by an arm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mdlgen.geometry.arrays import Floats
from mdlgen.geometry.solids import BOX, CORNERS, Solid, cylinder, slice_
from mdlgen.model.axles import turning
from mdlgen.model.covers import covered, lower_cover
from mdlgen.model.frames import frame
from mdlgen.model.moved import lower_stops
from mdlgen.model.parameters.axles import axle_rows, drive_rows, ratio_rows
from mdlgen.model.parameters.machine import center_rows, spring_rows, start_row
from mdlgen.model.parameters.moving import stops_rows
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.parts.kind import SLACK, BodyRow, Boxes, Drawn, Kind
from mdlgen.model.parts.words import begins, direction
from mdlgen.model.press import balance
from mdlgen.model.press.before import Before
from mdlgen.model.press.springs import roller_press
from mdlgen.model.rims import lower_rim
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import (
    BOX_CYLINDER,
    CYLINDER_CYLINDER,
    ArmPart,
    Bodies,
    Ints,
    Model,
    OneWay,
    Parameter,
    Press,
    RollerPart,
    SheetPart,
)
from mdlgen.model.tables.axle import CONTROLLED, LIMITER, OPEN, STEPPER
from mdlgen.spec.machine import Roller
from mdlgen.spec.scene import Scene
from mdlgen.units import PER_SECOND

FLAT = 0.1  # a roller is parallel to a sheet while |axis . normal| is below this
MARK = 0.12  # breadth of the mark on a roller, relative to its radius
PROUD = 0.01  # height of the mark above the surface, relative to the radius


class _Rollers(Kind[RollerPart]):
    table, part = "rollers", RollerPart
    with_sheet, with_roller = BOX_CYLINDER, CYLINDER_CYLINDER

    def lower(self, scene: Scene, before: Before, first: int) -> tuple[RollerPart, ...]:
        parts = []
        order = {name: index for index, name in enumerate(sorted(scene.rollers))}
        for name, index in order.items():
            roller = scene.rollers[name]
            turns = turning(scene, name)
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
                    speed=turns.speed,
                    ramp=turns.ramp,
                    profile=turns.profile,
                    one_way=OneWay(**dict(roller.one_way)) if roller.one_way else None,
                    press=roller_press(scene, name, before) if roller.press else None,
                    rim=lower_rim(roller),
                    arm=_arm(roller) if roller.arm else None,
                    cover=lower_cover(scene, name),
                    axle=turns.axle,
                    leader=-1 if turns.leader is None else first + order[turns.leader],
                    ratio=turns.ratio,
                    spin=roller.spin,
                )
            )
        return tuple(parts)

    def body(self, part: RollerPart, rollers: tuple[RollerPart, ...]) -> BodyRow:
        start = part.press.start * part.press.direction if part.press else _brought(part)
        inertia = np.array([part.inertia_transverse, part.inertia_transverse, part.inertia_axial])
        return BodyRow(part.center + start, frame(part.axis), part.mass, inertia, False, np.zeros(3))

    def bounds(
        self, part: RollerPart, bodies: Bodies, rollers: tuple[RollerPart, ...]
    ) -> tuple[Floats, Floats]:
        """A pressed one may move by its radius along its slide, and about its balance by as much as it begins
        off that."""
        center = bodies.position[part.body]
        extent = np.abs(part.axis) * part.width / 2 + part.reach * np.sqrt(np.maximum(0, 1 - part.axis**2))
        if part.press is not None:
            extent = extent + (part.reach + 2.0 * part.press.off) * np.abs(part.press.direction) + SLACK
        if part.arm is not None:
            extent = extent + swing(part) + SLACK
        return center - extent, center + extent

    def reach(self, part: RollerPart, bodies: Bodies, way: Floats) -> float:
        across = part.reach * float(np.linalg.norm(np.cross(part.axis, way)))
        along = 0.5 * part.width * abs(float(part.axis @ way))
        return float(bodies.position[part.body] @ way) + across + along

    def press(self, part: RollerPart) -> Press | None:
        return part.press

    def centre_bounds(
        self, part: RollerPart, position: Floats, margin: float | None
    ) -> tuple[Floats, Floats] | None:
        """One may move by its radius along its slide, or swing by as much."""
        if margin is None or (part.press is None and part.arm is None):
            return None
        if part.arm is not None:
            return position - swing(part) - margin, position + swing(part) + margin
        assert part.press is not None
        way = (part.reach + 2.0 * part.press.off) * np.abs(part.press.direction) + margin
        return position - way, position + way

    def inside(
        self, part: RollerPart, points: Floats, centers: Floats, position: Floats, rotation: Floats
    ) -> Floats:
        """A mask of points inside; the least radius of a rim counts, whatever its angle."""
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
            # its axis is beyond the sheet, of which an edge may be in it
            return max(
                0.0,
                float(self.of_boxes(model, np.arange(sheet.first, sheet.first + sheet.count), part).max()),
            )
        return part.radius + sheet.thickness / 2 - abs(float((center - sheet.center) @ normal))

    def contact_depth(self, model: Model, row: int, sheet: SheetPart, part: RollerPart) -> float:
        boxes = model.pairs.a[model.pairs.contact == row]
        return float(self.of_boxes(model, boxes, part).max()) if len(boxes) else 0.0

    def of_boxes(self, model: Model, boxes: Ints, part: RollerPart) -> Floats:
        """Depth of boxes in it as the run begins, (n,); below zero by how far they are off."""
        bodies = model.bodies
        shown = Boxes(bodies.position[boxes][None], bodies.rotation[boxes][None], bodies.half[boxes])
        return self.depths(part, shown, bodies.position[part.body][None])[0]

    def half_depth(self, part: RollerPart) -> float:
        return 0.5 * part.radius

    def constraints(self, model: Model, sheet: SheetPart, part: RollerPart) -> list[tuple[Floats, Floats]]:
        """The constraints of a nip, see `lints.idle`; one roller alone has none."""
        return []

    def depths(self, part: RollerPart, boxes: Boxes, at: Floats) -> Floats:
        """Depth by the point of each box's middle plane that is nearest to the axis, limited to the box."""
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

    def parameters(
        self, scene: Scene, name: str, starts: Mapping[str, tuple[float, float]]
    ) -> list[Parameter]:
        roller, base = scene.rollers[name], ("rollers", name)
        rows = center_rows(name, roller.center, base)
        rows += [
            Parameter(name, "R", "Radius R", roller.radius, "mm", (*base, "radius")),
            Parameter(name, "w", "Width", roller.width, "mm", (*base, "width")),
            Parameter(name, "M", "Mass", roller.mass, "g", (*base, "mass")),
        ]
        if roller.drive is not None:
            rows += drive_rows(name, roller.drive, (*base, "drive"))
        rows += ratio_rows(scene, name)
        if roller.spin != 0.0:
            label = "Spin as the run begins (rad/s)"
            rows.append(Parameter(name, "spin", label, roller.spin, "rad/ms", (*base, "spin")))
        if roller.one_way is not None:
            way, path = roller.one_way, (*base, "one_way")
            label = "Speed of its clutch at that torque (rad/s)"
            rows += [
                Parameter(name, "T_w", "Torque of its clutch (N mm)", way.torque, "N*mm", (*path, "torque")),
                Parameter(name, "w_w", label, way.creep, "rad/ms", (*path, "creep")),
            ]
        rows += axle_rows(name, roller)
        rows += _rim_rows(scene, name) + _arm_rows(scene, name)
        if roller.press is not None:
            carrier = roller.press.carrier_mass
            touch, start = starts[name]
            rows += [
                *spring_rows(name, roller.press, base),
                *stops_rows(name, roller.press.stops, (*base, "press", "stops")),
                Parameter(
                    name,
                    "M_c",
                    "Carrier mass",
                    roller.mass / 1000 if carrier is None else carrier,
                    "g",
                    (*base, "press", "carrier_mass"),
                ),
                Parameter(name, "touch", "Touching position along the slide, as written", touch, "mm", None),
                start_row(name, start, roller.press),
            ]
        return rows

    def facts(self, model: Model, part: RollerPart) -> list[str]:
        facts = [f"radius {part.radius:.4g} mm, width {part.width:.4g} mm, {part.mass:.4g} g"]
        if part.axle is not None or part.leader >= 0:
            facts += _turned(part)
        elif part.speed is None:
            facts.append("turns freely" if part.spin == 0.0 else f"turns freely{_from(part.spin, 'rad/s')}")
        elif part.profile is not None:
            facts.append(f"driven by a profile, {PER_SECOND * part.speed:.4g} rad/s at most")
        else:
            surface = PER_SECOND * abs(part.speed) * part.radius
            ramp = f", ramp {part.ramp:.4g} ms" if part.ramp else ""
            facts.append(f"driven at {PER_SECOND * part.speed:.4g} rad/s, surface {surface:.4g} mm/s{ramp}")
        if part.one_way is not None:
            facts.append(f"clutch, free in the sense {part.one_way.direction:+d}")
        if part.press is not None:
            spring = part.press
            facts.append(
                f"pressed along {direction(spring.direction)} by {spring.preload:.4g} N where it touches, "
                f"{spring.stiffness:.4g} N/mm"
            )
            facts += begins(spring)
        if part.arm is not None:
            facts.append(f"on an arm of {part.arm.mass:.4g} g, spring torque {part.arm.torque:.4g} N mm")
            if part.arm.angle != 0.0 or part.arm.speed != 0.0:
                angle = f"its arm begins turned by {np.degrees(part.arm.angle):.4g} deg"
                facts.append(angle + (_from(part.arm.speed, "rad/s") if part.arm.speed != 0.0 else ""))
        if part.rim is not None:
            facts.append(f"rim of {len(part.rim)} sectors")
        if part.cover is not None:
            facts += covered(part.cover)
        return facts


def _turned(part: RollerPart) -> list[str]:
    """Sentences about the motor, limiter, bearing or shaft that turns a roller."""
    if part.leader >= 0:
        return [f"turns {part.ratio:.4g} times for each turn of the roller that leads its shaft"]
    axle, found = part.axle, []
    assert axle is not None, "it has an axle, or follows one"
    if axle.shaft:
        found.append(f"leads the shaft {axle.shaft}")
    if axle.motor:
        word = {OPEN: "motor", CONTROLLED: "motor with speed control", STEPPER: "stepper"}[axle.kind]
        line = f", no load {PER_SECOND * axle.no_load:.4g} rad/s" if axle.no_load else ""
        found.append(f"{word}, {axle.stall:.4g} N mm at rest{line}")
    elif axle.kind == LIMITER:
        aims = 0.0 if part.speed is None else part.speed
        held = f"a shaft of {PER_SECOND * aims:.4g} rad/s" if aims else "a shaft that stands"
        found.append(f"torque limiter of {axle.limit:.4g} N mm to {held}")
    if axle.friction or axle.drag:
        found.append(f"bearing takes {axle.friction:.4g} N mm, {axle.drag:.4g} N mm ms/rad")
    return found


def _from(speed: float, unit: str) -> str:
    return f", at {PER_SECOND * speed:.4g} {unit} as the run begins"


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
    """Distance that a roller on an arm may move in either direction [mm]. It is its radius in any direction
    across its axis, plus the distance by which its arm is turned at the start."""
    begun = 2.0 * float(np.linalg.norm(_brought(roller)))
    return (roller.reach + begun) * np.sqrt(np.maximum(0, 1 - roller.axis**2))


def _brought(roller: RollerPart) -> Floats:
    """Displacement of a roller by its arm as the run begins [mm], (3,)."""
    if roller.arm is None or roller.arm.angle == 0.0:
        return np.zeros(3)
    way = roller.center - roller.arm.pivot
    return matrices(roller.arm.angle * roller.axis[None])[0] @ way - way


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
        angle=spec.start,
        speed=spec.start_speed,
        stops=lower_stops(spec.stops),
    )


def _rim_rows(scene: Scene, name: str) -> list[Parameter]:
    """Angles, radius, friction, stiffness and restitution of the sectors of a rim, as far as given."""
    rim, rows = scene.rollers[name].rim, []
    for k, sector in enumerate(rim.sectors if rim is not None else ()):
        path = ("rollers", name, "rim", "sectors", k)
        for member, label, value, unit in (
            ("from", "Angle where sector %d begins (deg)", sector.from_, "rad"),
            ("to", "Angle where sector %d ends (deg)", sector.to, "rad"),
            ("radius", "Radius of sector %d", sector.radius, "mm"),
            ("friction", "Friction of sector %d relative to the contact", sector.friction, "1"),
            ("stiffness", "Stiffness of sector %d relative to the contact", sector.stiffness, "1"),
            ("restitution", "Restitution c_R of sector %d", sector.restitution, "1"),
        ):
            if value is not None:
                rows.append(Parameter(name, f"s{k}_{member}", label % k, value, unit, (*path, member)))
    return rows


def _arm_rows(scene: Scene, name: str) -> list[Parameter]:
    """Pivot, mass and spring of an arm; centre of mass and inertia where they are given."""
    arm, path = scene.rollers[name].arm, ("rollers", name, "arm")
    if arm is None:
        return []
    rows = []
    for k, axis in enumerate(NAMED_AXES):
        label = f"Pivot of the arm {axis}"
        rows.append(Parameter(name, f"a_{axis}", label, arm.pivot[k], "mm", (*path, "pivot", k)))
    rows.append(Parameter(name, "M_a", "Mass of the arm", arm.mass, "g", (*path, "mass")))
    if arm.center is not None:
        for k, axis in enumerate(NAMED_AXES):
            label = f"Centre of mass of the arm {axis}"
            rows.append(Parameter(name, f"g_{axis}", label, arm.center[k], "mm", (*path, "center", k)))
    if arm.inertia is not None:
        label = "Inertia of the arm about it (kg mm2)"
        rows.append(Parameter(name, "I_a", label, arm.inertia, "g*mm^2", (*path, "inertia")))
    if arm.sprung:
        rows += [
            Parameter(name, "T_a", "Torque of its spring (N mm)", arm.torque, "N*mm", (*path, "torque")),
            Parameter(
                name, "k_a", "Its stiffness (N mm/rad)", arm.stiffness, "N*mm/rad", (*path, "stiffness")
            ),
            Parameter(
                name, "c_a", "Its damping (N mm s/rad)", arm.damping, "N*mm*ms/rad", (*path, "damping")
            ),
        ]
    return rows + stops_rows(name, arm.stops, (*path, "stops"))


KIND = _Rollers()
