"""Operators on values: numbers, truth values, texts and vectors (tuples of numbers)."""

from __future__ import annotations

from typing import Any

from mdlgen.backends.motionview.reader.pair import Pair
from mdlgen.backends.motionview.reader.report import Trouble

MOST_TEXT = 100_000  # characters; more is no label


def truth(value: Any) -> bool:
    """Truth of a number, a truth value or a text."""
    value = one(value)
    if isinstance(value, (bool, float, int, str)):
        return bool(value)
    raise Trouble("evaluate", "this is neither true nor false")


def compare(sign: str, a: Any, b: Any, shift: int) -> bool:
    """`a == b` and the like; a number and a text are never equal."""
    a, b = one(a), one(b)
    if sign in ("==", "!="):
        if isinstance(a, (bool, float)) and isinstance(b, (bool, float)):
            return (float(a) == float(b)) is (sign == "==")
        return (type(a) is type(b) and a == b) is (sign == "==")
    if isinstance(a, str) is not isinstance(b, str):
        raise Trouble("evaluate", f"a number and a text cannot be compared by {sign}", shift)
    if not isinstance(a, (bool, float, str)) or not isinstance(b, (bool, float, str)):
        raise Trouble("evaluate", f"{sign} needs two numbers", shift)
    left: Any = a
    right: Any = b
    return {"<": left < right, ">": left > right, "<=": left <= right, ">=": left >= right}[sign]


def arithmetic(sign: str, a: Any, b: Any, shift: int) -> Any:
    """`a + b` and the like, for numbers, vectors item by item, and + for texts."""
    if a.__class__ is float and b.__class__ is float:
        return _number(sign, a, b, shift)
    if sign == "+" and (isinstance(a, str) or isinstance(b, str)):
        text = shown(a) + shown(b)
        if len(text) > MOST_TEXT:
            raise Trouble("evaluate", f"this text grows beyond {MOST_TEXT} characters", shift)
        return text
    if isinstance(a, (bool, float)) and isinstance(b, (bool, float)):
        return _number(sign, float(a), float(b), shift)
    if isinstance(a, tuple) and isinstance(b, tuple) and sign in "+-" and len(a) == len(b):
        return tuple([arithmetic(sign, x, y, shift) for x, y in zip(a, b, strict=True)])
    if isinstance(a, tuple) and isinstance(b, float) and sign in "*/":
        return tuple([arithmetic(sign, x, b, shift) for x in a])
    if isinstance(a, float) and isinstance(b, tuple) and sign == "*":
        return tuple([arithmetic(sign, a, y, shift) for y in b])
    raise Trouble("evaluate", f"{named(a)} {sign} {named(b)} has no meaning", shift)


def one(value: Any) -> Any:
    """The common value of a pair whose two values are equal: `pair_of_joints.isbush` is one answer for
    both."""
    if value.__class__ is Pair and isinstance(value.l, (bool, float, str)) and value.l == value.r:
        return value.l
    return value


def shown(value: Any) -> str:
    """A value as it is pasted into a text: 10.0 as 10, other numbers the shortest that reads back."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, tuple):
        return ", ".join(shown(v) for v in value)
    return str(value)


def named(value: Any) -> str:
    """Kind of a value, for messages."""
    if isinstance(value, (bool, float)):
        return f"the number {shown(value)}"
    if isinstance(value, str):
        return "a text"
    if isinstance(value, tuple):
        return "a vector"
    return str(value)


def _number(sign: str, a: float, b: float, shift: int) -> float:
    try:
        if sign == "+":
            value = a + b
        elif sign == "-":
            value = a - b
        elif sign == "*":
            value = a * b
        elif sign == "/":
            value = a / b
        elif sign == "%":
            value = a % b
        else:
            value = a**b
    except ZeroDivisionError:
        raise Trouble("evaluate", f"{shown(a)} {sign} {shown(b)} divides by zero", shift) from None
    except OverflowError:
        raise Trouble("evaluate", f"{shown(a)} {sign} {shown(b)} is too large", shift) from None
    if isinstance(value, complex) or value - value != 0.0:
        raise Trouble("evaluate", f"{shown(a)} {sign} {shown(b)} is no finite number", shift)
    return value
