"""What no law depends on: where the origin is, how axes are turned, left and right, the units of the file."""

from __future__ import annotations

import copy
import json
import re
from typing import Any

import numpy as np
import pytest
from asked import as_asked
from scipy.spatial.transform import Rotation

import mdlgen
from mdlgen.model.tables import Floats
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.spec.load import parse
from mdlgen.units import parse_quantity

Spec = dict[str, Any]
AXES = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}


def transport() -> Spec:
    """A note that is drawn obliquely between rollers over a plane: contacts, friction, presses, drives."""
    spec = parse((samples() / "transport_4x4.yaml").read_text("utf-8"), "t").data
    spec["sheets"]["note"] |= {"boxes": [4, 6], "turn": "7 deg"}
    spec["run"] = {"duration": "6 ms", "step": "20 us", "print_step": "0.5 ms"}
    return spec


def channel() -> Spec:
    """A strip that is pushed into a bend."""
    spec = parse((samples() / "channel.yaml").read_text("utf-8"), "c").data
    spec["sheets"]["note"] |= {"boxes": [8, 2], "center": ["-22 mm", "0 mm", "0 mm"]}
    spec["run"] = {"duration": "5 ms", "step": "20 us", "print_step": "0.5 ms"}
    return spec


def block() -> Spec:
    """A spinning block of one box that falls on a plane, turned."""
    spec = parse((samples() / "verify" / "drop.yaml").read_text("utf-8"), "d").data
    spec["sheets"]["block"] |= {
        "center": ["0 mm", "0 mm", "8 mm"],
        "rotation": ["5 deg", "3 deg", "20 deg"],
        "spin": ["9 rad/s", "2 rad/s", "4 rad/s"],
    }
    spec["planes"]["floor"]["size"] = ["500 mm", "500 mm", "10 mm"]
    spec["run"] = {"duration": "24 ms", "step": "20 us", "print_step": "1 ms"}
    return spec


def sprung() -> Spec:
    """The same block on a plate that gives way obliquely."""
    spec = block()
    spec["planes"]["floor"] |= {
        "mass": "100 g",
        "press": {
            "direction": [0.2, 0.1, 1.0],
            "stiffness": "0.5 N/mm",
            "preload": "0.96 N",
            "free_length": "30 mm",
        },
    }
    return spec


def numbers(value: Any, unit: str) -> Floats:
    if isinstance(value, str):
        sign, axis = (-1.0, value[1:]) if value.startswith("-") else (1.0, value)
        return sign * np.array(AXES[axis])
    return np.array([parse_quantity(v, unit) if isinstance(v, str) else v for v in value])


def written(value: Floats, unit: str) -> list[Any]:
    factor = parse_quantity(f"1 {unit}", unit) if unit else 1.0
    return [f"{v / factor!r} {unit}" if unit else v for v in np.asarray(value).tolist()]


def moved(spec: Spec, turn: Floats, shift: Floats) -> Spec:
    """The scene after a proper or mirroring `turn` (3, 3) of the world, then a `shift` [mm].

    An axis about which something turns is its own mirror image where the mirror contains it with its sense
    turned, hence the determinant. A mirror turns a sheet's own y around too, which is its symmetry.
    """
    spec = copy.deepcopy(spec)
    hand = round(float(np.linalg.det(turn)))

    def place(part: Spec, *names: str) -> None:
        for name in names:
            part[name] = written(turn @ numbers(part.get(name, ["0 mm"] * 3), "mm") + shift, "mm")

    def way(part: Spec, name: str, unit: str = "", sense: int = 1) -> None:
        if name in part:
            part[name] = written(sense * turn @ numbers(part[name], unit), unit)

    way(spec, "gravity", "m/s^2")
    for sheet in spec["sheets"].values():
        place(sheet, "center")
        angles = sheet.pop("rotation", ["0 deg", "0 deg", sheet.pop("turn", "0 deg")])
        own = Rotation.from_euler("xyz", numbers(angles, "deg")).as_matrix()
        own = turn @ own @ np.diag([1.0, hand, 1.0])
        sheet["rotation"] = written(Rotation.from_matrix(own).as_euler("xyz"), "deg")
        way(sheet, "velocity", "m/s")
        way(sheet, "spin", "rad/s", hand)
    for roller in spec.get("rollers", {}).values():
        place(roller, "center")
        way(roller, "axis", sense=hand)
        way(roller.get("press", {}), "direction")
    for plane in spec.get("planes", {}).values():
        place(plane, "center")
        way(plane, "normal")
        way(plane.get("press", {}), "direction")
    for guide in spec.get("guides", {}).values():
        if "line" in guide:
            place(guide["line"], "from", "to")
            way(guide["line"], "axis", sense=hand)
    for probe in spec.get("probes", {}).values():
        if hand < 0 and "at" in probe:
            x, y = probe["at"]
            probe["at"] = [x, f"-{y}"]
    return spec


