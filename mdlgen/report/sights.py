"""What sensors see along, as rods in space, and when each was covered."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from mdlgen.geometry.solids import Solid, cylinder, join
from mdlgen.model.frames import frame
from mdlgen.model.tables import Floats, Model, SensorPart
from mdlgen.report.arrows import longest

if TYPE_CHECKING:
    from mdlgen.results.result import Result

RADIUS = 0.035  # of a rod, in times the length of the greatest arrow
WORDS = {"beam": "a beam", "point": "seen from a point", "line": "seen from a line"}


def sights(model: Model) -> Iterator[tuple[SensorPart, Solid]]:
    """Each sensor with its triangles [mm], global axes: the beam, the way that a point sees, or the outline
    of what a line sees."""
    radius = RADIUS * longest(model)
    for sensor in model.reactions.sensors:
        one, two = sensor.ends
        lines = [(one, sensor.way)]
        if sensor.kind == "line":
            lines += [(two, sensor.way), (one, two - one), (one + sensor.way, two - one)]
        yield sensor, join(*(_rod(at, way, radius) for at, way in lines))


def _rod(at: Floats, way: Floats, radius: float) -> Solid:
    length = float(np.linalg.norm(way))
    points, triangles = cylinder(radius, 0.0, length)
    return Solid(points @ frame(way / length).T + at, triangles)


def covered(result: Result | None, sensor: str) -> list[list[float]]:
    """From when to when a sensor was covered [ms]; to the end of the run where it still is."""
    if result is None:
        return []
    found: list[list[float]] = []
    for row in result.reactions:
        if row.get("sensor") != sensor:
            continue
        if row["kind"] == "covered":
            found.append([float(row["time_ms"]), float(result.time[-1])])
        elif found:
            found[-1][1] = float(row["time_ms"])
    return found
