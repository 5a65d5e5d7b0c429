"""The Model as record arrays for compiled code, in the Model's units (mm, N, g, ms, rad).

Free boxes are the nodes of the lattice, six unknowns each; they are numbered so that neighbours stand close
(along the shorter side of the sheet first), which makes the matrix a band. Free rollers turn (one unknown),
pressed ones also slide, and those on an arm swing (one more), and pressed plates slide: the border of the
matrix. Everything else is held or driven.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mdlgen.backends.lattice.kernels.state import Tables
from mdlgen.backends.lattice.search import Search, plan
from mdlgen.mechanics.arm import ARM, AXIAL, PRESS, arm
from mdlgen.mechanics.curve import FOLLOWS, curve_points, follow
from mdlgen.mechanics.driven import DRIVEN, drive
from mdlgen.mechanics.edge import ENDS
from mdlgen.mechanics.frame import LAW, LAW_DYNAMIC, LAW_STATIC
from mdlgen.mechanics.laws import damping_share
from mdlgen.mechanics.mesh import Meshes, mesh_numbers, mesh_tables
from mdlgen.mechanics.rim import RIM, rim
from mdlgen.model.rotations import matrices
from mdlgen.model.tables import BOX_BOX, BOX_MESH, CYLINDER_MESH, GROUND, SUPPORT, Floats, Ints, Model

if TYPE_CHECKING:
    from mdlgen.backends.lattice.mirror import Mirror

BODY = np.dtype(
    [
        ("node", "i8"),  # number of a free box, -1: not free
        ("slide", "i8"),  # number in the border, -1: none
        ("spin", "i8"),
        ("mass", "f8"),
        ("inertia", "f8", 3),
        ("half", "f8", 3),  # of a box; of a guide: half of its length, width and thickness
        ("arc", "f8", 3),  # of a guide: radius (0: straight), middle angle, half angle
        ("side", "i8"),  # of a guide, that may be touched: as in mechanics.guide
        *ENDS,
        ("exposed", "i8"),
        ("axis", "f8", 3),
        ("way", "f8", 3),  # direction of a slide
        ("press", "f8", PRESS),  # columns as in mechanics.arm
        *DRIVEN,
        ("size", "f8", 2),  # radius, of a rim the greatest, and width
        ("carries", "i8"),  # 1: a roller with a mesh on it, whose turn is followed
        *RIM,
        *ARM,
    ]
)
JOINT = np.dtype(
    [
        ("a", "i8"),
        ("b", "i8"),
        ("ra", "f8", 3),  # arms in body axes, to the middle of both bushings
        ("rb", "f8", 3),
        ("plain", "i8"),  # both frames are the bodies' own
        ("fa", "f8", 9),  # frames in body axes
        ("fb", "f8", 9),
        ("e", "f8", 3),  # from the middle to one of two equal bushings, in bushing axes; 0: one bushing
        ("k", "f8", 6),  # sums of both
        ("c", "f8", 6),
        ("time", "f8"),  # damping time of its material, the least of MD and CD [ms]; 0: damped by a ratio
        ("mirrored", "i8"),  # one end is the image of the other, see mirror
        *FOLLOWS,
    ]
)
PAIR = np.dtype(
    [
        ("kind", "i8"),
        ("a", "i8"),
        ("b", "i8"),
        ("row", "i8"),  # of the contacts
        ("mark", "i8"),  # its place among the marks of pairs that have touched
        ("shared", "i8"),
        ("mesh", "i8"),  # number of it
        ("beside", "i8"),  # sides of the box that stand before ends of a plate, see mechanics.edge
        ("k", "f8"),
        ("law", "f8", LAW),  # columns as in mechanics.frame
    ]
)
# A body is seen in the plane normal . x = at; its axes are those of the other one seen there, times `signs`.
IMAGE = np.dtype([("body", "i8"), ("of", "i8"), ("normal", "f8", 3), ("at", "f8"), ("signs", "f8", 3)])
LOAD = np.dtype([("body", "i8"), ("local", "f8", 3), ("force", "f8", 3), ("moment", "f8", 3)])


class System(NamedTuple):
    """What a run is of. The last row of the bodies is the ground."""

    bodies: np.ndarray  # BODY, (n + 1,)
    joints: np.ndarray  # JOINT
    pairs: np.ndarray  # PAIR, and room for those that are searched
    loads: np.ndarray  # LOAD
    gravity: Floats
    nodes: Ints  # body of each node
    sheets: Ints  # and its sheet; the free boxes of a sheet all hang together
    reach: int  # how many nodes apart two that are coupled may be
    border: int  # unknowns of rollers and pressed plates
    folded: int  # bushings that share a joint with another one
    points: np.ndarray  # of the curves that joints follow, mechanics.curve.POINT
    images: np.ndarray  # IMAGE: of boxes that joints of a halved scene need
    mirror: Mirror | None  # the plane that halves it, None: this is the whole
    search: Search  # of boxes of two sheets that are near each other
    marks: int  # how many pairs there can be
    meshes: Meshes

    @property
    def tables(self) -> Tables:
        """What compiled code takes first."""
        return Tables(
            bodies=self.bodies,
            joints=self.joints,
            pairs=self.pairs,
            loads=self.loads,
            gravity=self.gravity,
            nodes=self.nodes,
            points=self.points,
            images=self.images,
            meshes=self.meshes,
        )


def build(model: Model, fold: bool = True) -> System:
    """Arrays of a Model; `fold`: equal bushings side by side as one joint."""
    bodies, nodes, border = _bodies(model)
    joints, folded = _joints(model, fold)
    listed, found = _pairs(model)
    pairs, search, marks = plan(model, listed)
    for name in ("shared", "k", "law"):
        search.regions[name] = found[name]
    return System(
        bodies=bodies,
        joints=joints,
        pairs=pairs,
        loads=_loads(model),
        gravity=np.array(model.gravity),
        nodes=nodes,
        sheets=np.searchsorted([s.first for s in model.sheets], nodes, side="right") - 1,
        reach=reach(bodies, joints),
        border=border,
        folded=folded,
        points=curve_points(model.curves),
        images=np.zeros(0, IMAGE),
        mirror=None,
        search=search,
        marks=marks,
        meshes=mesh_tables(model),
    )


def _bodies(model: Model) -> tuple[np.ndarray, Ints, int]:
    table = model.bodies
    count = len(table.name)
    bodies = np.zeros(count + 1, BODY)
    for name in ("node", "slide", "spin"):
        bodies[name] = -1
    bodies["mass"][:count] = table.mass
    bodies["inertia"][:count] = table.inertia
    bodies["half"][:count] = table.half
    bodies["exposed"][:count] = table.exposed @ np.array([1, 2, 4, 8])
    bodies["size"] = 1.0
    nodes: list[int] = []
    for sheet in model.sheets:
        grid = np.arange(sheet.first, sheet.first + sheet.count).reshape(sheet.n_y, sheet.n_x)
        order = grid.ravel() if sheet.n_x <= sheet.n_y else grid.T.ravel()
        nodes += [int(b) for b in order if not table.fixed[b]]
    bodies["node"][nodes] = np.arange(len(nodes))
    border = 0
    for roller in model.rollers:
        row = bodies[roller.body]
        row["axis"], row["size"] = roller.axis, (roller.reach, roller.width)
        row["press"][AXIAL] = roller.inertia_axial + roller.carried[1]
        if roller.press is not None:
            spring = roller.press
            row["way"] = spring.direction
            force = spring.preload - spring.stiffness * (spring.start - spring.touch)
            mass = roller.mass + roller.carried[0] + spring.carrier_mass
            row["press"][:AXIAL] = (spring.stiffness, spring.damping, force, mass)
            row["slide"], border = border, border + 1
        if roller.arm is not None:
            row["slide"], border = border, border + 1
        drive(row, roller)
        rim(row, roller)
        arm(row, roller)
        if roller.turns:
            row["spin"], border = border, border + 1
    for guide in model.guides:
        row = bodies[guide.body]
        row["half"] = [0.5 * size for size in (guide.length, guide.width, guide.thickness)]
        row["arc"], row["side"] = (guide.radius, guide.middle, guide.half_angle), guide.sides
    grip = 1.0 if model.run.analysis == "static" else 0.0
    for part in (*model.planes, *model.guides):
        bodies["ends"][part.body], bodies["edge"][part.body] = part.ends, (*part.edges, grip)
    for mesh in model.meshes:
        if mesh.on >= 0:
            bodies["carries"][model.rollers[mesh.on].body] = 1
    for plate, spring in model.plates:
        row = bodies[plate.body]
        row["way"] = spring.direction
        force = spring.preload - spring.stiffness * (spring.start - spring.touch)
        row["press"][:AXIAL] = (spring.stiffness, spring.damping, force, plate.sliding_mass)
        row["slide"], border = border, border + 1
    return bodies, np.array(nodes, dtype=np.int64), border


def _joints(model: Model, fold: bool) -> tuple[np.ndarray, int]:
    """Bushings as joints; two equal linear ones between the same bodies become one, exactly."""
    table = model.bushings
    position = np.concatenate([model.bodies.position, np.zeros((1, 3))])
    rotation = np.concatenate([model.bodies.rotation, np.eye(3)[None]])
    single = np.zeros(len(table), JOINT)
    for end in "ab":
        body = getattr(table, end)
        single[end] = body
        single["r" + end] = np.einsum("nji,nj->ni", rotation[body], table.origin - position[body])
        # at rest the frame on b has turned onto the one on a
        axes = table.axes if end == "a" else table.axes @ matrices(-table.rest)
        single["f" + end] = np.einsum("nji,njk->nik", rotation[body], axes).reshape(-1, 9)
    single["k"], single["c"] = table.k, table.c
    for number, sheet in enumerate(model.sheets):
        if sheet.damping_times is not None:
            own = (table.sheet == number) & (table.kind != SUPPORT)
            single["time"][own] = min(sheet.damping_times)
    follow(single, model.curves, np.arange(len(table)))
    joints = _fold(single) if fold else single
    own = np.eye(3).ravel()
    for name in ("fa", "fb"):
        joints[name][np.abs(joints[name] - own).max(axis=1) < 1e-14] = own
    joints["plain"] = ((joints["fa"] == own) & (joints["fb"] == own)).all(axis=1)
    return joints, len(single) - len(joints)


def _fold(single: np.ndarray) -> np.ndarray:
    """One joint for each two that are alike, in the place of the first."""
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
    return np.delete(joints, two[chosen])


def _alike(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """Equal but for their place, which is the same seen from both bodies; and linear, since two curves at
    different gaps do not add up to one."""
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
    """The Model's pairs but those of two sheets, and the laws of these, one for each contact."""
    rows = model.contacts
    own = np.flatnonzero(rows.kind[model.pairs.contact] != BOX_BOX)
    chosen = model.pairs.contact[own]
    pairs = _laws(model, chosen)
    mesh, other = mesh_numbers(model)
    pairs["a"], pairs["b"], pairs["mesh"] = model.pairs.a[own], other[own], mesh[own]
    pairs["law"][:, [LAW_STATIC, LAW_DYNAMIC]] *= model.pair_friction[own, None]
    return pairs, _laws(model, np.flatnonzero(rows.kind == BOX_BOX))


