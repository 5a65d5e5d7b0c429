"""Forces of every kind of contact pair are continuous in places and velocities.

10,000 random states of each kind stand near and across what its law has: ends of plates and arcs, edges of
meshes, sides of boxes, ends of rollers. Each goes a short way in a random direction, in places, rotations and
velocities. A way is halved LEVELS times, and of both halves the one is kept over which the force changes
more: what is continuous changes as little as the way is short, a jump stays.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from many_pairs import NOTHING, States, forces, records, rest
from scipy.spatial.transform import Rotation
from solids import binary, brick, flats

from mdlgen.mechanics.by_kind import KINDS
from mdlgen.mechanics.guide import BOTH, INSIDE, OUTSIDE
from mdlgen.mechanics.mesh_tables import mesh_tables
from mdlgen.mechanics.point import DEPTH, PRESSING
from mdlgen.mechanics.rim import rim_table
from mdlgen.mechanics.shapes import Shapes
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats
from mdlgen.model.tables.contacts import (
    BOX_BOX,
    BOX_CYLINDER,
    BOX_GUIDE,
    BOX_MESH,
    BOX_PLANE,
    CYLINDER_CYLINDER,
    CYLINDER_GUIDE,
    CYLINDER_MESH,
    CYLINDER_PLANE,
)
from mdlgen.spec.load import loads

COUNT, LEVELS = 10_000, 20
K = 300.0  # [N/mm^1.5]
DEEP = 0.08  # greatest depth of a state [mm]
# How far a state goes: place [mm], rotation [rad], velocity [mm/ms], angular velocity [rad/ms].
WAY = (0.04, 0.01, 0.01, 0.003)
# Of the greatest force. A way of 2^-20 of those changes z^1.5 by less than a ten thousandth of that.
JUMP = 1e-4
LEVER = 10.0  # [mm]
SHALLOW = 0.15  # [mm]
# States of 10,000 whose force still jumps, at most, and how far, in times of the greatest force. A law that
# is made continuous takes its number down. Blocks on meshes, and two rollers, have none.
STILL = {
    "box_cylinder": 60,  # 0.05, where a free edge comes to the contact line
    "box_plane": 25,  # 0.02, at corners of a plate, where two free ends meet
    "box_guide": 15,  # 0.03, the same
    "box_arc": 100,  # 0.3, the round face where the end of the arc is oblique to the box; its long sides
    "box_box": 170,  # 2, where a side takes the contact over from the face
    "sheet_lobe": 30,  # 0.06
    "cylinder_plane": 45,  # 0.25, rollers that stand askew over an edge
    "cylinder_guide": 60,  # 0.2, the same
    "cylinder_mesh": 115,  # 0.07, the same, for each of eight slices of the roller
}
SHEET, ROLLER, OTHER = (3.35, 3.175, 0.05), (7.5, 5.0), (5.0, 8.0)


class Setup(NamedTuple):
    """States of one kind: records of bodies and pairs, shapes, and both bodies of each pair; the first ones
    come down along z until they touch."""

    bodies: np.ndarray
    pairs: np.ndarray
    shapes: Shapes
    a: States
    b: States


def turned(random: np.random.Generator, most: float, yaw: float = 3.2) -> Floats:
    """Rotations by any angle up to `yaw` about z, leaning by up to `most`; a quarter of them by 0."""
    lean = random.uniform(-most, most, (COUNT, 3)) * random.choice([0.0, 0.1, 1.0, 1.0], (COUNT, 1))
    lean[:, 2] = 0.0
    about = random.uniform(-yaw, yaw, COUNT) * random.choice([0.0, 0.05, 1.0], COUNT)
    spin = Rotation.from_rotvec(np.outer(about, [0.0, 0.0, 1.0]))
    return (Rotation.from_rotvec(lean) * spin).as_matrix()


def about(random: np.random.Generator, places: list[float], wide: float) -> Floats:
    """Places near some that matter, on either side of the origin, and anywhere between them."""
    near = random.choice(places, COUNT) * random.choice([-1.0, 1.0], COUNT) + random.normal(0, 0.1, COUNT)
    return np.where(random.random(COUNT) < 0.7, near, random.uniform(-wide, wide, COUNT))


def around(
    random: np.random.Generator,
    along: tuple[list[float], float],
    across: tuple[list[float], float],
    height: float,
) -> Floats:
    """Places of the first bodies (n, 3), clear of the second ones."""
    return np.stack([about(random, *along), about(random, *across), np.full(COUNT, height)], axis=1)


def law(random: np.random.Generator, kind: int) -> tuple[np.ndarray, np.ndarray]:
    """Records with the law, some with neither friction nor damping. Pairs share k: with `share: pair` a box
    has all of it as soon as it is over an end."""
    bodies, pairs = records(COUNT)
    pairs["kind"], pairs["k"], pairs["shared"] = kind, K, 1
    beta, mu = random.choice([0.0, 0.6], COUNT), random.choice([0.0, 0.4], COUNT)
    pairs["law"] = np.stack(
        [beta, mu, 0.7 * mu, *np.tile([[0.02], [0.04], [0.03], [0.0], [0.0], [0.0]], COUNT)], axis=1
    )
    return bodies, pairs


def moving(random: np.random.Generator, x: Floats, r: Floats) -> States:
    """Bodies at those places, at speeds of the size of those over which friction and damping change."""
    return States(x, r, 0.03 * random.normal(size=(COUNT, 3)), 0.01 * random.normal(size=(COUNT, 3)))


def boxes(bodies: np.ndarray, random: np.random.Generator, half: tuple[float, float, float]) -> None:
    """The first bodies are boxes of a sheet, with and without free sides."""
    bodies["half"][:-1:2] = half
    bodies["exposed"][:-1:2] = random.choice([0, 1, 2, 4, 8, 5, 10], COUNT)


def rollers(bodies: np.ndarray, first: int, axis: Floats, size: tuple[float, float]) -> None:
    bodies["axis"][first:-1:2], bodies["size"][first:-1:2] = axis, size


def box_cylinder(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_CYLINDER)
    boxes(bodies, random, SHEET)
    rollers(bodies, 1, np.array([0.0, 1.0, 0.0]), ROLLER)
    x = around(random, ([SHEET[0]], 5.0), ([SHEET[1] + 2.5, SHEET[1] - 2.5], 6.0), 12.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, turned(random, 0.1)), rest(COUNT))


def box_plane(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_PLANE)
    boxes(bodies, random, SHEET)
    bodies["half"][1::2], bodies["ends"][1::2] = (20.0, 15.0, 1.0), 15
    bodies["edge"][1::2] = (0.1, 0.1, 0.0)
    x = around(random, ([20.0, 23.35, 16.65], 24.0), ([15.0, 18.2], 19.0), 8.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, turned(random, 0.3)), rest(COUNT))


def plates(bodies: np.ndarray, random: np.random.Generator, arc: bool) -> States:
    """The second bodies are guides with their touched faces up, arcs turned so that an end is below x = 0."""
    bodies["ends"][1::2], bodies["edge"][1::2] = 3 if arc else 15, (0.1, 0.1, 0.0)
    bodies["half"][1::2] = (0.0 if arc else 20.0, 15.0, 0.5)
    side = random.choice([INSIDE, OUTSIDE, BOTH], COUNT)
    bodies["side"][1::2] = side
    b = rest(COUNT)
    # z of a guide is -y of the world, so that its y is up
    b.r[:] = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
    if not arc:
        down = side == OUTSIDE
        b.r[down] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
        return b
    bodies["arc"][1::2] = (20.0, 0.3, 0.5)
    round_ = (side == OUTSIDE) | ((side == BOTH) & (random.random(COUNT) < 0.5))
    base = np.where(round_, 0.5, -0.5) * np.pi  # the angle of the place that is touched
    off = random.choice([-0.5, 0.5, 0.0], COUNT) + 0.02 * random.normal(size=COUNT)
    spin = Rotation.from_rotvec(np.outer(base - 0.3 - off, [0.0, 0.0, 1.0])).as_matrix()
    b.r[:] = b.r @ spin
    b.x[:, 2] = np.where(round_, -20.0, 20.0)
    return b


def box_guide(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_GUIDE)
    boxes(bodies, random, SHEET)
    b = plates(bodies, random, arc=False)
    x = around(random, ([20.0, 23.35, 16.65], 24.0), ([15.0, 18.2], 19.0), 8.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, turned(random, 0.3)), b)


def box_arc(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_GUIDE)
    boxes(bodies, random, SHEET)
    b = plates(bodies, random, arc=True)
    x = around(random, ([0.0, 3.35], 4.0), ([0.0, 15.0, 18.2], 19.0), 6.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, turned(random, 0.2)), b)


def box_box(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_BOX)
    bodies["exposed"][1::2] = random.choice([0, 1, 2, 4, 8, 5, 10], COUNT)
    boxes(bodies, random, SHEET)
    bodies["half"][1::2] = (2.5, 4.0, 0.1)
    x = around(random, ([5.85, 0.85], 6.5), ([7.2, 0.8], 8.0), 4.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, turned(random, 0.1)), rest(COUNT))


def meshed(folder: Path, solid: Any, on: str = "") -> tuple[Shapes, Any]:
    """Tables of one mesh, and its Model."""
    (folder / "part.stl").write_bytes(binary(*solid))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [9 mm, 9 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}}\n"
        "rollers: {r: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 1 g}}\n"
        f"meshes: {{p: {{file: part.stl, mass: 1 g{on}}}}}\n"
    )
    model = lower(loads(text, folder=folder))
    return Shapes(mesh_tables(model), rim_table(model)), model


def block_mesh(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_MESH)
    boxes(bodies, random, (6.0, 4.0, 2.0))
    bodies["exposed"][:-1:2] = 15
    shapes, _ = meshed(folder, brick(40.0, 30.0, 6.0))
    x = around(random, ([20.0, 26.0, 14.0], 26.0), ([15.0, 19.0], 19.0), 14.0)
    return Setup(bodies, pairs, shapes, moving(random, x, turned(random, 0.9)), rest(COUNT))


def block_lobe(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, BOX_MESH)
    boxes(bodies, random, (6.0, 4.0, 2.0))
    bodies["exposed"][:-1:2] = 15
    rollers(bodies, 1, np.array([0.0, 1.0, 0.0]), ROLLER)
    shapes, _ = meshed(folder, flats(7.5, 5.0, 24, 6.0), ", on: r")
    b = rest(COUNT)
    b.r[:] = Rotation.from_rotvec(np.outer(random.uniform(-3, 3, COUNT), [0.0, 1.0, 0.0])).as_matrix()
    x = around(random, ([6.0], 8.0), ([6.5, 1.5], 7.0), 17.0)
    return Setup(bodies, pairs, shapes, moving(random, x, turned(random, 0.6)), b)


def sheet_lobe(random: np.random.Generator, folder: Path) -> Setup:
    made = block_lobe(random, folder)
    boxes(made.bodies, random, SHEET)
    made.bodies["exposed"][:-1:2] = 0
    return made._replace(a=made.a._replace(r=turned(random, 0.1)))


def sheet_mesh(random: np.random.Generator, folder: Path) -> Setup:
    made = block_mesh(random, folder)
    boxes(made.bodies, random, SHEET)
    made.bodies["exposed"][:-1:2] = 0
    return made._replace(a=made.a._replace(r=turned(random, 0.3)))


def cylinder_cylinder(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, CYLINDER_CYLINDER)
    rollers(bodies, 0, np.array([0.0, 1.0, 0.0]), OTHER)
    rollers(bodies, 1, np.array([0.0, 1.0, 0.0]), ROLLER)
    x = around(random, ([0.0], 8.0), ([6.5, 1.5], 7.0), 15.0)
    a = moving(random, x, rest(COUNT).r)
    return Setup(bodies, pairs, NOTHING, a, rest(COUNT))


def cylinder_plane(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, CYLINDER_PLANE)
    rollers(bodies, 0, axes_of(random), OTHER)
    bodies["half"][1::2] = (20.0, 15.0, 1.0)
    x = around(random, ([20.0], 26.0), ([15.0, 19.0, 11.0], 19.0), 15.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, rest(COUNT).r), rest(COUNT))


def axes_of(random: np.random.Generator) -> Floats:
    """Axes of rollers along y, askew and leaning."""
    return turned(random, 0.1)[:, :, 1]


def cylinder_guide(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, CYLINDER_GUIDE)
    rollers(bodies, 0, axes_of(random), OTHER)
    b = plates(bodies, random, arc=False)
    x = around(random, ([20.0], 26.0), ([15.0, 19.0, 11.0], 19.0), 15.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, rest(COUNT).r), b)


def cylinder_arc(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, CYLINDER_GUIDE)
    rollers(bodies, 0, np.array([0.0, 1.0, 0.0]), OTHER)
    b = plates(bodies, random, arc=True)
    x = around(random, ([0.0], 6.0), ([15.0, 19.0, 11.0], 19.0), 9.0)
    return Setup(bodies, pairs, NOTHING, moving(random, x, rest(COUNT).r), b)


def cylinder_mesh(random: np.random.Generator, folder: Path) -> Setup:
    bodies, pairs = law(random, CYLINDER_MESH)
    rollers(bodies, 0, axes_of(random), OTHER)
    shapes, _ = meshed(folder, brick(40.0, 30.0, 6.0))
    x = around(random, ([20.0], 26.0), ([15.0, 19.0, 11.0], 19.0), 15.0)
    return Setup(bodies, pairs, shapes, moving(random, x, rest(COUNT).r), rest(COUNT))


SETUPS: list[Callable[[np.random.Generator, Path], Setup]] = [
    box_cylinder,
    box_plane,
    box_guide,
    box_arc,
    box_box,
    block_mesh,
    block_lobe,
    sheet_mesh,
    sheet_lobe,
    cylinder_cylinder,
    cylinder_plane,
    cylinder_guide,
    cylinder_arc,
    cylinder_mesh,
]


def lowered(made: Setup, random: np.random.Generator) -> Setup:
    """The first bodies come down until they touch, and then by a random depth."""
    x = made.a.x.copy()

    def touches(down: Floats) -> Floats:
        place = made.a._replace(x=x - np.outer(down, [0.0, 0.0, 1.0]))
        return forces(made.bodies, made.pairs, made.shapes, place, made.b)[:, PRESSING] > 0.0

    clear, down, found = np.zeros(COUNT), np.zeros(COUNT), np.zeros(COUNT, bool)
    for step in np.arange(0.0, x[0, 2] + 1.0, 0.05 if x[0, 2] < 5.0 else 0.25):
        now = np.full(COUNT, step)
        hit = touches(now) & ~found
        down, found = np.where(hit, now, down), found | hit
        clear = np.where(found, clear, now)
    for _ in range(9):
        middle = 0.5 * (clear + down)
        hit = touches(middle)
        clear, down = np.where(hit, clear, middle), np.where(hit, middle, down)
    x[:, 2] -= down + random.uniform(-0.01, DEEP, COUNT)
    return made._replace(a=made.a._replace(x=x))


def along(made: Setup, way: tuple[Floats, ...], part: Floats) -> Floats:
    """Forces after a part of a way (n,)."""
    x, turn, u, w = (part[:, None] * each for each in way)
    a = made.a
    there = States(a.x + x, (Rotation.from_rotvec(turn).as_matrix() @ a.r), a.u + u, a.w + w)
    return forces(made.bodies, made.pairs, made.shapes, there, made.b)


def size_of(change: Floats) -> Floats:
    """Of forces and torques, the latter over LEVER [N]."""
    parts = np.abs(change[:, :PRESSING]).reshape(-1, 4, 3)
    return parts[:, ::2].max(axis=(1, 2)) + parts[:, 1::2].max(axis=(1, 2)) / LEVER


def jumps(made: Setup, random: np.random.Generator) -> tuple[Floats, Floats]:
    """What is left of the change of force when each way is as short as it gets, and the force there [N]; of
    ways that a run may take: what is deeper than SHALLOW at an end has come in from beside."""
    way = tuple(most * random.normal(size=(COUNT, 3)) for most in WAY)
    low, high = np.zeros(COUNT), np.ones(COUNT)
    first, last = along(made, way, low), along(made, way, high)
    for _ in range(LEVELS):
        half = 0.5 * (low + high)
        between = along(made, way, half)
        left = size_of(between - first) >= size_of(last - between)
        low, high = np.where(left, low, half), np.where(left, half, high)
        first, last = np.where(left[:, None], first, between), np.where(left[:, None], between, last)
    valid = np.maximum(first[:, DEPTH], last[:, DEPTH]) < SHALLOW
    return size_of(last - first)[valid], np.maximum(size_of(first), size_of(last))[valid]


@pytest.mark.parametrize("setup", SETUPS, ids=lambda setup: setup.__name__)
def test_the_force_of_a_pair_does_not_jump(setup: Callable[..., Setup], tmp_path: Path) -> None:
    random = np.random.default_rng(zlib.crc32(setup.__name__.encode()))
    made = lowered(setup(random, tmp_path), random)
    left, force = jumps(made, random)
    touching = force > 0.0
    assert touching.sum() > 0.3 * COUNT
    jumping = (left > JUMP * np.quantile(force[touching], 0.99)).sum()
    assert jumping <= STILL.get(setup.__name__, 0)


def test_every_kind_of_pair_is_there(tmp_path: Path) -> None:
    kinds = {int(setup(np.random.default_rng(0), tmp_path).pairs["kind"][0]) for setup in SETUPS}
    assert kinds == KINDS.keys()
