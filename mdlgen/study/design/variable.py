"""A value of the scene that differs from case to case, as `--over` and its like give it."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from mdlgen.errors import SpecError
from mdlgen.study.design.case import BETWEEN, Case
from mdlgen.units import parse_unit

MOST_CASES = 100_000
_PATH = re.compile(r"[A-Za-z0-9_]{1,64}(\.[A-Za-z0-9_]{1,64})*")
_NUMBER = re.compile(r"\s*([-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)\s*(\S.*?)?\s*")
HOW = "write PATH=START:STOP:N, as contacts.0.friction=0.1:0.5:9, or PATH=[a, b, c]"


@dataclass(frozen=True)
class Variable:
    """`path` as of `--set` (several with commas between take one value), and the texts of its values."""

    path: str
    texts: tuple[str, ...]


def split(text: str, option: str, how: str = HOW) -> tuple[str, str]:
    """Path and the rest of `PATH=...`. Raises SpecError."""
    path, equals, rest = text.partition("=")
    path = BETWEEN.join(part.strip() for part in path.split(BETWEEN))
    if not equals or not rest.strip() or not all(_PATH.fullmatch(part) for part in path.split(BETWEEN)):
        raise SpecError(f"{option}: {text[:80]!r} has no path and values; {how}")
    return path, rest.strip()


def quantity(text: str) -> tuple[float, str] | None:
    """Number and unit ("" where there is none) of `0.3` or `180 rad/s`; None where it is neither."""
    match = _NUMBER.fullmatch(text)
    if match is None:
        return None
    unit = match[2] or ""
    if unit:
        try:
            parse_unit(unit)
        except ValueError:
            return None
    return float(match[1]), unit


def quantity_text(number: float, unit: str = "") -> str:
    """The inverse of `quantity`."""
    return f"{float(number)!r} {unit}".rstrip()


def interval(low: str, high: str, message: str) -> tuple[float, float, str]:
    """Two numbers in the unit of the first, and that unit ("" where there is none).

    `message` begins an error, as "--over 'a=1:2 mm:3'". Raises SpecError.
    """
    ends = quantity(low), quantity(high)
    for end, text in zip(ends, (low, high), strict=True):
        if end is None:
            raise SpecError(f"{message}: {text.strip()[:40]!r} is not a number, or one with a unit")
    (first, unit), (last, other) = ends  # type: ignore[misc]
    if unit != other:
        if not unit or not other:
            raise SpecError(
                f"{message}: one end has the unit {unit or other!r}, the other none; write it at both"
            )
        to, of = parse_unit(unit), parse_unit(other)
        if to.dimension != of.dimension:
            raise SpecError(f"{message}: {unit!r} and {other!r} are not units of the same thing")
        last *= of.factor / to.factor
    return first, last, unit


def variable(text: str, option: str = "--over") -> Variable:
    """Parses `PATH=START:STOP:N` or `PATH=[a, b, c]`. Raises SpecError."""
    path, rest = split(text, option)
    message = f"{option} {text[:80]!r}"
    texts = _list(rest, message) if rest.startswith("[") else _range(rest, message)
    if len(set(texts)) < len(texts):
        raise SpecError(f"{message}: a value stands twice")
    return Variable(path, texts)


def _range(rest: str, message: str) -> tuple[str, ...]:
    parts = rest.split(":")
    if len(parts) != 3:
        raise SpecError(f"{message}: is neither a range nor a list; {HOW}")
    first, last, unit = interval(parts[0], parts[1], message)
    if not re.fullmatch(r"\s*[0-9]{1,6}\s*", parts[2]) or not 2 <= int(parts[2]) <= MOST_CASES:
        raise SpecError(
            f"{message}: {parts[2].strip()[:20]!r} is no count; allowed are 2 to {MOST_CASES} values"
        )
    count = int(parts[2])
    # twelve digits: what is typed as 0.1:0.5:9 holds 0.15, not 0.15000000000000002
    numbers = [float(f"{first + (last - first) * k / (count - 1):.12g}") for k in range(count)]
    numbers[0], numbers[-1] = first, last
    whole = not unit and all(re.fullmatch(r"\s*[-+]?[0-9]+\s*", end) for end in parts[:2])
    if whole and all(number.is_integer() for number in numbers):
        return tuple(str(int(number)) for number in numbers)
    return tuple(quantity_text(number, unit) for number in numbers)


def _list(rest: str, text: str) -> tuple[str, ...]:
    from mdlgen.spec.load import parse

    try:
        values = parse(rest, "value").data
    except SpecError as error:
        raise SpecError(f"{text}: {error.message}") from None
    if not isinstance(values, list) or not values:
        raise SpecError(f"{text}: is not a list of values; {HOW}")
    return tuple(value_text(value) for value in values)


def value_text(value: Any) -> str:
    """A value of a scene as a text of one line that reads back as the same."""
    from mdlgen.spec.load import parse

    if isinstance(value, str):
        try:
            if parse(value, "value").data == value and "\n" not in value:
                return value
        except SpecError:
            pass
    return json.dumps(value, ensure_ascii=False)


def grid(variables: Sequence[Variable]) -> tuple[Case, ...]:
    """Every combination, the last variable fastest. Raises SpecError for too many, and a path given twice."""
    check_paths([variable.path for variable in variables])
    count = 1
    for variable in variables:
        count *= len(variable.texts)
    check_count(count)
    paths = [variable.path for variable in variables]
    combinations = product(*(variable.texts for variable in variables))
    return tuple(
        Case(index, tuple(zip(paths, texts, strict=True))) for index, texts in enumerate(combinations)
    )


def check_paths(paths: Sequence[str]) -> None:
    """Raises SpecError for a place that is named twice."""
    places = [place for path in paths for place in path.split(BETWEEN)]
    for place in places:
        if places.count(place) > 1:
            raise SpecError(f"{place} is given twice; give each value once")


def check_count(count: int) -> None:
    """Raises SpecError for more cases than are allowed."""
    if count > MOST_CASES:
        raise SpecError(f"{count} cases; allowed are {MOST_CASES}")
