"""Each lint fires on a scene that deserves it, and none on the samples."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import mdlgen
from mdlgen.checks import CHECKS, Lint, lints
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load, loads

SAMPLES = sorted(samples().rglob("*.yaml"))


def found(sample: str, *overrides: str) -> list[Lint]:
    return lints(lower(load(samples() / f"{sample}.yaml", overrides)))


@pytest.mark.parametrize("path", SAMPLES, ids=lambda p: p.stem)
def test_no_false_alarm_on_a_sample(path: Path) -> None:
    # the rod of one sample is there to bend a sheet beyond its yield curvature, and notes of another bend
    # along their way alone
    expected = {"crease": {"W146"}, "recycler": {"W102"}}.get(path.stem, set())
    assert {lint.code for lint in lints(lower(load(path)))} == expected


CASES = [
    ("W101", "cantilever", ["materials.eur10.E_md=3530 Pa"], "materials.eur10.E_md"),
    ("W102", "cantilever", ["sheets.note.boxes=[2,40]"], "sheets.note.boxes"),
    ("W103", "cantilever", ["gravity=[0 m/s^2,0 m/s^2,0 m/s^2]"], "sheets.note.clamp"),
    ("W104", "transport_4x4", ["sheets.note.boxes=[5,20]"], "rollers.counter_1_left.radius"),
    ("W105", "transport_4x4", ["contacts.5.stiffness=100 N/mm^1.5"], "contacts.5.stiffness"),
    ("W106", "transport_4x4", ["contacts.4.smoothing=100 mm/s"], "contacts.4.smoothing"),
    ("W107", "transport_4x4", ["contacts.6.smoothing=0.1 mm/s"], "contacts.6.smoothing"),
    (
        "W108",
        "transport_4x4",
        ["rollers.motor_2_left.drive.speed=0 rad/s"],
        "rollers.motor_2_left.drive.speed",
    ),
    ("W109", "verify/drop", ["contacts=[]"], "sheets.block"),
    ("W110", "cantilever", ["sheets.note.clamp=null"], "sheets.note"),
    ("W111", "verify/drop", ["contacts=[]"], "planes.floor"),
    (
        "W112",
        "transport_4x4",
        ["rollers.motor_1_left.center=[13.5 mm,-20.5 mm,-7.4 mm]"],
        "rollers.motor_1_left.center",
    ),
    ("W112", "verify/drop", ["sheets.block.center=[0 mm,0 mm,-1 mm]"], "planes.floor.center"),
    ("W113", "transport_4x4", ["rollers.motor_1_left.drive.ramp=1 s"], "rollers.motor_1_left.drive.ramp"),
    ("W114", "transport_4x4", ["sheets.note.mass=0.72 kg"], "sheets.note.mass"),
    ("W115", "cantilever", ["sheets.note.layout=plate"], "sheets.note.layout"),
]


@pytest.mark.parametrize(
    ("code", "sample", "overrides", "where"), CASES, ids=lambda v: v if isinstance(v, str) else ""
)
def test_fires(code: str, sample: str, overrides: list[str], where: str) -> None:
    hits = [lint for lint in found(sample, *overrides) if lint.code == code]
    assert where in {lint.where for lint in hits}
    for lint in hits:
        assert lint.message and lint.remedy
        assert str(lint).isascii() and "\n" not in str(lint)


def test_the_advice_on_long_boxes_ends_the_finding() -> None:
    (lint,) = [x for x in found("cantilever", "sheets.note.boxes=[2,40]") if x.code == "W102"]
    assert lint.remedy == "take [5, 40] boxes, or [1, 40] where the sheet bends one way only"
    for boxes in ("[5,40]", "[1,40]", "[40,1]"):
        assert "W102" not in {x.code for x in found("cantilever", f"sheets.note.boxes={boxes}")}
    (lint,) = [x for x in found("cantilever", "sheets.note.boxes=[40,3]") if x.code == "W102"]
    assert lint.remedy.startswith("take [40, 16] boxes, or [40, 1]")


@pytest.mark.parametrize("radius", [7.45, 3.3, 5.0, 10.2])
@pytest.mark.parametrize("thickness", [0.08, 0.1, 0.12])
@pytest.mark.parametrize("height", [0.0, 0.3, 1.1, 2.7])
def test_a_roller_that_begins_half_of_the_thickness_deep_is_no_finding(
    radius: float, thickness: float, height: float
) -> None:
    """Round-off of places puts it above or below; 2 % more is a finding, with the limit in its message."""

    def deep(more: float) -> list[str]:
        made = found(
            "transport_4x4",
            f"sheets.note.thickness={thickness} mm",
            f"sheets.note.center.2={height} mm",
            f"rollers.motor_1_left.radius={radius} mm",
            f"rollers.motor_1_left.center.2={height - radius + more * thickness / 2!r} mm",
        )
        where = "rollers.motor_1_left.center"
        return [lint.message for lint in made if (lint.code, lint.where) == ("W112", where)]

    assert deep(0.0) == []
    (message,) = deep(0.02)
    stated = (
        f"starts {0.51 * thickness:.3g} mm inside note, more than {thickness / 2:g} mm, half of its thickness"
    )
    assert stated in message


BEYOND = """
name: edges
materials: {m: {E_md: 3 GPa, E_cd: 3 GPa}}
sheets: {note: {material: m, size: [60 mm, 40 mm], thickness: 0.4 mm, mass: 1 g, boxes: [6, 2]}}
rollers: {low: {center: [32 mm, 0 mm, -9 mm], axis: y, radius: 10 mm, width: 8 mm, mass: 9 g}}
planes: {pad: {center: [-30 mm, 0 mm, -0.9 mm], normal: z, size: [10 mm, 8 mm, 2 mm], mass: 9 g}}
contacts: [{between: [note, [low, pad]], stiffness: 300 N/mm^1.5, friction: 0.3}]
run: {duration: 10 ms}
"""


def test_an_edge_of_a_sheet_that_begins_in_a_roller_or_a_narrow_plate_is_found() -> None:
    """The roller's axis is 2 mm beyond the sheet, and the plate lies between the corners of the sheet."""
    made = {lint.where: lint.message for lint in lints(lower(loads(BEYOND))) if lint.code == "W112"}
    deep = 10.0 - math.hypot(2.0, 8.8)
    assert f"low starts {deep:.3g} mm inside note" in made["rollers.low.center"]
    assert "pad starts 0.3 mm inside note" in made["planes.pad.center"]
    clear = ("rollers.low.center.0=36 mm", "planes.pad.center.0=-35.1 mm")
    assert not [x for x in lints(lower(loads(BEYOND, overrides=clear))) if x.code == "W112"]


