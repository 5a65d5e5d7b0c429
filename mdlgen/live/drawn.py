"""The drawing data of a run for the page, as JSON: of the whole, of the part so far, and of its start."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from mdlgen.report import boxes
from mdlgen.report.animation import animation, at_the_start, colour, frames
from mdlgen.report.html.environment import environment
from mdlgen.report.html.labels import labels
from mdlgen.report.html.page import run_record

if TYPE_CHECKING:
    from mdlgen.model.tables import Ints, Model
    from mdlgen.results.result import Result

NAME = "current"
SECTIONS = ("headline", "numbers", "events", "lints", "map")
MOST_OF_PART = 80  # states of a part that is shown during the run, and of a draft
COLOURS = (("speed", "mm/s"), ("strain", ""), ("curvature", "1/mm"), ("contact", "N"))


def finished(result: Result, draft: bool) -> bytes:
    """A run that came to its end, or failed: animation, figures, and the pieces of the page that are text."""
    if not _is_finite(result):
        return b""
    record = run_record(result, NAME, _few(result) if draft else None)
    drawn = record.pop("drawn")
    pieces: Any = environment().get_template("parts.html.j2").module
    html = {
        name: str(pieces.headline(record) if name == "headline" else getattr(pieces, name)(record, False))
        for name in SECTIONS
        if not (draft and name == "map")
    }
    return _json({**drawn, "html": html})


def partial(result: Result) -> bytes:
    """The states so far, few of them, in the colours of speed; the others take long, and come at the end."""
    if not _is_finite(result):
        return b""
    shown = _few(result)
    speed = boxes.speed(result, shown)
    colours = {name: (unit, speed if name == "speed" else np.zeros_like(speed)) for name, unit in COLOURS}
    drawn = {"animation": animation(result, shown, colours), **labels(result.model)}
    return _json({"name": NAME, "scene": result.model.name, **drawn})


def _few(result: Result) -> Ints:
    """Stored states that are drawn where another picture soon follows."""
    shown = frames(result)
    if len(shown) <= MOST_OF_PART:
        return shown
    return np.unique(np.linspace(0, len(result.time) - 1, MOST_OF_PART).astype(np.int64))


def begun(model: Model) -> bytes:
    """A scene before its first step."""
    none = np.zeros((1, boxes.count(model)))
    colours = [colour(name, unit, none) for name, unit in COLOURS]
    drawn = {**at_the_start(model, colours), "static": False}
    return _json({"name": NAME, "scene": model.name, "animation": drawn, **labels(model)})


def _is_finite(result: Result) -> bool:
    arrays = (result.position, result.rotation, result.velocity, result.spin)
    return all(bool(np.isfinite(array).all()) for array in arrays)


def _json(value: Any) -> bytes:
    return json.dumps(value, allow_nan=False, separators=(",", ":")).encode()
