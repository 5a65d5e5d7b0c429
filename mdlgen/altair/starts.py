"""Starts, and gravity over time, that no text has."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model, RollerPart


def refuse_starts(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for gravity over time, which is a constant there, and for slides
    and arms that begin with a speed, and arms that begin turned."""
    if len(model.gravity_profile):
        raise RefusedError(
            f"{who}: gravity_profile has no counterpart there, where gravity is a constant; run the scene "
            "with lattice or exudyn, or leave it out",
            ("gravity_profile",),
        )
    for roller in model.rollers:
        for path, value in _given(roller):
            if value != 0.0:
                raise RefusedError(
                    f"{who}: roller {roller.name} has {'.'.join(path)}, which is not written; run the scene "
                    "with lattice or exudyn, or leave it out",
                    ("rollers", roller.name, *path),
                )
    for plate, press in model.plates:
        if press.speed != 0.0:
            raise RefusedError(
                f"{who}: plane {plate.name} has press.start_speed, which is not written; run the scene with "
                "lattice or exudyn, or leave it out",
                ("planes", plate.name, "press", "start_speed"),
            )


def _given(roller: RollerPart) -> list[tuple[tuple[str, ...], float]]:
    found: list[tuple[tuple[str, ...], float]] = []
    if roller.press is not None:
        found.append((("press", "start_speed"), roller.press.speed))
    if roller.arm is not None:
        found += [(("arm", "start"), roller.arm.angle), (("arm", "start_speed"), roller.arm.speed)]
    return found
