"""Random formulas over random parameters, each with the value that it must have, worked out beside it."""

from __future__ import annotations

import math
import random
from typing import NamedTuple

# Per unit of a formula: the units that it may be written in, and what one of each is in mm, N, g, ms, rad.
UNITS: dict[str, dict[str, float]] = {
    "mm": {"mm": 1.0, "cm": 10.0, "um": 1e-3, "in": 25.4},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3},
    "g": {"g": 1.0, "kg": 1e3, "mg": 1e-3},
    "ms": {"ms": 1.0, "s": 1e3, "us": 1e-3},
    "mm/s": {"mm/s": 1e-3, "m/s": 1.0, "mm/ms": 1.0, "cm/s": 0.01},
    "rad/s": {"rad/s": 1e-3, "deg/s": math.pi / 180e3, "rpm": 2 * math.pi / 6e4},
    "N/mm": {"N/mm": 1.0, "N/m": 1e-3},
    "MPa": {"MPa": 1.0, "GPa": 1e3, "N/mm^2": 1.0, "N/mm2": 1.0},
    "1": {"": 1.0},
}
# A product or quotient of two that has such a unit.
MADE = {
    "mm": [("mm/s", "*", "ms"), ("N", "/", "N/mm")],
    "N": [("N/mm", "*", "mm")],
    "mm/s": [("mm", "/", "ms"), ("rad/s", "*", "mm")],
    "rad/s": [("mm/s", "/", "mm")],
    "N/mm": [("N", "/", "mm"), ("MPa", "*", "mm")],
    "MPa": [("N/mm", "/", "mm")],
    "ms": [("mm", "/", "mm/s")],
    "g": [],
    "1": [("mm", "/", "mm"), ("N", "/", "N"), ("g", "/", "g")],
}


class Known(NamedTuple):
    """A formula, and its value in internal units."""

    text: str
    value: float


class Trees:
    """Formulas of one scene: they share its parameters, which may follow from each other."""

    def __init__(self, seed: int):
        self.random = random.Random(seed)
        self.parameters: dict[str, tuple[str, Known]] = {}  # unit, what it is

    def formula(self, unit: str, depth: int) -> Known:
        """A positive value of a unit."""
        choose = self.random.choice
        kind = self.random.random()
        if depth == 0 or kind < 0.15:
            return self._number(unit)
        if kind < 0.45:
            return self._parameter(unit, depth - 1)
        a = self.formula(unit, depth - 1)
        if kind < 0.55:
            b = self.formula(unit, depth - 1)
            return Known(f"({a.text} + {b.text})", a.value + b.value)
        if kind < 0.62:
            b = self.formula(unit, depth - 1)
            low, high = sorted((a, b), key=lambda known: known.value)
            return Known(f"({high.text} - {low.text}*0.5)", high.value - 0.5 * low.value)
        if kind < 0.7:
            b = self.formula(unit, depth - 1)
            word = choose(("min", "max"))
            return Known(f"{word}({a.text}, {b.text})", {"min": min, "max": max}[word](a.value, b.value))
        if kind < 0.76:
            b = self.formula(unit, depth - 1)
            return Known(f"sqrt({a.text}*({b.text}))", math.sqrt(a.value * b.value))
        if kind < 0.82:
            return Known(f"abs(-{a.text})", a.value)
        if kind < 0.88:
            return Known(f"(({a.text})^2)^(1/2)", a.value)
        if MADE[unit]:
            one, sign, other = choose(MADE[unit])
            p, q = self.formula(one, depth - 1), self.formula(other, depth - 1)
            value = p.value * q.value if sign == "*" else p.value / q.value
            return Known(f"({p.text}){sign}({q.text})", value)
        b = self.formula("1", depth - 1)
        return Known(f"({a.text})*({b.text})", a.value * b.value)

    def near(self, unit: str, value: float, depth: int = 3) -> Known:
        """A formula that comes to a value: of random size, brought to it by a plain factor."""
        found = self.formula(unit, depth)
        factor = value / found.value
        return Known(f"{factor!r}*({found.text})", factor * found.value)

    def _number(self, unit: str) -> Known:
        word, one = self.random.choice(list(UNITS[unit].items()))
        number = float(f"{self.random.uniform(0.5, 3.0):.4g}")
        return Known(f"{number} {word}".strip(), number * one)

    def _parameter(self, unit: str, depth: int) -> Known:
        known = [name for name, (own, _) in self.parameters.items() if own == unit]
        if known and self.random.random() < 0.5:
            name = self.random.choice(known)
            return Known(name, self.parameters[name][1].value)
        value = self.formula(unit, depth)
        name = f"p_{len(self.parameters)}"
        self.parameters[name] = (unit, value)
        return Known(name, value.value)
