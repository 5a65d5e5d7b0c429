"""The values of a scene that can be turned: where each stands, its text, and the span of its slider."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from mdlgen.errors import Place, SpecError
from mdlgen.spec.document import Document, SpecPath, parse
from mdlgen.spec.scene import Scene
from mdlgen.spec.schema import bounds
from mdlgen.spec.setting import WORD, met
from mdlgen.study.design.variable import quantity
from mdlgen.units import parse_unit

MOST = 600  # values of a scene that are offered
LONGEST = 3  # list whose items are offered one by one: a place, not a curve
PARAMETERS, BOXES, SEVERAL = "parameters", "boxes", "several at once"
STEPS = 200  # of a slider, at least
AXES = "xyz"
# Half the span of a value that is 0, in its unit; others have 1.
FROM_ZERO = {"mm": 10.0, "deg": 10.0, "mm/s": 100.0, "rad/s": 10.0}
_TEXTS = ("name", "author", "revision", "require")
_LEFT_OUT = (PARAMETERS, "defaults", *_TEXTS)


@dataclass(frozen=True)
class Control:
    """`path` as of `--set`, `text` as the file has the value. One that is a formula has a field alone: then
    `number` and the span are None."""

    path: str
    group: str
    label: str
    text: str
    unit: str = ""
    number: float | None = None  # in its unit, as the span
    low: float | None = None
    high: float | None = None
    step: float | None = None


def controls(scene: Scene, document: Document) -> list[Control]:
    """Those of a scene that is valid and its document, parameters first."""
    found = [_of_parameter(scene, name) for name in scene.parameters]
    for path, value in _values(document.data, ()):
        if len(found) >= MOST:
            break
        control = control_of(path, value, _group(document.data, path))
        if control is not None:
            found.append(control)
    return found


def of_pattern(text: str, pattern: str) -> Control:
    """One for all values that a path with patterns meets in the text of a scene, as
    `rollers.motor_*.drive.speed`; it begins at the first of them. Raises SpecError."""
    words = pattern.strip().split(".")
    if not all(WORD.fullmatch(word) for word in words):
        raise SpecError(f"{pattern[:80]!r} is no path; write like rollers.motor_*.drive.speed")
    data = parse(text, "scene").data
    paths = met(data, words, Place("scene", 1, 1))
    found = [control_of(path, _at(data, path), SEVERAL) for path in paths if path[0] not in _TEXTS]
    if not found or None in found:
        raise SpecError(f"{pattern[:80]!r} matches a value that is no number with a unit")
    first = next(control for control in found if control is not None)
    return replace(first, path=".".join(words), label=".".join(words[1:]) or words[0])


def control_of(path: SpecPath, value: Any, group: str) -> Control | None:
    """The control of a value at a path of the plain data; None where it is not a number."""
    amount = _amount(value)
    if amount is None:
        return None
    number, unit = amount
    whole = type(value) is int and (path[-2:-1] == (BOXES,) or path[-1] == "count")
    low, high = (max(1.0, number // 2), 2.0 * number) if whole else _span(number, unit)
    least, most = (-math.inf, math.inf) if unit else bounds(tuple(path[:-1]), str(path[-1]))
    return _control(path, group, value, amount, (max(low, least), min(high, most)), whole)


def _of_parameter(scene: Scene, name: str) -> Control:
    value = scene.parameters[name]
    amount = _amount(value)
    if amount is None:
        return Control(f"{PARAMETERS}.{name}", PARAMETERS, name, str(value))
    number, unit = amount
    span = _span(number, unit)
    if name in scene.ranges:
        factor = parse_unit(unit).factor if unit else 1.0
        low, high = scene.ranges[name]
        span = low / factor, high / factor
    return _control((PARAMETERS, name), PARAMETERS, value, amount, span)


def _control(
    path: SpecPath,
    group: str,
    value: Any,
    amount: tuple[float, str],
    span: tuple[float, float],
    whole: bool = False,
) -> Control:
    label = [str(key) for key in path[2:]] or [str(path[-1])]
    if isinstance(path[-1], int) and path[-1] < len(AXES):
        label[-1] = AXES[path[-1]]
    number, unit = amount
    low, high = span
    if not low < high:  # a value at a bound of its kind
        low, high = number - 1.0, number + 1.0
    step = 1.0 if whole else _step(low, high)
    return Control(
        ".".join(map(str, path)), group, " ".join(label), str(value), unit, number, low, high, step
    )


def _group(data: Any, path: SpecPath) -> str:
    """The part that a value is of; a contact or a load of a list is named by its parts."""
    kind, *rest = path
    if len(rest) < 2:
        return str(kind)
    group, item = f"{kind}.{rest[0]}", data[kind][rest[0]]
    if not isinstance(rest[0], int):
        return group
    meant = item.get("name") or item.get("between") or item.get("sheet") or ""
    return f"{group} ({', '.join(map(str, meant)) if isinstance(meant, list) else meant})"


def _span(number: float, unit: str) -> tuple[float, float]:
    """A sensible one about a value."""
    if number == 0.0:
        half = FROM_ZERO.get(unit, 1.0)
        return -half, half
    low, high = sorted((0.5 * number, 1.5 * number))
    # a slider stands at its lower end and whole steps from there, which so are round numbers
    step = _step(low, high)
    digits = max(0, -math.floor(math.log10(step)))
    return round(math.floor(low / step) * step, digits), round(math.ceil(high / step) * step, digits)


def _step(low: float, high: float) -> float:
    """A power of ten."""
    return 10.0 ** math.floor(math.log10((high - low) / STEPS))


def _amount(value: Any) -> tuple[float, str] | None:
    """Number and unit of a value as it is written; None where it is none."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value), ""
    return quantity(value) if isinstance(value, str) else None


def _values(node: Any, path: SpecPath) -> Iterator[tuple[SpecPath, Any]]:
    """The plain values of a scene that a path of `--set` can name."""
    if isinstance(node, dict):
        for key, item in node.items():
            if (path or key not in _LEFT_OUT) and WORD.fullmatch(str(key)):
                yield from _values(item, (*path, key))
    elif isinstance(node, list):
        for k, item in enumerate(node if len(node) <= LONGEST or len(path) == 1 else ()):
            yield from _values(item, (*path, k))
    else:
        yield path, node


def _at(data: Any, path: SpecPath) -> Any:
    """The value at a path that plain data has, None: that is made where it is set."""
    for key in path:
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            return None
    return data
