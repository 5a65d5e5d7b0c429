"""The force of a mesh on a box of a sheet is the slope of the energy that is stored, also at its edges."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from many_pairs import States, forces, records, rest
from scipy.spatial.transform import Rotation
from solids import binary, brick, prism

from mdlgen.mechanics.mesh_tables import mesh_tables
from mdlgen.mechanics.point import DEPTH, STORED
from mdlgen.mechanics.rim import rim_table
from mdlgen.mechanics.shapes import Shapes
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats
from mdlgen.model.tables.contacts import BOX_MESH
from mdlgen.spec.load import loads

COUNT = 60
HALF = (3.35, 3.175, 0.05)
NO_LOSSES = (0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0)  # columns as in mechanics.frame
STEP = 1e-5  # mm, rad
# A roof of which one side is gentle and the other one too steep for a broad face, and a brick; with a place
# at an edge.
ROOF = prism([(-14.25, -19.4), (14.25, -19.4), (6.33, 0.0)], 45.6), (6.33, 0.0, 0.0)
EDGE = brick(40.0, 30.0, 6.0), (20.0, 0.0, 3.0)
TEXT = """
name: n
materials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}
sheets: {s: {material: m, size: [9 mm, 9 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}}
meshes: {p: {file: part.stl, mass: 1 g}}
"""


def does(shapes: Shapes, mesh: tuple[Floats, Floats], x: Floats, r: Floats) -> Floats:
    """What boxes without a free side do there; `mesh` has the place and the rotation of its body."""
    bodies, pairs = records(len(x))
    bodies["half"][:-1:2] = HALF
    pairs["kind"], pairs["k"], pairs["shared"], pairs["law"] = BOX_MESH, 300.0, 1, NO_LOSSES
    b = rest(len(x))
    return forces(bodies, pairs, shapes, States(x, r, b.u, b.w), b._replace(x=b.x + mesh[0], r=b.r @ mesh[1]))


@pytest.mark.parametrize("solid", [ROOF, EDGE], ids=["roof", "brick"])
def test_the_force_on_a_sheet_at_an_edge_is_the_slope_of_the_energy(tmp_path: Path, solid: tuple) -> None:
    """A sheet that fell on such a roof made 3 % of its energy: the force was along the one side that pressed,
    and not along the sheet's normal. It was off by up to its size at the roof, and by up to 0.4 of it at the
    brick."""
    surface, place = solid
    (tmp_path / "part.stl").write_bytes(binary(*surface))
    model = lower(loads(TEXT, folder=tmp_path))
    body = model.meshes[0].body
    mesh = model.bodies.position[body], model.bodies.rotation[body]
    shapes, random = Shapes(mesh_tables(model), rim_table(model)), np.random.default_rng(3)
    x = np.array(place) + random.uniform(-2.0, 2.0, (COUNT, 3)) * [1.0, 1.0, 0.0]
    lean = random.uniform(-0.5, 0.5, (COUNT, 2))
    r = Rotation.from_euler("xyz", np.c_[lean, random.uniform(-3.0, 3.0, COUNT)]).as_matrix()
    heights = np.arange(5.0, -1.0, -0.04)  # of which the first one that touches is taken, and 0.3 mm less
    at = x[:, None] + heights[:, None] * [0.0, 0.0, 1.0]
    stored = does(shapes, mesh, at.reshape(-1, 3), np.repeat(r, len(heights), axis=0))[:, STORED]
    x = at[np.arange(COUNT), np.argmax(stored.reshape(COUNT, -1) > 0.0, axis=1)] - [0.0, 0.0, 0.3]
    out, slope = does(shapes, mesh, x, r), np.zeros((COUNT, 6))
    for k in range(6):
        by = STEP * np.eye(3)[k % 3]
        turn = Rotation.from_rotvec(by).as_matrix()
        there = (x + by, r) if k < 3 else (x, turn @ r)
        back = (x - by, r) if k < 3 else (x, turn.T @ r)
        slope[:, k] = (does(shapes, mesh, *back)[:, STORED] - does(shapes, mesh, *there)[:, STORED]) / (
            2.0 * STEP
        )
    size = np.linalg.norm(slope[:, :3], axis=1)
    seen = (size > 1e-6) & (out[:, DEPTH] < 0.9)
    assert seen.sum() > 0.8 * COUNT
    # the rule of pressures on triangles is right to 1e-3; of torques at 3 mm of arm
    assert (np.abs(out[:, :3] - slope[:, :3]).max(axis=1) < 2e-3 * size)[seen].all()
    assert (np.abs(out[:, 3:6] - slope[:, 3:]).max(axis=1) < 6e-3 * size)[seen].all()
