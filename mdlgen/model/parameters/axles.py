"""What the user gave of prescribed speeds, and of motors, bearings and torque limiters."""

from __future__ import annotations

from mdlgen.model.tables import Model, Parameter, RollerPart
from mdlgen.spec.drive import Drive
from mdlgen.spec.machine import Roller
from mdlgen.spec.motor import Motor
from mdlgen.spec.scene import Scene

Path = tuple[str | int, ...]
OF_SHAFT = "shaft_"
"""What the data set of a shaft begins with, before its name."""


def shaft_rows(scene: Scene) -> list[Parameter]:
    """Speeds of shafts that have a prescribed one."""
    rows = []
    for name, shaft in sorted(scene.shafts.items()):
        if shaft.prescribed and shaft.drive is not None:
            rows += drive_rows(f"{OF_SHAFT}{name}", shaft.drive, ("shafts", name, "drive"))
    return rows


def ratio_rows(scene: Scene, name: str) -> list[Parameter]:
    """Turns of a roller for one of its shaft, where that has a prescribed speed."""
    return [
        Parameter(
            name,
            "ratio",
            f"Turns for one of shaft {own}",
            shaft.rollers[name],
            "1",
            ("shafts", own, "rollers", name),
        )
        for own, shaft in scene.shafts.items()
        if shaft.prescribed and name in shaft.rollers
    ]


def home_of(model: Model, roller: RollerPart) -> str:
    """The data set that has the speed of a roller: its own, or that of its shaft."""
    for row in model.parameters:
        if row.data_set == roller.name and row.member == "ratio" and row.path is not None:
            return f"{OF_SHAFT}{row.path[1]}"
    return roller.name


def drive_rows(name: str, drive: Drive, path: Path) -> list[Parameter]:
    """The speed of a data set over time, as a ramp or by corners."""
    rows = []
    if drive.speed is not None:
        rows.append(Parameter(name, "omega", "Speed (rad/s)", drive.speed, "rad/ms", (*path, "speed")))
        rows.append(Parameter(name, "ramp", "Ramp time", drive.ramp, "ms", (*path, "ramp")))
    for k, (time, speed) in enumerate(drive.profile or ()):
        at = (*path, "profile", k)
        rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
        rows.append(Parameter(name, f"w_{k}", f"Speed at corner {k} (rad/s)", speed, "rad/ms", (*at, 1)))
    return rows


def axle_rows(name: str, roller: Roller) -> list[Parameter]:
    """Of a roller: its motor that runs by its voltage, its bearing and its limiter."""
    base: Path = ("rollers", name)
    motor = roller.drive.motor if roller.drive is not None else None
    rows = [] if motor is None or not motor.open else _motor(name, motor, (*base, "drive", "motor"))
    if roller.limiter is not None:
        path = (*base, "limiter")
        speed = "Speed against its shaft at that torque (rad/s)"
        rows += [
            Parameter(
                name, "T_l", "Torque of its limiter (N mm)", roller.limiter.torque, "N*mm", (*path, "torque")
            ),
            Parameter(name, "w_l", speed, roller.limiter.creep, "rad/ms", (*path, "creep")),
        ]
    if roller.bearing is not None:
        own, path = roller.bearing, (*base, "bearing")
        speed = "Speed over which that changes its sign (rad/s)"
        drag = "Drag of its bearing (N mm s/rad)"
        rows += [
            Parameter(
                name, "T_b", "Friction torque of its bearing (N mm)", own.torque, "N*mm", (*path, "torque")
            ),
            Parameter(name, "w_b", speed, own.creep, "rad/ms", (*path, "creep")),
            Parameter(name, "d_b", drag, own.drag, "N*mm*ms/rad", (*path, "drag")),
        ]
    return rows


def _motor(name: str, motor: Motor, path: Path) -> list[Parameter]:
    """A line or a table of torques, whose first speed and last torque are 0; rotor, gear and voltage."""
    rows = []
    if motor.table is None:
        assert motor.torque is not None and motor.speed is not None, "a motor without a table has both"
        at = (*path, "speed")
        rows += [
            Parameter(
                name, "T_m", "Stall torque of its motor (N mm)", motor.torque, "N*mm", (*path, "torque")
            ),
            Parameter(name, "w_m", "No-load speed of its motor (rad/s)", motor.speed, "rad/ms", at),
        ]
    for k, (speed, torque) in enumerate(motor.table or ()):
        at = (*path, "table", k)
        if k:
            label = f"Speed of its motor, point {k} (rad/s)"
            rows.append(Parameter(name, f"w_m{k}", label, speed, "rad/ms", (*at, 0)))
        if motor.table is not None and k < len(motor.table) - 1:
            label = f"Torque of its motor, point {k} (N mm)"
            rows.append(Parameter(name, f"T_m{k}", label, torque, "N*mm", (*at, 1)))
    rows += [
        Parameter(name, "J_m", "Inertia of its rotor (kg mm2)", motor.inertia, "g*mm^2", (*path, "inertia")),
        Parameter(name, "g_m", "Turns of its motor for one of the roller", motor.gear, "1", (*path, "gear")),
    ]
    for k, (time, part) in enumerate(motor.voltage or ()):
        at = (*path, "voltage", k)
        label = f"Part of the full voltage at corner {k}"
        rows.append(Parameter(name, f"t_{k}", f"Time of corner {k}", time, "ms", (*at, 0)))
        rows.append(Parameter(name, f"u_{k}", label, part, "1", (*at, 1)))
    return rows
