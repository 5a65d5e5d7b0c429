"""The states of a run, small enough to be mailed: positions and rotations of bodies as 16-bit numbers."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Collection
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.model.passing import begun_stays
from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.report import boxes
from mdlgen.report.meshes import machine, moving
from mdlgen.report.motion import names, poses, start
from mdlgen.report.sights import covered, sights

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Boxes times states of a page, 600 boxes at 501 states; more states than FRAMES are not seen one by one.
MOST, FRAMES = 600 * 501, 1000
WHOLE = 32767  # of a 16-bit number
# Part of the values that the colours leave out, where the greatest is FAR times the rest. Colours begin at
# the least value where that is NEAR of the greatest.
OUTLIERS, FAR, NEAR = 0.005, 1.5, 0.5


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


def animation(
    result: Result,
    at: Ints,
    colours: dict[str, tuple[str, Floats]],
    names: Collection[str] = (),
) -> dict[str, Any]:
    """The data that the page draws in space.

    `colours` are, by name, a unit and the values of boxes at the states `at`, (t, boxes). Those of `names`
    are parts of the ramp itself, (1, boxes). A run with one state (a static one) is shown together with its
    start.
    """
    model = result.model
    moves = np.array(moving(model), dtype=np.int64)
    place, turn = (whole[:, moves] for whole in poses(result, at))
    time = result.time[at]
    if len(at) == 1:
        before = [whole[None, moves] for whole in start(model)]
        place, turn = np.concatenate([before[0], place]), np.concatenate([before[1], turn])
        time = np.array([0.0, 1.0])
        colours = {
            k: (u, v if k in names else np.concatenate([np.zeros_like(v), v]))
            for k, (u, v) in colours.items()
        }
    packed_colours = [
        colour(name, unit, values, (0.0, 1.0) if name in names else None)
        for name, (unit, values) in colours.items()
    ]
    shown = _states(model, moves, time, place, turn, packed_colours)
    shown["meshes"] += _sensors(model, result)
    return {**shown, **_stays(model, result.stays), "static": len(at) == 1}


def at_the_start(model: Model, colours: list[dict[str, Any]]) -> dict[str, Any]:
    """As `animation` of a scene that is not run, with `colours` as `colour` makes them: the one state that it
    begins in."""
    moves = np.array(moving(model), dtype=np.int64)
    place, turn = (whole[None, moves] for whole in start(model))
    shown = _states(model, moves, np.zeros(1), place, turn, colours)
    shown["meshes"] += _sensors(model, None)
    return {**shown, **_stays(model, begun_stays(model)), "static": True}


def _stays(model: Model, stays: Floats | None) -> dict[str, Any]:
    """Times at which the boxes of each sheet are drawn: the first box, their number, begin and end [ms],
    null: never, and to the end; nothing where all are there throughout."""
    if stays is None:
        return {}
    rows = [
        [sheet.first, sheet.count, *(None if np.isnan(when) else float(when) for when in stay)]
        for sheet, stay in zip(model.sheets, stays, strict=True)
    ]
    return {"stays": rows}


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


def colour(name: str, unit: str, values: Floats, ends: tuple[float, float] | None = None) -> dict[str, Any]:
    """Values of boxes (t, boxes) as parts of a span: `ends`, or that of the values without outliers, of
    which the legend speaks."""
    least, most, beyond = (*ends, "") if ends is not None else span(values, unit)
    share = np.clip((values - least) / (most - least), 0.0, 1.0) if most > least else np.zeros_like(values)
    packed_values = packed(np.round(255 * share), "u1")
    return {
        "name": name, "unit": unit, "least": least, "most": most, "beyond": beyond, "values": packed_values,
    }  # fmt: skip


def span(values: Floats, unit: str) -> tuple[float, float, str]:
    """Range of the colours, and the values beyond it, in words.

    To the greatest value, or to that which OUTLIERS of those above zero exceed, where these are FAR above it;
    from 0, or from the least where all are near the greatest.
    """
    most, least = float(values.max(initial=0.0)), float(values.min()) if values.size else 0.0
    if most <= 0.0:
        return 0.0, most, ""
    above = values[values > 0.0]
    usual = float(np.partition(above, k := int((1.0 - OUTLIERS) * (len(above) - 1)))[k])
    beyond = ""
    if most > FAR * usual:
        part = 100.0 * float(np.count_nonzero(values > usual)) / values.size
        beyond = f"{part:.2g} % of boxes and times above, up to {most:.4g} {unit}".strip()
        most = usual
    return (least if least > NEAR * most else 0.0), most, beyond


def _sensors(model: Model, result: Result | None) -> list[dict[str, Any]]:
    """What is drawn of sensors, each with the `spans` in which it was covered [ms]."""
    return [
        {
            "name": sensor.name,
            "kind": "sensor",
            "row": -1,
            "place": [0.0, 0.0, 0.0],
            "turn": [1.0, 0.0, 0.0, 0.0],
            "points": packed(solid.points, "f4"),
            "triangles": packed(solid.triangles, "u2"),
            "spans": covered(result, sensor.name),
        }
        for sensor, solid in sights(model)
    ]


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