def run(spec: Spec) -> Result:
    result = mdlgen.solve(mdlgen.lower(mdlgen.loads(json.dumps(spec))), "lattice")
    assert as_asked(result), result.status
    return result


@pytest.fixture(scope="module")
def plain() -> dict[str, Result]:
    return {name: run(make()) for name, make in SCENES.items()}


def difference(one: Result, other: Result, turn: Floats, shift: Floats, mirrored: bool = False) -> float:
    """Greatest distance of a box from where the symmetry has it, relative to the greatest travel."""
    sheet = one.model.sheets[0]
    boxes = np.arange(sheet.count)
    images = boxes.reshape(sheet.n_y, sheet.n_x)[::-1].ravel() if mirrored else boxes
    expected = one.position[:, boxes] @ turn.T + shift
    apart = np.linalg.norm(other.position[:, images] - expected, axis=2).max()
    travel = np.linalg.norm(one.position[-1, boxes] - one.position[0, boxes], axis=1).max()
    assert travel > 1.0  # mm
    return float(apart / travel)


SCENES = {"transport": transport, "channel": channel, "block": block, "sprung": sprung}
TURNS = {
    "about x": [90, 0, 0],
    "about y": [0, 37, 0],
    "about all": [20, -65, 140],
}
FAR = np.array([6e3, -7.5e3, 2.8e3])  # 10 m


@pytest.mark.parametrize("scene", ["transport", "block", "sprung"])
@pytest.mark.parametrize("turn", TURNS)
def test_turned_and_far_away(scene: str, turn: str, plain: dict[str, Result]) -> None:
    matrix = Rotation.from_euler("xyz", TURNS[turn], degrees=True).as_matrix()
    found = run(moved(SCENES[scene](), matrix, FAR))
    assert difference(plain[scene], found, matrix, FAR) < 1e-6


@pytest.mark.parametrize("scene", SCENES)
def test_mirrored(scene: str, plain: dict[str, Result]) -> None:
    matrix = np.diag([1.0, -1.0, 1.0])
    spec = moved(SCENES[scene](), matrix, np.zeros(3))
    if scene == "channel":  # seen from the other side of its plane: angles and sides as they were
        spec = SCENES[scene]()
    assert difference(plain[scene], run(spec), matrix, np.zeros(3), mirrored=True) < 1e-9


UNITS = {
    "mm": "m",
    "g": "kg",
    "ms": "s",
    "MPa": "Pa",
    "N/mm^1.5": "N/m^1.5",
    "rad/s": "rpm",
    "N/mm": "kN/m",
    "m/s^2": "mm/ms^2",
}
UNITS |= {"N*mm/rad": "N*m/rad", "mm/s": "m/s", "deg": "rad", "us": "ms", "N": "mN", "N*mm": "N*m", "mg": "g"}


def in_other_units(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: in_other_units(item) for key, item in value.items()}
    if isinstance(value, list):
        return [in_other_units(item) for item in value]
    found = re.fullmatch(r"([-+0-9.e]+) (.+)", value) if isinstance(value, str) else None
    if found is None:
        return value
    other = UNITS[found[2]]
    return f"{parse_quantity(value, found[2]) / parse_quantity(f'1 {other}', other)!r} {other}"


@pytest.mark.parametrize("scene", SCENES)
def test_other_units(scene: str, plain: dict[str, Result]) -> None:
    found = run(in_other_units(SCENES[scene]()))
    # numbers of the scene differ in their last digit
    assert difference(plain[scene], found, np.eye(3), np.zeros(3)) < 1e-9
