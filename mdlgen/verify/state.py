"""Solver expressions, evaluated: the laws of drives over time, and outputs in a made-up state of motion.

An output is a formula of markers. Whether it reads the right ones is seen by numbers: each body gets a
displacement, a velocity and a spin of its own, made from its name, and the formula must give what these
make of the material point that the Model has for the probe.
"""

from __future__ import annotations

import ast
import hashlib
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from mdlgen.model.tables import Floats

_MOST = 100_000  # characters of an expression


class Unreadable(Exception):
    """An expression that is none, or of more than is known here."""


class Motion(NamedTuple):
    """State of a body: displacement [mm], velocity of its point at the origin [mm/s], spin [rad/s]."""

    displacement: Floats
    velocity: Floats
    spin: Floats

    def place(self, point: Floats) -> Floats:
        """Where the body's point at `point` is."""
        return point + self.displacement

    def speed(self, point: Floats) -> Floats:
        """Velocity of the body's point at `point`."""
        return self.velocity + np.cross(self.spin, point)


GROUND = Motion(np.zeros(3), np.zeros(3), np.zeros(3))


def motion(body: str) -> Motion:
    """The made-up state of a body, always the same for the same name; ground is at rest."""
    if body in ("B_Ground", ""):
        return GROUND
    raw = hashlib.blake2b(body.encode(), digest_size=36).digest()
    numbers = np.frombuffer(raw, dtype="<u4").astype(float) / 2**32 * 2 - 1
    return Motion(numbers[:3] * 10, numbers[3:6] * 1000, numbers[6:] * 10)


class Place(NamedTuple):
    """A marker: its body, where it is, its axes in rows."""

    body: str
    origin: Floats
    axes: Floats


GLOBAL_FRAME = Place("B_Ground", np.zeros(3), np.eye(3))


class Places:
    """Markers by name, from the records of a text; later records count."""

    def __init__(self, *records: Mapping[str, Any]):
        self._records = [r for r in records if r]

    def __getitem__(self, name: str) -> Place:
        """Raises Unreadable for a marker that there is not."""
        if name == "Global_Frame":
            return GLOBAL_FRAME
        for records in reversed(self._records):
            record = records.get(name)
            if record is not None and record["body"] is not None:
                return Place(record["body"], np.array(record["origin"]), np.array(record["axes"]))
        raise Unreadable(f"there is no marker {name}")


def request(text: str, markers: Places) -> float:
    """Value of an output's expression in the made-up state. Raises Unreadable."""

    def measure(name: str, names: list[str]) -> float:
        if not 1 <= len(names) <= 3:
            raise Unreadable(f"{name} takes one to three markers")
        i, j, axes = (markers[n] for n in (*names, *["Global_Frame"] * (3 - len(names))))
        one, other = motion(i.body), motion(j.body)
        vector = {
            "D": one.place(i.origin) - other.place(j.origin),
            "V": one.speed(i.origin) - other.speed(j.origin),
            "W": one.spin - other.spin,
        }[name[0]]
        return float(axes.axes["XYZ".index(name[1])] @ vector)

    return _value(text, {}, measure)


def law(text: str, time: float) -> float:
    """Value of a drive's expression at a time [s]. Raises Unreadable."""

    def none(name: str, names: list[str]) -> float:
        raise Unreadable(f"{name} in a law of time")

    return _value(text, {"time": time, "pi": math.pi}, none)


_MEASURES = {f"{kind}{axis}" for kind in "DVW" for axis in "XYZ"}
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "max": max,
    "min": min,
    "abs": abs,
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
}
_OPERATORS: dict[type, Callable[[float, float], float]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.Pow: lambda a, b: a**b,
}


def _value(text: str, names: Mapping[str, float], measure: Callable[[str, list[str]], float]) -> float:
    """The expression language of the solver is, for what is written here, that of Python."""
    if len(text) > _MOST:
        raise Unreadable(f"an expression of {len(text)} characters")
    try:
        value = _node(ast.parse(text.strip(), mode="eval").body, names, measure)
    except (SyntaxError, ValueError, RecursionError, MemoryError, ArithmeticError, TypeError) as error:
        raise Unreadable(f"{text[:80]} has no value ({error})") from None
    if not isinstance(value, float | int) or not math.isfinite(value):
        raise Unreadable(f"{text[:80]} has no finite value")
    return float(value)


def _node(node: ast.expr, names: Mapping[str, float], measure: Callable[[str, list[str]], float]) -> float:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return float(node.value)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        value = _node(node.operand, names, measure)
        return -value if isinstance(node.op, ast.USub) else value
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _OPERATORS[type(node.op)](_node(node.left, names, measure), _node(node.right, names, measure))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        name = node.func.id
        if name.upper() in _MEASURES:
            return measure(name.upper(), [ast.unparse(argument) for argument in node.args])
        if name.lower() in _FUNCTIONS:
            return float(_FUNCTIONS[name.lower()](*(_node(a, names, measure) for a in node.args)))
    if isinstance(node, ast.Name) and node.id.lower() in names:
        return names[node.id.lower()]
    raise Unreadable(f"{ast.unparse(node)[:80]} is not known in a solver expression")
