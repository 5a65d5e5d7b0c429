"""Pictures of a run at some times, for print: from the side, as in the paper, and from a corner."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from mdlgen.errors import SpecError
from mdlgen.geometry.solids import CORNERS, FACES
from mdlgen.model.rotations import turns
from mdlgen.model.tables import Floats, Ints
from mdlgen.report import boxes
from mdlgen.report.figures.figure import STYLE
from mdlgen.report.meshes import machine
from mdlgen.report.motion import poses
from mdlgen.results.result import Result
from mdlgen.results.strain import histories
from mdlgen.units import parse_quantity

# the camera looks along the last of these three, with the first to the right and the second upward
_SIDE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
_AWAY = np.array([-0.55, -0.75, 0.5]) / np.linalg.norm([-0.55, -0.75, 0.5])
_LOOKS = {
    "roller": ("#b4bdc7", 1.0),
    "sector": ("#5b6670", 1.0),
    "mark": ("#d55e00", 1.0),
    "arm": ("#a98f63", 1.0),
    "mesh": ("#7d93a8", 1.0),
    "plane": ("#c8ccd2", 0.35),
    "guide": ("#7d93a8", 0.6),
}
_LIGHT = np.array([-0.3, -0.5, 0.81])


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
    scenes = [_Scene(result, place[k], matrix[k], values[k] / (most or 1.0)) for k in range(len(at))]
    message = f"colour: {name}, 0 to {most:.4g} {unit}"
    frame = [_frame([scene.points @ view.T for scene in scenes]) for view in (_SIDE, _corner())]
    return {
        f"still_{time:g}ms.png": _draw(result, scene, frame, float(result.time[k]), message)
        for time, scene, k in zip(at_ms, scenes, at, strict=True)
    }


def _colours(result: Result, at: Ints) -> tuple[str, str, Floats, float]:
    """What boxes are coloured by, its unit, values at states, (t, boxes), and the greatest of the run: speed,
    and of a sheet at rest curvature."""
    every = np.arange(len(result.time))
    speeds = boxes.speed(result, every)
    if speeds.max() > 0.0:
        return "speed", "mm/s", speeds[at], float(speeds.max())
    bent = boxes.greatest(histories(result, every), speeds.shape)[1]
    return "curvature", "1/mm", bent[at], float(bent.max())


def _corner() -> Floats:
    right = np.cross([0.0, 0.0, 1.0], _AWAY)
    right = right / np.linalg.norm(right)
    return np.array([right, np.cross(_AWAY, right), -_AWAY])


class _Scene:
    """Faces of all bodies at one state, with colours."""

    def __init__(self, result: Result, place: Floats, turn: Floats, share: Floats):
        import matplotlib
        from matplotlib.colors import to_rgb

        ramp = matplotlib.colormaps["viridis"]
        model, count = result.model, boxes.count(result.model)
        corners = np.einsum("nij,ncj->nci", turn[:count], CORNERS * model.bodies.half[:count, None])
        moved = corners + place[:count, None]
        self.faces: list[Floats] = list(moved[:, FACES].reshape(-1, 4, 3))
        self.colours: list[tuple[float, ...]] = [ramp(float(v)) for v in np.repeat(share, len(FACES))]
        self.plane: list[bool] = [False] * len(self.faces)
        # centre and normal of every box, by which what lies behind a sheet is known from what lies before it
        self.boxes = place[:count], turn[:count, :, 2]
        held = [moved.reshape(-1, 3)]
        for mesh in machine(model):
            points = mesh.points @ turn[mesh.body].T + place[mesh.body]
            colour, opacity = _LOOKS[mesh.kind]
            faces = points[mesh.triangles]
            self.faces += list(faces)
            self.colours += [(*to_rgb(colour), opacity)] * len(faces)
            self.plane += [mesh.kind == "plane"] * len(faces)
            if mesh.kind != "plane":
                held.append(points)
        self.points = np.concatenate(held)


def _frame(seen: list[Floats]) -> tuple[Floats, Floats]:
    """Least and greatest of what is seen at all times, with a margin."""
    low = np.min([points[:, :2].min(axis=0) for points in seen], axis=0)
    high = np.max([points[:, :2].max(axis=0) for points in seen], axis=0)
    margin = 0.06 * float((high - low).max())
    return low - margin, high + margin


def _draw(
    result: Result, scene: _Scene, frame: list[tuple[Floats, Floats]], time: float, message: str
) -> bytes:
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    # the user's own matplotlibrc must not change the picture
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update({**STYLE, "axes.grid": False})
        page = Figure(figsize=(8.0, 6.4), dpi=120)
        canvas = FigureCanvasAgg(page)
        page.suptitle(f"{result.model.name}, {time:g} ms", x=0.02, ha="left", fontsize=11, weight="bold")
        page.text(0.98, 0.965, message, ha="right", fontsize=9)
        tall = [(high - low)[1] / (high - low)[0] for low, high in frame]
        share = np.clip(tall[0] / (tall[0] + tall[1]), 0.2, 0.6)
        side = page.add_axes((0.08, 0.09, 0.9, 0.84 * float(share) - 0.02))
        corner = page.add_axes(
            (0.02, 0.09 + 0.84 * float(share) + 0.03, 0.96, 0.84 * float(1 - share) - 0.04)
        )
        for panel, view, (low, high) in zip((side, corner), (_SIDE, _corner()), frame, strict=True):
            _paint(panel, scene, view)
            panel.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
            panel.set_aspect("equal", adjustable="box")
        side.set(xlabel="x [mm]", ylabel="z [mm]")
        corner.set_axis_off()
        stream = io.BytesIO()
        canvas.print_png(stream, metadata={"Software": None})
    return stream.getvalue()


def _paint(panel: Any, scene: _Scene, view: Floats) -> None:
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
    count = len(FACES) * len(place)
    group = np.where(np.arange(len(middle)) < count, 1, np.where(before, 2, 0))
    group[np.array(scene.plane)] = -1
    order: Ints = np.lexsort((-(middle @ view[2]), group))
    shown = [int(k) for k in order if facing[k]]
    colours = [(*(lit[k] * np.array(scene.colours[k][:3])), scene.colours[k][3]) for k in shown]
    faces = PolyCollection([seen[k][:, :2] for k in shown], facecolors=colours)
    # lines in the faces' colour close the seams between them; of what is translucent they would be seen twice
    edges = [colour if colour[3] == 1.0 else (0.0, 0.0, 0.0, 0.0) for colour in colours]
    faces.set(edgecolors=edges, linewidths=0.3)
    panel.add_collection(faces, autolim=False)