def _laws(model: Model, chosen: Ints) -> np.ndarray:
    """A pair of no bodies for each of the contacts `chosen`."""
    rows = model.contacts
    pairs = np.zeros(len(chosen), PAIR)
    pairs["row"], pairs["kind"], pairs["mark"] = chosen, rows.kind[chosen], np.arange(len(chosen))
    pairs["shared"] = np.array([share == "width" for share in rows.share], dtype=int)[chosen]
    pairs["k"] = rows.stiffness[chosen]
    beta = damping_share.py_func(rows.restitution)  # compiled code is for the solver alone to load
    speeds = (rows.stiction_velocity, rows.friction_velocity, rows.smoothing)
    for column, values in enumerate((beta, rows.mu_static, rows.mu_dynamic, *speeds, rows.rolling)):
        pairs["law"][:, column] = values[chosen]
    return pairs


def partner(model: Model, pair: Any) -> int:
    """The body that the second one of a pair is called by: a mesh, where that moves with another."""
    return (
        model.meshes[int(pair["mesh"])].body if pair["kind"] in (BOX_MESH, CYLINDER_MESH) else int(pair["b"])
    )


def _loads(model: Model) -> np.ndarray:
    loads = np.zeros(len(model.loads.body), LOAD)
    for name in ("body", "local", "force", "moment"):
        loads[name] = getattr(model.loads, name)
    return loads


def reach(bodies: np.ndarray, joints: np.ndarray) -> int:
    """How many nodes apart two are that a joint couples, at most."""
    a, b = bodies["node"][joints["a"]], bodies["node"][joints["b"]]
    both = (a >= 0) & (b >= 0)
    return int(np.abs(a - b)[both].max(initial=0))


assert GROUND == -1, "the ground is the last row of the bodies"
