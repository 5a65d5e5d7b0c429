"""Finds the sense of rotation with which a roller's surface moves as asked where it faces the sheet."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mdlgen.spec.quantities import combined
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.strict import fail, fail_all

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

Vector = tuple[float, float, float]
# A roller faces a sheet whose mid-plane is so far from its axis, in radii: beyond, the sheet comes to it
# round a bend, and where from is not known.
NEAR, FAR = 0.3, 2.0
SQUARE = 0.5  # cosine below which a direction is not the one the surface moves along


def with_rates(scene: Scene, pairs: Iterable[tuple[int, str, str]]) -> None:
    """Gives each drive by surface_speed its angular speed. Raises the error where a sense is not clear."""
    pairs, errors = list(pairs), []
    for name, roller in scene.rollers.items():
        drive = roller.drive
        if drive is None or drive.surface_speed is None:
            continue
        try:
            sense = _sense(scene, name, pairs)
        except PydanticCustomError as error:
            errors.append(error)
            continue
        rate = combined(
            sense * drive.surface_speed / roller.radius,
            "-{0}/{1}" if sense < 0.0 else "{0}/{1}",
            (drive.surface_speed, "mm/s"),
            (roller.radius, "mm"),
        )
        plain = drive.model_copy(update={"speed": rate, "surface_speed": None, "direction": None})
        scene.rollers[name] = roller.model_copy(update={"drive": plain})
    if errors:
        raise fail_all(errors)


def _sense(scene: Scene, name: str, pairs: list[tuple[int, str, str]]) -> float:
    """1 or -1: about the roller's axis, right-hand rule."""
    roller, path = scene.rollers[name], ("rollers", name, "drive", "direction")
    assert roller.drive is not None and roller.drive.direction is not None, "with a surface speed"
    assert roller.drive.surface_speed is not None
    speed = f"{1e3 * roller.drive.surface_speed / roller.radius:.4g}"
    by_speed = (
        f"give speed in place of surface_speed and direction, as speed: {speed} rad/s or -{speed} rad/s"
    )
    met = [a if b == name else b for _, a, b in pairs if name in (a, b)]
    faces = [
        _to_sheet(scene.sheets[other], roller.center, roller.radius) for other in met if other in scene.sheets
    ]
    found = [face for face in faces if face is not None]
    if not found and faces:  # a sheet that comes later passes between it and its counterpart
        others = [scene.rollers[other].center for other in met if other in scene.rollers]
        found = [_minus(center, roller.center) for center in others]
    ways = [_cross(roller.axis, face) for face in found]
    if not ways:
        why = (
            "no sheet that it has a contact with lies next to it at the start"
            if faces
            else "it meets no sheet"
        )
        raise fail(f"which way {name} turns is not clear: {why}; {by_speed}", path)
    senses = set()
    for way, face in zip(ways, found, strict=True):
        along = _dot(way, roller.drive.direction) / math.hypot(*face)
        if abs(along) < SQUARE:
            raise fail(_allowed(name, way, along, by_speed), path)
        senses.add(math.copysign(1.0, along))
    if len(senses) > 1:
        raise fail(f"{name} faces sheets on both sides, which move opposite ways; {by_speed}", path)
    return senses.pop()


def _allowed(name: str, way: Vector, along: float, by_speed: str) -> str:
    """The directions allowed for a surface that moves along `way`, the nearer one as the example."""
    length = math.hypot(*way)
    if length < 1e-9:
        return f"{name} faces the sheet with its end, where its surface moves no way; {by_speed}"
    nearer, other = (
        _as_given([sign * c / length for c in way]) for sign in ((-1, 1) if along < 0 else (1, -1))
    )
    return (
        f"where {name} faces the sheet its surface moves along {nearer} or {other}, not that way; "
        f"write like direction: {nearer}"
    )


def _as_given(way: list[float]) -> str:
    """A unit vector as a scene has it."""
    for axis, part in zip("xyz", way, strict=True):
        if abs(part) > 1.0 - 1e-9:
            return axis if part > 0.0 else f"-{axis}"
    return f"[{', '.join(f'{round(c, 4) + 0.0:g}' for c in way)}]"


def _to_sheet(sheet: Sheet, center: Vector, radius: float) -> Vector | None:
    """From a roller's axis to the mid-plane of a sheet as it starts; None: it is not near that plane."""
    normal = sheet.normal
    height = _dot(_minus(sheet.center, center), normal)
    if not NEAR * radius < abs(height) < FAR * radius:
        return None
    x, y, z = (height * n for n in normal)
    return x, y, z


def _minus(one: Vector, two: Vector) -> Vector:
    return one[0] - two[0], one[1] - two[1], one[2] - two[2]


def _dot(one: Vector, two: Vector) -> float:
    return sum(p * q for p, q in zip(one, two, strict=True))


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
