"""Quantities as text with units.

Inside, one consistent set holds: mm, N, g, ms, rad (so N = g mm/ms², stress in MPa). A unit is a
product of powers of the names in `_NAMES`; its dimension counts length, mass, time and angle.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

PER_SECOND = 1000.0  # converts values per ms, as speeds in mm/ms and rad/ms, to values per s


class Unit(NamedTuple):
    """Factor to the internal set, and exponents of length, mass, time, angle."""

    factor: float
    dimension: tuple[float, float, float, float]


_LENGTH, _MASS = (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)
_TIME, _ANGLE = (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)
_FORCE, _STRESS = (1.0, 1.0, -2.0, 0.0), (-1.0, 1.0, -2.0, 0.0)
_RATE, _FREQUENCY = (0.0, 0.0, -1.0, 1.0), (0.0, 0.0, -1.0, 0.0)

_NAMES: dict[str, Unit] = {
    name: Unit(factor, dimension)
    for dimension, table in (
        (_LENGTH, {"mm": 1.0, "m": 1e3, "cm": 10.0, "um": 1e-3, "µm": 1e-3, "in": 25.4}),
        (_MASS, {"g": 1.0, "kg": 1e3, "mg": 1e-3, "t": 1e6}),
        (_TIME, {"ms": 1.0, "s": 1e3, "us": 1e-3, "µs": 1e-3, "min": 6e4}),
        (_ANGLE, {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "°": math.pi / 180.0}),
        (_FORCE, {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "kN": 1e3}),
        (_STRESS, {"MPa": 1.0, "Pa": 1e-6, "uPa": 1e-12, "µPa": 1e-12, "kPa": 1e-3, "GPa": 1e3}),
        (_RATE, {"rpm": 2.0 * math.pi / 6e4}),
        (_FREQUENCY, {"Hz": 1e-3, "kHz": 1.0}),
    )
    for name, factor in table.items()
}

# Known where a unit is due, and no names of units in a formula, where W is a width: the power of a drive, and
# degrees of hardness on the scale Shore A.
_NO_NAMES = {
    "W": Unit(1.0, (2.0, 1.0, -3.0, 0.0)),
    "mW": Unit(1e-3, (2.0, 1.0, -3.0, 0.0)),
    "ShA": Unit(1.0, (0.0, 0.0, 0.0, 0.0)),
}

_NUMBER = r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*")
# `mm^2`, and `mm2` as it is typed
_FACTOR = re.compile(r"([A-Za-zµ°]+|1)(?:\^([-+]?[0-9]+(?:\.[0-9]+)?))?")
_POWER = re.compile(r"([A-Za-zµ°])([0-9])")

# A unit as it stands in a formula behind a number: names joined by * and /, each with its power.
_KNOWN = "|".join(sorted(_NAMES, key=len, reverse=True))
_ONE = rf"(?:{_KNOWN})(?:\^[-+]?[0-9]+(?:\.[0-9]+)?|[0-9²³])?(?![\w°.(])"
UNIT_TEXT = rf"{_ONE}(?:\s*[*/·]\s*{_ONE})*"

_COMMA = re.compile(r"\s*([-+]?[0-9]+(?:,[0-9]+)+)((?:\.[0-9]*)?[^,]*?)\s*")

_SLIPS = {"sec": "s", "gr": "g", "grams": "g", "degrees": "deg", "micron": "um", "mu": "um", "inch": "in"}


def _meant(word: str) -> str:
    """A known name that differs from an unknown one by case only, or is its usual form."""
    name = word.strip().partition("^")[0].lower()
    near = [known for known in _NAMES if known.lower() == name] or [_SLIPS.get(name, "")]
    return f"; did you mean {' or '.join(near)}?" if near[0] else ""


def _powers(text: str) -> str:
    """With `^` before every power: of mm², and of mm2."""
    return _POWER.sub(r"\1^\2", text.replace("²", "^2").replace("³", "^3"))


def _with_point(comma: re.Match[str]) -> str:
    """The possible meanings of a number with commas: a decimal comma, or thousands."""
    number, rest = comma[1], comma[2]
    meant = []
    if number.count(",") == 1 and not rest.startswith("."):
        meant.append(number.replace(",", ".") + rest)
    if all(len(group) == 3 for group in number.split(",")[1:]):
        meant.append(number.replace(",", "") + rest)
    return f"write {' or '.join(meant)}" if meant else "decimals are written with a point, as 0.5"


class UnknownUnit(ValueError):
    """A word that is no unit."""


@lru_cache(maxsize=512)
def parse_unit(text: str) -> Unit:
    """`N*mm/rad`, `N/mm^1.5`, `m/s^2` as a Unit. Raises ValueError with the fault."""
    factor, dimension = 1.0, (0.0, 0.0, 0.0, 0.0)
    for sign, word in re.findall(r"(^|[*/·])([^*/·]*)", _powers(text)):
        match = _FACTOR.fullmatch(word.strip())
        known = match and (match[1] == "1" or match[1] in _NAMES or match[1] in _NO_NAMES)
        if not match or not known:
            raise UnknownUnit(f"unknown unit {word.strip()!r} in {text!r}{_meant(word)}")
        if match[1] == "1":
            continue
        unit = _NAMES.get(match[1]) or _NO_NAMES[match[1]]
        power = float(match[2] or 1) * (-1.0 if sign == "/" else 1.0)
        if abs(power) > 8:
            raise ValueError(f"exponent {match[2]} in {text!r} has no physical use")
        factor *= unit.factor**power
        length, mass, time, angle = (d + power * u for d, u in zip(dimension, unit.dimension, strict=True))
        dimension = (length, mass, time, angle)
    return Unit(factor, dimension)


def parse_number(text: str, example: str = "1 mm") -> tuple[float, str]:
    """The value of `text` ("0.72 g") in internal units, and its unit. Raises ValueError."""
    match = _QUANTITY.fullmatch(text[:200])
    comma = _COMMA.fullmatch(text[:200])
    if comma:
        raise ValueError(f"{text.strip()!r} has a comma; {_with_point(comma)}")
    if not match:
        raise ValueError(f"{text[:60]!r} is not a number with a unit; expected like '{example}'")
    if not match[2]:
        unit = example.partition(" ")[2]
        raise ValueError(f"{text.strip()} has no unit; expected like '{match[1]} {unit}'")
    value = float(match[1]) * parse_unit(match[2]).factor
    if not math.isfinite(value):
        raise ValueError(f"{text.strip()!r} is not finite; allowed are values below 1.8e308")
    return value, match[2]


def parse_quantity(text: object, expected: str) -> float:
    """The value of `text` ("0.72 g") in internal units; `expected` is a unit of the right dimension.

    Raises ValueError that names the unit expected, for a bare number, an unknown or a wrong unit, and
    a value that is not finite.
    """
    if isinstance(text, bool) or not isinstance(text, str):
        number = isinstance(text, (int, float)) and not isinstance(text, bool)
        shown = f"{text} has no unit" if number else f"{text!r} is not a quantity"
        raise ValueError(f"{shown}; expected text with a unit like '{text if number else 1} {expected}'")
    due = f"expected a unit like '{expected}', as '{_number_of(text)} {expected}'"
    try:
        value, unit = parse_number(text, f"1 {expected}")
    except UnknownUnit as error:
        raise ValueError(str(error) if str(error).endswith("?") else f"{error}; {due}") from None
    if not same(parse_unit(unit).dimension, parse_unit(expected).dimension):
        raise ValueError(f"{text.strip()!r} has the wrong unit; {due}")
    return value


def _number_of(text: str) -> str:
    """The number that a text begins with, 1 where it begins with none."""
    match = _QUANTITY.fullmatch(text[:200])
    return match[1] if match else "1"


def check_unit(text: str, dimension: Sequence[float], expected: str) -> None:
    """Raises ValueError where what a formula comes to is not of the dimension of a unit; it names both."""
    if not same(dimension, parse_unit(expected).dimension):
        due = "a plain number is due" if expected == "1" else f"expected a unit like '{expected}'"
        message = "has no unit" if same(dimension, (0.0,) * 4) else f"has the unit {unit_of(dimension)}"
        raise ValueError(f"{text.strip()[:80]!r} {message}; {due}")


def same(one: Sequence[float], other: Sequence[float]) -> bool:
    """True if two dimensions are equal, but for the round-off of fractional powers."""
    return all(abs(a - b) <= 1e-9 for a, b in zip(one, other, strict=True))


# As a reader of the field writes what has such a dimension.
_USUAL = (
    *("mm", "g", "s", "rad", "N", "MPa", "rad/s", "Hz", "mm/s", "mm/s^2", "rad/s^2", "mm^2", "mm^3", "N/mm"),
    *("N*mm", "N*mm/rad", "N/mm^1.5", "g/mm^2", "g/mm^3", "g*mm^2", "N*s/mm", "N*mm*s/rad"),
)


def unit_of(dimension: Sequence[float]) -> str:
    """A unit of a dimension, as `N/mm`; "no unit" where it has none."""
    for text in _USUAL:
        if same(parse_unit(text).dimension, dimension):
            return text
    named = zip(("mm", "g", "s", "rad"), dimension, strict=True)
    return "*".join(f"{name}^{power:.6g}" for name, power in named if abs(power) > 1e-9) or "no unit"


def is_unit(name: str) -> bool:
    """True if a name is that of a unit."""
    return name in _NAMES


def _internal(dimension: Sequence[float]) -> str:
    """The unit of a dimension that has the factor 1."""
    powers = [(name, power) for name, power in zip(("mm", "g", "ms", "rad"), dimension, strict=True) if power]
    over = [name if power == 1.0 else f"{name}^{power:g}" for name, power in powers if power > 0.0]
    under = [name if power == -1.0 else f"{name}^{-power:g}" for name, power in powers if power < 0.0]
    return "/".join(["*".join(over) or "1", *under])


def exact_quantity(value: float, unit: str) -> str:
    """The shortest text that `parse_quantity` reads as exactly this value; in the internal unit of its kind
    where no number of `unit` is it."""
    factor, dimension = parse_unit(unit)
    near = value / factor
    tries = [float(f"{near:.15g}"), near, math.nextafter(near, math.inf), math.nextafter(near, -math.inf)]
    found = next((number for number in tries if number * factor == value), None)
    if found is None:
        found, unit = value, _internal(dimension)
    shown = repr(int(found)) if found.is_integer() and abs(found) < 1e15 else repr(found)
    return f"{shown} {unit}"
