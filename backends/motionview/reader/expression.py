"""Compiles the text of an expression into a function of the scope that returns its value.

Each rule of the grammar makes a closure. `Compiled.depth` is how deep closures call each other, so that the
evaluator can stop before Python's own limit; chains such as a+b+c+... are loops and add no depth.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from mdlgen.backends.motionview.reader.functions import FUNCTIONS
from mdlgen.backends.motionview.reader.operators import arithmetic, compare, truth
from mdlgen.backends.motionview.reader.report import Trouble
from mdlgen.backends.motionview.reader.statement import SOLVER, TEXT

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Scope

Run = Callable[["Scope"], Any]
MOST_NESTED = 24  # parentheses in parentheses; a real file has five
MOST_DEEP = 230  # calls in calls, such as a.b.c.d...

_TOKEN = re.compile(
    rf"""\s*(?:
      (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?)
    | (?P<name>[A-Za-z_]\w*)
    | (?P<string>{TEXT})
    | (?P<solver>{SOLVER})
    | (?P<sign>==|!=|<=|>=|&&|\|\||\*\*|[-+*/%^<>!?:()\[\]{{}},.@])
    )""",
    re.X,
)
# Operators between two values, from the loosest on.
_OR, _AND, _EQUAL, _LESS, _SUM, _PRODUCT = 1, 2, 3, 4, 5, 6
_RANKS = {
    **{"||": _OR, "&&": _AND, "==": _EQUAL, "!=": _EQUAL},
    **{"<": _LESS, ">": _LESS, "<=": _LESS, ">=": _LESS},
    **{"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "%": _PRODUCT},
}
_BEHIND = (".", "[", "@")  # operators that may follow a value
_BARE_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\Z")
_ESCAPES = {"n": "\n", "t": "\t"}


class Compiled(NamedTuple):
    """A compiled expression."""

    run: Run
    depth: int


def literal(text: str) -> float | None:
    """Value of a text that is a number; None where it is not, or where the number is too large."""
    number = float(text) if _BARE_NUMBER.match(text) else math.inf
    return number if math.isfinite(number) else None


@lru_cache(maxsize=10_000)  # of the texts that are read while a scene is verified, most are the same
def compiled(text: str) -> Compiled:
    """The compiled form of `text`. Raises Trouble (with the offset in `text`) where it is no expression."""
    return _Parser(text).whole()


def solver_parts(text: str) -> list[tuple[int, str, bool]]:
    """A solver expression as pieces (offset, text, is an MDL expression in braces)."""
    parts: list[tuple[int, str, bool]] = []
    at = depth = begin = 0
    for m in re.finditer(rf"{TEXT}|[{{}}]", text):
        if m[0] == "{":
            if depth == 0:
                parts.append((at, text[at : m.start()], False))
                begin = m.end()
            depth += 1
        elif m[0] == "}" and depth:
            depth -= 1
            if depth == 0:
                parts.append((begin, text[begin : m.start()], True))
                at = m.end()
    if depth:
        raise Trouble("syntax", "a brace in this solver expression is not closed", begin)
    parts.append((at, text[at:], False))
    return [p for p in parts if p[1] or p[2]]


class _Parser:
    def __init__(self, text: str):
        self.text = text
        self.tokens: list[tuple[str, str, int]] = []
        at, end = 0, len(text.rstrip())
        for m in _TOKEN.finditer(text, 0, end):
            if m.start() != at:
                break
            kind = str(m.lastgroup)
            self.tokens.append((kind, m[kind], m.start(kind)))
            at = m.end()
        if at < end:
            shift = at + len(text[at:]) - len(text[at:].lstrip())
            raise Trouble("syntax", f"{text[shift]!r} has no meaning in an expression", shift)
        self.tokens.append(("end", "", end))
        self.at = 0
        self.nested = 0
        self.depth = 0

    def whole(self) -> Compiled:
        run = self.choice()
        kind, value, shift = self.tokens[self.at]
        if kind != "end":
            raise Trouble("syntax", f"{value!r} is not expected here", shift)
        if self.depth > MOST_DEEP:
            raise Trouble("syntax", "this expression has more dots, indices and signs than can be followed")
        return Compiled(run, self.depth)

    # -- helpers

    def sign(self, *signs: str) -> str:
        """Consumes one of the signs and returns it, or an empty text."""
        kind, value, _ = self.tokens[self.at]
        if kind == "sign" and value in signs:
            self.at += 1
            return value
        return ""

    def due(self, sign: str) -> None:
        if not self.sign(sign):
            _, value, shift = self.tokens[self.at]
            raise Trouble("syntax", f"{sign!r} is due here" + (f", not {value!r}" if value else ""), shift)

    def enter(self) -> None:
        self.nested += 1
        self.depth = max(self.depth, 8 * self.nested)
        if self.nested > MOST_NESTED:
            message = f"parentheses are nested more than {MOST_NESTED} deep"
            raise Trouble("syntax", message, self.tokens[self.at][2])

    # -- grammar, loosest first

    def choice(self) -> Run:
        self.enter()
        condition = self.operation(1)
        if self.sign("?"):
            yes = self.choice()
            self.due(":")
            no = self.choice()
            chosen = condition
            self.nested -= 1
            return lambda scope: yes(scope) if truth(chosen(scope)) else no(scope)
        self.nested -= 1
        return condition

    def operation(self, least: int) -> Run:
        """Values joined by operators of rank `least` or more; those of one rank are evaluated from left to
        right, in one loop."""
        value = self.unary()
        while True:
            rank = self.rank()
            if rank < least:
                return value
            rest: list[tuple[str, Run, int]] = []
            while self.rank() == rank:
                _, sign, shift = self.tokens[self.at]
                self.at += 1
                rest.append((sign, self.operation(rank + 1), shift))
            value = _joined(rank, value, rest)

    def rank(self) -> int:
        """Rank of the operator at this place; 0: there is none."""
        kind, sign, _ = self.tokens[self.at]
        return _RANKS.get(sign, 0) if kind == "sign" else 0

    def unary(self) -> Run:
        signs = []
        while sign := self.sign("-", "+", "!"):
            signs.append(sign)
        shift = self.tokens[self.at][2]
        value = self.power()
        for sign in reversed(signs):
            if sign != "+":
                value = _signed(sign, value, shift)
                self.depth += 1
        return value

    def power(self) -> Run:
        base = self.postfix()
        shift = self.tokens[self.at][2]
        if not self.sign("^", "**"):
            return base
        self.enter()
        exponent = self.unary()
        self.nested -= 1
        return lambda scope: arithmetic("^", base(scope), exponent(scope), shift)

    def postfix(self) -> Run:
        value = self.atom()
        while True:
            kind, sign, shift = self.tokens[self.at]
            if kind != "sign" or sign not in _BEHIND:
                return value
            self.at += 1
            if sign == ".":
                kind, name, _ = self.tokens[self.at]
                if kind != "name":  # MotionView itself writes a dot too many now and then
                    continue
                self.at += 1
                value = _attribute(value, name, shift)
            elif sign == "[":
                index = self.choice()
                self.due("]")
                value = _indexed(value, index, shift)
            else:
                value = _body_at(value, self.postfix(), shift)
            self.depth += 1

    def atom(self) -> Run:
        kind, value, shift = self.tokens[self.at]
        self.at += 1
        if kind == "number":
            number = float(value.replace("d", "e").replace("D", "e"))
            if not math.isfinite(number):
                raise Trouble("evaluate", f"{value[:80]} is more than the largest number", shift)
            return lambda scope: number
        if kind == "string":
            string = re.sub(r"\\(.)", lambda m: _ESCAPES.get(m[1], m[1]), value[1:-1], flags=re.S)
            return lambda scope: string
        if kind == "solver":
            inner = value[1:-1]
            return lambda scope: scope.world.pasted(inner, scope)
        if kind == "name":
            return self._name(value, shift)
        if value == "(":
            inside = self.choice()
            self.due(")")
            return inside
        if value == "{":
            return self._vector()
        what = f"{value!r} is" if value else "the end of the text is"
        raise Trouble("syntax", f"a value is due here; {what} none", shift)

    def _arguments(self, closing: str) -> list[Run]:
        parts: list[Run] = []
        if not self.sign(closing):
            parts.append(self.choice())
            while self.sign(","):
                parts.append(self.choice())
            self.due(closing)
        return parts

    def _vector(self) -> Run:
        parts = self._arguments("}")
        if len(parts) == 1:  # { text } is a computed text, not a vector
            return parts[0]
        return lambda scope: tuple([part(scope) for part in parts])

    def _name(self, name: str, shift: int) -> Run:
        if self.sign("("):
            function = FUNCTIONS.get(name.lower())
            if function is None:
                raise Trouble("function", f"there is no function {name}(...) that is known", shift)
            parts = self._arguments(")")
            return lambda scope: function(scope, [part(scope) for part in parts], shift)

        def run(scope: Scope) -> Any:
            try:
                return scope.value_of(name)
            except Trouble as trouble:
                if trouble.place is None and not trouble.shift:
                    trouble.shift = shift
                raise

        return run


def _joined(rank: int, first: Run, rest: list[tuple[str, Run, int]]) -> Run:
    """Values and the operators of one rank between them."""
    if rank in (_OR, _AND):
        parts = [first, *(part for _, part, _ in rest)]
        judge = any if rank == _OR else all
        return lambda scope: judge(truth(part(scope)) for part in parts)
    apply = compare if rank < _SUM else arithmetic

    def run(scope: Scope) -> Any:
        value = first(scope)
        for sign, part, shift in rest:
            value = apply(sign, value, part(scope), shift)
        return value

    return run


def _signed(sign: str, value: Run, shift: int) -> Run:
    if sign == "!":
        return lambda scope: not truth(value(scope))
    return lambda scope: arithmetic("*", -1.0, value(scope), shift)


def _attribute(value: Run, name: str, shift: int) -> Run:
    key = name.lower()

    def run(scope: Scope) -> Any:
        try:
            owner = value(scope)
        except Trouble as trouble:
            if key == "label" and trouble.code == "dangling":
                return ""  # `x.label != ""` is how MotionView files ask whether x exists
            raise
        return scope.world.attribute(owner, key, name, shift)

    return run


def _indexed(value: Run, index: Run, shift: int) -> Run:
    def run(scope: Scope) -> Any:
        items = value(scope)
        try:
            place = operator.index(int(index(scope)))
            if place < 0:
                raise IndexError
            return scope.world.vector(items)[place] if not isinstance(items, (tuple, list)) else items[place]
        except (IndexError, TypeError, ValueError):
            raise Trouble("evaluate", "this has no such item", shift) from None

    return run


def _body_at(beam: Run, point: Run, shift: int) -> Run:
    """`beam.body@point`: the body that a beam of many has at one of its points."""

    def run(scope: Scope) -> Any:
        return scope.world.body_at(beam(scope), point(scope), shift)

    return run
