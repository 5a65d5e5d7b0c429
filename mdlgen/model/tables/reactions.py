"""Sensors and rules of a machine: readings of its sheets, and actions."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.geometry.arrays import Floats as Floats
from mdlgen.geometry.arrays import Ints as Ints
from mdlgen.model.tables.bodies import Frozen


@dataclass(frozen=True)
class SensorPart(Frozen):
    """A sensor: it sees sheets on the way `way` from any point between both `ends`."""

    name: str
    kind: str  # beam, point or line
    ends: Floats  # ends of the line; for a beam and a point twice the same [mm], (2, 3)
    way: Floats  # direction of the view, as long as it sees [mm], (3,)
    hysteresis: float  # [mm]
    sheets: Ints  # numbers of the sheets that it sees


@dataclass(frozen=True)
class Order(Frozen):
    """One thing that a rule does."""

    kind: str  # speed, press, torque, move, enter, go, end
    name: str  # name of the part, the stream or the state; empty: none
    value: float  # a speed about the axis [rad/ms], a force [N], a torque [N mm], a place [rad, mm]
    ramp: float  # duration of the change [ms]
    sheets: tuple[int, ...] = ()  # numbers of the sheets of which the next one comes in


@dataclass(frozen=True)
class RulePart(Frozen):
    """A rule, see the spec."""

    when: str
    after: float  # [ms]
    once: bool
    states: tuple[str, ...]  # states in which it holds; empty: all
    orders: tuple[Order, ...]


@dataclass(frozen=True)
class Reactions(Frozen):
    """All sensors and rules, by name and as they are listed."""

    sensors: tuple[SensorPart, ...] = ()
    rules: tuple[RulePart, ...] = ()
    amounts: tuple[tuple[str, float, tuple[float, float, float, float]], ...] = ()  # parameters, dimensions
    begins: str = ""  # initial state of the machine; empty: it has none
    streams: tuple[tuple[str, tuple[int, ...]], ...] = ()  # each with the numbers of its sheets

    def __bool__(self) -> bool:
        return bool(self.sensors or self.rules)

    def ordered(self, kind: str) -> dict[str, list[float]]:
        """Values that rules order, by the name of what they order them of, in the units of `Order.value`."""
        found: dict[str, list[float]] = {}
        for order in (order for rule in self.rules for order in rule.orders if order.kind == kind):
            found.setdefault(order.name, []).append(order.value)
        return found


def no_reactions() -> Reactions:
    """The table of a machine without sensors and rules."""
    return Reactions()
