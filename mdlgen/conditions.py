"""Conditions of rules: comparisons over what sensors see, times, places and parameters, with units checked.

`exit covered and count(exit) < 3`, `gap(entry) < 20 mm`, `time > 30 ms`, `note.x > 120 mm`. A word asks for
the reading of a sensor: `covered(exit)` or `exit covered`, `count(exit)`, `gap(exit)`. It also asks if a
sheet has come in or left, `note_3 left`, or how many sheets of a stream have, `left(infeed)`. Values are in
the internal units (mm, g, ms, rad).
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import cast

from mdlgen.errors import did_you_mean
from mdlgen.expressions import Expression, Grammar, Refused, read
from mdlgen.formulas import GRAMMAR as FORMULAS
from mdlgen.formulas import NONE, ON, PI, Amount, Dimension
from mdlgen.units import same

LENGTH, TIME, ANGLE = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)
SPEED, RATE = (1.0, 0.0, -1.0, 0.0), (0.0, 0.0, -1.0, 1.0)
# Readings of a sensor, with their dimension; None: yes or no.
OF_SENSOR: dict[str, Dimension | None] = {
    "covered": None,
    "clear": None,
    "count": NONE,
    "gap": LENGTH,
    "speed": SPEED,
    "skew": ANGLE,
    "position": LENGTH,
    "since": TIME,
}
# Values of a sheet or a probe, and of a roller.
OF_SHEET: dict[str, Dimension | None] = {
    **dict.fromkeys(("x", "y", "z"), LENGTH),
    **dict.fromkeys(("vx", "vy", "vz", "speed"), SPEED),
}
# Whether a sheet that comes and goes has come in, and has left; of a stream how many have.
OF_STAY = ("entered", "left")
OF_ROLLER: dict[str, Dimension | None] = {"omega": RATE}
CLOCK = "time"

_CALL = re.compile(rf"\b({'|'.join((*OF_SENSOR, *OF_STAY))})\s*\(\s*([A-Za-z]\w*)\s*\)", re.ASCII)
# what may stand behind a name, and two names of which the second one is none of these
_SAID = ("covered", "clear", "entered", "left")
_ASSIGNED = re.compile(r"(?<![<>=!])=(?!=)")
_LOGIC = ("and", "or", "not")
_STATE = re.compile(rf"\b([A-Za-z]\w*)\s+({'|'.join(_SAID)})\b", re.ASCII)
_SIDE_BY_SIDE = re.compile(
    rf"\b(?!(?:{'|'.join(_LOGIC)})\b)([A-Za-z]\w*)\s+(?!(?:and|or)\b)([A-Za-z]\w*)", re.ASCII
)
GRAMMAR = Grammar(
    functions=FORMULAS.functions,
    allowed="comparisons with and, or, not; SENSOR covered, SENSOR clear; count, gap, speed, skew, position "
    "and since of a sensor, as count(exit); SHEET entered, SHEET left; entered(STREAM), "
    "left(STREAM); time; NAME.x, .y, .z, .vx, .vy, .vz and .speed of a sheet or "
    "probe; NAME.omega of a roller; parameters, numbers with units, + - * / % ^, ( ), sqrt, abs, min, max",
    logic=True,
    units=True,
    remainder=True,
    characters=1000,
    depth=16,
)
# what to write in place of the name of a sensor, sheet, stream or roller alone
_ALONE = {
    "covered": "{} covered",
    "clear": "{} clear",
    "count": "count({}) > 0",
    "x": "{}.x > 5 mm",
    "entered": "{} entered",
    "left": "{} left",
    "left of a stream": "left({}) > 0",
    "omega": "{}.omega > 1 rad/s",
}
Known = Callable[[str], Amount | float]


@dataclass(frozen=True)
class Condition:
    """A condition that has been read; `names` of its expression are `time`, `NAME.WORD` and parameters."""

    text: str
    expression: Expression

    def holds(self, known: Known) -> bool:
        """True if it holds. `known` returns an Amount by name, or 0 or 1 for yes or no. No comparison holds
        if a value is not known, nan, or if it divides by zero."""
        try:
            return bool(self.expression.on(ON, known))
        except (ArithmeticError, ValueError):
            return False


@lru_cache(maxsize=1024)
def condition(text: str) -> Condition:
    """Reads a text. Raises ValueError with the fault, in one line."""

    def stated(found: re.Match[str]) -> str:
        return found[0] if found[1] in _LOGIC else f"{found[1]}.{found[2]}"

    plain = _STATE.sub(stated, _CALL.sub(r"\2.\1", text))
    try:
        return Condition(text.strip(), read(plain, GRAMMAR))
    except Refused as error:
        if _ASSIGNED.search(plain):
            raise ValueError(f"{text.strip()[:80]!r}: = compares nothing; write ==") from None
        if found := _SIDE_BY_SIDE.search(plain):
            close = did_you_mean(found[2], _SAID) or ";"
            raise ValueError(
                f"{text.strip()[:80]!r}: {found[0]!r} is not understood{close} behind a name stands "
                f"{', '.join(_SAID[:-1])} or {_SAID[-1]}, and between two conditions and or or"
            ) from None
        raise ValueError(f"{text.strip()[:80]!r}: {error}; allowed are {GRAMMAR.allowed}") from None


def check(of: Condition, words: Mapping[str, Dimension | None], parameters: Mapping[str, Amount]) -> None:
    """Raises ValueError, in one line, where a condition names what there is not, compares what has unlike
    units, or is neither a comparison nor yes or no; `words`: the dimension of each name, None: yes or no."""

    def named(name: str) -> Amount | float:
        if name in words:
            dimension = words[name]
            return 1.0 if dimension is None else Amount(1.0, dimension)
        if name in parameters:
            return parameters[name]
        if name == "pi":
            return PI
        thing, _, word = name.partition(".")
        if word and word not in (of := [n.partition(".")[2] for n in words if n.startswith(f"{thing}.")]):
            if of:
                raise ValueError(
                    f"{thing} has no {word!r}{did_you_mean(word, of) or ';'} it has {_listed(of)}"
                )
            things = dict.fromkeys(n.partition(".")[0] for n in words if "." in n)
            raise ValueError(
                f"there is no {thing!r}{did_you_mean(thing, things) or ';'} there are {_listed(things)}"
            )
        known = dict.fromkeys([*parameters, CLOCK, *(n.partition(".")[0] for n in words)])
        raise ValueError(f"there is no {name!r}{did_you_mean(name, known) or ';'} there are {_listed(known)}")

    shown = f"{of.text[:80]!r}"
    plain = [name for name in of.expression.names if name not in words and name not in parameters]
    for name in plain:
        own = {n.partition(".")[2]: dimension for n, dimension in words.items() if n.startswith(f"{name}.")}
        own = {"left of a stream": NONE} if own.get("left") == NONE else own
        ways = [say.format(name) for word, say in _ALONE.items() if word in own]
        if ways:
            raise ValueError(f"{shown}: {name} alone says nothing; write {', or '.join(ways[:3])}")
    try:
        _check(of.expression.tree, of.expression, named)
    except ZeroDivisionError:
        pass  # of the values that stand in for what is not known yet
    except ValueError as error:
        raise ValueError(f"{shown}: {error}") from None
    except (AttributeError, TypeError):
        raise ValueError(f"{shown}: what is covered is yes or no, and no number to compute with") from None


def _check(node: ast.expr, expression: Expression, named: Known) -> None:
    """One part of a condition that has to be true or false."""
    match node:
        case ast.BoolOp(values=parts):
            for part in parts:
                _check(part, expression, named)
        case ast.UnaryOp(op=ast.Not(), operand=part):
            _check(part, expression, named)
        case ast.Compare(left=left, comparators=others):
            sides = [_amount(part, expression, named) for part in (left, *others)]
            for (part, one), (other, two) in pairwise(zip((left, *others), sides, strict=True)):
                if not same(one.dimension, two.dimension):
                    bare = [side for side in (part, other) if isinstance(side, ast.Constant)]
                    unit = one.unit if other in bare else two.unit
                    hint = f"; write a unit with the number, as {bare[0].value:g} {unit}" if bare else ""
                    raise ValueError(f"compares {one.unit} with {two.unit}{hint}")
        case _:
            if isinstance(expression.part(node, ON, named), Amount):
                raise ValueError("is a number, not true or false; compare it, as gap(exit) < 20 mm")


def _amount(node: ast.expr, expression: Expression, named: Known) -> Amount:
    found = expression.part(node, ON, named)
    if not isinstance(found, Amount):
        raise TypeError
    return cast(Amount, found)


def _listed(names: object) -> str:
    return ", ".join(sorted(names))[:200] or "none"  # type: ignore[call-overload]
