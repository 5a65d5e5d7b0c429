"""Sensors and rules of a scene as tables."""

from __future__ import annotations

import numpy as np

from mdlgen.model.tables import Order, Reactions, RulePart, SensorPart
from mdlgen.spec.reacting import COMMANDED, beginning, entering, of_stream, place, seen, sense
from mdlgen.spec.rule import Rule
from mdlgen.spec.scene import Scene
from mdlgen.spec.sensor import REACH


def lower_reactions(scene: Scene) -> Reactions:
    """The table of a scene's sensors, by name, and of its rules."""
    numbers = {name: k for k, name in enumerate(sorted(scene.sheets))}
    amounts = tuple((name, a.value, a.dimension) for name, a in scene.amounts.items()) if scene.rules else ()
    return Reactions(
        sensors=tuple(_sensor(scene, name, numbers) for name in sorted(scene.sensors)),
        rules=tuple(_rule(scene, rule) for rule in scene.rules),
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


def _rule(scene: Scene, rule: Rule) -> RulePart:
    orders: list[Order] = []
    numbers = {name: k for k, name in enumerate(sorted(scene.sheets))}
    for kind, of in COMMANDED.items():
        for pattern, given in getattr(rule.do, kind).items():
            for name in of(scene, pattern, ()):
                if kind == "move":
                    orders.append(Order(kind, name, place(scene, name, given.to, ()), given.in_))
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
