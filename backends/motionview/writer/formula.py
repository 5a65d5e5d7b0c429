"""Formulas over the user's parameters as MotionView evaluates them.

A formula is computed in mm, N, s, rad, and so in N s^2/mm where it has a mass: these belong together, and a
text shows masses in kg and angles in degrees.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping

from mdlgen.backends.motionview.writer.units import factor, in_degrees, in_kg, number
from mdlgen.errors import SpecError
from mdlgen.expressions import Expression
from mdlgen.formulas import formula
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.parameters.starts import reference
from mdlgen.model.tables import Model
from mdlgen.units import parse_unit

MOST = 20_000  # characters
_SUM, _PRODUCT, _POWER, _VALUE = 1, 2, 4, 5  # how tightly a text holds together
_SIGNS: dict[type, tuple[str, int]] = {
    ast.Add: ("+", _SUM),
    ast.Sub: ("-", _SUM),
    ast.Mult: ("*", _PRODUCT),
    ast.Div: ("/", _PRODUCT),
}


def units_of(model: Model) -> dict[str, str]:
    """Internal unit of each parameter that the user named."""
    return {p.member: p.unit for p in model.parameters if p.data_set == OF_USER}


def rows_of(model: Model) -> dict[str, tuple[str, str]]:
    """Internal unit and MDL of each value that a start follows, by the name that its formula has it by."""
    return {
        reference(p.data_set, p.member): (p.unit, f"ds_{p.data_set}.real_{p.member}.value")
        for p in model.parameters
        if p.data_set != OF_USER
    }


def mdl_formula(
    text: str, unit: str, units: Mapping[str, str], rows: Mapping[str, tuple[str, str]] | None = None
) -> str:
    """A formula in MDL, for a value of an internal unit; `units` are those of the user's parameters, `rows`
    other values that it may name. Raises SpecError where it grows too long."""
    expression = formula(text)
    if expression.plain and (name := expression.names[0]) in units and units[name] == unit:
        return _reference(name)
    said = _Writer(expression, units, rows or {}).said(expression.tree)
    dimension = parse_unit(unit).dimension
    if in_degrees(dimension):
        return f"{_held(said, _PRODUCT)}*180/PI"
    return f"{_held(said, _PRODUCT)}*1000" if in_kg(dimension) else said[0]


def _reference(name: str) -> str:
    return f"ds_{OF_USER}.real_{name}.value"


def _held(said: tuple[str, int], least: int) -> str:
    """A text that is one value for an operator that binds as tightly as `least`."""
    return said[0] if said[1] >= least else f"({said[0]})"


class _Writer:
    """One formula."""

    def __init__(self, expression: Expression, units: Mapping[str, str], rows: Mapping[str, tuple[str, str]]):
        self.expression = expression
        self.known = {name: (unit, _reference(name)) for name, unit in units.items()} | dict(rows)

    def said(self, node: ast.expr) -> tuple[str, int]:
        """The text of a part, and how tightly it holds together."""
        text, tight = self._of(node)
        if len(text) > MOST:
            raise SpecError(f"the formula {self.expression.text[:80]!r} is too long for a text")
        return text, tight

    def _of(self, node: ast.expr) -> tuple[str, int]:
        match node:
            case ast.Constant(value=value):
                return number(float(value)), _VALUE  # pyright: ignore[reportArgumentType]
            case ast.Name():
                return self._named(node)
            case ast.UnaryOp(op=op, operand=inner):
                sign = "-" if isinstance(op, ast.USub) else "+"
                return sign + _held(self.said(inner), _POWER), _SUM
            case ast.BinOp(op=ast.Pow(), left=left, right=right):
                return f"{_held(self.said(left), _VALUE)}^{_held(self.said(right), _VALUE)}", _POWER
            case ast.BinOp(left=left, op=op, right=right):
                sign, tight = _SIGNS[type(op)]
                return f"{_held(self.said(left), tight)}{sign}{_held(self.said(right), tight + 1)}", tight
            case ast.Call(func=ast.Name(id=word), args=args):
                return self._call(word, [self.said(part)[0] for part in args])
        raise AssertionError(f"{type(node).__name__} was let in")

    def _call(self, word: str, args: list[str]) -> tuple[str, int]:
        """With the functions that are seen in files of MotionView."""
        if word == "tan":
            return f"sin({args[0]})/cos({args[0]})", _PRODUCT
        if word == "abs":
            return f"sqrt(({args[0]})^2)", _VALUE
        if word in ("min", "max"):
            sign, text = "<" if word == "min" else ">", args[0]
            for other in args[1:]:
                text = f"(({text}) {sign} ({other}) ? ({text}) : ({other}))"
            return text, _VALUE
        return f"{word}({args[0]})", _VALUE

    def _named(self, node: ast.Name) -> tuple[str, int]:
        quantity = self.expression.quantity(node)
        if quantity is not None:
            unit = parse_unit(quantity[1])
            return number(float(f"{quantity[0] * unit.factor * factor(unit.dimension):.15g}")), _VALUE
        name = self.expression.named(node)
        if name not in self.known:
            return "PI", _VALUE
        unit, said = self.known[name]
        dimension = parse_unit(unit).dimension
        if in_degrees(dimension):
            return f"{said}*PI/180", _PRODUCT
        return (f"{said}/1000", _PRODUCT) if in_kg(dimension) else (said, _VALUE)