def test_a_pressed_roller_whose_counterpart_is_forgotten() -> None:
    law = "stiffness: 300 N/mm^1.5, friction: 0"
    sheet = ", ".join(f"{{between: [note, {name}], {law}}}" for name in ("motor", "idler"))
    (hit,) = (lint for lint in found("channel", f"contacts=[{sheet}]") if lint.code == "W118")
    assert hit.where == "rollers.idler.press" and "motor" in hit.message and "[idler, motor]" in hit.remedy
    # where the two are not opposite each other there is nothing to forget
    aside = "rollers.motor.center=[-9 mm, 9 mm, -7.55 mm]"
    assert "W118" not in {lint.code for lint in found("channel", f"contacts=[{sheet}]", aside)}


def test_a_free_roller_that_nothing_turns() -> None:
    still = [f"contacts.{k}.friction=0" for k in (0, 5)]
    (hit,) = (lint for lint in found("transport_4x4", *still) if lint.code == "W126")
    assert hit.where == "contacts.0.friction" and hit.message.startswith("counter_1_left turns freely")
    # with friction on its counterpart alone it turns, and so does a driven one
    assert "W126" not in {lint.code for lint in found("transport_4x4", "contacts.5.friction=0")}
    assert "W126" not in {lint.code for lint in found("transport_4x4", "contacts.4.friction=0")}


