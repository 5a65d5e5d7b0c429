"""The quantities of a run that the requests in MDL files, decks and scripts record."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from mdlgen.altair.recorded import called, recorded
from mdlgen.model.tables import Floats
from mdlgen.results.quantities import GRAZE, LEAST, TENTH
from mdlgen.results.result import ON_B, RUBS, Result
from mdlgen.units import PER_SECOND


@dataclass(frozen=True)
class Quantity:
    """One quantity over the stored times, and how it follows from the six numbers of its request."""

    name: str  # probes.lead.position
    unit: str
    values: Floats  # (t, 1 or 3)
    labels: tuple[str, str]  # of its request: name and comment
    take: Callable[[Floats], Floats]  # picks (t, 1 or 3) of the six numbers of a request, (t, 6)
    rate: bool = False  # true if the last three of the six are its rate [1/s]
    moves: bool = False  # true if a difference is relative to how far it moved, not to its value
    least: float = LEAST  # least scale of a difference


def quantities(result: Result) -> list[Quantity]:
    """All quantities of a run that a request may have."""
    return [*_probes(result), *_rollers(result), *_plates(result), *_contacts(result)]


def _first(six: Floats) -> Floats:
    return six[:, :3]


def _last(six: Floats) -> Floats:
    return six[:, 3:]


def _along(axis: Floats) -> Callable[[Floats], Floats]:
    """A function that projects the last three of six numbers on an axis."""
    return lambda six: six[:, 3:] @ axis[:, None]


def _size(six: Floats) -> Floats:
    """Size of the first three numbers."""
    return np.linalg.norm(six[:, :3], axis=1, keepdims=True)


def _motion(
    result: Result, name: str, labels: tuple[str, str], motion: tuple[Floats, Floats], least: float
) -> Iterator[Quantity]:
    place, rate = motion
    slow = least / _seconds(result)
    yield Quantity(f"{name}.position", "mm", place, labels, _first, rate=True, moves=True, least=least)
    yield Quantity(f"{name}.velocity", "mm/s", rate * PER_SECOND, labels, _last, least=slow)


def _seconds(result: Result) -> float:
    return max(result.model.run.duration / PER_SECOND, LEAST)


def _probes(result: Result) -> Iterator[Quantity]:
    for k, probe in enumerate(result.model.probes):
        labels = f"o_{probe.name}", f"Probe {probe.name}: position, velocity"
        least = TENTH * max(result.model.sheets[probe.sheet].size)
        yield from _motion(result, f"probes.{probe.name}", labels, result.anchor_motion(k), least)


def _rollers(result: Result) -> Iterator[Quantity]:
    for roller in result.model.rollers:
        labels = f"o_{roller.name}", f"Roller {roller.name}: position, spin"
        place = result.position[:, roller.body]
        name = f"rollers.{roller.name}"
        least = TENTH * roller.radius
        yield Quantity(f"{name}.position", "mm", place, labels, _first, moves=True, least=least)
        spin = result.spin[:, roller.body] @ roller.axis[:, None] * PER_SECOND
        slow = TENTH / _seconds(result)
        yield Quantity(f"{name}.omega", "rad/s", spin, labels, _along(roller.axis), least=slow)


def _plates(result: Result) -> Iterator[Quantity]:
    for plate, _ in result.model.plates:
        labels = f"o_{plate.name}", f"Plane {plate.name}: position, velocity"
        motion = result.position[:, plate.body], result.velocity[:, plate.body]
        yield from _motion(result, f"planes.{plate.name}", labels, motion, TENTH * plate.size[2])


def _contacts(result: Result) -> Iterator[Quantity]:
    """Size of the resultant of normal force and friction, and torque about the axis of a roller."""
    table = result.model.contacts
    least = max(GRAZE * float(result.contact_force.max(initial=0.0)), LEAST)
    rollers = {roller.name: roller for roller in result.model.rollers}
    for row in recorded(result.model):
        by, on = table.part_a[row], table.part_b[row]
        labels = called(result.model, row), f"Contact of {by} on {on}: force, torque"
        name, part = f"contacts.{by}.{on}", rollers.get(on)
        if result.contact_friction is not None:
            force = np.hypot(result.contact_force[:, row], result.contact_friction[:, row, RUBS])
            yield Quantity(f"{name}.resultant", "N", force[:, None], labels, _size, least=least)
        if result.contact_torque is not None and part is not None:
            torque = result.contact_torque[:, row, ON_B:]
            turn = _along(part.axis)
            yield Quantity(f"{name}.torque", "N mm", torque, labels, turn, least=least * part.radius)
