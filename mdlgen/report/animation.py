"""The states of a run, small enough to be mailed: positions and rotations of bodies as 16-bit numbers."""

from __future__ import annotations

from base64 import b64encode
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.report import boxes
from mdlgen.report.meshes import machine, moving
from mdlgen.report.motion import names, poses, start

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Boxes times states of a page, 600 boxes at 501 states; more states than FRAMES are not seen one by one.
MOST, FRAMES = 600 * 501, 1000
WHOLE = 32767  # of a 16-bit number


def frames(result: Result) -> Ints:
    """The stored states that are shown: every one, or every n-th and the last."""
    states = len(result.time)
    most = max(2, min(FRAMES, MOST // max(1, boxes.count(result.model))))
    every = max(1, -(-(states - 1) // (most - 1)))
    return thinned(states, every)


def thinned(states: int, every: int) -> Ints:
    """Every n-th of some states, and the last."""
    return np.array([*range(0, states - 1, every), states - 1], dtype=np.int64)


def packed(values: Any, kind: str) -> str:
    """Base64 of numbers, little endian."""
    return b64encode(np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<")).tobytes()).decode()


def animation(result: Result, at: Ints, colours: dict[str, tuple[str, Floats]]) -> dict[str, Any]:
    """What the page draws in space.

    `colours` are, by name, a unit and the values of boxes at the states `at`, (t, boxes). A run with one
    state (a static one) is shown beside where it began.
    """
    model = result.model
    moves = np.array(moving(model), dtype=np.int64)
    place, turn = (whole[:, moves] for whole in poses(result, at))
    time = result.time[at]
    if len(at) == 1:
        before = [whole[None, moves] for whole in start(model)]
        place, turn = np.concatenate([before[0], place]), np.concatenate([before[1], turn])
        time = np.array([0.0, 1.0])
        colours = {k: (u, np.concatenate([np.zeros_like(v), v])) for k, (u, v) in colours.items()}
    packed_colours = [colour(name, unit, values) for name, (unit, values) in colours.items()]
    return {**_states(model, moves, time, place, turn, packed_colours), "static": len(at) == 1}


def at_the_start(model: Model, colours: list[dict[str, Any]]) -> dict[str, Any]:
    """As `animation` of a scene that is not run, with `colours` as `colour` makes them: the one state that it
    begins in."""
    moves = np.array(moving(model), dtype=np.int64)
    place, turn = (whole[None, moves] for whole in start(model))
    return {**_states(model, moves, np.zeros(1), place, turn, colours), "static": True}


def _states(
    model: Model, moves: Ints, time: Floats, place: Floats, turn: Floats, colours: list[dict[str, Any]]
) -> dict[str, Any]:
    low, high = place.min(axis=(0, 1)), place.max(axis=(0, 1))
    step = np.where(high > low, (high - low) / (2 * WHOLE + 1), 1.0)
    return {
        "time": [float(t) for t in time],
        "boxes": boxes.count(model),
        "bodies": len(moves),
        "half": packed(model.bodies.half[: boxes.count(model)], "f4"),
        "low": low.tolist(),
        "step": step.tolist(),
        "place": packed(np.round((place - low) / step), "u2"),
        "turn": packed(np.round(turn * WHOLE), "i2"),
        "colours": colours,
        "meshes": _meshes(model, moves),
        "names": [names(model)[body] for body in moves],
    }


def colour(name: str, unit: str, values: Floats, most: float | None = None) -> dict[str, Any]:
    """Values of boxes (t, boxes) as parts of the greatest, or of `most`."""
    most = float(values.max(initial=0.0)) if most is None else most
    share = np.clip(values / most, 0.0, 1.0) if most > 0.0 else np.zeros_like(values)
    return {"name": name, "unit": unit, "most": most, "values": packed(np.round(255 * share), "u1")}


def _meshes(model: Model, moves: Ints) -> list[dict[str, Any]]:
    place, turn = start(model)
    rows = {int(body): k for k, body in enumerate(moves)}
    return [
        {
            "name": mesh.name,
            "kind": mesh.kind,
            "row": rows.get(mesh.body, -1),  # of the moving bodies
            "place": place[mesh.body].tolist(),
            "turn": turn[mesh.body].tolist(),
            "points": packed(mesh.points, "f4"),
            "triangles": packed(mesh.triangles, "u2"),
        }
        for mesh in machine(model)
    ]
