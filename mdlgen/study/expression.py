"""Arithmetic over names, as it is typed: read by an allow-list, never evaluated as Python."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, cast

from mdlgen.errors import SpecError

MOST_CHARACTERS, MOST_DEPTH = 1000, 40

# A name may hold what Python reserves (a roller `in`), so names are taken out before the text is parsed.
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*(?:\.\w+)*", re.ASCII)
_WORDS = ("and", "or", "not")

Value = float | Sequence[float] | None
Lookup = Callable[[str], Value]


def _norm(vector: Value) -> float:
    if not isinstance(vector, (list, tuple)):
        raise ValueError("norm() takes a vector")
    return math.hypot(*vector)


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": abs,
    "sqrt": math.sqrt,
    "min": min,
    "max": max,
    "norm": _norm,
}
_OF_SEVERAL = ("min", "max")
_OPERATORS: dict[type, Callable[[float, float], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
ALLOWED = "numbers, names, + - * / **, < <= > >= == !=, and, or, not, abs, sqrt, min, max, norm"


class Missing(Exception):
    """A name that has no number in this run."""


@dataclass(frozen=True)
class Expression:
    """Arithmetic over names; a comparison is 1 where it holds, else 0."""

    text: str
    names: tuple[str, ...]
    _tree: ast.expr

    @property
    def plain(self) -> bool:
        """Whether it is a name and nothing else."""
        return isinstance(self._tree, ast.Name)

    def value(self, lookup: Lookup) -> float | None:
        """Its value, with numbers (or, for norm(), vectors) by name; None where a name has no number.

        Raises ValueError with what is wrong: a division by zero, a root of what is negative, a vector where a
        number is due.
        """
        try:
            found = self._of(self._tree, lookup)
        except Missing:
            return None
        except ZeroDivisionError:
            raise ValueError(f"{self.text}: a division by zero") from None
        except (OverflowError, ValueError) as error:
            raise ValueError(f"{self.text}: {error}") from None
        if isinstance(found, complex) or not math.isfinite(found):
            raise ValueError(f"{self.text}: is no finite number")
        return float(found) + 0.0

    def _of(self, node: ast.expr, lookup: Lookup) -> Any:
        match node:
            case ast.Constant(value=number):
                return float(number)  # pyright: ignore[reportArgumentType]
            case ast.Name(id=word):
                return self._named(self.names[int(word[1:])], lookup)
            case ast.UnaryOp(op=op, operand=inner):
                value = self._number(inner, lookup)
                return (
                    float(not value)
                    if isinstance(op, ast.Not)
                    else -value
                    if isinstance(op, ast.USub)
                    else value
                )
            case ast.BinOp(left=left, op=op, right=right):
                return _OPERATORS[type(op)](self._number(left, lookup), self._number(right, lookup))
            case ast.BoolOp(op=op, values=parts):
                truths = [bool(self._number(part, lookup)) for part in parts]
                return float(all(truths) if isinstance(op, ast.And) else any(truths))
            case ast.Compare(left=left, ops=ops, comparators=others):
                numbers = [self._number(part, lookup) for part in (left, *others)]
                pairs = zip(ops, numbers, numbers[1:], strict=False)
                return float(all(_OPERATORS[type(op)](a, b) for op, a, b in pairs))
            case ast.Call(func=ast.Name(id=word), args=args):
                take = self._of if word == "norm" else self._number
                return _FUNCTIONS[word](*(take(part, lookup) for part in args))
        raise AssertionError(f"{type(node).__name__} was let in")

    def _number(self, node: ast.expr, lookup: Lookup) -> Any:
        found = self._of(node, lookup)
        if isinstance(found, (list, tuple)):
            assert isinstance(node, ast.Name)
            name = self.names[int(node.id[1:])]
            raise ValueError(f"{name} is a vector; write {name}.x, .y or .z, or norm({name})")
        return found

    @staticmethod
    def _named(name: str, lookup: Lookup) -> Value:
        found = lookup(name)
        if found is None:
            raise Missing
        return found


def read(text: str, option: str) -> Expression:
    """The Expression of a text; `option` is what an error names. Raises SpecError."""

    def refuse(what: str) -> SpecError:
        return SpecError(f"{option}: {text[:80]!r}: {what}; allowed are {ALLOWED}")

    if len(text) > MOST_CHARACTERS:
        raise SpecError(f"{option}: longer than {MOST_CHARACTERS} characters")
    names: list[str] = []

    def placed(match: re.Match[str]) -> str:
        word = match[0]
        if word in _WORDS or (word in _FUNCTIONS and text[match.end() :].lstrip().startswith("(")):
            return word
        if word not in names:
            names.append(word)
        return f"_{names.index(word)}"

    try:
        tree = ast.parse(_NAME.sub(placed, text).strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise refuse("is not an expression") from None
    if told := _told(tree, 0):
        raise refuse(told)
    return Expression(text.strip(), tuple(names), tree)


def _told(node: ast.AST, depth: int) -> str:
    """What is not allowed in a tree; empty where all is."""
    if depth > MOST_DEPTH:
        return f"is nested deeper than {MOST_DEPTH}"
    inner: Sequence[ast.AST]
    match node:
        case ast.Constant(value=number):
            if type(number) not in (int, float) or not abs(cast(float, number)) < 1e300:
                return f"{str(number)[:40]!r} is not a finite number"
            return ""
        case ast.Name():
            return ""
        case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.UAdd(), operand=operand):
            inner = [operand]
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            inner = [left, right]
        case ast.BoolOp(values=values):
            inner = values
        case ast.Compare(left=left, ops=ops, comparators=others) if all(type(op) in _OPERATORS for op in ops):
            inner = [left, *others]
        case ast.Call(func=ast.Name(id=word), args=args, keywords=[]) if word in _FUNCTIONS:
            if (len(args) < 2) if word in _OF_SEVERAL else (len(args) != 1):
                return f"{word}() takes {'two values or more' if word in _OF_SEVERAL else 'one value'}"
            if word == "norm" and not isinstance(args[0], ast.Name):
                return "norm() takes the name of a vector"
            inner = args
        case _:
            return f"{type(node).__name__} is not allowed"
    return next((told for part in inner if (told := _told(part, depth + 1))), "")
