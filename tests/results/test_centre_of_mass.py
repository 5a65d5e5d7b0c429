"""Travel and speed of a sheet are those of its centre of mass, whatever its boxes weigh."""

from __future__ import annotations

import json

import numpy as np
import pytest

import mdlgen
from mdlgen.model.tables import Model
from mdlgen.results.compare import compare, travel
from mdlgen.results.io.series import series

SPIN = 0.5  # rad/ms
GRADED = {"grading": {"x": [1, 1, 1, 3, 5, 8]}}
ZONED = {"zones": {"heavy": {"x": ["20 mm", "50 mm"], "y": ["-30 mm", "10 mm"], "density": 3.0}}}


def spinning(about: tuple[float, float] = (0.0, 0.0), **more: object) -> Model:
    """A free sheet that turns about a point of itself [mm]."""
    velocity = np.cross([0.0, 0.0, SPIN], [-about[0], -about[1], 0.0])  # of the middle of the outline
    sheet = {
        "material": "p",
        "size": ["100 mm", "60 mm"],
        "thickness": "0.1 mm",
        "mass": "0.5 g",
        "boxes": [6, 3],
        "layout": "plate",
        "spin": ["0 rad/s", "0 rad/s", f"{SPIN * 1e3} rad/s"],
        "velocity": [f"{v!r} m/s" for v in velocity.tolist()],
        **more,
    }
    stiff = {"E_md": "3530 MPa", "E_cd": "1113 MPa", "D_md": "0.40 N*mm", "D_cd": "0.24 N*mm"}
    scene = {
        "name": "spinning",
        "gravity": ["0 m/s^2"] * 3,
        "materials": {"p": stiff},
        "sheets": {"n": sheet},
        "run": {"duration": "6.28 ms"},
    }
    return mdlgen.lower(mdlgen.loads(json.dumps(scene)))


def centre(model: Model) -> np.ndarray:
    """Of mass, worked out here [mm]."""
    mass = model.bodies.mass
    return (mass[:, None] * model.bodies.position).sum(axis=0) / mass.sum()


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize("kind", ["graded", "zoned"])
def test_a_sheet_that_turns_about_its_centre_of_mass_stays(solver: str, kind: str) -> None:
    more = GRADED if kind == "graded" else ZONED
    at = centre(spinning(**more))
    assert (np.linalg.norm(at) > 5.0) == (kind == "zoned")  # a graded sheet of one paper has it in the middle
    result = mdlgen.solve(spinning((at[0], at[1]), **more), solver)
    assert result.ok, result.status
    record = result.summary()["sheets"]["n"]
    # momentum is kept: what moves is round-off; promised are 1e-3 of its size
    assert np.linalg.norm(record["travel_mm"]) < 1e-6 * 100.0
    assert np.linalg.norm(record["speed_mm_per_s"]) < 1e-6 * SPIN * 100.0 * 1e3
    table = series(result)
    assert max(np.ptp(table[f"n.{axis}_mm"]) for axis in "xyz") < 1e-6 * 100.0
    half_a_turn = result.sheet_motion(0)[2][-1]
    assert half_a_turn == pytest.approx(SPIN * 6.28, rel=0.02)  # a sheet that spins stretches


def test_velocity_is_that_of_the_middle_of_the_outline() -> None:
    model = spinning(**ZONED)
    at = centre(model)
    mass = model.bodies.mass / model.bodies.mass.sum()
    assert mass @ model.bodies.velocity == pytest.approx(np.cross([0.0, 0.0, SPIN], at), rel=1e-12)
    result = mdlgen.solve(model, "lattice")
    # nothing acts on it: its centre of mass goes straight on
    assert travel(result) == pytest.approx(np.cross([0.0, 0.0, SPIN], at) * 6.28, rel=1e-9)


def test_the_norm_of_the_estimate_weighs_boxes_by_mass() -> None:
    model = spinning(**ZONED)
    result = mdlgen.solve(model, "lattice")
    shifted = mdlgen.solve(model, "lattice")
    box = int(np.argmax(model.bodies.mass))
    shifted.position[:, box, 2] += 1.0
    found = compare(result, shifted)
    assert found.position_rms_mm == pytest.approx(np.sqrt(model.mass_share(0)[box]), rel=1e-12)
    assert found.position_axes_mm[2] == pytest.approx(found.position_rms_mm, rel=1e-12)
