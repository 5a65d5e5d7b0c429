"""The forms of measured friction that the contact of two parts may have."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene


def unlike_measured(scene: Scene, index: int, names: tuple[str, str]) -> tuple[str, str] | None:
    """(key of the friction, why the contact of two parts, those of an entry, may not have it); None: it may
    have all that it has."""
    friction = scene.contacts[index].friction
    if not friction.measured:
        return None
    a, b = names
    where = f"the contact of {a} and {b}"
    given = [
        (key, what)
        for key, what in (
            ("md", "friction by direction (md, cd)"),
            ("front", "friction by face (front, back)"),
            ("scatter", "scatter over a sheet"),
            ("pressure", "friction by pressure"),
        )
        if getattr(friction, key) is not None
    ]
    if a not in scene.sheets:
        for key, what in given:
            return key, f"{what} is of a sheet, and {where} has none; give mu"
        return None
    if b in scene.sheets:
        for key, what in given:
            return key, f"{what} is of a sheet on a part of the machine, not of {where}, two sheets; give mu"
        key = "speed" if friction.speed is not None else "stribeck_velocity"
        return key, (
            f"{key} is not modelled in {where}, two sheets; give static, dynamic, stiction_velocity and "
            "friction_velocity, or speed with two points"
        )
    mesh = scene.meshes.get(b)
    if friction.pressure is not None and (
        b in scene.rollers or b in scene.parts or (mesh is not None and mesh.on is not None)
    ):
        message = (
            f"friction by pressure is not modelled in {where}: the area of a nip is not that of its boxes"
        )
        return "pressure", f"{message}; give the coefficient at the pressure of the nip"
    if scene.run.analysis == "static":
        for key, what in given:
            if key != "scatter":
                return key, f"{what} is not modelled in a static analysis; give mu"
    return None
