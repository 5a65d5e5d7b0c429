"""Rates that rollers, their arms and what springs press begin with."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from mdlgen.model.tables import Model


class Rate(NamedTuple):
    """A rate of a body as the run begins."""

    body: int
    of: str  # slide or spin
    rate: float  # [rad/ms] where it turns, [mm/ms] along a press
    turns: bool


def begun_rates(model: Model) -> Iterator[Rate]:
    """All that are not 0."""
    for roller in model.rollers:
        if roller.spin != 0.0:
            yield Rate(roller.body, "spin", roller.spin, True)
        held = roller.press or roller.arm
        if held is not None and held.speed != 0.0:
            yield Rate(roller.body, "slide", held.speed, roller.arm is not None)
    for plate, press in model.plates:
        if press.speed != 0.0:
            yield Rate(plate.body, "slide", press.speed, False)


def fastest_start(model: Model) -> float:
    """Greatest initial speed of the surface of a spinning roller, of an arm's end or of a pressed part
    [mm/ms]."""
    rollers = {roller.body: roller for roller in model.rollers}
    found = [0.0]
    for body, of, rate, turns in begun_rates(model):
        lever = (rollers[body].reach if of == "spin" else rollers[body].swung_length) if turns else 1.0
        found.append(abs(rate) * lever)
    return max(found)
