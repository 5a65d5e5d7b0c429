"""A still of a scene as it begins, without a run and without a browser."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Model
from mdlgen.report.arrows import BREADTH, arrows, longest
from mdlgen.report.begin import Known, known
from mdlgen.report.boxes import at_start
from mdlgen.report.figures.space import VIEWS, Frame, Space, frame, picture
from mdlgen.report.meshes import Mesh
from mdlgen.report.motion import start
from mdlgen.report.sheets import parts_of_sheets

_TONES = (("x", "#d55e00"), ("y", "#009e73"), ("z", "#0072b2"))
_WARNS, _PLAIN = "#b13c00", "#1b1e22"
_BAR = 0.15  # greatest length of the scale, relative to the breadth of a panel
_ORIGIN = (34.0, 38.0)  # of the axes, from the lower left corner [points]
_JOINT = 0.95  # of a box's lengths, so that the grid is seen
_LETTER, _LINE = 4.2, 8.5  # breadth of a letter of a name and height of its line [points]


def still(model: Model) -> bytes:
    """PNG: names, axes, scale and arrows, from a corner and from the side. The same Model gives the same
    bytes."""
    place, turn = start(model)
    breadth = BREADTH * longest(model)
    more = tuple(Mesh(a.part, a.kind, -1, *a.solid(breadth)) for a in arrows(model))
    _, share = parts_of_sheets(model)
    space = Space(model, place, turns(turn), share, more, _JOINT, at_start(model))
    frames = [frame([space.points @ view.T]) for view in VIEWS]
    gravity = float(np.linalg.norm(model.gravity)) * 1000.0
    message = "not run; " + (f"gravity {gravity:.4g} m/s$^2$" if gravity else "no gravity")
    over = partial(_over, model, known(model))
    return picture(space, frames, f"{model.name}, as it begins", message, over)


def _over(model: Model, parts: list[Known], panel: Any, view: Floats, shown: Frame) -> None:
    """Names, axes with gravity, and the scale."""
    _names(parts, panel, view, shown)
    ways = [(name, np.eye(3)[k], tone) for k, (name, tone) in enumerate(_TONES)]
    size = float(np.linalg.norm(model.gravity))
    if size > 0.0:
        ways.append(("g", 0.8 * model.gravity / size, _PLAIN))
    for name, way, tone in ways:
        x, y, _ = (view @ way).tolist()
        if math.hypot(x, y) < 0.2:
            continue
        tip = (_ORIGIN[0] + 22.0 * x, _ORIGIN[1] + 22.0 * y)
        style = {
            "arrowstyle": "->",
            "color": tone,
            "linestyle": "--" if name == "g" else "-",
            "shrinkA": 0,
            "shrinkB": 0,
        }
        corner = "axes points"
        panel.annotate("", tip, _ORIGIN, xycoords=corner, textcoords=corner, arrowprops=style)
        at = (_ORIGIN[0] + 29.0 * x, _ORIGIN[1] + 29.0 * y)
        panel.annotate(name, at, xycoords=corner, color=tone, fontsize=8, ha="center", va="center")
    low, high = shown
    length = _round(_BAR * float(high[0] - low[0]))
    left = high[0] - length - 0.03 * (high[0] - low[0])
    bottom = low[1] + 0.03 * (high[1] - low[1])
    panel.plot([left, left + length], [bottom, bottom], color=_PLAIN, linewidth=2, solid_capstyle="butt")
    panel.annotate(
        f"{length:g} mm",
        (left + length / 2, bottom),
        (0, 3),
        textcoords="offset points",
        fontsize=8,
        ha="center",
    )


def _names(parts: list[Known], panel: Any, view: Floats, shown: Frame) -> None:
    """Names next to the parts' middles. A name that would cover another one is left out; names with a warning
    are placed first."""
    low, high = shown
    box = panel.get_window_extent()
    scale = 72.0 / panel.figure.dpi * min(box.width / (high[0] - low[0]), box.height / (high[1] - low[1]))
    left, bottom = (scale * value for value in low.tolist())
    taken = [(left, bottom, left + 2 * _ORIGIN[0], bottom + 2 * _ORIGIN[1])]  # the axes
    for part in sorted(parts, key=lambda p: (not p.lints, p.kind == "probe")):
        x, y, _ = (view @ np.array(part.at)).tolist()
        text = f"{part.name} !" if part.lints else part.name
        left, bottom = scale * x + 4.0, scale * y - _LINE / 2
        own = (left, bottom, left + _LETTER * len(text), bottom + _LINE)
        inside = low[0] <= x <= high[0] and low[1] <= y <= high[1]
        if not inside or any(
            own[0] < t[2] and t[0] < own[2] and own[1] < t[3] and t[1] < own[3] for t in taken
        ):
            continue
        taken.append(own)
        style = {"boxstyle": "round,pad=0.15", "facecolor": "#ffffffb8", "edgecolor": "none"}
        tone = _WARNS if part.lints else _PLAIN
        panel.annotate(
            text,
            (x, y),
            (4, 0),
            textcoords="offset points",
            fontsize=6.5,
            va="center",
            color=tone,
            bbox=style,
        )


def _round(length: float) -> float:
    """The greatest of 1, 2, 5, 10 ... that is not more."""
    tens = 10.0 ** math.floor(math.log10(length))
    return tens * next(k for k in (5.0, 2.0, 1.0) if k * tens <= length * (1.0 + 1e-9))
