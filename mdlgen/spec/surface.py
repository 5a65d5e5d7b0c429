"""Which way a roller turns so that its surface moves as asked where it faces the sheet."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from mdlgen.spec.fields import combined
from mdlgen.spec.sheet import Sheet
from mdlgen.spec.strict import fail

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

Vector = tuple[float, float, float]
# A roller faces a sheet whose mid-plane is so far from its axis, in radii: beyond, the sheet comes to it
# round a bend, and where from is not known.
NEAR, FAR = 0.3, 2.0
SQUARE = 0.5  # cosine below which a direction is not the one the surface moves along


def with_rates(scene: Scene, pairs: Iterable[tuple[int, str, str]]) -> None:
    """Gives each drive by surface_speed its angular speed. Raises the error where its sense is not clear."""
    pairs = list(pairs)
    for name, roller in scene.rollers.items():
        drive = roller.drive
        if drive is None or drive.surface_speed is None:
            continue
        sense = _sense(scene, name, pairs)
        rate = combined(
            sense * drive.surface_speed / roller.radius,
            "-{0}/{1}" if sense < 0.0 else "{0}/{1}",
            (drive.surface_speed, "mm/s"),
            (roller.radius, "mm"),
        )
        plain = drive.model_copy(update={"speed": rate, "surface_speed": None, "direction": None})
        scene.rollers[name] = roller.model_copy(update={"drive": plain})


def _sense(scene: Scene, name: str, pairs: list[tuple[int, str, str]]) -> float:
    """1 or -1: about the roller's axis, right-hand rule."""
    roller, path = scene.rollers[name], ("rollers", name, "drive", "direction")
    assert roller.drive is not None and roller.drive.direction is not None, "with a surface speed"
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
            "no sheet that it has a contact with lies beside it at the start"
            if faces
            else "it meets no sheet"
        )
        raise fail(f"which way {name} turns is not clear: {why}; give speed, as speed: 60 rad/s", path)
    senses = set()
    for way, face in zip(ways, found, strict=True):
        along = _dot(way, roller.drive.direction) / math.hypot(*face)
        if abs(along) < SQUARE:
            length = math.hypot(*way) or 1.0
            shown = ", ".join(f"{c / length:.3g}" for c in way)
            raise fail(f"where {name} faces the sheet its surface moves along [{shown}], not that way", path)
        senses.add(math.copysign(1.0, along))
    if len(senses) > 1:
        raise fail(f"{name} faces sheets on both sides, which move opposite ways; give speed", path)
    return senses.pop()


def _to_sheet(sheet: Sheet, center: Vector, radius: float) -> Vector | None:
    """From a roller's axis to the mid-plane of a sheet as it starts; None: it is not beside that plane."""
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
