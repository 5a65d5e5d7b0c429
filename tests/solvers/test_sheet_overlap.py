"""Sheets without a contact to what they lie on or run into: lints, what is noticed, how a run ends."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.checks import lints
from mdlgen.cli import app
from mdlgen.model.lower import lower
from mdlgen.model.overlaps.parts import HAIR
from mdlgen.model.overlaps.sheets import SheetOverlaps
from mdlgen.model.tables import Model
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

SOLVERS = ["lattice", "exudyn"]
TWO = """
name: two
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.4 N*mm, D_cd: 0.2 N*mm}}}}
sheets:
  top: {{material: paper, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [6, 4],
         center: [0 mm, 0 mm, {top} mm]}}
  low: {{material: paper, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [6, 4],
         center: [{aside} mm, 0.3 mm, {low} mm]}}
planes:
  table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm], mass: 1 g}}
{more}
contacts:
  table: {{between: [low, table], stiffness: 300 N/mm^1.5, friction: 0.5}}
{contacts}
run: {{duration: {time} ms, print_step: 1 ms}}
"""
EACH_OTHER = "  each: {between: [top, low], stiffness: 300 N/mm^1.5, friction: 0.5}"
BOTH = "  both: {between: [top, [low, table]], stiffness: 300 N/mm^1.5, friction: 0}"
ROLLER = """rollers:
  r: {{center: [0 mm, 0 mm, {z} mm], axis: y, radius: 8 mm, width: 10 mm, mass: 5 g,
       drive: {{speed: 10 rad/s}}}}"""

GUIDE = """guides:
  g: {{line: {{from: [-40 mm, 0 mm, {z} mm], to: [40 mm, 0 mm, {z} mm], axis: y, side: left}}, width: 30 mm,
       thickness: 1 mm}}"""


def two(
    top: float = 0.15,
    low: float = 0.05,
    aside: float = 0.2,
    more: str = "",
    contacts: str = "",
    time: float = 20,
) -> Model:
    return lower(loads(TWO.format(**locals())))


def codes(model: Model) -> list[tuple[str, str]]:
    return [(x.code, x.message) for x in lints(model) if x.code in ("W120", "W121")]


# -- the lint


@pytest.mark.parametrize(
    ("top", "aside", "says"),
    [
        (0.15, 0.2, True),  # on it
        (0.19, 0.2, True),
        (0.21, 0.2, False),  # over it
        (0.05, 0.2, True),  # in it
        (0.05, 60.2, False),  # beside it
        (0.05, 59.9, True),
    ],
)
def test_sheets_that_lie_on_each_other_need_a_contact(top: float, aside: float, says: bool) -> None:
    given = "  t: {between: [top, table], stiffness: 1 N/mm^1.5, friction: 0}"
    found = codes(two(top, aside=aside, contacts=given))
    assert [code for code, _ in found] == ["W120"] * says
    if says:
        assert "sheet top" in found[0][1]
    assert codes(two(top, aside=aside, contacts=BOTH)) == []


def test_the_lint_says_what_to_add() -> None:
    (found,) = [x for x in lints(two()) if x.code == "W120"]
    assert found.where == "sheets.low"
    assert "{between: [low, top], stiffness: 300 N/mm^1.5, friction: 0.5}" in found.remedy


@pytest.mark.parametrize(
    ("more", "what"),
    [
        (ROLLER.format(z=8.22), "roller r"),  # on the upper sheet, with 0.02 mm to it
        (ROLLER.format(z=8.27), ""),
        (ROLLER.format(z=3), "roller r"),
        (ROLLER.format(z=30), ""),
        (GUIDE.format(z=0.1), "guide g"),
        (GUIDE.format(z=4), ""),
    ],
)
def test_a_sheet_on_a_part_needs_a_contact(more: str, what: str) -> None:
    found = [
        message for code, message in codes(two(more=more, contacts=EACH_OTHER)) if "table" not in message
    ]
    assert bool(found) is bool(what) and all(what in said for said in found)


def test_a_sheet_on_a_plate_needs_a_contact() -> None:
    found = codes(two(0.05, aside=100.0))
    assert [code for code, _ in found] == ["W121"] and "plane table" in found[0][1]


# -- what is noticed


def test_what_was_looked_at_before_changes_nothing() -> None:
    """Two sheets that wander about each other, looked at by one that knows how far apart they were and by one
    that does not."""
    made = two(0.25)
    start, turn = made.bodies.position, made.bodies.rotation.reshape(-1, 9)
    rng, overlaps, said = np.random.default_rng(2), SheetOverlaps(made), 0
    for _ in range(100):
        places, size = start.copy(), 10.0 ** rng.uniform(-2, 0.5)
        for _ in range(5):
            places[:24] += size * rng.normal(size=3) * [1.0, 1.0, 0.2]
            found = overlaps.found(places, turn, 0.0)
            assert (found is None) == (SheetOverlaps(made).found(places, turn, 0.0) is None)
            said += found is not None
    assert 20 < said < 450


# -- runs

FALL = 9.81e-3  # g [mm/ms^2]
# Between two states that are searched for overlaps [ms]: of lattice every second step of 0.1 ms in these
# scenes, of Exudyn those that are stored.
LOOKED = {"lattice": 0.2, "exudyn": 1.0}


def ends(result: Result, one: str, two: str) -> float:
    """The depth of the overlap [mm] in the reason of a run that ended with it, which has just this text."""
    names = ", ".join(part.split()[1] for part in (one, two))
    reason = (
        rf"{one} and {two} overlap by (\S+) mm at {result.time[-1]:.6g} ms, and no contact holds them apart; "
        rf"give a contact between \[{names}\]"
    )
    found = re.fullmatch(reason, result.status)
    assert not result.usable and found, result.status
    return float(found[1])


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("top", [0.15, 1.0])
def test_a_sheet_that_falls_through_another_ends_its_run_with_both_names(solver: str, top: float) -> None:
    result = mdlgen.solve(two(top), solver)
    deep = ends(result, "sheet low", "sheet top")
    # by half of the thickness, free from a height above it: to the next stored time
    fall = np.sqrt(2.0 * (top - 0.15 + 0.05) / FALL)
    assert fall < result.time[-1] < fall + LOOKED[solver] + 1e-6
    # the shortest way out, up or down; what carries the lower one is pressed by 4e-5 mm
    apart = top - 0.5 * FALL * result.time[-1] ** 2 - 0.05
    assert deep == pytest.approx(0.1 - abs(apart), abs=1.5e-4)


@pytest.mark.parametrize("solver", SOLVERS)
def test_sheets_in_one_place_end_the_run(solver: str) -> None:
    """At the first state that is looked at, by the thickness of a sheet."""
    result = mdlgen.solve(two(0.05), solver)
    assert ends(result, "sheet low", "sheet top") == pytest.approx(0.1, abs=1e-4)
    assert result.time[-1] <= 0.1


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_sheet_that_falls_through_a_plate_ends_its_run(solver: str) -> None:
    """Its middle plane is HAIR below the face."""
    result = mdlgen.solve(two(0.05, aside=100.0), solver)
    deep = ends(result, "sheet top", "plane table")
    fall = np.sqrt(2.0 * (HAIR + 0.05) / FALL)
    assert fall < result.time[-1] < fall + LOOKED[solver] + 1e-6
    assert deep == pytest.approx(0.5 * FALL * result.time[-1] ** 2 - 0.05, abs=1e-4)


@pytest.mark.parametrize(
    ("more", "what", "height", "thick"),
    [
        # a place of a box 0.2 mm beside the axis of the roller, whose top is at -1.2 mm
        (ROLLER.format(z=-9.2), "roller r", 8.0 - 9.2 - 0.2**2 / 16.0 - HAIR, 0.0),
        # onto the back of a plate that is 1 mm thick: its face is the lower one
        (GUIDE.format(z=-1.2), "guide g", -0.2, 1.0),
    ],
)
def test_rollers_and_guides_are_noticed_too(more: str, what: str, height: float, thick: float) -> None:
    """Both sheets fall on a part below them, where there is no table: the middle plane of the lower one, from
    0.05 mm, to a height."""
    moved = TWO.format(top=0.15, low=0.05, aside=0.2, more=more, contacts=EACH_OTHER, time=40).replace(
        "center: [0 mm, 0 mm, -5 mm]", "center: [0 mm, 0 mm, -50 mm]"
    )
    result = mdlgen.solve(lower(loads(moved)))
    deep = ends(result, "sheet low", what)
    fall = np.sqrt(2.0 * (0.05 - height) / FALL)
    assert fall < result.time[-1] < fall + LOOKED["lattice"] + 1e-6
    further = height - (0.05 - 0.5 * FALL * result.time[-1] ** 2)
    assert deep == pytest.approx(thick - further if thick else HAIR + further, abs=1e-3)


def test_a_sheet_in_a_hole_from_the_start_is_left_alone() -> None:
    """It falls freely through the table that it is in."""
    result = mdlgen.solve(two(-3.0, aside=100.0, low=0.05, time=5))
    assert as_asked(result), result.status
    assert result.position[-1, 24:48, 2] == pytest.approx(np.full(24, -3.0 - 0.5 * FALL * 5.0**2), abs=1e-9)
    assert [code for code, _ in codes(two(-3.0, aside=100.0))] == ["W121"]


def test_a_run_says_at_once_which_contacts_are_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "two.yaml"
    file.write_text(TWO.format(top=-3.0, low=0.05, aside=100.0, more="", contacts="", time=2))
    app(["run", str(file), "-o", str(tmp_path / "out")], standalone_mode=False)
    said = capsys.readouterr().err
    assert "W121 sheets.top: it lies on plane table, or in it, and has no contact with it" in said
    app(["run", str(file), "-o", str(tmp_path / "out"), "-q"], standalone_mode=False)
    assert capsys.readouterr().err == ""


def test_sheets_with_contacts_run_on() -> None:
    """To their rest: each contact bears what lies above it, (m g / (24 k))^(2/3) deep on each of 24 boxes."""
    result = mdlgen.solve(two(contacts=EACH_OTHER))
    assert as_asked(result), result.status
    low, top = result.position[-1, :48, 2].reshape(2, 24).mean(axis=1)
    weight = 0.2 * FALL / 24  # of a box [N]
    assert 0.05 - low == pytest.approx((2.0 * weight / 300.0) ** (2 / 3), rel=1e-3)
    # they lie on each other with all but 0.2 mm of 60 and 0.3 mm of 40
    covered = 59.8 / 60.0 * 39.7 / 40.0
    assert 0.1 - (top - low) == pytest.approx((weight / (300.0 * covered)) ** (2 / 3), rel=2e-3)
    assert np.abs(result.velocity[-1, :48]).max() < 1e-4
