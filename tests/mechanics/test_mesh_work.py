"""The force of a mesh on a block is the gradient of a stored energy: round a closed way it does no work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from many_pairs import States, forces, records, rest
from scipy.spatial.transform import Rotation
from solids import binary, brick, flats

from mdlgen.mechanics.mesh_tables import mesh_tables
from mdlgen.mechanics.point import DEPTH, STORED
from mdlgen.mechanics.rim import rim_table
from mdlgen.mechanics.shapes import Shapes
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats
from mdlgen.model.tables.contacts import BOX_MESH
from mdlgen.spec.load import loads

STEPS = 1500  # of a way: half of them change no sum by more than a tenth of what is allowed
HALF = (6.0, 4.0, 2.0)
NO_LOSSES = (0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0)  # columns as in mechanics.frame
# Places on a brick of 40 x 30 x 6 mm, and on a lobe of the radius 7.5 mm with two flats; and from where the
# block comes there.
DOWN, ALONG = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
BRICK = {
    "face": ((4.0, 3.0, 5.0), DOWN),
    "edge": ((20.0, 2.0, 4.9), DOWN),
    "corner": ((20.0, 15.0, 4.9), DOWN),
    "end": ((25.9, 0.0, 0.0), ALONG),
}
LOBE = {"round": ((0.0, 0.0, 9.4), DOWN), "cap": ((1.0, 2.5, 9.3), DOWN), "flat": ((6.2, 1.0, 6.0), DOWN)}


def shapes(folder: Path, lobe: bool) -> Shapes:
    """Tables of one mesh, fixed or on a roller."""
    solid, on = (flats(7.5, 5.0, 60, 6.0), ", on: r") if lobe else (brick(40.0, 30.0, 6.0), "")
    (folder / "part.stl").write_bytes(binary(*solid))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [9 mm, 9 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}}\n"
        "rollers: {r: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 7.5 mm, width: 5 mm, mass: 1 g}}\n"
        f"meshes: {{p: {{file: part.stl, mass: 1 g{on}}}}}\n"
    )
    model = lower(loads(text, folder=folder))
    return Shapes(mesh_tables(model), rim_table(model))


def ways(random: np.random.Generator, wide: float, most: float, begin: Rotation) -> tuple[Floats, Rotation]:
    """A closed way: places about the origin, and rotations."""
    t = np.linspace(0.0, 2.0 * np.pi, STEPS + 1)[:, None]
    waves = [np.cos(k * t + random.uniform(0, 6, 3)) * random.normal(0, 1.0 / k, 3) for k in (1, 2)]
    turns = [np.cos(k * t + random.uniform(0, 6, 3)) * random.normal(0, 0.6 / k, 3) for k in (1, 2)]
    return wide * np.sum(waves, axis=0), Rotation.from_rotvec(most * np.sum(turns, axis=0)) * begin


@pytest.mark.parametrize("lobe", [False, True], ids=["brick", "lobe"])
def test_round_a_closed_way_a_mesh_does_no_work(tmp_path: Path, lobe: bool) -> None:
    """In place and rotation, over faces, edges and corners, and by a roller that turns."""
    random, mesh = np.random.default_rng(11), shapes(tmp_path, lobe)
    places, closed = LOBE if lobe else BRICK, 0
    for name, (place, clear) in places.items():
        for lean in (0.0, 0.3, 0.9):
            x, turn = ways(random, 0.12, 0.15, Rotation.from_rotvec([0.3 * lean, lean, 0.2]))
            spin = Rotation.from_rotvec(
                0.05 * np.outer(np.sin(np.linspace(0, 2 * np.pi, STEPS + 1)), [0, 1, 0])
            )
            x = brought_near(mesh, x + place, turn, np.array(clear))
            out = press(mesh, x, turn, spin)
            energy = out[:, STORED]
            assert energy.max() > 0.0, name
            if (
                out[:, DEPTH].max() >= 1.0
            ):  # a pressure reaches no deeper; the end of the brick comes in at once
                continue
            closed += 1
            half = 0.5 * (out[1:] + out[:-1])
            work = np.einsum("ni,ni->n", half[:, :3], np.diff(x, axis=0))
            work += np.einsum("ni,ni->n", half[:, 3:6], (turn[1:] * turn[:-1].inv()).as_rotvec())
            work += np.einsum("ni,ni->n", half[:, 9:12], (spin[1:] * spin[:-1].inv()).as_rotvec())
            # of what is stored at most; the rule of the pressures on triangles is right to 2e-4 of it
            assert abs(work.sum()) < 1e-3 * energy.max(), (name, lean)
    assert closed >= 3 * len(places) - 2


def brought_near(mesh: Shapes, x: Floats, turn: Rotation, clear: Floats) -> Floats:
    """The way, come from 8 mm towards the mesh until its deepest place is some 0.2 mm deep."""
    x, some = x + 8.0 * clear, slice(None, None, 25)
    for step in (0.2, 0.02):
        # coming back by a step after the coarse ones
        for _ in range(int(16.0 / step)):
            if press(mesh, x[some], turn[some], None)[:, DEPTH].max() > (0.0 if step > 0.1 else 0.2):
                break
            x = x - step * clear
        else:
            pytest.fail("the way does not meet the mesh")
        x = x + 0.2 * clear if step > 0.1 else x
    return x


def press(mesh: Shapes, x: Floats, turn: Rotation, spin: Rotation | None) -> Floats:
    """Forces at all places of a way at once."""
    bodies, pairs = records(len(x))
    bodies["half"][:-1:2], bodies["exposed"][:-1:2] = HALF, 15
    bodies["axis"][1::2] = (0.0, 1.0, 0.0)
    pairs["kind"], pairs["k"], pairs["shared"], pairs["law"] = BOX_MESH, 300.0, 1, NO_LOSSES
    a, b = rest(len(x)), rest(len(x))
    if spin is not None:
        b = b._replace(r=spin.as_matrix())
    return forces(bodies, pairs, mesh, States(x, turn.as_matrix(), a.u, a.w), b)
