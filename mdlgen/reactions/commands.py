"""Orders carried out on the records that kernels read: what a drive or a spring does from a time on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from mdlgen.mechanics.arm import FORCE_0
from mdlgen.mechanics.gate import WIDE, command, write
from mdlgen.model.limits import MOST_CORNERS
from mdlgen.model.tables import Model, Order

# A jump of a speed takes so long [ms], since a law over time has one value at each (convention: far below any
# step).
JUMP = 1e-9


class Units(NamedTuple):
    """A millimetre, a gram and a millisecond in the units of a solver, where a newton stays one."""

    length: float = 1.0
    time: float = 1.0


def _same(body: int) -> int:
    return body


class Commands:
    """The values that a Model's drives and springs were ordered to so far, by body."""

    def __init__(self, model: Model, units: Units):
        self._units = units
        # the row of a body among records, where some of the Model's bodies have none
        self.number: Callable[[int], int] = _same
        self._parts = {part.name: part for part in model.machine}
        self._ordered: dict[int, dict[str, Any]] = {}  # fields of the records of bodies
        self._preload: dict[int, float] = {}  # [N]

    def order(self, order: Order, t: float, bodies: np.ndarray) -> float:
        """Carries an order out at the time t [ms], in the record of its body. Returns by how much the force,
        or the torque, of a spring grew in its place at the start, in the solver's units."""
        part: Any = self._parts[order.name]
        at = self.number(part.body)
        row: Any = bodies[at]
        ordered, grown = self._ordered.setdefault(part.body, {}), 0.0
        if order.kind == "speed":
            ordered["corners"], ordered["drive"] = self._speed(row, order, t)
        elif order.kind == "move":
            along = 1.0 if part.moving.turns else self._units.length
            time = self._units.time
            command(bodies, at, t * time, order.value * along, order.ramp * time)
            if t > 0.0:  # Exudyn counts places from that at the time 0, where a part is given
                write(row, np.array([np.zeros(WIDE), *row["drive"][: 2 * WIDE].reshape(2, WIDE)]))
            ordered["corners"], ordered["drive"] = int(row["corners"]), row["drive"].copy()
        else:
            press = row["press"].copy()
            if order.kind == "torque":
                grown = order.value * self._units.length - float(press[FORCE_0])
            else:
                grown = order.value - self._preload.get(part.body, float(part.press.preload))
                self._preload[part.body] = order.value
            press[FORCE_0] += grown
            ordered["press"] = press
        for name, value in ordered.items():
            row[name] = value
        return grown

    def write(self, bodies: np.ndarray) -> None:
        """Writes all that was ordered into other records of the same bodies."""
        for body, ordered in self._ordered.items():
            for name, value in ordered.items():
                bodies[name][self.number(body)] = value

    def body(self, name: str) -> int:
        """The body of a part."""
        return self._parts[name].body

    def kept(self) -> dict[str, Any]:
        """All that a resumed run needs, as plain values."""
        ordered = {
            str(body): {name: np.asarray(value).tolist() for name, value in fields.items()}
            for body, fields in self._ordered.items()
        }
        return {"ordered": ordered, "preload": {str(body): force for body, force in self._preload.items()}}

    def restore(self, kept: dict[str, Any]) -> None:
        """Restores the state that `kept` returned."""
        self._ordered = {int(body): dict(fields) for body, fields in kept["ordered"].items()}
        self._preload = {int(body): force for body, force in kept["preload"].items()}

    def _speed(self, row: Any, order: Order, t: float) -> tuple[int, np.ndarray]:
        """The corners of a drive that goes to a speed from the time t on. Those before stay; where there are
        too many, one mean speed takes their place, by which the roller has turned as far."""
        time = self._units.time
        begin, jump = t * time, max(JUMP, 1e-12 * t) * time
        count = int(row["corners"])
        times, speeds = row["drive"][: 2 * count : 2], row["drive"][1 : 2 * count : 2]
        now = float(np.interp(begin, times, speeds))
        before = times < begin
        times, speeds = times[before], speeds[before]
        if len(times) > MOST_CORNERS - 2 and begin > 0.0:
            moments = np.unique(np.append(np.clip(times, 0.0, begin), (0.0, begin)))
            turned = float(np.trapezoid(np.interp(moments, times, speeds), moments))
            times = np.array([0.0, begin - jump])
            speeds = np.full(2, turned / begin)
        corners = [
            *zip(times, speeds, strict=True),
            (begin, now),
            (begin + max(order.ramp * time, jump), order.value / time),
        ]
        drive = np.zeros_like(row["drive"])
        drive[: 2 * len(corners)] = np.ravel(corners)
        return len(corners), drive
