"""Nothing passes through: fast bodies against thin plates, rollers, guides, meshes and sheets."""

from __future__ import annotations

import os

import pytest
from asked import as_asked
from solids import binary, brick

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.spec.load import loads

SCENE = """
name: thrown
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  p: {{E_md: 1000 MPa, E_cd: 1000 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets:
  n: {{material: p, size: {size}, thickness: 0.1 mm, mass: 0.032 g, boxes: {boxes},
       center: [0 mm, 0 mm, {z!r} mm], rotation: {rotation}, velocity: [0 m/s, 0 m/s, -{speed!r} m/s],
       spin: {spin}}}
  {other}
{part}
contacts:
  - {{between: [n, t], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0.3}}
run: {{duration: {time!r} ms, print_step: {time!r} ms{step}}}
"""
FLAT, EDGE = "[0 deg, 0 deg, 0 deg]", "[90 deg, 0 deg, 0 deg]"
STILL = "[0 rad/s, 0 rad/s, 0 rad/s]"
LINE = "line: {{from: [-60 mm, 0 mm, {z}], to: [60 mm, 0 mm, {z}], axis: -y, side: {side}}}"


def plate(thick):
    return (
        f"planes: {{t: {{center: [0 mm, 0 mm, {-thick / 2!r} mm], normal: z, size: [200 mm, 200 mm, "
        f"{thick!r} mm], mass: 1 g}}}}"
    )


PARTS = {
    "plate of 0.2 mm": plate(0.2),
    "plate of 1 mm": plate(1.0),
    "roller of 0.5 mm": "rollers: {t: {center: [0 mm, 0 mm, -0.5 mm], axis: y, radius: 0.5 mm, width: 60 mm, "
    "mass: 1 g, drive: {speed: 0 rad/s}}}",
    "guide": f"guides: {{t: {{{LINE.format(z='0 mm', side='left')}, width: 80 mm, thickness: 0.4 mm}}}}",
    "guide, both sides": f"guides: {{t: {{{LINE.format(z='0 mm', side='both')}, width: 80 mm, "
    "thickness: 0.4 mm}}",
    "arc": "guides: {t: {arc: {center: [0 mm, 0 mm, -40 mm], axis: -y, radius: 40 mm, from: 30 deg, "
    "to: 150 deg, side: outside}, width: 80 mm, thickness: 0.4 mm}}",
    "mesh": "meshes: {t: {file: plate.stl, center: [0 mm, 0 mm, -0.2 mm], mass: 1 g}}",
    "block of 0.3 mm": "",
}
OTHER = (
    "t: {material: p, size: [60 mm, 60 mm], thickness: 0.3 mm, mass: 2 g, boxes: [1, 1], "
    "center: [0 mm, 0 mm, -0.15 mm]}"
)
THROWN = {
    "block": {},
    "block on its edge": {"rotation": EDGE},
    "spinning block": {"spin": "[0 rad/s, 900 rad/s, 0 rad/s]"},
    "sheet": {"boxes": "[3, 3]"},
    "sheet on its edge": {"boxes": "[3, 3]", "rotation": EDGE},
}


def scene(part, speed, height=20.0, step=None, **other):
    time = 1.4 * height / speed
    record = {"size": "[20 mm, 20 mm]", "boxes": "[1, 1]", "rotation": FLAT, "spin": STILL, **other}
    text = SCENE.format(
        part=PARTS.get(part, part),
        other="" if PARTS.get(part, part) else OTHER,
        speed=speed,
        z=height,
        time=time,
        step="" if step is None else f", step: {step!r} ms",
        **record,
    )
    return text


def held(result):
    """Whether a run ended with a reason, or every box is above what it was thrown at."""
    sheet = result.model.sheets[0]
    low = 0.0
    if len(result.model.sheets) > 1:  # a sheet that is hit is pushed down
        low = float(result.position[-1, sheet.count :, 2].max())
    return not result.ok or bool(result.position[-1, : sheet.count, 2].min() > low)


# Places in a step at which a block comes to the plate; MDLGEN_OFFSETS=20 is the study.
OFFSETS = int(os.environ.get("MDLGEN_OFFSETS", "3"))


