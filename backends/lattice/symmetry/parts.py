"""Mirror images of parts of the machine, by kind. A part of any other kind has no image."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import SAME
from mdlgen.backends.lattice.symmetry.mirror import Mirror
from mdlgen.model.tables import ArmPart, GuidePart, MachinePart, Model, PlanePart, RollerPart


class _Kind(NamedTuple):
    """`image(mirror, model, one, two)`: true if one part, whose place is the image of the other one's, is its
    mirror image; `half(mirror, part)`: extent from its centre along the normal [mm]."""

    image: Callable[[Mirror, Model, Any, Any], bool]
    half: Callable[[Mirror, Any], float]


def seen_as(mirror: Mirror, model: Model, one: MachinePart, two: MachinePart) -> bool:
    """True if one part of the machine is the mirror image of the other one."""
    if type(one) is not type(two) or type(one) not in _KINDS:
        return False
    size = max(1.0, float(np.abs(one.center).max()))
    if np.abs(mirror.places(one.center) - two.center).max() > SAME * size:
        return False
    return _KINDS[type(one)].image(mirror, model, one, two)


def off(mirror: Mirror, part: MachinePart) -> float:
    """Distance of a part from the plane [mm]."""
    return abs(float(mirror.normal @ part.center) - mirror.at) - _KINDS[type(part)].half(mirror, part)


def same(a: Any, b: Any) -> bool:
    """True if equal within round-off."""
    if isinstance(a, (float, np.ndarray)) and isinstance(b, (float, np.ndarray)):
        a, b = np.asarray(a), np.asarray(b)
        if a.shape != b.shape:
            return False
        most = max(np.abs(a).max(initial=0.0), np.abs(b).max(initial=0.0))
        return bool(np.abs(a - b).max(initial=0.0) <= SAME * most)
    return bool(a == b)


def _roller(mirror: Mirror, model: Model, one: RollerPart, two: RollerPart) -> bool:
    way = -float(mirror.seen(one.axis) @ two.axis)  # a turn is seen the other way round
    # an arm in the plane is not cut, and angles that are counted the other way are not compared
    whole = (one.arm is None or one is not two) and (one.rim is None or way > 0.0)
    # friction of one side alone would turn a free roller that is cut along its axis
    cut = one is two and way < 0.0 and one.speed is None
    if abs(abs(way) - 1.0) > SAME or not whole or cut:
        return False
    return _turning(one, float(np.sign(way)), mirror) == _turning(two, 1.0, None)


def _turning(part: RollerPart, way: float, mirror: Mirror | None) -> tuple[Any, ...]:
    """Properties of a roller, in the sense of an axis with the sign `way`."""
    clutch = part.one_way and replace(part.one_way, direction=int(way * part.one_way.direction))
    press = part.press
    if press is not None and mirror is not None:
        press = replace(press, direction=mirror.seen(press.direction))
    arm = part.arm
    if arm is not None and mirror is not None:
        arm = replace(arm, pivot=mirror.places(arm.pivot), center=mirror.places(arm.center))
    own = {
        "axis": 0.0,
        "speed": part.speed if part.speed is None else way * part.speed,
        "profile": part.profile if part.profile is None else part.profile * (1.0, way),
        "one_way": clutch,
        "spin": way * part.spin,
        "press": press and _values_of(press, {}),
        "arm": arm and (_rounded(arm.center), *_values_of(_seen_arm(arm, way), {})),
    }
    return _values_of(part, own)


def _seen_arm(arm: ArmPart, way: float) -> ArmPart:
    """An arm with its torque, angle and speed in the sense of an axis with the sign `way`."""
    return replace(arm, torque=way * arm.torque, angle=way * arm.angle, speed=way * arm.speed)


def _half_roller(mirror: Mirror, roller: RollerPart) -> float:
    along = min(1.0, abs(float(mirror.normal @ roller.axis)))
    return 0.5 * roller.width * along + roller.radius * math.sqrt(1.0 - along * along)


def _plane(mirror: Mirror, model: Model, one: PlanePart, two: PlanePart) -> bool:
    frames = [model.bodies.rotation[part.body] for part in (one, two)]
    square = np.abs(mirror.axes(frames[0][None])[0].T @ frames[1])
    own: dict[str, Any] = {"normal": mirror.seen(one.normal)}
    if one.press is not None:
        own["press"] = replace(one.press, direction=mirror.seen(one.press.direction))
    return bool(np.abs(square - np.eye(3)).max() < SAME) and _values_of(one, own) == _values_of(two, {})


def _half_plane(mirror: Mirror, plane: PlanePart) -> float:
    """Infinity: a plane is wide, so it counts as crossing the mirror plane."""
    return math.inf


def _guide(mirror: Mirror, model: Model, one: GuidePart, two: GuidePart) -> bool:
    """True if the outline of a guide is parallel to the mirror plane, and its width crosses it."""
    flat = np.abs(one.axes[:, :2].T @ mirror.normal).max() < SAME
    return bool(flat) and _values_of(one, {}) == _values_of(two, {})


def _half_guide(mirror: Mirror, guide: GuidePart) -> float:
    return 0.5 * guide.width


_PLACE = ("name", "body", "center")


def _values_of(part: Any, instead: dict[str, Any]) -> tuple[Any, ...]:
    """All fields of a part except its name and its place, rounded for comparison."""
    values = (instead.get(f.name, getattr(part, f.name)) for f in fields(part) if f.name not in _PLACE)
    return tuple(_rounded(v) for v in values)


def _rounded(value: Any) -> Any:
    """A value rounded so that values within round-off are equal. Nan, as in a sector that uses the value of
    its roller, equals nan."""
    if isinstance(value, np.ndarray):
        most = float(np.nanmax(np.abs(value), initial=0.0)) or 1.0
        return (_rounded(most), *(_rounded(v) for v in (np.round(value / most, 9) + 0.0).ravel().tolist()))
    if is_dataclass(value):
        return _values_of(value, {})
    if isinstance(value, (list, tuple)):
        return tuple(_rounded(v) for v in value)
    if isinstance(value, float):
        return None if math.isnan(value) else float(f"{value:.9e}") + 0.0
    return value


_KINDS: dict[type, _Kind] = {
    RollerPart: _Kind(_roller, _half_roller),
    PlanePart: _Kind(_plane, _half_plane),
    GuidePart: _Kind(_guide, _half_guide),
}
