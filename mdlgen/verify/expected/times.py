"""Times, and spins of rollers, at which laws are evaluated, by what they are laws of."""

from __future__ import annotations

from collections.abc import Mapping

Times = Mapping[str, tuple[float, ...]]
"""Times [s] by motion, as many for all; those of loads; and points of axles and of stops, see there."""
OF_AXLES, OF_STOPS = "axle ", "stop "
"""What keys of times and spins of a roller, and of places and rates of what has stops, begin with: no name
has a blank."""


def longest(times: Times) -> int:
    """How many times the law of a drive or a load is looked at, at most."""
    return max((len(found) for name, found in times.items() if " " not in name), default=0)
