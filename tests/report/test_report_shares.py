"""The colour "contact force" of boxes that touch meshes and other sheets: how a pair's force is shared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from papers import on_paper
from ran import ran
from solids import binary, brick, cylinder
from synthetic import moving

from mdlgen.model.lower import lower
from mdlgen.model.rotations import euler_parameters, matrices
from mdlgen.model.tables import BOX_MESH
from mdlgen.report import boxes
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

ON_ROLLER = ", on: r, mass: 1 g"
TWO = on_paper(
    """
name: two
materials: {{m: PLATE_PAPER}}
sheets:
  low: {{material: m, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: {low}}}
  top:
    {{material: m, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: {top}, center: {at},
     turn: {turn}}}
contacts: [{{between: [low, top], stiffness: 100 N/mm^1.5, friction: 0}}]
run: {{duration: 1 ms}}
""",
    template=True,
)
ON = on_paper(
    """
name: on
materials: {{m: PLATE_PAPER}}
sheets:
  note: {{material: m, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.3 g, boxes: [6, 4], center: {at}}}
rollers:
  r:
    {{center: [0 mm, 0 mm, -7.5 mm], axis: y, radius: 7.5 mm, width: 25 mm, mass: 1 g,
     drive: {{speed: 1 rad/s}}}}
meshes:
  part: {{file: part.stl, center: {place}{more}}}
contacts: [{{between: [note, {other}], stiffness: 100 N/mm^1.5, friction: 0}}]
run: {{duration: 1 ms}}
""",
    template=True,
)


def pressed(
    text: str, folder: Path | None = None, tilt: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> np.ndarray:
    """Force of each box where the scene starts and its only contact presses with 1 N; boxes of the last sheet
    are turned about the global axes by `tilt` [rad], about the sheet's middle."""
    model = lower(loads(text) if folder is None else loads(text, folder=folder))
    result = moving(model, times=2, speed=0.0)
    position, rotation = result.position.copy(), np.zeros(result.rotation.shape)
    rotation[:] = euler_parameters(model.bodies.rotation)
    sheet, turn = model.sheets[-1], matrices(np.array(tilt))
    rows = np.arange(sheet.first, sheet.first + sheet.count)
    position[:, rows] = sheet.center + (position[:, rows] - sheet.center) @ turn.T
    rotation[:, rows] = euler_parameters(turn @ model.bodies.rotation[rows])
    made = replace(result, position=position, rotation=rotation, contact_force=np.ones((2, 1)))
    return boxes.contact(made, np.array([1]))[0][0]


def two(
    low: str = "[3, 4]", top: str = "[2, 2]", at: str = "[0 mm, 0 mm, 0.09 mm]", turn: str = "0 deg"
) -> str:
    return TWO.format(low=low, top=top, at=at, turn=turn)


@pytest.mark.parametrize("turn", ["0 deg", "90 deg"])
def test_flat_sheets_share_by_the_area_that_lies_on_each_box(turn: str) -> None:
    force = pressed(two(turn=turn))
    low, top = force[:12].reshape(4, 3), force[12:]
    # a face of 60 x 40 turned by 90 deg covers 40 of the 60 mm: the middle column wholly, the others half
    columns = [1 / 3, 1 / 3, 1 / 3] if turn == "0 deg" else [0.25, 0.5, 0.25]
    assert low == pytest.approx(np.tile(np.array(columns) / 4, (4, 1)), rel=1e-9)
    assert top == pytest.approx(np.full(4, 0.25), rel=1e-9)


@pytest.mark.parametrize("shift", [4.0, 13.0, 27.0])
def test_a_sheet_that_lies_on_another_in_part(shift: float) -> None:
    """Six columns of 10 mm: the k-th is covered from `shift` on."""
    force = pressed(two("[6, 1]", "[1, 1]", f"[{shift} mm, 0 mm, 0.09 mm]"))
    covered = np.clip(10.0 * np.arange(1, 7) - shift, 0.0, 10.0)
    assert force[:6] == pytest.approx(covered / covered.sum(), abs=1e-9)
    assert force[6] == pytest.approx(1.0)


