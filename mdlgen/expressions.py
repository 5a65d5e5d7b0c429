"""Arithmetic as it is typed: read by an allow-list, never evaluated as Python.

One grammar is a selection of it: what functions there are, whether comparisons are allowed, whether numbers
have units. Who evaluates gives the names, and on what it is computed: plain numbers here, quantities with
units in `formulas`.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Protocol, cast

from mdlgen.units import UNIT_TEXT, Unit, parse_unit

# A name may be reserved in Python (a roller `in`), so names are taken out before the text is parsed.
_NAME = r"(?<![\w.])[A-Za-z_]\w*(?:\.\w+)*"
_NUMBER = r"(?<![\w.])(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_WORD = re.compile(_NAME, re.ASCII)
_WORD_OR_QUANTITY = re.compile(rf"(?P<number>{_NUMBER})\s*(?P<unit>{UNIT_TEXT})|(?P<name>{_NAME})", re.ASCII)
_LOGIC = ("and", "or", "not")


class Function(NamedTuple):
    """A function and how many arguments it takes: numbers, one vector, or names alone."""

    run: Callable[..., Any]
    least: int = 1
    most: float = 1
    of: Literal["numbers", "vector", "names"] = "numbers"

    def takes(self) -> str:
        """How many arguments, in words."""
        if self.most == math.inf:
            return {1: "one value or more", 2: "two values or more"}[self.least]
        return {1: "one value", 2: "two values"}.get(self.least, f"{self.least} to {self.most:g} values")


@dataclass(frozen=True)
class Grammar:
    """The grammar of a text."""

    functions: Mapping[str, Function]
    allowed: str  # in words, for errors
    logic: bool = False  # comparisons, and, or, not
    units: bool = False  # numbers have units, and a power may be written ^
    remainder: bool = False  # a % b is what is left of a by whole multiples of b, of the sign of b
    folded: bool = False  # functions without regard to case; their names are lower
    characters: int = 1000
    depth: int = 40  # of operations in operations; those of one rank side by side are one

    def function(self, word: str) -> Function | None:
        return self.functions.get(word.lower() if self.folded else word)


class Arithmetic(Protocol):
    """The arithmetic on which an expression is computed."""

    def number(self, value: float) -> Any: ...

    def quantity(self, value: float, unit: Unit) -> Any: ...

    def negative(self, a: Any) -> Any: ...

    def binary(self, operation: type[ast.operator], a: Any, b: Any) -> Any: ...


_OPERATORS: dict[type, Callable[[float, float], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Mod: operator.mod,
}
_COMPARISONS: dict[type, Callable[[float, float], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
_SIDE_BY_SIDE = (ast.Add, ast.Sub, ast.Mult, ast.Div)


class _Plain:
    """Numbers without units."""

    def number(self, value: float) -> float:
        return value

    def quantity(self, value: float, unit: Unit) -> float:
        return value * unit.factor

    def negative(self, a: float) -> float:
        return -a

    def binary(self, operation: type[ast.operator], a: float, b: float) -> Any:
        return _OPERATORS[operation](a, b)


PLAIN = _Plain()
Value = float | Sequence[float] | None
Lookup = Callable[[str], Any]


class Refused(ValueError):
    """A text that is not of the grammar; says why, without the text."""


class _Missing(Exception):
    """A name that has no value."""


@dataclass(frozen=True)
class Expression:
    """Arithmetic over names; a comparison is 1 where it holds, else 0."""

    text: str
    names: tuple[str, ...]
    quantities: tuple[tuple[float, str], ...]  # numbers with their units
    grammar: Grammar
    tree: ast.expr  # names stand there as _0, _1, ..., quantities as q_0, ...

    @property
    def plain(self) -> bool:
        """True if it is a name and nothing else."""
        return isinstance(self.tree, ast.Name) and self.tree.id.startswith("_")

    def named(self, node: ast.Name) -> str:
        """The name that a node of the tree stands for."""
        return self.names[int(node.id[1:])]

    def quantity(self, node: ast.Name) -> tuple[float, str] | None:
        """Number and unit that a node of the tree stands for; None where it is a name."""
        return self.quantities[int(node.id[2:])] if node.id.startswith("q") else None

    def value(self, lookup: Lookup) -> float | None:
        """Its value, with numbers (or, for norm(), vectors) by name; None where a name has no number.

        Raises ValueError with what is wrong: a division by zero, a root of what is negative, a vector where a
        number is due.
        """
        try:
            found = self.on(PLAIN, lookup)
        except _Missing:
            return None
        except ZeroDivisionError:
            raise ValueError(f"{self.text}: a division by zero") from None
        except (OverflowError, ValueError) as error:
            raise ValueError(f"{self.text}: {error}") from None
        if isinstance(found, complex) or not math.isfinite(found):
            raise ValueError(f"{self.text}: is no finite number")
        return float(found) + 0.0

    def on(self, arithmetic: Arithmetic, lookup: Lookup) -> Any:
        """Its value on an arithmetic; raises the errors of that, and _Missing, see `value`."""
        return self.part(self.tree, arithmetic, lookup)

    def part(self, node: ast.expr, arithmetic: Arithmetic, lookup: Lookup) -> Any:
        """The value of a part of its tree; as `on`."""
        return _Evaluation(self, arithmetic, lookup).of(node)


class _Evaluation:
    """One expression with names that have values."""

    def __init__(self, expression: Expression, arithmetic: Arithmetic, lookup: Lookup):
        self.expression, self.arithmetic, self.lookup = expression, arithmetic, lookup

    def of(self, node: ast.expr) -> Any:
        on = self.arithmetic
        match node:
            case ast.Constant(value=number):
                return on.number(float(number))  # pyright: ignore[reportArgumentType]
            case ast.Name():
                return self._named(node)
            case ast.UnaryOp(op=op, operand=inner):
                value = self.number(inner)
                if isinstance(op, ast.Not):
                    return float(not value)
                return on.negative(value) if isinstance(op, ast.USub) else value
            case ast.BinOp():
                chain = [node]
                while isinstance(chain[-1].left, ast.BinOp):
                    chain.append(chain[-1].left)
                value = self.number(chain[-1].left)
                for part in reversed(chain):
                    value = on.binary(type(part.op), value, self.number(part.right))
                return value
            case ast.BoolOp(op=op, values=parts):
                truths = [bool(self.number(part)) for part in parts]
                return float(all(truths) if isinstance(op, ast.And) else any(truths))
            case ast.Compare(left=left, ops=ops, comparators=others):
                numbers = [self.number(part) for part in (left, *others)]
                pairs = zip(ops, numbers, numbers[1:], strict=False)
                return float(all(_COMPARISONS[type(op)](a, b) for op, a, b in pairs))
            case ast.Call(func=ast.Name(id=word), args=args):
                return self._call(word, args)
        raise AssertionError(f"{type(node).__name__} was let in")

    def _call(self, word: str, args: Sequence[ast.expr]) -> Any:
        function = self.expression.grammar.function(word)
        assert function is not None, "it was let in"
        if function.of == "names":
            return function.run(*(self.expression.named(cast(ast.Name, part)) for part in args))
        take = self.of if function.of == "vector" else self.number
        return function.run(*(take(part) for part in args))

    def number(self, node: ast.expr) -> Any:
        found = self.of(node)
        if isinstance(found, (list, tuple)) and not hasattr(found, "_fields"):
            name = self.expression.named(cast(ast.Name, node))
            raise ValueError(f"{name} is a vector; write {name}.x, .y or .z, or norm({name})")
        return found

    def _named(self, node: ast.Name) -> Any:
        quantity = self.expression.quantity(node)
        if quantity is not None:
            return self.arithmetic.quantity(quantity[0], parse_unit(quantity[1]))
        found = self.lookup(self.expression.named(node))
        if found is None:
            raise _Missing
        return found


def read(text: str, grammar: Grammar) -> Expression:
    """The Expression of a text. Raises Refused."""
    if len(text) > grammar.characters:
        raise Refused(f"longer than {grammar.characters} characters")
    names: list[str] = []
    quantities: list[tuple[float, str]] = []

    def placed(match: re.Match[str]) -> str:
        groups = match.groupdict()
        if groups.get("number") is not None:
            quantities.append((float(groups["number"]), groups["unit"].strip()))
            return f" q_{len(quantities) - 1} "
        word = match[0]
        if grammar.logic and word in _LOGIC:
            return word
        if grammar.function(word) is not None and text[match.end() :].lstrip().startswith("("):
            return word
        if word not in names:
            names.append(word)
        return f"_{names.index(word)}"

    made = (_WORD_OR_QUANTITY if grammar.units else _WORD).sub(placed, text).strip()
    if grammar.units:
        made = made.replace("^", "**")
    try:
        tree = ast.parse(made, mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise Refused("is not an expression") from None
    found = Expression(text.strip(), tuple(names), tuple(quantities), grammar, tree)
    if message := _refusal(tree, grammar, 0):
        raise Refused(message)
    return found


def _refusal(node: ast.AST, grammar: Grammar, depth: int) -> str:
    """The fault of a tree that is not allowed; empty where all is."""
    if depth > grammar.depth:
        return f"is nested deeper than {grammar.depth}"
    inner: Sequence[ast.AST]
    match node:
        case ast.Constant(value=number):
            if type(number) not in (int, float) or not abs(cast(float, number)) < 1e300:
                return f"{str(number)[:40]!r} is not a finite number"
            return ""
        case ast.Name(id=word):
            return "" if word.lstrip("q").startswith("_") else f"{word} is a function; it takes arguments"
        case ast.UnaryOp(op=ast.Not(), operand=operand) if grammar.logic:
            inner = [operand]
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            inner = [operand]
        case ast.BinOp(op=op) if type(op) in _OPERATORS and (grammar.remainder or type(op) is not ast.Mod):
            parts, left = [node.right], node.left
            while isinstance(left, ast.BinOp) and isinstance(left.op, _SIDE_BY_SIDE):
                parts.append(left.right)
                left = left.left
            inner = [*parts, left]
        case ast.BoolOp(values=values) if grammar.logic:
            inner = list(values)
        case ast.Compare(left=left, ops=ops, comparators=others) if grammar.logic and all(
            type(op) in _COMPARISONS for op in ops
        ):
            inner = [left, *others]
        case ast.Call(func=ast.Name(id=word), args=args, keywords=[]) if function := grammar.function(word):
            if not function.least <= len(args) <= function.most:
                return f"{word}() takes {function.takes()}"
            if function.of != "numbers" and not all(isinstance(part, ast.Name) for part in args):
                return f"{word}() takes the name of a {'vector' if function.of == 'vector' else 'marker'}"
            inner = list(args)
        case _:
            return f"{type(getattr(node, 'op', node)).__name__} is not allowed"
    return next((message for part in inner if (message := _refusal(part, grammar, depth + 1))), "")
