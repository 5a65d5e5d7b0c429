"""Checks that the names in sensors and rules of a scene exist, and the errors where they do not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from functools import partial
from typing import TYPE_CHECKING

from mdlgen.conditions import CLOCK, OF_ROLLER, OF_SENSOR, OF_SHEET, OF_STAY, TIME, check, condition
from mdlgen.errors import did_you_mean
from mdlgen.formulas import NONE, Dimension
from mdlgen.spec.between import known, matching
from mdlgen.spec.moving import Pivot, Slide
from mdlgen.spec.nip import names_of as rollers_of
from mdlgen.spec.stream import names_of as sheets_of
from mdlgen.spec.strict import fail
from mdlgen.units import parse_quantity

if TYPE_CHECKING:
    from mdlgen.spec.scene import Scene

MOST_RULES, MOST_SENSORS = 200, 100  # convention: far above the needs of a machine


def words(scene: Scene) -> dict[str, Dimension | None]:
    """The names that a condition may have, but for parameters, and the dimension of each; None: yes or no."""
    found: dict[str, Dimension | None] = {CLOCK: TIME}
    for names, of in (
        (scene.sensors, OF_SENSOR),
        ((*scene.sheets, *scene.probes), OF_SHEET),
        (scene.rollers, OF_ROLLER),
        (scene.sheets, dict.fromkeys(OF_STAY)),
        (scene.streams, dict.fromkeys(OF_STAY, NONE)),
    ):
        found |= {f"{name}.{word}": dimension for name in names for word, dimension in of.items()}
    return found


def beginning(scene: Scene) -> str:
    """The state in which the machine begins: the first one of the first rule that has to do with states.
    Where that rule only goes to one the machine is in none until then: empty."""
    for rule in scene.rules:
        if rule.in_ or rule.do.go:
            return rule.in_[0] if rule.in_ else ""
    return ""


def of_stream(scene: Scene, name: str) -> list[str]:
    """The sheets of a stream."""
    stream = scene.streams[name]
    return sheets_of(name, {"count": stream.count, "times": stream.times})


def check_units(when: str, path: tuple[str | int, ...]) -> None:
    """Raises the error of a condition that compares unlike units, whatever the things are that it names; of
    one with other mistakes, or with parameters, nothing is said."""
    dimensions = OF_SENSOR | OF_SHEET | OF_ROLLER | dict.fromkeys(OF_STAY)
    try:
        found = condition(when)
    except ValueError:
        return
    of: dict[str, Dimension | None] = {CLOCK: TIME}
    for name in found.expression.names:
        _, dot, word = name.partition(".")
        if name != CLOCK and not (dot and word in dimensions):
            return
        of.setdefault(name, dimensions.get(word))
    try:
        check(found, of, {})
    except ValueError as error:
        raise fail(str(error), path) from None


def seen(scene: Scene, name: str) -> list[str]:
    """The sheets that a sensor sees."""
    found: list[str] = []
    for k, pattern in enumerate(scene.sensors[name].sees):
        found += matching(pattern, scene.sheets, ("sensors", name, "sees", k))
    return list(dict.fromkeys(found))


def of_nips(scene: Scene, pattern: str) -> dict[str, str]:
    """The rollers of the nips that a name or a pattern means, each with its nip; none where a roller or a
    plane has that name, or is meant by that pattern."""
    if any(fnmatchcase(name, pattern) for name in (*scene.rollers, *scene.planes)):
        return {}
    nips = {name: nip for name, nip in scene.nips.items() if fnmatchcase(name, pattern)}
    return {
        roller: name
        for name, nip in nips.items()
        for roller in rollers_of(name, {"lower": nip.lower, "upper": nip.upper})
    }


def driven(scene: Scene, pattern: str, path: tuple[str | int, ...]) -> list[str]:
    """The driven rollers that a command means: by name, by pattern, or those of a nip or a shaft."""
    having = [name for name, roller in scene.rollers.items() if roller.drive is not None]
    if pattern in scene.shafts:
        shaft = scene.shafts[pattern]
        having, names = list(shaft.rollers if shaft.drive is not None else ()), list(shaft.rollers)
    else:
        names = list(of_nips(scene, pattern)) or matching(pattern, (*scene.rollers, *scene.nips), path)
    found = [name for name in names if name in having]
    if not found:
        others = [*having, *(name for name, shaft in scene.shafts.items() if shaft.drive is not None)]
        shown = ", ".join(others)[:200] or "none"
        raise fail(f"{pattern} has no drive; those that have one are: {shown}", path)
    return found


def movable(scene: Scene, pattern: str, path: tuple[str | int, ...]) -> list[str]:
    """The gates that a command means."""
    having = {name: part for name, part in scene.machine.items() if _motion(part) is not None}
    return matching(pattern, having, path)


def _motion(part: object) -> Pivot | Slide | None:
    """Prescribed motion of a part; None: it has none."""
    for key in ("pivot", "slide"):
        motion = getattr(part, key, None)
        if motion is not None and getattr(motion, motion.inert) is None:
            return motion
    return None


def place(scene: Scene, name: str, to: str, path: tuple[str | int, ...]) -> float:
    """The place that a command sends a gate to [rad, mm]. Raises the error for one that there is not, or that
    is beyond those from which its contacts are chosen."""
    motion = _motion(scene.machine[name])
    assert motion is not None, "movable() gives those that move"
    named = dict(motion.positions or {})
    if to in named:
        return named[to]
    try:
        value = parse_quantity(to, motion.unit)
    except ValueError as error:
        raise fail(
            f"{to!r} is no name of positions ({', '.join(named) or 'none'}), and {error}", path
        ) from None
    places = [0.0, *named.values(), *(at for _, at in motion.profile or ())]
    if not min(places) <= value <= max(places):
        raise fail(
            f"{to} is beyond the places that {name} has, {min(places) * motion.scale:g} to "
            f"{max(places) * motion.scale:g} {motion.unit}; add it to positions",
            path,
        )
    return value


def entering(scene: Scene, name: str, path: tuple[str | int, ...]) -> list[str]:
    """The sheets of a stream, or the sheet, that a command lets in, one at each time."""
    waiting = [n for n, sheet in scene.sheets.items() if sheet.by_rule]
    names = of_stream(scene, name) if name in scene.streams else [name]
    found = [n for n in names if n in waiting]
    if not found:
        others = [n for n, stream in scene.streams.items() if stream.by_rule]
        known(name, dict.fromkeys([*others, *waiting]), "stream or sheet with by_rule", path)
    return found


def pressed(scene: Scene, pattern: str, path: tuple[str | int, ...]) -> list[str]:
    """The rollers and planes with a press that a command means; of a nip the roller that has one."""
    having = {n: p for n, p in (scene.rollers | scene.planes).items() if p.press is not None}
    nips = of_nips(scene, pattern)
    found = [name for name in nips if name in having]
    if nips and not found:
        raise fail(
            f"no roller of nip {pattern} has a press; those that have one are: "
            f"{', '.join(having)[:200] or 'none'}",
            path,
        )
    return found or [name for name in matching(pattern, (*having, *scene.nips), path) if name in having]


def on_arms(scene: Scene, pattern: str, path: tuple[str | int, ...]) -> list[str]:
    """The rollers on an arm that a command means."""
    return matching(pattern, {n: r for n, r in scene.rollers.items() if r.arm is not None}, path)


# who each kind of command is for
COMMANDED: dict[str, Callable[[Scene, str, tuple[str | int, ...]], list[str]]] = {
    "speed": driven,
    "press": pressed,
    "torque": on_arms,
    "move": movable,
}


def checks(scene: Scene) -> Iterator[Callable[[], None]]:
    """The checks of sensors and rules, one by one, so that each mistake is reported."""
    for count, most, key in (
        (len(scene.sensors), MOST_SENSORS, "sensors"),
        (len(scene.rules), MOST_RULES, "rules"),
    ):
        if count > most:
            raise fail(f"{count} {key}; allowed are {most}", (key,))
    for name in scene.sensors:
        yield partial(_sensor, scene, name)
    if not scene.rules:
        return
    if scene.run.analysis == "static":
        raise fail("rules act over time, and a static analysis has none; leave them out", ("rules",))
    named = words(scene)
    for k in range(len(scene.rules)):
        yield partial(_condition, scene, k, named)
        yield partial(_action, scene, k)


def _sensor(scene: Scene, name: str) -> None:
    seen(scene, name)


def _condition(scene: Scene, k: int, named: dict[str, Dimension | None]) -> None:
    rule = scene.rules[k]
    try:
        check(condition(rule.when), named, scene.amounts)
    except ValueError as error:
        raise fail(str(error), ("rules", k, "when")) from None
    for name in condition(rule.when).expression.names:
        thing, _, word = name.partition(".")
        if word == "left":
            leaves(scene, thing, ("rules", k, "when"))


def leaves(scene: Scene, name: str, path: tuple[str | int, ...]) -> None:
    """Raises the error where no sheet of that name, or of that stream, can leave."""
    sheets = of_stream(scene, name) if name in scene.streams else [name]
    if not any(scene.sheets[sheet].out for sheet in sheets):
        key = f"streams.{name}" if name in scene.streams else f"sheets.{name}"
        raise fail(f"{name} never leaves; give {key} out, as out: beyond x = 400 mm", path)


def _action(scene: Scene, k: int) -> None:
    rule, path = scene.rules[k], ("rules", k, "do")
    for kind, of in COMMANDED.items():
        for pattern, given in getattr(rule.do, kind).items():
            names = of(scene, pattern, (*path, kind, pattern))
            for name in names:
                if kind == "speed" and given.surface_speed is not None:
                    _turns(scene, name, (*path, kind, pattern))
                if kind == "move":
                    place(scene, name, given.to, (*path, kind, pattern))
    for k, name in enumerate(rule.do.enter):
        entering(scene, name, (*path, "enter", k))
    named = dict.fromkeys(name for other in scene.rules for name in other.in_)
    if rule.do.go is not None and rule.do.go not in named and did_you_mean(rule.do.go, named):
        known(rule.do.go, named, "state of a rule's `in`", (*path, "go"))


def _turns(scene: Scene, name: str, path: tuple[str | int, ...]) -> None:
    """Raises the error for a drive without a sense of its own, in which a surface's speed would be."""
    drive = scene.rollers[name].drive
    surface = None if drive is None else drive.surface_speed  # which is a speed of the drive only later
    if not surface and sense(scene, name) == 0.0:
        why = "is driven by a shaft" if drive is None else "stands by its own drive"
        message = f"{name} {why}, so that surface_speed has no sense; give speed"
        raise fail(message, path)


def sense(scene: Scene, name: str) -> float:
    """1 or -1: the sense in which a drive turns by itself about its axis; 0: it stands."""
    drive = scene.rollers[name].drive
    if drive is None:
        return 0.0  # on a shaft, which has no surface
    rates = [rate for _, rate in drive.profile] if drive.profile is not None else [drive.speed or 0.0]
    fastest = max(rates, key=abs)
    return float(fastest > 0.0) - float(fastest < 0.0)
