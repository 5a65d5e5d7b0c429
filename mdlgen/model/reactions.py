"""Sensors and rules of a scene as tables."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Contacts, Order, Reactions, RulePart, SensorPart
from mdlgen.spec.reacting import COMMANDED, beginning, entering, of_nips, of_stream, place, seen, sense
from mdlgen.spec.rule import Rule
from mdlgen.spec.scene import Scene
from mdlgen.spec.sensor import REACH


def lower_reactions(scene: Scene, contacts: Contacts) -> Reactions:
    """The table of a scene's sensors, by name, and of its rules."""
    numbers = {name: k for k, name in enumerate(sorted(scene.sheets))}
    amounts = tuple((name, a.value, a.dimension) for name, a in scene.amounts.items()) if scene.rules else ()
    return Reactions(
        sensors=tuple(_sensor(scene, name, numbers) for name in sorted(scene.sensors)),
        rules=tuple(_rule(scene, contacts, rule) for rule in scene.rules),
        amounts=amounts,
        begins=beginning(scene),
        streams=tuple(
            (name, tuple(numbers[sheet] for sheet in of_stream(scene, name)))
            for name in sorted(scene.streams)
        ),
    )


def _sensor(scene: Scene, name: str, numbers: dict[str, int]) -> SensorPart:
    sensor = scene.sensors[name]
    if sensor.beam is not None:
        one, two = map(np.array, sensor.beam)
        kind, ends, way = "beam", np.stack([one, one]), two - one
    else:
        assert sensor.direction is not None, "the spec asks for it"
        kind = "line" if sensor.line is not None else "point"
        ends = np.array(sensor.line if sensor.line is not None else (sensor.point, sensor.point))
        way = (REACH if sensor.reach is None else sensor.reach) * np.array(sensor.direction)
    sheets = np.array(sorted(numbers[sheet] for sheet in seen(scene, name)), dtype=np.int64)
    return SensorPart(name, kind, ends, way, sensor.hysteresis, sheets)


def _spring(scene: Scene, contacts: Contacts, nip: str, force: float) -> float:
    """The force of a nip's spring where its rollers just touch [N], with which each presses the sheet with a
    force [N]; as the preload follows from `force` of the nip, in `spec.nip`."""
    spec = scene.nips[nip]
    roller = next(name for name in of_nips(scene, nip) if scene.rollers[name].press is not None)
    press, thick = scene.rollers[roller].press, scene.sheets[_between(scene, contacts, nip)].thickness
    assert press is not None, "chosen so"
    stiffness = {contacts.called(row): float(k) for row, k in enumerate(contacts.stiffness)}
    depths = [stiffness[f"{nip}_{side}"] for side in ("lower", "upper")]

    def found(pressed: float) -> float:
        if nip not in stiffness:  # the rollers do not meet
            return pressed
        left = thick - sum((max(0.0, pressed) / k) ** (2.0 / 3.0) for k in depths)
        return pressed - press.stiffness * left + stiffness[nip] * max(0.0, -left) ** 1.5

    return press.preload + found(force) - found(spec.force)


def _between(scene: Scene, contacts: Contacts, nip: str) -> str:
    """A sheet that a nip grips; of a stream all are like."""
    row = next(row for row in range(len(contacts)) if contacts.called(row) == f"{nip}_lower")
    return next(name for name in (contacts.part_a[row], contacts.part_b[row]) if name in scene.sheets)


def _rule(scene: Scene, contacts: Contacts, rule: Rule) -> RulePart:
    orders: list[Order] = []
    numbers = {name: k for k, name in enumerate(sorted(scene.sheets))}
    for kind, of in COMMANDED.items():
        for pattern, given in getattr(rule.do, kind).items():
            for name in of(scene, pattern, ()):
                if kind == "move":
                    orders.append(Order(kind, name, place(scene, name, given.to, ()), given.in_))
                    continue
                if kind == "press" and name in (nips := of_nips(scene, pattern)):
                    orders.append(Order(kind, name, _spring(scene, contacts, nips[name], given), 0.0))
                    continue
                if kind != "speed":
                    orders.append(Order(kind, name, given, 0.0))
                    continue
                speed = given.speed
                if speed is not None and pattern in scene.shafts:
                    speed *= scene.shafts[pattern].rollers[name]
                if speed is None:
                    speed = sense(scene, name) * given.surface_speed / scene.rollers[name].radius
                orders.append(Order(kind, name, speed, given.ramp))
    for name in rule.do.enter:
        sheets = tuple(numbers[sheet] for sheet in entering(scene, name, ()))
        orders.append(Order("enter", name, 0.0, 0.0, sheets))
    if rule.do.go is not None:
        orders.append(Order("go", rule.do.go, 0.0, 0.0))
    if rule.do.end:
        orders.append(Order("end", "", 0.0, 0.0))
    return RulePart(rule.when, rule.after, rule.once, rule.in_, tuple(orders))
