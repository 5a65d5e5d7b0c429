"""Converts from the Model's units (mm, N, g, ms, rad) to those of the deck (mm, N, kg, s, rad), as text."""

from __future__ import annotations

from collections.abc import Iterable

from mdlgen.model.tables import Floats

Triple = tuple[str, str, str]


def number(value: float) -> str:
    """A number as written in the deck: the shortest that reads back as the same float."""
    return repr(float(value) + 0.0)  # + 0.0 turns -0.0 into 0.0


def _fifteen(value: float) -> str:
    """`value` to 15 digits, so that 0.72 g is 0.00072 kg and 0.1867 rad/ms 186.7 rad/s."""
    return number(float(f"{value:.15g}"))


def per_thousand(value: float) -> str:
    """g in kg, g mm^2 in kg mm^2, ms in s, N ms/mm in N s/mm, N mm ms/rad in N mm s/rad."""
    return _fifteen(value / 1000)


def thousandfold(value: float) -> str:
    """mm/ms in mm/s, rad/ms in rad/s."""
    return _fifteen(value * 1000)


def acceleration(value: float) -> str:
    """mm/ms^2 in mm/s^2."""
    return _fifteen(value * 1e6)


def numbers(values: Floats | Iterable[float]) -> tuple[str, ...]:
    """Lengths, forces or directions, which keep their units."""
    return tuple(repr(v + 0.0) for v in map(float, values))


def triples(points: Floats) -> list[Triple]:
    """Points [mm], (n, 3)."""
    return [(repr(x), repr(y), repr(z)) for x, y, z in (points + 0.0).tolist()]
