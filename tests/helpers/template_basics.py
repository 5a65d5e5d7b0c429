"""Parts and values of which scenes for templates are made."""

from __future__ import annotations

import json

ROLLER = {
    "center": ["0 mm", "0 mm", "-5 mm"],
    "axis": "y",
    "radius": "5 mm",
    "width": "8 mm",
    "mass": "0.5 g",
}


DRIVE = {"speed": "100 rad/s"}


MOTOR = {"torque": "3 N*mm", "speed": "200 rad/s", "inertia": "20 g*mm^2", "gear": 4}


TABLE = {
    "table": [["0 rad/s", "4 N*mm"], ["80 rad/s", "3 N*mm"], ["90 rad/s", "0 N*mm"]],
    "voltage": [["0 ms", 0.5], ["2 ms", 1]],
}


PRESS = {"direction": "-z", "stiffness": "0.3 N/mm", "preload": "3 N"}


PLANE = {
    "center": ["0 mm", "0 mm", "-20 mm"],
    "normal": "z",
    "size": ["90 mm", "80 mm", "10 mm"],
    "mass": "9 g",
}


def put(path: str, value: object) -> str:
    return f"{path}={json.dumps(value)}"


SOFT = PRESS | {"preload": "1 N"}  # what the spring itself holds, as nothing else does


LINE = {"from": ["-9 mm", "0 mm", "1 mm"], "to": ["9 mm", "0 mm", "2 mm"], "axis": "y", "side": "left"}


MESH = {"file": "meshes/ramp.stl", "center": ["9 mm", "0 mm", "-3 mm"]}
