"""Solver expressions, evaluated: laws of drives and clutches over time, and outputs in a made-up state.

An output is a formula of markers. Numbers show if it reads the right ones: each body gets a displacement, a
velocity and a spin of its own, made from its name. The formula must then yield their values at the material
point that the Model has for the probe.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mdlgen.expressions import Function, Grammar, read
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
        """Position of the body's point at `point`."""
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


def torques(text: str, points: Sequence[tuple[float, float]]) -> list[float]:
    """Values of the expression of a clutch, a motor, a limiter or a bearing at times [s] and spins about z
    [rad/s]. Raises Unreadable."""
    return _over(text, points, {"time": 0}, {"WZ": 1})


def of_joint(text: str, points: Sequence[tuple[float, float]]) -> list[float]:
    """Values of the expression of stops at places along or about z and their rates. Raises Unreadable."""
    return _over(text, points, {}, {"DZ": 0, "AZ": 0, "VZ": 1, "WZ": 1})


def _over(
    text: str, points: Sequence[tuple[float, float]], names: Mapping[str, int], measures: Mapping[str, int]
) -> list[float]:
    """Values at points of two numbers; names and measures give which of both they stand for."""
    now = points[0] if points else (0.0, 0.0)

    def measure(name: str, markers: list[str]) -> float:
        if name not in measures:
            raise Unreadable(f"{name} in a force over a joint")
        return now[measures[name]]

    value, found = _reader(text, measure), []
    for now in points:
        found.append(value({"pi": math.pi, **{name: now[k] for name, k in names.items()}}))
    return found


def _step(x: float, x0: float, h0: float, x1: float, h1: float) -> float:
    """The cubic from h0 at x0 to h1 at x1, level at both ends."""
    if x1 == x0:
        raise ValueError("STEP between two values that are the same")
    s = min(max((x - x0) / (x1 - x0), 0.0), 1.0)
    return h0 + (h1 - h0) * s * s * (3.0 - 2.0 * s)


_MEASURES = ("AZ", *(f"{kind}{axis}" for kind in "DVW" for axis in "XYZ"))
_FUNCTIONS = {
    "max": Function(max, 1, math.inf),
    "min": Function(min, 1, math.inf),
    "abs": Function(abs),
    "sqrt": Function(math.sqrt),
    "sin": Function(math.sin),
    "cos": Function(math.cos),
    "step": Function(_step, 5, 5),
}


def _value(text: str, names: Mapping[str, float], measure: Callable[[str, list[str]], float]) -> float:
    return _reader(text, measure)(names)


def _reader(text: str, measure: Callable[[str, list[str]], float]) -> Callable[[Mapping[str, float]], float]:
    """Gives values of an expression for values of names. Its language is, for what is written here, that of
    Python."""

    def measured(name: str) -> Callable[..., float]:
        return lambda *markers: measure(name, list(markers))

    measures = {name.lower(): Function(measured(name), 1, 3, "names") for name in _MEASURES}
    grammar = Grammar(_FUNCTIONS | measures, "", folded=True, characters=_MOST, depth=100)
    try:
        expression = read(text, grammar)
    except ValueError as error:
        raise _unreadable(text, error) from None

    def value(names: Mapping[str, float]) -> float:
        def named(name: str) -> float:
            if name.lower() not in names:
                raise Unreadable(f"{name[:80]} is not known in a solver expression")
            return names[name.lower()]

        try:
            found = expression.value(named)
        except ValueError as error:
            raise _unreadable(text, error) from None
        assert found is not None, "each name has a value"
        return found

    return value


def _unreadable(text: str, error: ValueError) -> Unreadable:
    return Unreadable(f"{text[:80]} has no value ({error})"[:300])
