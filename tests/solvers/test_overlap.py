"""Rollers that come into plates, guides and meshes without a contact: depths, lint, how a run ends."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from asked import as_asked
from roller_scenes import ARC, LINE, PICK, PLANE, SOLVERS, scene
from solids import binary, brick

import mdlgen
from mdlgen.checks import lints
from mdlgen.geometry.rods import Box, Rod, into_box, into_triangles
from mdlgen.model.lower import lower
from mdlgen.model.overlaps.parts import HAIR, Overlaps
from mdlgen.paths import samples
from mdlgen.spec.load import load, loads

ROD = Rod(np.zeros(3), np.array([0.0, 1.0, 0.0]), 10.0, 8.0)
OTHER = "  - {between: [strip, r], stiffness: 1 N/mm^1.5, friction: 0}"


def without(text: str) -> str:
    """A scene whose roller has a contact with the sheet alone."""
    return text.replace("between: [r, part]", "between: [strip, r]")


def box(center: tuple[float, float, float], half: tuple[float, float, float], turn: float = 0.0) -> Box:
    c, s = math.cos(turn), math.sin(turn)
    return Box(np.array(center), np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]), np.array(half))


# -- depths


@pytest.mark.parametrize(
    ("block", "deep"),
    [
        (box((0, 0, -14.7), (50, 50, 5)), 0.3),  # over a face
        (box((0, 0, -15.1), (50, 50, 5)), 0.0),
        (box((56.0, 0, -11.0), (50, 50, 5)), 10 - math.hypot(6, 6)),  # over an edge
        (box((59.0, 0, 0), (50, 50, 5)), 1.0),  # beside a side
        (box((0, 57.5, 0), (50, 50, 5)), 0.5),  # its end beside a plate
        (box((0, 58.5, 0), (50, 50, 5)), 0.0),
        (box((0, 0, 3.0), (50, 50, 0.1)), 7.1),  # right through a thin plate
        (box((0, 0, -14.6), (50, 50, 5), math.pi / 2), 50 + 10 - 14.6),  # a plate on its side: out sideways
    ],
)
def test_how_deep_a_roller_is_in_a_block(block: Box, deep: float) -> None:
    found = max(0.0, into_box(ROD, block))
    if abs(block.axes[0, 0]) < 0.5:
        deep = min(deep, 15.0)  # by the shortest way out
    assert found == pytest.approx(deep, abs=1e-9)


def test_how_deep_triangles_are_in_a_roller() -> None:
    corners, triangles = brick(100, 100, 10)
    for shift, deep in ((-14.7, 0.3), (-15.1, 0.0), (15.5, 0.0), (13.0, 2.0)):
        found = into_triangles(ROD, (corners + np.array([0, 0, shift]))[triangles])
        assert max(0.0, found) == pytest.approx(deep, abs=1e-9)
    beside = corners + np.array([56.0, 0, -11.0])
    assert into_triangles(ROD, beside[triangles]) == pytest.approx(10 - math.hypot(6, 6), abs=1e-9)
    along = corners + np.array([0, 58.5, 0])  # beyond the end of the roller
    assert into_triangles(ROD, along[triangles]) <= 0.0


# -- the lint


def test_a_lint_names_both_and_says_what_to_add() -> None:
    bare = PICK.replace("  - {between: [pick, table]", "  # {between: [pick, table]")
    (found,) = [x for x in lints(lower(loads(bare))) if x.code == "W119"]
    assert found.where == "rollers.pick" and "plane table" in found.message
    assert "{between: [pick, table]" in found.remedy
    assert [x.code for x in lints(lower(loads(PICK)))] == []


DOWNWARDS = "press: {direction: -z, stiffness: 0.5 N/mm, preload: 1 N}"
UPWARDS = "press: {direction: z, stiffness: 0.5 N/mm, preload: 3 N}"


@pytest.mark.parametrize(
    ("part", "more", "says"),
    [
        (PLANE, DOWNWARDS, True),
        (PLANE, UPWARDS, False),  # away from it
        (PLANE, "arm: {pivot: [-30 mm, 0 mm, 10 mm], mass: 1 g}", True),
        (PLANE, "", False),  # a fixed axis
        (PLANE.replace("mass: 1 g", f"mass: 1 g, {UPWARDS}"), "", True),
        (LINE.format(side="right"), DOWNWARDS, True),
        (ARC.format(z=30, begin=45, end=135, side="inside"), DOWNWARDS, True),
        (PLANE.replace("-5 mm]", "5 mm]"), DOWNWARDS, False),  # in a hole from the start
    ],
)
def test_pairs_that_can_meet_are_found(part: str, more: str, says: bool) -> None:
    text = without(scene(part, more, center="[0 mm, 0 mm, 10.2 mm]"))
    assert (len(Overlaps(lower(loads(text))).ahead()) == 1) is says


HOLE = """
name: hole
materials: {{card: {{E_md: 2750 MPa, E_cd: 2750 MPa}}}}
sheets:
  note: {{material: card, size: [40 mm, 20 mm], thickness: 0.6 mm, mass: 0.6 g, boxes: [8, 1]}}
