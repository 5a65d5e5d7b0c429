"""A sheet on a sharp edge of a mesh meets the face that it is on, and not the one behind it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from laws import box_mesh
from solids import binary, brick, prism

import mdlgen
from mdlgen.mechanics.frame import Box, Frame, Law
from mdlgen.mechanics.mesh import LOWER, NEITHER, UPPER
from mdlgen.mechanics.mesh_tables import mesh_tables
from mdlgen.mechanics.point import OUT, PRESSING
from mdlgen.model.lower import lower
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

EYE, STILL = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0)
THICK, LONG, WIDE = 0.08, 10.0, 8.0
STIFF = Law(300.0, True, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0)


def wedge(angle: float) -> bytes:
    """40 mm long and level above, its edge at x = 20 mm; below it rises to there."""
    return binary(*prism([(20.0, 0.0), (-20.0, 0.0), (-20.0, -40.0 * math.tan(math.radians(angle)))], 60.0))


def flat(folder: Path, angle: float, above: float, met: int) -> tuple[float, float]:
    """What presses on a level box, a quarter of it over the wedge, and its force; above: of its lower face
    over the wedge."""
    (folder / "part.stl").write_bytes(wedge(angle))
    text = (
        "name: n\nmaterials: {m: {E_md: 1 GPa, E_cd: 1 GPa}}\n"
        "sheets: {s: {material: m, size: [9 mm, 9 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}}\n"
        "meshes: {p: {file: part.stl, mass: 1 g}}\n"
    )
    model = lower(loads(text, folder=folder))
    mesh = model.meshes[0].body
    out = np.zeros(OUT)
    box = Frame((20.0 + LONG / 4, 0.0, above + THICK / 2), EYE, STILL, STILL)
    part = Frame(tuple(model.bodies.position[mesh]), tuple(model.bodies.rotation[mesh].ravel()), STILL, STILL)
    half = (LONG / 2, WIDE / 2, THICK / 2)
    box_mesh(out, box, Box(half, 0), part, STILL, 0, mesh_tables(model), STIFF, met=met)
    return float(out[PRESSING]), float(out[2])


def over_a_quarter(deep: float) -> tuple[float, float]:
    """The same of k z^1.5 of a quarter of the face. The energy per area, 2/5 k z^2.5 of all of it, pushes
    along the face where the edge ends the contact."""
    up, along = STIFF.k * 0.25 * deep**1.5, 0.4 * STIFF.k * deep**2.5 / LONG
    return math.hypot(up, along), up


@pytest.mark.parametrize("angle", [10.0, 20.0, 40.0, 60.0])
def test_a_box_over_a_sharp_edge_has_the_law_of_its_lower_face(tmp_path: Path, angle: float) -> None:
    """k z^1.5 of the quarter that lies on it, and nothing before it touches."""
    for above in (0.3, 0.1, 0.01):
        assert flat(tmp_path, angle, above, NEITHER) == (0.0, 0.0)
    for deep in (0.002, 0.02, 0.039):
        assert flat(tmp_path, angle, -deep, NEITHER) == pytest.approx(over_a_quarter(deep), rel=1e-4)


@pytest.mark.parametrize("angle", [10.0, 40.0])
def test_a_sheet_that_is_deep_in_an_edge_stays_on_its_side(tmp_path: Path, angle: float) -> None:
    """Deeper than half of its thickness, and than all of it, where the lower face pressed before."""
    for deep in (0.05, 0.12, 0.2):
        assert flat(tmp_path, angle, -deep, LOWER) == pytest.approx(over_a_quarter(deep), rel=1e-4)
    # from below, a sheet whose upper face was met is pushed down
    pressing, up = flat(tmp_path, angle, -0.2, UPPER)
    assert pressing > 0.0 and up < 0.0


def fall(folder: Path, part: bytes, stiffness: float, boxes: str, solver: str = "lattice") -> Result:
    """A sheet falls across the edge, which is at x = 20 mm."""
    (folder / "part.stl").write_bytes(part)
    text = (
        "name: n\nmaterials: {m: {E_md: 4 GPa, E_cd: 3 GPa}}\n"
        f"sheets: {{s: {{material: m, size: [60 mm, 30 mm], thickness: {THICK} mm, grammage: 60 g/m^2, "
        f"boxes: [{boxes}], center: [18 mm, 1 mm, 0.3 mm]}}}}\n"
        "meshes: {p: {file: part.stl}}\n"
        f"contacts: [{{between: [s, p], stiffness: {stiffness} N/mm^1.5, friction: 0.4}}]\n"
        "run: {duration: 30 ms, step: 0.02 ms}\n"
    )
    return mdlgen.solve(mdlgen.lower(mdlgen.loads(text, folder=folder)), solver)


@pytest.mark.parametrize(("stiffness", "boxes"), [(1.0, "8, 3"), (200.0, "8, 3"), (20.0, "1, 1")])
def test_a_sheet_falls_on_a_wedge_as_on_a_block(tmp_path: Path, stiffness: float, boxes: str) -> None:
    """Both are level above and have their edge at the same place; under the edge a sheet meets neither."""
    block = brick(40.0, 60.0, 10.0)
    below = fall(tmp_path, binary(block[0] - [0.0, 0.0, 5.0], block[1]), stiffness, boxes)
    assert below.ok, below.status
    for angle in (15.0, 50.0):
        other = fall(tmp_path, wedge(angle), stiffness, boxes)
        assert other.ok, other.status
        assert np.abs(other.position - below.position)[:, : other.model.meshes[0].body].max() < 1e-5
    if stiffness == 1.0:
        assert below.statistics.max_depth[0] > THICK / 2


def test_both_solvers_remember_the_face(tmp_path: Path) -> None:
    """The sheet sinks in by more than half of its thickness. The two integrate in different ways."""
    fast, slow = (fall(tmp_path, wedge(20.0), 1.0, "8, 3", solver) for solver in ("lattice", "exudyn"))
    assert fast.usable and slow.usable
    assert fast.statistics.max_depth[0] > THICK / 2
    assert np.abs(fast.position - slow.position).max() < 0.02
