"""Formulas: arithmetic over quantities and named parameters, with units checked.

Values are in the internal units (mm, g, ms, rad). A speed over a length is a rate of turning (rad/s), and a
rate or an angle times a length a speed or a length: elsewhere an angle is a unit like others.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import NamedTuple

from mdlgen.errors import did_you_mean
from mdlgen.expressions import Expression, Function, Grammar, Refused, read
from mdlgen.units import UNIT_TEXT, Unit, is_unit, same, unit_of

Dimension = tuple[float, float, float, float]
NONE: Dimension = (0.0, 0.0, 0.0, 0.0)
_LENGTH, _ANGLE = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
_SPEED, _RATE = (1.0, 0.0, -1.0, 0.0), (0.0, 0.0, -1.0, 1.0)
MOST_POWER = 16.0  # of a unit
MOST_CHARACTERS, MOST_DEPTH = 1000, 16


class Amount(NamedTuple):
    """A value in internal units, and the exponents of its length, mass, time and angle."""

    value: float
    dimension: Dimension

    @property
    def unit(self) -> str:
        return unit_of(self.dimension)


def _same_unit(name: str, a: Amount, b: Amount) -> None:
    if not same(a.dimension, b.dimension):
        raise ValueError(f"{name} needs one unit, not {a.unit} and {b.unit}")


class _Units:
    """Quantities with their units."""

    def number(self, value: float) -> Amount:
        return Amount(value, NONE)

    def quantity(self, value: float, unit: Unit) -> Amount:
        return Amount(value * unit.factor, unit.dimension)

    def negative(self, a: Amount) -> Amount:
        return Amount(-a.value, a.dimension)

    def binary(self, operation: type[ast.operator], a: Amount, b: Amount) -> Amount:
        if operation is ast.Add or operation is ast.Sub:
            _same_unit("a sum" if operation is ast.Add else "a difference", a, b)
            return Amount(a.value + b.value if operation is ast.Add else a.value - b.value, a.dimension)
        if operation is ast.Mod:
            _same_unit("a remainder", a, b)
            return Amount(a.value % b.value, a.dimension)
        if operation is ast.Mult:
            return Amount(a.value * b.value, _product(a.dimension, b.dimension))
        if operation is ast.Div:
            return Amount(a.value / b.value, _quotient(a.dimension, b.dimension))
        return _power(a, b)


def _product(a: Dimension, b: Dimension) -> Dimension:
    for one, other in ((a, b), (b, a)):
        if same(one, _LENGTH) and (same(other, _RATE) or same(other, _ANGLE)):
            return _SPEED if same(other, _RATE) else _LENGTH
    return _four(p + q for p, q in zip(a, b, strict=True))


def _quotient(a: Dimension, b: Dimension) -> Dimension:
    if same(a, _SPEED) and same(b, _LENGTH):
        return _RATE
    return _four(p - q for p, q in zip(a, b, strict=True))


def _four(values: object) -> Dimension:
    length, mass, time, angle = (round(v, 9) for v in values)  # type: ignore[attr-defined]
    if max(abs(length), abs(mass), abs(time), abs(angle)) > MOST_POWER:
        raise ValueError("a power of a unit has no physical use")
    return length, mass, time, angle


def _power(a: Amount, b: Amount) -> Amount:
    if not same(b.dimension, NONE):
        raise ValueError(f"an exponent has no unit, not {b.unit}")
    if abs(b.value) > 64:
        raise ValueError(f"the exponent {b.value:g} is more than 64")
    value = a.value**b.value
    if isinstance(value, complex):
        raise ValueError("a broken power of what is negative")
    return Amount(value, _four(p * b.value for p in a.dimension))


def _root(a: Amount) -> Amount:
    return Amount(math.sqrt(a.value), _four(p / 2 for p in a.dimension))


def _extreme(name: str, choose: Callable[..., float]) -> Callable[..., Amount]:
    def run(first: Amount, *others: Amount) -> Amount:
        for other in others:
            _same_unit(f"{name}()", first, other)
        return Amount(choose(first.value, *(other.value for other in others)), first.dimension)

    return run


def _of_angle(name: str, function: Callable[[float], float]) -> Callable[[Amount], Amount]:
    def run(a: Amount) -> Amount:
        if not same(a.dimension, _ANGLE) and not same(a.dimension, NONE):
            raise ValueError(f"{name}() takes an angle, not {a.unit}")
        return Amount(function(a.value), NONE)

    return run


def _to_angle(name: str, function: Callable[[float], float]) -> Callable[[Amount], Amount]:
    def run(a: Amount) -> Amount:
        if not same(a.dimension, NONE):
            raise ValueError(f"{name}() takes a plain number, not {a.unit}")
        return Amount(function(a.value), _ANGLE)

    return run


GRAMMAR = Grammar(
    functions={
        "abs": Function(lambda a: Amount(abs(a.value), a.dimension)),
        "sqrt": Function(_root),
        "min": Function(_extreme("min", min), 2, 4),
        "max": Function(_extreme("max", max), 2, 4),
        **{name: Function(_of_angle(name, getattr(math, name))) for name in ("sin", "cos", "tan")},
        **{name: Function(_to_angle(name, getattr(math, name))) for name in ("asin", "acos", "atan")},
    },
    allowed="numbers with units, parameters, pi, + - * / ^, ( ), sqrt, abs, min, max, sin, cos, tan, asin, "
    "acos, atan",
    units=True,
    characters=MOST_CHARACTERS,
    depth=MOST_DEPTH,
)
PI = Amount(math.pi, NONE)
ON = _Units()

_NUMBER = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_TOKEN = re.compile(
    rf"\s*(?:(?P<value>{_NUMBER}(?:\s*{UNIT_TEXT})?(?![\w.]))|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|[-+*/^(),]))",
    re.ASCII,
)


# `0.05 1/mm`: one number whose unit begins with a 1
_PER = re.compile(rf"\s*{_NUMBER}\s+1\s*/\s*{UNIT_TEXT}\s*", re.ASCII)


def is_formula(text: str, parameters: Mapping[str, object]) -> bool:
    """True if a text is meant as a formula, not as one number with its unit."""
    if _PER.fullmatch(text):
        return False
    at, words, signs, values, before = 0, [], "", 0, ""
    text = text.rstrip()
    while at < len(text):
        token = _TOKEN.match(text, at)
        if token is None:
            return False
        name = token["name"]
        if name and name not in parameters and before in ("value", "unit") and name not in GRAMMAR.functions:
            return False  # 5 mmm, and 5 N*mmm: a unit that is misspelt
        words += [name] if name else []
        signs += token["sign"] or ""
        values += token["value"] is not None
        if token["value"]:
            before = "value"
        else:
            last = token["value"] is None and before == "value" and token["sign"] in ("*", "/")
            before = "unit" if last and text[: token.start("sign")].rstrip()[-1].isalpha() else ""
        at = token.end()
    calls = "(" in signs
    if ("," in signs and not calls) or not (words or values):
        return False
    if any(word in parameters for word in words):
        return True
    if len(words) == 1 and not values and not signs.strip("+-"):  # a word alone
        return bool(parameters)
    return calls or bool(signs.strip("+-")) or (bool(signs) and values + len(words) > 1)


@lru_cache(maxsize=4096)
def formula(text: str) -> Expression:
    """The Expression of a formula. Raises Refused."""
    return read(text, GRAMMAR)


def evaluated(text: str, parameters: Mapping[str, Amount]) -> Amount:
    """The value of a formula. Raises ValueError with the fault, in one line."""
    shown = f"{text.strip()[:80]!r}"
    try:
        expression = formula(text)
    except Refused as error:
        raise ValueError(f"{shown}: {error}; allowed are {GRAMMAR.allowed}") from None

    def named(name: str) -> Amount:
        if name in parameters:
            return parameters[name]
        if name == "pi":
            return PI
        if is_unit(name):
            raise ValueError(f"the unit {name} has no number; write 1 {name}")
        if name in GRAMMAR.functions:
            raise ValueError(f"{name} is a function; write {name}(...)")
        close = did_you_mean(name, parameters)
        raise ValueError(
            f"there is no parameter {name[:80]!r}{close or ';'} "
            f"there are: {', '.join(parameters)[:200] or 'none'}"
        )

    try:
        found = expression.on(ON, named)
    except ZeroDivisionError:
        raise ValueError(f"{shown}: a division by zero") from None
    except (OverflowError, ValueError) as error:
        raise ValueError(f"{shown}: {error}") from None
    if not math.isfinite(found.value):
        raise ValueError(f"{shown}: is no finite number")
    return Amount(found.value + 0.0, found.dimension)


def names(text: str) -> tuple[str, ...]:
    """The parameters that a formula names."""
    return tuple(name for name in formula(text).names if name != "pi")
