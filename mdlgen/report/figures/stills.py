"""Pictures of a run at some times, for print: from the side, as in the paper, and from a corner."""

from __future__ import annotations

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Ints
from mdlgen.report import boxes
from mdlgen.report.figures.space import VIEWS, Space, frame, picture
from mdlgen.report.motion import poses
from mdlgen.results.result import Result
from mdlgen.results.strain import histories
from mdlgen.units import parse_quantity


def times(text: str) -> list[float]:
    """`0,18,30,50ms` as times [ms]; a number without a unit has the next one's. Raises SpecError."""
    found: list[float] = []
    unit = "ms"
    for piece in reversed(text.split(",")):
        number = piece.strip()
        letters = number.lstrip("+-.0123456789")
        try:
            found.append(parse_quantity(number if letters else f"{number} {unit}", "ms"))
        except ValueError as error:
            raise SpecError(f"--stills {text[:80]}: {error}; give times like 0,18,30,50ms") from None
        unit = letters.strip() or unit
    return found[::-1]


def stills(result: Result, at_ms: list[float]) -> dict[str, bytes]:
    """PNG pictures by file name, `still_18ms.png`, each of the stored state that is nearest to its time.

    Raises SpecError for a time that the run does not have. The same result gives the same bytes.
    """
    end = float(result.time[-1])
    for time in at_ms:
        if not -1e-9 <= time <= end * (1 + 1e-9):
            raise SpecError(f"--stills: {time:g} ms is not in the run, which has 0 to {end:g} ms")
    at = np.array([int(np.argmin(np.abs(result.time - time))) for time in at_ms], dtype=np.int64)
    place, turn = poses(result, at)
    matrix = turns(turn)
    name, unit, values, most = _colours(result, at)
    when = boxes.there(result, at)
    scenes = [
        Space(result.model, place[k], matrix[k], values[k] / (most or 1.0), there=here)
        for k, here in enumerate(when)
    ]
    message = f"colour: {name}, 0 to {most:.4g} {unit}"
    frames = [frame([scene.points @ view.T for scene in scenes]) for view in VIEWS]
    return {
        f"still_{time:g}ms.png": picture(
            scene, frames, f"{result.model.name}, {float(result.time[k]):g} ms", message
        )
        for time, scene, k in zip(at_ms, scenes, at, strict=True)
    }


def _colours(result: Result, at: Ints) -> tuple[str, str, Floats, float]:
    """The quantity that colours the boxes, its unit, values at states, (t, boxes), and the greatest of the
    run: speed, and curvature for a sheet at rest."""
    every = np.arange(len(result.time))
    speeds = boxes.speed(result, every)
    if speeds.max() > 0.0:
        return "speed", "mm/s", speeds[at], float(speeds.max())
    bent = boxes.greatest(histories(result, every), speeds.shape)[1]
    return "curvature", "1/mm", bent[at], float(bent.max())
