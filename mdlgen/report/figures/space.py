"""Bodies in space as matplotlib paints them: from the side, as in the paper, and from a corner."""

from __future__ import annotations

import io
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.geometry.solids import CORNERS, FACES
from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.report import boxes
from mdlgen.report.arrows import AWAY
from mdlgen.report.figures.figure import STYLE
from mdlgen.report.meshes import Mesh, machine

# the camera looks along the last of these three, with the first to the right and the second upward
_SIDE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
_AWAY = AWAY / np.linalg.norm(AWAY)
LOOKS = {
    "roller": ("#b4bdc7", 1.0),
    "sector": ("#5b6670", 1.0),
    "mark": ("#d55e00", 1.0),
    "arm": ("#a98f63", 1.0),
    "mesh": ("#7d93a8", 1.0),
    "plane": ("#c8ccd2", 0.35),
    "guide": ("#7d93a8", 0.6),
    "drive": ("#0072b2", 1.0),
    "press": ("#009e73", 1.0),
    "motion": ("#cc79a7", 1.0),
    "load": ("#e69f00", 1.0),
}
_LIGHT = np.array([-0.3, -0.5, 0.81])


def _corner() -> Floats:
    right = np.cross([0.0, 0.0, 1.0], _AWAY)
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(_AWAY, right), -_AWAY])


VIEWS = (_SIDE, _corner())
Frame = tuple[Floats, Floats]  # least and greatest coordinates in a panel [mm], (2,) each
Over = Callable[[Any, Floats, Frame], None]  # draws over a panel, with a view and its frame


class Space:
    """Faces of all bodies at one state, with colours."""

    def __init__(
        self,
        model: Model,
        place: Floats,
        turn: Floats,
        share: Floats,
        more: tuple[Mesh, ...] = (),
        drawn: float = 1.0,
        there: NDArray[np.bool_] | None = None,
    ):
        """`place` and `turn` are of bodies and arms, (n, 3) and (n, 3, 3), `share` the colours of boxes from
        0 to 1; `more` are drawn too, in global axes where their body is -1. Boxes are drawn by `drawn` as
        large along the sheet, so that joints are seen. `there` (boxes,): boxes that are, None: all."""
        import matplotlib
        from matplotlib.colors import to_rgb

        ramp = matplotlib.colormaps["viridis"]
        count = boxes.count(model)
        half = model.bodies.half[:count, None] * [drawn, drawn, 1.0]
        corners = np.einsum("nij,ncj->nci", turn[:count], CORNERS * half)
        own = np.arange(count) if there is None else np.flatnonzero(there)
        moved = corners[own] + place[own, None]
        self.faces: list[Floats] = list(moved[:, FACES].reshape(-1, 4, 3))
        self.colours: list[tuple[float, ...]] = [ramp(float(v)) for v in np.repeat(share[own], len(FACES))]
        self.plane: list[bool] = [False] * len(self.faces)
        # centre and normal of every box, which separate parts behind a sheet from those in front of it
        self.of_boxes, near = len(self.faces), own if own.size else np.arange(count)
        self.boxes = place[near], turn[near, :, 2]
        held = [moved.reshape(-1, 3)]
        for mesh in (*machine(model), *more):
            points = mesh.points if mesh.body < 0 else mesh.points @ turn[mesh.body].T + place[mesh.body]
            colour, opacity = LOOKS[mesh.kind]
            faces = points[mesh.triangles]
            self.faces += list(faces)
            self.colours += [(*to_rgb(colour), opacity)] * len(faces)
            self.plane += [mesh.kind == "plane"] * len(faces)
            if mesh.kind != "plane":
                held.append(points)
        self.points = np.concatenate(held)


def frame(seen: list[Floats]) -> Frame:
    """Least and greatest visible coordinates at all times, with a margin."""
    low = np.min([points[:, :2].min(axis=0) for points in seen], axis=0)
    high = np.max([points[:, :2].max(axis=0) for points in seen], axis=0)
    margin = 0.06 * float((high - low).max())
    return low - margin, high + margin


def picture(space: Space, frames: list[Frame], title: str, message: str, over: Over | None = None) -> bytes:
    """PNG of both views, of which each has its frame: from a corner above, from the side below, with axes."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    # the user's own matplotlibrc must not change the picture
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update({**STYLE, "axes.grid": False})
        page = Figure(figsize=(8.0, 6.4), dpi=120)
        canvas = FigureCanvasAgg(page)
        page.suptitle(title, x=0.02, ha="left", fontsize=11, weight="bold")
        page.text(0.98, 0.965, message, ha="right", fontsize=9)
        tall = [(high - low)[1] / (high - low)[0] for low, high in frames]
        share = np.clip(tall[0] / (tall[0] + tall[1]), 0.2, 0.6)
        side = page.add_axes((0.08, 0.09, 0.9, 0.84 * float(share) - 0.02))
        corner = page.add_axes(
            (0.02, 0.09 + 0.84 * float(share) + 0.03, 0.96, 0.84 * float(1 - share) - 0.04)
        )
        for panel, view, (low, high) in zip((side, corner), VIEWS, frames, strict=True):
            _paint(panel, space, view)
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
            panel.set_aspect("equal", adjustable="box")
            if over is not None:
                over(panel, view, (low, high))
        side.set(xlabel="x [mm]", ylabel="z [mm]")
        corner.set_axis_off()
        stream = io.BytesIO()
        canvas.print_png(stream, metadata={"Software": None})
    return stream.getvalue()


def _paint(panel: Any, scene: Space, view: Floats) -> None:
    """Planes, then what lies behind the nearest box, boxes, and the rest; the furthest of each first."""
    from matplotlib.collections import PolyCollection
    from scipy.spatial import KDTree

    seen = [face @ view.T for face in scene.faces]
    normals = np.array([np.cross(face[1] - face[0], face[2] - face[1]) for face in scene.faces])
    size = np.linalg.norm(normals, axis=1)
    facing = normals @ view[2] < 0.0
    lit = 0.72 + 0.28 * np.abs(normals @ _LIGHT) / np.where(size > 0.0, size, 1.0)
    middle = np.array([face.mean(axis=0) for face in scene.faces])
    place, normal = scene.boxes
    near = KDTree(place).query(middle)[1]
    toward = normal[near] * -np.sign(normal[near] @ view[2])[:, None]
    before = np.einsum("ni,ni->n", middle - place[near], toward) > 0.0
    group = np.where(np.arange(len(middle)) < scene.of_boxes, 1, np.where(before, 2, 0))
    group[np.array(scene.plane)] = -1
    order: Ints = np.lexsort((-(middle @ view[2]), group))
    shown = [int(k) for k in order if facing[k]]
    colours = [(*(lit[k] * np.array(scene.colours[k][:3])), scene.colours[k][3]) for k in shown]
    faces = PolyCollection([seen[k][:, :2] for k in shown], facecolors=colours)
    # lines in the faces' colour close the seams between them; of what is translucent they would be seen twice
    edges = [colour if colour[3] == 1.0 else (0.0, 0.0, 0.0, 0.0) for colour in colours]
    faces.set(edgecolors=edges, linewidths=0.3)
    panel.add_collection(faces, autolim=False)
