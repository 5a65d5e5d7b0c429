"""Smoothing speeds of contacts that give none: they follow the speeds of the scene."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from mdlgen.spec.drive import Drive
    from mdlgen.spec.machine import Roller
    from mdlgen.spec.scene import Scene
    from mdlgen.spec.sheet import Sheet

SHARE = 0.01  # of the fastest driven surface or sheet: what is held by friction creeps by less
LEAST, MOST = 1e-3, 20e-3  # [mm/ms]
_MOST_CHARACTERS = 500  # of a formula: a longer one is a number in a text


class Speeds(NamedTuple):
    """Smoothing speeds of one contact [mm/ms]."""

    smoothing: float
    stiction: float
    friction: float


def speeds(scene: Scene, pairs: Iterable[tuple[int, str, str]] | None = None) -> tuple[Speeds, ...]:
    """Those of each contact: its own, or what follows from the scene. `pairs` are its contact_pairs.

    A smoothing that is left out is 1 % of the fastest surface of a roller, or of the fastest sheet as the run
    begins, but at least 1 mm/s and at most 20 mm/s. A contact in which a sheet meets a sheet has 1 mm/s:
    there slow creep is what counts. A stiction velocity that follows is no more than a friction velocity
    given.
    """
    pairs = scene.contact_pairs() if pairs is None else pairs
    general, fine = _general(scene), _with_two_sheets(scene, pairs)
    found = []
    for index, contact in enumerate(scene.contacts):
        friction = contact.friction
        if contact.smoothing is not None:
            found.append(Speeds(contact.smoothing, *friction.speeds(contact.smoothing)))
            continue
        own = LEAST if index in fine else general
        most = own if friction.friction_velocity is None else min(own, friction.friction_velocity)
        found.append(Speeds(own, *friction.speeds(most)))
    return tuple(found)


def following(scene: Scene) -> list[int]:
    """The contacts whose smoothing follows from the scene and so is not 1 mm/s, what it was up to version
    0.1."""
    if _general(scene) == LEAST:
        return []
    fine = _with_two_sheets(scene, scene.contact_pairs())
    return [k for k, contact in enumerate(scene.contacts) if contact.smoothing is None and k not in fine]


def _general(scene: Scene) -> float:
    return min(max(SHARE * _fastest(scene), LEAST), MOST)


def _with_two_sheets(scene: Scene, pairs: Iterable[tuple[int, str, str]]) -> set[int]:
    """Contacts in which a sheet meets a sheet."""
    return {index for index, a, b in pairs if a in scene.sheets and b in scene.sheets}


def surface_speed(roller: Roller) -> float:
    """Greatest surface speed of a driven roller [mm/ms]; without a drive, that at the start."""
    drive = roller.drive
    if drive is None:
        return abs(roller.spin) * _reach(roller)
    return _fastest_of(drive) * _reach(roller)


def _fastest_of(drive: Drive) -> float:
    """Greatest speed that a drive prescribes or aims at [rad/ms], of a motor that has no target its no-load
    speed."""
    if drive.motor is not None and drive.motor.open:
        return abs(drive.motor.no_load) / drive.motor.gear
    rates = [rate for _, rate in drive.profile] if drive.profile is not None else [drive.speed or 0.0]
    return max(abs(rate) for rate in rates)


def _on_shafts(scene: Scene) -> float:
    """Greatest surface speed of a roller on a shaft [mm/ms]."""
    speeds = [
        abs(ratio) * _fastest_of(shaft.drive) * _reach(scene.rollers[name])
        for shaft in scene.shafts.values()
        if shaft.drive is not None
        for name, ratio in shaft.rollers.items()
    ]
    return max(speeds, default=0.0)


def _reach(roller: Roller) -> float:
    sectors = roller.rim.sectors if roller.rim is not None else ()
    return max([roller.radius, *(s.radius for s in sectors if s.radius is not None)])


def _start_speed(sheet: Sheet) -> float:
    """Speed of a sheet's centre as the run begins [mm/ms]."""
    return math.hypot(*sheet.velocity)


def _fastest(scene: Scene) -> float:
    surfaces = [surface_speed(roller) for roller in scene.rollers.values()]
    return max([_on_shafts(scene), *surfaces, *(_start_speed(sheet) for sheet in scene.sheets.values())])


def formulas(scene: Scene) -> dict[tuple[str | int, ...], str]:
    """Smoothings that follow from the scene as formulas, by place; none where no speed of the scene is one.

    Only what has formulas itself changes with a parameter: all else counts as the number that it is.
    """
    text = _formula(scene) if scene.formulas else ""
    if not text:
        return {}
    fine = _with_two_sheets(scene, scene.contact_pairs())
    left = [k for k, contact in enumerate(scene.contacts) if contact.smoothing is None and k not in fine]
    return {("contacts", k, "smoothing"): text for k in left}


def _formula(scene: Scene) -> str:
    given, own, rest = scene.formulas, [], 0.0
    for name, roller in scene.rollers.items():
        rate = given.get(("rollers", name, "drive", "speed"), "")
        radius = given.get(("rollers", name, "radius"), "")
        if (rate or radius) and roller.drive is not None and roller.drive.speed is not None:
            rate = rate or f"{roller.drive.speed * 1e3!r} rad/s"
            own.append(f"abs({rate})*({radius or f'{roller.radius!r} mm'})")
        else:
            rest = max(rest, surface_speed(roller))
    rest = max(rest, _on_shafts(scene), *map(_start_speed, scene.sheets.values()))
    if not own:
        return ""
    speeds = [*dict.fromkeys(own), *([f"{rest * 1e3!r} mm/s"] if rest else [])]
    text = speeds[0]
    for speed in speeds[1:]:
        text = f"max({text}, {speed})"
    text = f"max({LEAST * 1e3:g} mm/s, min({MOST * 1e3:g} mm/s, {SHARE:g}*{text}))"
    return text if len(text) <= _MOST_CHARACTERS else ""
