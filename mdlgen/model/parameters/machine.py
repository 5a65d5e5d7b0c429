"""What the user gave of parts of the machine."""

from __future__ import annotations

from mdlgen.model.meshes import LIGHT
from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter
from mdlgen.spec.machine import Press
from mdlgen.spec.scene import Scene


def center_rows(name: str, center: tuple[float, ...], base: tuple[str, str]) -> list[Parameter]:
    return [
        Parameter(name, axis, f"Centre {axis}", center[k], "mm", (*base, "center", k))
        for k, axis in enumerate(NAMED_AXES)
    ]


def guide_rows(scene: Scene, name: str) -> list[Parameter]:
    guide, base = scene.guides[name], ("guides", name)
    rows = []
    if guide.line is not None:
        for end, key, place in (("0", "from", guide.line.from_), ("1", "to", guide.line.to)):
            for k, axis in enumerate(NAMED_AXES):
                path = (*base, "line", key, k)
                label = f"{axis} where it {'ends' if key == 'to' else 'begins'}"
                rows.append(Parameter(name, f"{axis}_{end}", label, place[k], "mm", path))
    if guide.arc is not None:
        arc, path = guide.arc, (*base, "arc")
        for k, axis in enumerate(NAMED_AXES):
            rows.append(Parameter(name, axis, f"Centre {axis}", arc.center[k], "mm", (*path, "center", k)))
        rows += [
            Parameter(name, "R", f"Radius, {arc.side}", arc.radius, "mm", (*path, "radius")),
            Parameter(name, "from", "Angle where it begins (deg)", arc.from_, "rad", (*path, "from")),
            Parameter(name, "to", "Angle where it ends (deg)", arc.to, "rad", (*path, "to")),
        ]
    return [
        *rows,
        Parameter(name, "w", "Width", guide.width, "mm", (*base, "width")),
        Parameter(name, "s", "Thickness of the plate", guide.thickness, "mm", (*base, "thickness")),
        Parameter(name, "M", "Mass", guide.mass, "g", (*base, "mass")),
    ]


def mesh_rows(scene: Scene, name: str) -> list[Parameter]:
    mesh, base = scene.meshes[name], ("meshes", name)
    rows = center_rows(name, mesh.center, base)
    for k, axis in enumerate(NAMED_AXES):
        label = f"Rotation about {axis} (deg)"
        rows.append(Parameter(name, f"r_{axis}", label, mesh.rotation[k], "rad", (*base, "rotation", k)))
    if mesh.density is not None:
        path = (*base, "density")
        return [*rows, Parameter(name, "rho", "Density (kg/mm3)", mesh.density, "g/mm^3", path)]
    mass = LIGHT if mesh.mass is None else mesh.mass
    return [*rows, Parameter(name, "M", "Mass", mass, "g", (*base, "mass"))]


def roller_rows(scene: Scene, name: str, starts: dict[str, tuple[float, float]]) -> list[Parameter]:
    roller, base = scene.rollers[name], ("rollers", name)
    rows = center_rows(name, roller.center, base)
    rows += [
        Parameter(name, "R", "Radius R", roller.radius, "mm", (*base, "radius")),
        Parameter(name, "w", "Width", roller.width, "mm", (*base, "width")),
        Parameter(name, "M", "Mass", roller.mass, "g", (*base, "mass")),
    ]
    if roller.drive is not None:
        drive = (*base, "drive")
        if roller.drive.speed is not None:
            rows.append(
                Parameter(name, "omega", "Speed (rad/s)", roller.drive.speed, "rad/ms", (*drive, "speed"))
            )
            rows.append(Parameter(name, "ramp", "Ramp time", roller.drive.ramp, "ms", (*drive, "ramp")))
        for k, (time, speed) in enumerate(roller.drive.profile or ()):
            at = (*drive, "profile", k)
            rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
            rows.append(Parameter(name, f"w_{k}", f"Speed at corner {k} (rad/s)", speed, "rad/ms", (*at, 1)))
    if roller.one_way is not None:
        way, path = roller.one_way, (*base, "one_way")
        label = "Speed of its clutch at that torque (rad/s)"
        rows += [
            Parameter(name, "T_w", "Torque of its clutch (N mm)", way.torque, "N*mm", (*path, "torque")),
            Parameter(name, "w_w", label, way.creep, "rad/ms", (*path, "creep")),
        ]
    rows += _rim(scene, name) + _arm(scene, name)
    if roller.press is not None:
        carrier = roller.press.carrier_mass
        touch, start = starts[name]
        rows += [
            *_spring(name, roller.press, base),
            Parameter(
                name,
                "M_c",
                "Carrier mass",
                roller.mass / 1000 if carrier is None else carrier,
                "g",
                (*base, "press", "carrier_mass"),
            ),
            Parameter(name, "touch", "Touching position along the slide, as written", touch, "mm", None),
            _start(name, start),
        ]
    return rows


def _spring(name: str, press: Press, base: tuple[str, str]) -> list[Parameter]:
    """The spring of a roller or a plate."""
    way = (*base, "press")
    return [
        Parameter(name, "k", "Spring stiffness", press.stiffness, "N/mm", (*way, "stiffness")),
        Parameter(name, "f", "Spring preload (N)", press.preload, "N", (*way, "preload")),
        Parameter(name, "l", "Spring free length", press.free_length, "mm", (*way, "free_length")),
        Parameter(name, "zeta", "Relative damping", press.damping_ratio, "1", (*way, "damping_ratio")),
    ]


def _start(name: str, start: float) -> Parameter:
    label = "Start along the slide in static equilibrium, as written"
    return Parameter(name, "start", label, start, "mm", None)


def plate_press_rows(name: str, press: Press, start: float) -> list[Parameter]:
    """Spring and slide of a plate, which touches no roller: its spring has the preload where it is given."""
    base = ("planes", name)
    rows = _spring(name, press, base)
    if press.carrier_mass is not None:
        path = (*base, "press", "carrier_mass")
        rows.append(Parameter(name, "M_c", "Mass of its slide", press.carrier_mass, "g", path))
    return [*rows, _start(name, start)]


def _rim(scene: Scene, name: str) -> list[Parameter]:
    """Angles, radius, friction, stiffness and restitution of the sectors of a rim, as far as given."""
    rim, rows = scene.rollers[name].rim, []
    for k, sector in enumerate(rim.sectors if rim is not None else ()):
        path = ("rollers", name, "rim", "sectors", k)
        for member, label, value, unit in (
            ("from", "Angle where sector %d begins (deg)", sector.from_, "rad"),
            ("to", "Angle where sector %d ends (deg)", sector.to, "rad"),
            ("radius", "Radius of sector %d", sector.radius, "mm"),
            ("friction", "Friction of sector %d in times that of the contact", sector.friction, "1"),
            ("stiffness", "Stiffness of sector %d in times that of the contact", sector.stiffness, "1"),
            ("restitution", "Restitution c_R of sector %d", sector.restitution, "1"),
        ):
            if value is not None:
                rows.append(Parameter(name, f"s{k}_{member}", label % k, value, unit, (*path, member)))
    return rows


def _arm(scene: Scene, name: str) -> list[Parameter]:
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
    return rows
