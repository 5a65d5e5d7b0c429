"""Maps of the sheets: which joints bore most, in membrane strain and in curvature, over the run."""

from __future__ import annotations

import io
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from mdlgen.model.grid import box_nodes, local
from mdlgen.model.tables import GROUND, Floats, Model, SheetPart
from mdlgen.report.figures.figure import STYLE
from mdlgen.results.result import Result
from mdlgen.results.strain import SheetJoints

_COLOURS = "viridis"  # rises evenly for all readers and in grey
_WAYS = ("x (MD)", "y (CD)")
# Round-off of a sheet that bears nothing is not shown as if it were a pattern.
_NOTHING = 1e-10
# Inches: the longer side of a sheet, the widest a sheet or a page gets, gaps, the writing above a map.
_LONG, _WIDEST, _PAGE, _GAP, _HEAD = 2.8, 8.0, 9.0, 0.3, 0.55
_NARROWEST = 1.8  # width of the text


class Map(NamedTuple):
    """A quantity of one sheet along one axis."""

    sheet: SheetPart
    title: str
    cells: Floats  # sheet axes from the centre [mm], (n, 4, 2)
    values: Floats
    place: Floats  # middle of the cell of the greatest, (2,)

    @property
    def parts(self) -> Floats:
        """Values relative to the greatest one, 0 where there is only round-off, (n,)."""
        most = float(self.values.max())
        return self.values / most if most >= _NOTHING else np.zeros_like(self.values)

    @property
    def scale(self) -> float:
        """Inches per mm."""
        x, y = self.outline
        return _LONG / y if y > x else min(_WIDEST, _LONG * x / y) / x

    @property
    def outline(self) -> Floats:
        return np.array(self.sheet.outline)


def strain_map(result: Result) -> bytes:
    """PNG with a map for strain and for curvature, along each axis of each sheet that has joints.

    Each joint is the rectangle of material that it stands for, where it lay in the flat sheet, coloured by
    its peak over the stored times as a part of the greatest; a ring is around that one. All stands in one
    coordinate system of inches, since axes and their ticks would take longer than many a run. The same
    result gives the same bytes.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    panels = maps(result)
    sizes = np.array([panel.outline * panel.scale for panel in panels] or [(0.0, 0.0)])
    width, height = np.maximum(sizes.max(axis=0), (_NARROWEST, 0.0)) + np.array([_GAP, _GAP + _HEAD])
    columns = max(1, min(len(panels), int(_PAGE // width)))
    rows = -(-len(panels) // columns)
    page_width, page_height = max(5.0, columns * width + _GAP), rows * height + 2 * _HEAD
    # the user's own matplotlibrc must not change the picture
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        page = Figure(figsize=(page_width, page_height), dpi=120)
        canvas = FigureCanvasAgg(page)
        paper = page.add_axes((0.0, 0.0, 1.0, 1.0))
        paper.set(xlim=(0.0, page_width), ylim=(0.0, page_height))
        paper.set_axis_off()
        message = "the most that each joint bore" if panels else "single boxes have no joints"
        title = f"{result.model.name}: {message}"
        paper.text(_GAP, page_height - 0.3, title, fontsize=11, weight="bold")
        for number, panel in enumerate(panels):
            row, column = divmod(number, columns)
            _draw(paper, panel, _GAP + column * width, page_height - _HEAD - row * height)
        if panels:
            _key(paper)
        stream = io.BytesIO()
        canvas.print_png(stream, metadata={"Software": None})
    return stream.getvalue()


def maps(result: Result) -> list[Map]:
    """Maps of strain and curvature, along each axis of each sheet that has joints: their peaks over the
    run."""
    if result.strains is None:
        return []
    strains = result.strains
    model, joints = result.model, strains.joints
    cells = _cells(model, joints)
    found = []
    for index, sheet in enumerate(model.sheets):
        for what, unit, values, at in (
            ("strain", "", np.maximum(strains.stretch.value, 0.0), strains.stretch.at),
            ("curvature", " 1/mm", np.abs(strains.curvature.value), strains.curvature.at),
        ):
            for axis, way in enumerate(_WAYS):
                mine = (joints.sheet == index) & (joints.axis == axis)
                if not mine.any():
                    continue
                most = int(np.argmax(np.where(mine, values, -1.0)))
                when = "" if model.run.analysis == "static" else f" at {at[most]:.4g} ms"
                record = f"{values[most]:.3g}{unit}{when}"
                if values[most] < _NOTHING:
                    record = f"below {_NOTHING:g}{unit}"
                name = f"{sheet.name}, {what} along {way}\n{record}"
                found.append(Map(sheet, name, cells[mine], values[mine], cells[most].mean(axis=0)))
    return found


def _cells(model: Model, joints: SheetJoints) -> Floats:
    """Corners of the material that each joint stands for, in sheet axes from the centre [mm], (n, 4, 2)."""
    bodies = model.bodies
    places = np.zeros((len(bodies.name), 2))
    for sheet in model.sheets:
        boxes = slice(sheet.first, sheet.first + sheet.count)
        places[boxes] = local(sheet, *box_nodes(sheet))[:, :2]
    start = np.where((joints.a == GROUND)[:, None], joints.at, places[joints.a])
    end = places[joints.b]
    row = np.arange(len(joints))
    along, across = np.zeros((len(joints), 2)), np.zeros((len(joints), 2))
    along[row, joints.axis] = (end - start)[row, joints.axis]
    across[row, 1 - joints.axis] = bodies.half[joints.b, 1 - joints.axis]
    return np.stack([start - across, start + along - across, start + along + across, start + across], axis=1)


def _draw(paper: Any, panel: Map, left: float, top: float) -> None:
    from matplotlib.collections import PolyCollection
    from matplotlib.patches import Rectangle

    size = panel.outline * panel.scale
    corner = np.array([left, top - _HEAD - size[1]])
    middle = corner + size / 2
    cells = PolyCollection(
        list(middle + panel.cells * panel.scale), array=panel.parts, cmap=_COLOURS, edgecolors="face"
    )
    cells.set(clim=(0.0, 1.0), linewidths=0.1)
    paper.add_collection(cells, autolim=False)
    paper.add_patch(Rectangle(tuple(corner), *size, fill=False, edgecolor="#888888", linewidth=0.6))
    if panel.parts.any():
        paper.plot(
            *(middle + panel.place * panel.scale), "o", markersize=9, mfc="none", mec="#D55E00", mew=1.6
        )
    paper.text(left, top - _HEAD + 0.08, panel.title, fontsize=8, va="bottom", linespacing=1.3)


def _key(paper: Any) -> None:
    """The colours from zero to the greatest of each map."""
    from matplotlib.collections import PolyCollection

    steps, left, low, wide, high = 48, _GAP, 0.22, 1.6, 0.12
    x = left + wide * np.arange(steps + 1) / steps
    cells = [[(a, low), (b, low), (b, low + high), (a, low + high)] for a, b in pairwise(x)]
    paper.add_collection(
        PolyCollection(cells, array=np.arange(steps), cmap=_COLOURS, edgecolors="face"), autolim=False
    )
    paper.text(left, low - 0.04, "0", fontsize=8, va="top", ha="left")
    paper.text(left + wide, low - 0.04, "greatest of each map (ring)", fontsize=8, va="top", ha="left")