def test_every_check_is_tested() -> None:
    assert {code for code, *_ in CASES} == {f"W{k}" for k in range(101, 116)}
    assert len(CHECKS) >= 11


@pytest.mark.parametrize(
    ("supports", "free"),
    [
        ("[]", 6),
        ("[{sheet: note, at: [0 mm, 0 mm], fix: [x, y, z]}]", 3),
        # a line of two points leaves the turn about it
        ("[{sheet: note, edge: y_min, fix: [x, y, z]}, {sheet: note, edge: y_max, fix: [x, y, z]}]", 1),
        (
            "[{sheet: note, edge: y_min, fix: [x, y, z]}, {sheet: note, edge: y_max, fix: [x, z]}, "
            "{sheet: note, edge: x_max, fix: [z]}]",
            0,
        ),
    ],
)
def test_rigid_body_freedom_is_counted(supports: str, free: int) -> None:
    text = found("cantilever", "sheets.note.clamp=null", "sheets.note.boxes=[3,5]", f"supports={supports}")
    messages = [lint.message for lint in text if lint.code == "W110"]
    assert bool(messages) == (free > 0)
    if free:
        assert f"in {free} of 6 ways" in messages[0]


STACK = """
name: pressed
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.4 N*mm, D_cd: 0.2 N*mm}}}}
sheets:
  top: {{material: paper, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [6, 4],
         center: [0 mm, 0 mm, 0.15 mm]}}
  low: {{material: paper, size: [60 mm, 40 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [6, 4],
         center: [0.2 mm, 0.3 mm, 0.05 mm]}}
rollers:
  pick: {{center: [4 mm, 0 mm, 8.3 mm], axis: y, radius: 8 mm, width: 16 mm, mass: 10 g,
          press: {{direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}}}
planes:
  table: {{center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 200 mm, 10 mm], mass: 1 g}}
contacts:
  pulls: {{between: [top, pick], stiffness: 1000 N/mm^1.5, friction: 1}}
  each: {{between: [top, low], stiffness: {each} N/mm^1.5, friction: 0.5}}
  table: {{between: [low, table], stiffness: 2000 N/mm^1.5, friction: 0.5}}
  stop: {{between: [pick, table], stiffness: 300 N/mm^1.5, friction: 0.5}}
run: {{duration: 3 ms, print_step: 0.5 ms}}
"""


@pytest.mark.parametrize(("each", "deep"), [(35, True), (1000, False)])
@pytest.mark.parametrize("step", ["0.05 ms", "0.002 ms"])
def test_a_stack_that_a_roller_presses_together_too_deep(each: int, deep: bool, step: str) -> None:
    """The roller stands on two boxes: 3 N are stopped by 35 N/mm^1.5 on these and on half as many beside
    them at (2.5*3/(3*35))^(2/3) = 0.17 mm. The run ends so, whatever its step, and says so."""
    model = lower(loads(STACK.format(each=each), overrides=[f"run.step={step}"]))
    hits = [lint for lint in lints(model) if lint.code == "W122"]
    assert [lint.where for lint in hits] == ["contacts.each.stiffness"] * deep
    result = mdlgen.solve(model)
    assert result.usable is not deep
    if deep:
        assert "some 0.17 mm into low" in hits[0].message
        assert "224 N/mm^1.5 or more" in hits[0].remedy
        assert "is more than three quarters of its thickness into box low" in result.status
        assert result.status.endswith("a stiffer contact would hold it, a smaller run.step would not")


@pytest.mark.parametrize("late", ["top", "low"])
def test_a_roller_does_not_press_on_a_sheet_that_comes_in_later(late: str) -> None:
    scene = loads(STACK.format(each=35), overrides=[f"sheets.{late}.enters=1 ms"])
    assert "contacts.each.stiffness" not in {x.where for x in lints(lower(scene)) if x.code == "W122"}
