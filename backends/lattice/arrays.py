"""The Model as record arrays for compiled code, in the Model's units (mm, N, g, ms, rad).

Free boxes are the nodes of the lattice, with six unknowns each. They are numbered along the shorter side of
the sheet first, so that neighbours have close numbers and the matrix is a band. Free rollers turn (one
unknown), pressed ones also slide, those on an arm swing (one more), and pressed plates slide: these unknowns
are the border of the matrix. Everything else is held or driven.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mdlgen.backends.lattice.bristles import bristles_of
from mdlgen.backends.lattice.hinges import Yielding, yielding
from mdlgen.backends.lattice.kernels.state import (
    OWN,
    OWN_INERTIA,
    OWN_MASS,
    OWN_REACH,
    OWN_SIZE,
    Tables,
)
from mdlgen.backends.lattice.search import Search, plan
from mdlgen.mechanics.corner import corners_of
from mdlgen.mechanics.curve import curve_points
from mdlgen.mechanics.gate import GATE
from mdlgen.mechanics.over_time import Changing, changing
from mdlgen.mechanics.pack import (
    gravity,
    number,
    pack_bodies,
    pack_bushings,
    pack_laws,
    pack_loads,
    pack_pairs,
)
from mdlgen.mechanics.records import (
    BODIES,
    CONSTANTS,
    CONTACT,
    CURVE,
    ENDS_OF_JOINT,
    FRAMES,
    OF_BODY,
)
from mdlgen.mechanics.shapes import Shapes, shape_tables
from mdlgen.model.tables import BOX_BOX, BOX_MESH, CYLINDER_MESH, SUPPORT, Floats, Ints, Model

if TYPE_CHECKING:
    from mdlgen.backends.lattice.symmetry.mirror import Mirror

BODY = np.dtype(
    [
        ("node", "i8"),  # number of a free box, -1: not free
        ("slide", "i8"),  # number in the border, -1: none
        ("spin", "i8"),
        *OF_BODY,
    ]
)
JOINT = np.dtype(
    [
        *ENDS_OF_JOINT,  # arms to the middle of both bushings
        ("plain", "i8"),  # both frames are the bodies' own
        *FRAMES,
        ("e", "f8", 3),  # from the middle to one of two equal bushings, in bushing axes; 0: one bushing
        *CONSTANTS,  # sums of both
        ("time", "f8"),  # damping time of its material, the least of MD and CD [ms]; 0: damped by a ratio
        ("mirrored", "i8"),  # one end is the image of the other, see mirror
        *CURVE,
    ]
)
PAIR = np.dtype(
    [
        *BODIES,
        ("row", "i8"),  # of the contacts
        ("mark", "i8"),  # its place among the marks of pairs that have touched
        *CONTACT,
        ("sticking", "f8"),  # k_t/k of two boxes [mm^0.5], 0: friction does not stick
        ("held", "i8"),  # its place among Tables.held, from 1 on; 0: no bristle holds it
    ]
)
# A mirrored body: the image of body `of` in the plane normal . x = at, with its axes times `signs`.
IMAGE = np.dtype([("body", "i8"), ("of", "i8"), ("normal", "f8", 3), ("at", "f8"), ("signs", "f8", 3)])


class System(NamedTuple):
    """All records of the scene of a run. The last row of the bodies is the ground."""

    bodies: np.ndarray  # BODY, (n + 1,).
    joints: np.ndarray  # JOINT.
    pairs: np.ndarray  # PAIR, with unused rows for those that are searched.
    loads: np.ndarray  # LOAD.
    gravity: Floats
    nodes: Ints  # body of each node.
    sheets: Ints  # sheet of each node; the free boxes of a sheet are all connected.
    offsets: Ints  # distances in nodes between two nodes that a joint couples, from 0 on.
    border: int  # number of unknowns of rollers and pressed plates.
    folded: int  # number of bushings that share a joint with another one.
    points: np.ndarray  # points of the curves that joints follow, mechanics.curve.POINT.
    images: np.ndarray  # IMAGE of boxes that joints of a halved scene need.
    mirror: Mirror | None  # plane that halves it, None: this is the whole scene.
    search: Search  # neighbour search for boxes of two sheets.
    marks: int  # number of all possible pairs.
    bristles: np.ndarray  # as in Tables.
    held: np.ndarray
    yields: Yielding
    shapes: Shapes
    corners: np.ndarray  # mechanics.corner.CORNER
    changes: Changing

    @property
    def reach(self) -> int:
        """Greatest distance in nodes between two nodes that a joint couples."""
        return int(self.offsets[-1])

    @property
    def moving(self) -> Ints:
        """Bodies that turn or slide: rollers, pressed plates, and bodies with a prescribed place."""
        turns, slides = (self.bodies["axis"] != 0.0).any(axis=1), self.bodies["slide"] >= 0
        return np.flatnonzero(turns | slides | (self.bodies["swings"] >= GATE))

    @property
    def runs(self) -> Ints:
        """Consecutive joints of one sheet: the first, the end, and the number of the sheet."""
        sheet = np.full(len(self.bodies), -1, np.int64)
        sheet[self.nodes] = self.sheets
        of = np.maximum(sheet[self.joints["a"]], sheet[self.joints["b"]])  # one end may be fixed
        of = np.maximum(of, 0)
        begins = np.flatnonzero(np.diff(of, prepend=-1))
        ends = np.append(begins, len(of))[1:]
        return np.stack([begins, ends, of[begins]], axis=1)

    def _corners(self) -> np.ndarray:
        """The corners, with the number of the run of their joints."""
        corners, runs = self.corners.copy(), self.runs
        for k in range(len(runs)):
            corners["run"][corners["sheet"] == runs[len(runs) - 1 - k, 2]] = len(runs) - 1 - k
        return corners

    @property
    def tables(self) -> Tables:
        """Records of the scene for compiled code."""
        return Tables(
            bodies=self.bodies,
            joints=self.joints,
            pairs=self.pairs,
            listed=self.search.listed,
            loads=self.loads,
            gravity=self.gravity,
            nodes=self.nodes,
            boxes=boxes_of(self.bodies, self.nodes),
            moving=self.moving,
            runs=self.runs,
            thinnest=thinnest_of(self.bodies, self.search.regions),
            points=self.points,
            images=self.images,
            bristles=self.bristles,
            held=self.held,
            hinges=self.yields.hinges,
            shapes=self.shapes,
            corners=self._corners(),
            changes=self.changes,
        )


def boxes_of(bodies: np.ndarray, nodes: Ints) -> Floats:
    """Most used values of free boxes, see state.Tables."""
    own = bodies[nodes]
    boxes = np.zeros((len(nodes), OWN))
    boxes[:, OWN_MASS], boxes[:, OWN_SIZE] = own["mass"], own["half"][:, 0] + own["half"][:, 1]
    boxes[:, OWN_REACH] = np.sqrt((own["half"] ** 2).sum(axis=1))
    boxes[:, OWN_INERTIA:] = own["inertia"]
    return boxes


def thinnest_of(bodies: np.ndarray, regions: np.ndarray) -> float:
    """Half thickness of the thinnest box of the sheets of all regions; a very large number where there are
    none, since no two boxes can pass through each other."""
    half, least = bodies["half"][:, 2], 1e300
    for first, many in (("a", "many_a"), ("b", "many_b")):
        for row in regions:
            least = min(least, float(half[row[first] : row[first] + row[many]].min()))
    return least


def build(model: Model, fold: bool = True) -> System:
    """Arrays of a Model; `fold`: merges adjacent equal bushings into one joint."""
    bodies, nodes, border = _bodies(model)
    joints, of = _joints(model, fold)
    listed, found = _pairs(model)
    bristles, held = bristles_of(model, bodies, listed)
    corners = corners_of(model, joints["row"])
    pairs, search, marks = plan(model, listed)
    for name in ("shared", "k", "law", "sticking"):
        search.regions[name] = found[name]
    loads, weight = pack_loads(model), gravity(model)
    return System(
        bodies=bodies,
        joints=joints,
        pairs=pairs,
        loads=loads,
        gravity=weight,
        nodes=nodes,
        sheets=np.searchsorted([s.first for s in model.sheets], nodes, side="right") - 1,
        offsets=offsets(bodies, joints, corners),
        border=border,
        folded=len(of) - len(joints),
        points=curve_points(model.curves),
        images=np.zeros(0, IMAGE),
        mirror=None,
        search=search,
        marks=marks,
        bristles=bristles,
        held=held,
        yields=yielding(model, joints, of),
        shapes=shape_tables(model),
        corners=corners,
        changes=changing(model, loads, weight),
    )


def _bodies(model: Model) -> tuple[np.ndarray, Ints, int]:
    table = model.bodies
    bodies = pack_bodies(model, BODY)
    nodes: list[int] = []
    for sheet in model.sheets:
        grid = np.arange(sheet.first, sheet.first + sheet.count).reshape(sheet.n_y, sheet.n_x)
        order = grid.ravel() if sheet.n_x <= sheet.n_y else grid.T.ravel()
        nodes += [int(b) for b in order if not table.fixed[b]]
    bodies["node"] = -1
    bodies["node"][nodes] = np.arange(len(nodes))
    border = number(model, bodies, 0)
    return bodies, np.array(nodes, dtype=np.int64), border


def _joints(model: Model, fold: bool) -> tuple[np.ndarray, Ints]:
    """Bushings as joints, and the joint of each; two equal linear ones between the same bodies become one,
    exactly."""
    table = model.bushings
    single = pack_bushings(model, JOINT, np.arange(len(table)))
    for k, sheet in enumerate(model.sheets):
        if sheet.damping_times is not None:
            own = (table.sheet == k) & (table.kind != SUPPORT)
            single["time"][own] = min(sheet.damping_times)
    joints, of = _fold(single) if fold else (single, np.arange(len(single)))
    own = np.eye(3).ravel()
    for name in ("fa", "fb"):
        joints[name][np.abs(joints[name] - own).max(axis=1) < 1e-14] = own
    joints["plain"] = ((joints["fa"] == own) & (joints["fb"] == own)).all(axis=1)
    return joints, of


def _fold(single: np.ndarray) -> tuple[np.ndarray, Ints]:
    """One joint for each two that are alike, in the place of the first; and the joint of each."""
    ends = np.stack([single["a"], single["b"]])
    order = np.lexsort(ends)
    one, two = order[:-1], order[1:]
    alike = (ends[:, one] == ends[:, two]).all(axis=0) & _alike(single[one], single[two])
    chosen: list[int] = []
    for k in np.flatnonzero(alike).tolist():
        if not chosen or chosen[-1] != k - 1:  # else its first one is folded already
            chosen.append(k)
    joints = single.copy()
    joints[one[chosen]] = _folded(single[one[chosen]], single[two[chosen]])
    left = np.ones(len(joints), bool)
    left[two[chosen]] = False
    of = np.cumsum(left) - 1
    of[two[chosen]] = of[one[chosen]]
    return joints[left], of


def _alike(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """Tests whether bushings are equal except for their place, which must be the same relative to both
    bodies. They must be linear, since two curves at different gaps do not add up to one."""
    same = (one["first"] < 0) & (two["first"] < 0)
    for name in ("k", "c", "fa", "fb"):
        same &= (one[name] == two[name]).all(axis=1)
    a, b = (np.einsum("nji,nj->ni", _axes(one, end), two["r" + end] - one["r" + end]) for end in "ab")
    return same & (np.abs(a - b).max(axis=1) <= 1e-12 * np.abs(a).max(axis=1))


def _folded(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    both = one.copy()
    for name in ("ra", "rb"):
        both[name] = 0.5 * (one[name] + two[name])
    both["e"] = np.einsum("nji,nj->ni", _axes(one, "a"), two["ra"] - one["ra"]) / 2
    both["k"], both["c"] = 2 * one["k"], 2 * one["c"]
    return both


def _axes(joints: np.ndarray, end: str) -> np.ndarray:
    return joints["f" + end].reshape(-1, 3, 3)


def _pairs(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """The Model's pairs except those of two sheets, and the laws of the latter, one for each contact."""
    kind = model.contacts.kind
    kept = np.flatnonzero(kind[model.pairs.contact] != BOX_BOX)
    searched = np.flatnonzero(kind == BOX_BOX)
    pairs, found = pack_pairs(model, PAIR, kept), pack_laws(model, PAIR, searched)
    for records, rows in ((pairs, model.pairs.contact[kept]), (found, searched)):
        records["row"], records["mark"] = rows, np.arange(len(rows))
        records["sticking"] = model.contacts.sticking[rows] / model.contacts.stiffness[rows]
    return pairs, found


def partner(model: Model, pair: Any) -> int:
    """Body whose name stands for the second one of a pair: a mesh that moves with another body."""
    return (
        model.meshes[int(pair["mesh"])].body if pair["kind"] in (BOX_MESH, CYLINDER_MESH) else int(pair["b"])
    )


def offsets(bodies: np.ndarray, joints: np.ndarray, corners: np.ndarray) -> Ints:
    """Distances in nodes between two nodes that a joint or a corner couples, from 0 on."""
    ends = [np.stack([joints["a"], joints["b"]])]
    for i in (0, 1):
        for j in (2, 3):
            one, two = corners["joint"][:, i], corners["joint"][:, j]
            one, two = one[(one >= 0) & (two >= 0)], two[(one >= 0) & (two >= 0)]
            ends += [np.stack([joints[p][one], joints[q][two]]) for p in "ab" for q in "ab"]
    a, b = bodies["node"][np.concatenate(ends, axis=1)]
    both = (a >= 0) & (b >= 0)
    return np.unique(np.append(np.abs(a - b)[both], 0)).astype(np.int64)