def test_a_tilted_sheet_presses_most_where_it_is_deepest() -> None:
    """Depth grows along x from 0 on: shares of columns as x^2.5, the integral of z^1.5."""
    tilt = 0.05 / 60  # rad: 0 to 0.05 mm
    force = pressed(two("[6, 4]", "[1, 1]", "[0 mm, 0 mm, 0.075 mm]"), tilt=(0.0, tilt, 0.0))[:24]
    edges = (np.arange(7) / 6) ** 2.5
    assert force.reshape(4, 6).sum(axis=0) == pytest.approx(np.diff(edges), abs=0.01)
    assert np.ptp(force.reshape(4, 6), axis=0).max() < 0.01 * force.max()


def test_sheets_that_only_graze_still_have_the_force_on_a_box_each() -> None:
    force = pressed(two(at="[59.99 mm, 0 mm, 0.0999 mm]"))
    assert force[:12].sum() == pytest.approx(1.0) and force[12:].sum() == pytest.approx(1.0)


@pytest.mark.parametrize("edge", [0.0, 4.0, 15.0])
def test_a_fixed_mesh_presses_by_what_of_it_lies_under_each_box(tmp_path: Path, edge: float) -> None:
    """A brick of 12 triangles under the sheet from x = edge on."""
    (tmp_path / "part.stl").write_bytes(binary(*brick(60.0, 50.0, 4.0)))
    model_text = ON.format(
        at="[0 mm, 0 mm, 0.04 mm]", place=f"[{edge + 30} mm, 0 mm, -2 mm]", more="", other="part"
    )
    force = pressed(model_text, tmp_path).reshape(4, 6)
    covered = np.clip(10.0 * np.arange(-2, 4) - edge, 0.0, 10.0)
    assert force.sum(axis=0) == pytest.approx(covered / covered.sum(), abs=0.04)
    assert force.sum(axis=1) == pytest.approx(np.full(4, 0.25), rel=0.03)


def test_a_cylinder_of_triangles_presses_as_the_roller_does(tmp_path: Path) -> None:
    """Along its axis by what of it lies on each box; across it, only the boxes that it is in."""
    (tmp_path / "part.stl").write_bytes(binary(*cylinder(7.5, 25.0, 180)))
    mesh = pressed(
        ON.format(at="[-5 mm, 0 mm, 0.03 mm]", place="[0 mm, 0 mm, -7.5 mm]", more=ON_ROLLER, other="part"),
        tmp_path,
    )
    assert mesh.sum() == pytest.approx(1.0)
    # rows of 10 mm: 2.5, 10, 10 and 2.5 mm of the 25 lie on them, in the column of the axis alone
    found = mesh.reshape(4, 6)
    assert np.flatnonzero(found.sum(axis=0) > 0.01).tolist() == [3]
    assert found[:, 3] == pytest.approx([0.1, 0.4, 0.4, 0.1], abs=0.02)


def test_every_force_of_a_run_with_meshes_is_on_some_box() -> None:
    result: Result = ran("pick", "run.duration=20 ms")
    model, at = result.model, np.arange(0, len(result.time), 4)
    force, _ = boxes.contact(result, at)
    meshes = np.flatnonzero(model.contacts.kind == BOX_MESH)
    assert result.contact_force[at][:, meshes].max() > 0.1
    total = result.contact_force[at].sum(axis=1)
    assert np.abs(force.sum(axis=1) - total).max() < 0.01 * total.max()


def test_every_force_between_notes_is_on_boxes_of_both() -> None:
    result = ran("stack", "run.duration=4 ms")
    force, _ = boxes.contact(result, np.array([-1]))
    rows = result.contact_force[-1]  # four between notes, then that of the table
    carried = [rows[4] + rows[0], rows[0] + rows[1], rows[1] + rows[2], rows[2] + rows[3], rows[3]]
    assert force[0].reshape(5, -1).sum(axis=1) == pytest.approx(carried, rel=1e-6)