# How far above a part a block begins [mm]; Exudyn takes seconds for each millisecond that it flies.
NEAR = {"lattice": 20.0, "exudyn": 4.0}


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize("thick", [0.2, 0.5, 2.0])
@pytest.mark.parametrize("speed", [1.0, 5.0, 30.0])
def test_a_block_rebounds_from_a_plate_or_the_run_ends(speed, thick, solver):
    for k in range(OFFSETS):
        height = NEAR[solver] + 0.37 * k * speed / 20 + 0.013 * k
        result = mdlgen.solve(lower(loads(scene(plate(thick), speed, height))), solver)
        assert held(result), result.status
        # what a plate can hold, it holds: 2/5 k z^2.5 = m v^2/2 (undamped, so a little less)
        if (5 * 0.032 * speed**2 / (4 * 300)) ** 0.4 < 0.4 * thick:
            assert as_asked(result), result.status
            # v' = c v whatever the plate is made of
            assert result.velocity[-1, 0, 2] == pytest.approx(0.5 * speed, rel=0.01)
        else:
            assert not as_asked(result) or result.velocity[-1, 0, 2] > 0.0


@pytest.mark.parametrize("step", [0.5, 0.05])
def test_a_step_of_the_users_own_does_not_take_a_block_through(step):
    for k in range(4):
        result = mdlgen.solve(lower(loads(scene("plate of 0.2 mm", 3.0, 20.0 + 0.31 * k, step))), "lattice")
        assert held(result), result.status
    result = mdlgen.solve(lower(loads(scene("plate of 0.2 mm", 3.0, 20.0, step))), "exudyn")
    assert held(result), result.status


@pytest.mark.parametrize("part", list(PARTS))
@pytest.mark.parametrize("thrown", list(THROWN))
def test_nothing_passes_through(thrown, part, tmp_path):
    (tmp_path / "plate.stl").write_bytes(binary(*brick(120.0, 120.0, 0.4)))
    for solver in ["lattice", "exudyn"] if thrown in ("block", "sheet on its edge") else ["lattice"]:
        # an edge is 10 mm below the middle
        height = 0.3 + NEAR[solver] + (10.0 if solver == "exudyn" and thrown != "block" else 0.0)
        text = scene(part, 6.0, height, **THROWN[thrown])
        result = mdlgen.solve(lower(loads(text, folder=tmp_path)), solver)
        assert held(result), (solver, result.status)


def test_contacts_that_are_too_soft_end_the_run(tmp_path):
    """What is too weak to hold a body lets it through at any step: the run ends with both names."""
    (tmp_path / "plate.stl").write_bytes(binary(*brick(120.0, 120.0, 0.4)))
    for part, thrown, message in (
        ("roller of 0.5 mm", "block", "box n_0_0 is more than half of its radius into roller t"),
        ("plate of 1 mm", "block", "box n_0_0 is more than half of its thickness into plane t"),
        ("guide, both sides", "sheet", "is more than half of its thickness into guide t"),
        ("mesh", "block on its edge", "box n_0_0 is more than half of its thickness into mesh t"),
        ("mesh", "sheet on its edge", "is more than half of its thickness into mesh t"),
    ):
        text = scene(part, 1.0, 12.0, **THROWN[thrown]).replace("stiffness: 300", "stiffness: 1e-3")
        for step in (None, 0.01):
            model = lower(loads(text.replace("ms}", "ms, step: 0.01 ms}") if step else text, folder=tmp_path))
            result = mdlgen.solve(model, "lattice")
            assert message in result.status, (part, thrown, result.status)


def test_what_is_below_a_plate_or_moves_along_it_is_let_be():
    """A plate has one face: what is below stays there, and what is fast along it is not fast towards it."""
    text = scene("plate of 0.2 mm", 5.0, 20.0).replace(
        "velocity: [0 m/s, 0 m/s, -5.0 m/s]", "velocity: [5 m/s, 0 m/s, 0 m/s]"
    )
    for height in (-9.0, -0.26, 0.06):
        moved = text.replace("center: [0 mm, 0 mm, 20.0 mm]", f"center: [0 mm, 0 mm, {height} mm]")
        result = mdlgen.solve(lower(loads(moved)), "lattice")
        assert as_asked(result), result.status
        assert result.velocity[-1, 0] == pytest.approx([5.0, 0.0, 0.0], abs=1e-12)
        assert result.steps < 100