nips:
  nip:
    at: [-6 mm, 0 mm, 0 mm]
    force: 5 N
    lower:
      radius: 11 mm
      width: 10 mm
      mass: 8 g
      drive: {{surface_speed: 1 m/s, direction: +x}}
      contact: {{stiffness: 300 N/mm^1.5, friction: 0.4}}
    upper:
      radius: 9 mm
      width: {width} mm
      mass: 7 g
      press: {{stiffness: 0.1 N/mm}}
      contact: {{stiffness: 100 N/mm^1.5, friction: 0.9}}
    contact: {{stiffness: 20 N/mm^1.5, friction: 0.4}}
planes: {{table: {{center: [0 mm, 0 mm, {top} mm], normal: z, size: [260 mm, 50 mm, 10 mm]}}}}
contacts: [{{between: [note, table], stiffness: 100 N/mm^1.5, friction: 0.2}}]
run: {{duration: 40 ms}}
"""


@pytest.mark.parametrize(("width", "top", "hole"), [(10, -5.5, True), (14, -5.5, False), (10, -30.0, False)])
def test_a_roller_comes_into_the_hole_of_the_one_that_it_presses_on(
    width: int, top: float, hole: bool
) -> None:
    """Once the sheet has left, a soft nip gives way by more than the table is below the sheet. A wider roller
    does not fit into the hole; where the lower roller is above the table there is none."""
    made = lower(loads(HOLE.format(width=width, top=top)))
    overlaps = Overlaps(made)
    met = {(pair.roller.name.rpartition("_")[2], pair.part.name) for pair in overlaps._watched}
    assert (("upper", "table") in met) is not hole
    assert (not [lint for lint in lints(made) if lint.code == "W119"]) is (hole or top < -10)
    if hole:
        result = mdlgen.solve(made, "lattice")
        assert as_asked(result), result.status
        below = result.position[-1, made.roller("nip_upper").body, 2] - 9.0
        assert below < top + 5.0 - HAIR


@pytest.mark.parametrize(
    "part", [PLANE, LINE.format(side="right"), ARC.format(z=30, begin=45, end=135, side="inside")]
)
def test_what_was_looked_at_before_changes_nothing(part: str) -> None:
    """A roller that wanders about a part, looked at by one that knows how far apart they were and by one that
    does not."""
    made = lower(loads(without(scene(part, DOWNWARDS, center="[0 mm, 0 mm, 10.2 mm]"))))
    body, overlaps, fresh = made.roller("r").body, Overlaps(made), Overlaps(made)
    rng, message = np.random.default_rng(3), 0
    for _ in range(75):
        places = made.bodies.position.copy()
        size = 10.0 ** rng.uniform(-3, 2)
        for _ in range(5):
            places[body] += size * rng.normal(size=3)
            found = overlaps.found(places, 0.0)
            fresh._apart[:] = 0.0
            assert found == fresh.found(places, 0.0)
            message += found is not None
    assert 12 < message < 350


# -- runs


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_pick_roller_without_a_contact_ends_its_run_with_both_names(solver: str) -> None:
    """The roller falls on the table as the note leaves, and would brake the note.

    Half of the note passes at the speed of the roller's surface, of which the ramp takes 1 ms. Then spring
    and weight press the roller down by the note's thickness and HAIR.
    """
    bare = PICK.replace("  - {between: [pick, table]", "  # {between: [pick, table]")
    result = mdlgen.solve(lower(loads(bare, overrides=["sheets.n.boxes=[12, 2]"])), solver)
    assert not result.usable
    found = re.fullmatch(
        rf"roller pick and plane table overlap by (\S+) mm at {result.time[-1]:.6g} ms, and no contact holds "
        r"them apart; give a contact between \[pick, table\]",
        result.status,
    )
    assert found, result.status
    deep = 10.0 - result.position[-1, result.model.roller("pick").body, 2]
    assert float(found[1]) == pytest.approx(deep, rel=5e-3) and HAIR < deep < 0.1
    left, force = 30.0 / 1.0 + 1.0, 2.0 + 10.01 * 9.81e-3
    fall = math.sqrt(2.0 * (0.1 + HAIR) / (force / 10.01))
    # it stands on the rear edge for a moment, and is stored each 0.1 ms
    assert result.time[-1] == pytest.approx(left + fall, abs=0.3)


@pytest.mark.parametrize("solver", SOLVERS)
def test_arms_guides_and_meshes_are_looked_at_too(solver: str, tmp_path: Path) -> None:
    arm = "arm: {pivot: [-60 mm, 0 mm, 10 mm], mass: 0.1 g, torque: 20 N*mm}"
    (tmp_path / "part.stl").write_bytes(binary(*_lowered()))
    for part, kind in ((LINE.format(side="right"), "guide"), ("meshes: {part: {file: part.stl}}", "mesh")):
        file = tmp_path / f"{kind}.yaml"
        file.write_text(without(scene(part, arm, center="[0 mm, 0 mm, 10.5 mm]")))
        result = mdlgen.solve(lower(load(file)), solver)
        depth = 10.0 - result.position[-1, result.model.roller("r").body, 2]
        reason = (
            rf"roller r and {kind} part overlap by (\S+) mm at {result.time[-1]:.6g} ms, and no contact "
            r"holds them apart; give a contact between \[r, part\]"
        )
        found = re.fullmatch(reason, result.status)
        assert found, result.status
        assert float(found[1]) == pytest.approx(depth, rel=5e-3) and HAIR < depth < 0.5


def _lowered() -> tuple[np.ndarray, np.ndarray]:
    corners, triangles = brick(120, 60, 10)
    return corners - [0, 0, 5], triangles


@pytest.mark.parametrize("solver", SOLVERS)
def test_what_overlaps_from_the_start_is_a_hole(solver: str) -> None:
    """A roller that looks out of a plate, in its hole, to where its spring ends: 1 N / (0.5 N/mm)."""
    text = without(scene(PLANE, "press: {direction: -z, stiffness: 0.5 N/mm, preload: 1 N}"))
    text = text.replace("center: [0 mm, 0 mm, 10 mm]", "center: [0 mm, 0 mm, -4 mm]")
    result = mdlgen.solve(lower(loads(text)), solver)
    assert result.ok and result.time[-1] == 20.0, result.status
    height = result.position[:, result.model.roller("r").body, 2]
    assert height == pytest.approx(np.full(len(height), -4.0 - 1.0 / 0.5), abs=1e-9)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize("step", ["0.02 ms", "0.1 ms"])
def test_what_presses_as_a_run_begins_may_be_the_greatest_force(solver: str, step: str) -> None:
    """A block that begins 0.05 mm deep leaves within half a millisecond: k z^1.5 and its depth, at any
    step."""
    sets = ["sheets.block.center=[0 mm, 0 mm, 4.95 mm]", "run.duration=2 ms", f"run.step={step}"]
    result = mdlgen.solve(lower(load(samples() / "verify" / "drop.yaml", sets)), solver)
    found = result.statistics
    assert found.max_force[0] == pytest.approx(1000.0 * 0.05**1.5, rel=1e-9)
    assert found.max_depth[0] == pytest.approx(0.05, rel=1e-9)
    assert found.max_force[0] == pytest.approx(float(result.contact_force.max()), rel=1e-9)
