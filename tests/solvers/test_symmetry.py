"""Scenes that are their own mirror image: lattice solves one half, and the whole is the same."""

from __future__ import annotations

import re

import numpy as np
import pytest
from asked import as_asked
from machines import MACHINE
from nip import FORTH_AND_BACK

import mdlgen
from mdlgen.paths import samples
from mdlgen.results.compare import compare


def solved(text: str, *sets: str) -> tuple[mdlgen.Result, mdlgen.Result]:
    """A scene with and without the rule."""
    results = [
        mdlgen.solve(mdlgen.lower(mdlgen.loads(text, [*sets, f"run.symmetry={rule}"])), "lattice")
        for rule in ("true", "false")
    ]
    for result in results:
        assert as_asked(result), result.status
    return results[0], results[1]


def assert_same(
    half: mdlgen.Result, whole: mdlgen.Result, most: float = 1e-6, sheets_meet: bool = False
) -> None:
    assert half.halved and not whole.halved
    assert compare(half, whole).relative < most
    states = ["position", "rotation", "velocity", "spin"]
    states += ["contact_force", "contact_torque", "contact_friction"]
    for name in states:
        one, two = getattr(half, name), getattr(whole, name)
        assert np.abs(one - two).max() <= most * max(1.0, np.abs(two).max()), name
    for name in ("max_depth", "mean_depth", "max_force", "mean_force", "last_force_at"):
        np.testing.assert_allclose(
            getattr(half.statistics, name),
            getattr(whole.statistics, name),
            rtol=1e-6,
            atol=most,
            err_msg=name,
        )
    # boxes of two sheets on different sides of the plane meet there in a line, and push with nothing
    assert half.touched == whole.touched or (sheets_meet and 0 < half.touched < whole.touched)
    for name in ("kinetic", "elastic", "dissipated", "driven"):
        assert getattr(half.energy, name) == pytest.approx(getattr(whole.energy, name), rel=1e-6, abs=1e-9), (
            name
        )
    assert half.energy.balance_error == pytest.approx(whole.energy.balance_error, abs=1e-7)


@pytest.mark.parametrize(
    "sets",
    [
        (),
        ("sheets.note.layout=center_to_center", "run.tolerance=1e-7"),
        (
            "sheets.note.layout=plate",
            "materials.paper={E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.9 N*mm, D_cd: 0.4 N*mm}",
        ),
        ("sheets.note.grading.y=[3, 5, 4, 6, 6, 6, 6, 4, 5, 3]",),
    ],
    ids=["plain", "c2c", "plate", "graded"],
)
def test_a_half_is_the_whole(sets: tuple[str, ...]) -> None:
    assert_same(*solved(MACHINE, *sets))


@pytest.mark.parametrize(
    "sets",
    [
        (),
        ("sheets.note.shape={curl: {radius: 200 mm, along: y}}",),
        ("rollers.middle.drive={speed: -50 rad/s}",),
        (
            "rollers.middle.drive={speed: -50 rad/s}",
            "rollers.middle.one_way={direction: 1, torque: 50 N*mm, creep: 1 rad/s}",
        ),
    ],
    ids=["free", "curl", "driven", "clutch"],
)
def test_a_roller_in_the_plane(sets: tuple[str, ...]) -> None:
    """Half of it is pushed by what is on one side; what it does is reported of the whole."""
    start = MACHINE.index("contacts:")
    law = "stiffness: 300 N/mm^1.5, restitution: 0.4, friction: 0.8, smoothing: 10 mm/s"
    text = (
        f"{MACHINE[:start]}contacts: [{{between: [note, middle], {law}}}]\n{MACHINE[MACHINE.index('run:') :]}"
    )
    for name in ("motor", "idler"):  # what has no contact stands aside
        text = re.sub(rf"({name}_\w+: {{center: \[)0 mm", r"\g<1>200 mm", text)
    # with 1e-7 iterations have to come as near as round-off, and by chance one side's step is halved
    half, whole = solved(text, "rollers.middle.center=[12 mm, 3 mm, 5 mm]", "run.tolerance=1e-6", *sets)
    assert half.statistics.max_force[0] > 0.05
    assert_same(half, whole)


def test_a_scene_along_another_axis() -> None:
    """The nip of a note that runs along y: the plane is that between its columns. What iterations leave goes
    with run.tolerance, as on either side of the comparison."""
    half, whole = solved(
        FORTH_AND_BACK,
        "run.duration=6 ms",
        "sheets.note.turn=90 deg",
        "sheets.note.boxes=[6, 4]",
        "rollers.motor.axis=x",
        "rollers.idler.axis=x",
        "run.step=0.05 ms",
        "run.tolerance=3e-8",
    )
    assert_same(half, whole)


def test_sheets_on_each_other() -> None:
    """One on the other, with grids of their own: boxes are looked for on one side alone."""
    other = (
        "  other: {material: paper, size: [36 mm, 48 mm], thickness: 0.1 mm, mass: 0.25 g, boxes: [5, 8],\n"
        "    center: [-1 mm, 3 mm, 0.1001 mm], velocity: [150 mm/s, 0 mm/s, -10 mm/s]}\n"
    )
    law = "stiffness: 300 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s"
    text = MACHINE.replace("rollers:\n", f"{other}rollers:\n", 1)
    text = text.replace("contacts:\n", f'contacts:\n  - {{between: [other, "idler_*"], {law}}}\n')
    half, whole = solved(text)
    both = [c for c, (a, b) in enumerate(zip(*ends(half), strict=True)) if {a, b} == {"note", "other"}]
    assert half.statistics.max_force[both].max() > 1.0
    assert_same(half, whole, sheets_meet=True)


def ends(result: mdlgen.Result) -> tuple[tuple[str, ...], tuple[str, ...]]:
    return result.model.contacts.part_a, result.model.contacts.part_b


ARMS = ("sheets.note_1.boxes=[6, 8]", "run.duration=15 ms", "run.step=0.03 ms", "run.tolerance=1e-6")


def test_rollers_on_arms_and_rims_in_the_plane() -> None:
    """The feeder: two skimmers, a roller of rubber and plastic, a slide."""
    text = (samples() / "feeder_one.yaml").read_text("utf-8")
    half, whole = solved(text, *ARMS)
    assert half.statistics.max_force.min(where=half.statistics.max_force > 0.0, initial=1.0) > 1e-3
    assert_same(half, whole)


@pytest.mark.parametrize(
    "sets",
    [
        ("rollers.skimmer_left.arm.torque=6.001 N*mm",),
        ("rollers.skimmer_left.arm.pivot=[-60 mm, 25 mm, 9.001 mm]",),
        ("rollers.skimmer_left.arm.mass=4.001 g",),
    ],
)
def test_arms_that_are_not_alike(sets: tuple[str, ...]) -> None:
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.symmetry.find import find

    model = mdlgen.lower(mdlgen.load(samples() / "feeder_one.yaml", [*ARMS, *sets]))
    assert find(model, build(model)) is None


@pytest.mark.parametrize(
    "sets",
    [
        ("sheets.note.boxes=[5, 5]",),
        ("sheets.note.turn=1 deg",),
        ("sheets.note.center=[0 mm, 3.01 mm, 0 mm]",),
        ("sheets.note.velocity=[200 mm/s, 1 mm/s, 0 mm/s]",),
        ("sheets.note.zones={stripe: {x: [0 mm, 10 mm], y: [5 mm, 15 mm], stiffness: 1.001}}",),
        ("rollers.motor_left.drive.speed=100.001 rad/s",),
        ("rollers.idler_left.mass=1.001 g",),
        ("rollers.idler_left.press.preload=1.001 N",),
        ("rollers.middle.center=[12 mm, 3.01 mm, 6 mm]",),
        ("gravity=[0 m/s^2, 0.01 m/s^2, -9.81 m/s^2]",),
        ("contacts.1.friction=0.501",),
    ],
)
def test_what_is_not_symmetric_is_solved_whole(sets: tuple[str, ...]) -> None:
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.symmetry.find import find

    model = mdlgen.lower(mdlgen.loads(MACHINE))
    assert find(model, build(model)) is not None
    other = mdlgen.lower(mdlgen.loads(MACHINE, sets))
    assert find(other, build(other)) is None


def test_a_free_roller_that_is_cut_along_its_axis_is_solved_whole() -> None:
    """Friction of one side alone would turn it. A stopped one does not turn."""
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.symmetry.find import find

    flat = ["sheets.strip.boxes=[12, 1]", "materials.eur10.yield=null"]
    free = mdlgen.lower(mdlgen.load(samples() / "crease.yaml", flat))
    assert find(free, build(free)) is None
    stopped = mdlgen.lower(
        mdlgen.load(samples() / "crease.yaml", [*flat, "rollers.rod.drive={speed: 0 rad/s}"])
    )
    assert find(stopped, build(stopped)) is not None


def test_a_measured_curve_across_the_plane() -> None:
    """A joint that follows a curve has its energy halved, too."""
    curve = "[[0, 0 MPa], [0.005, 15 MPa], [0.02, 30 MPa]]"
    paper = "{E_md: 3530 MPa, k_tx: 0.15 N*mm/rad, k_ty: 0.185 N*mm/rad, k_tz: 5 N*mm/rad"
    half, whole = solved(MACHINE, f"materials.paper={paper}, curve_cd: {{points: {curve}}}}}")
    assert_same(half, whole)


ROLLED = """
name: rolled
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.9 N*mm, D_cd: 0.4 N*mm}}
sheets:
  note: {material: paper, size: [20 mm, 48 mm], thickness: 0.1 mm, mass: 0.15 g, boxes: [1, 16]}
rollers:
  port: {center: [0 mm, -6 mm, -6 mm], axis: x, radius: 5 mm, width: 10 mm, mass: 1 g}
  starboard: {center: [0 mm, 6 mm, -6 mm], axis: x, radius: 5 mm, width: 10 mm, mass: 1 g}
loads:
  - {sheet: note, edge: y_max, moment: [3 N*mm, 0 N*mm, 0 N*mm]}
  - {sheet: note, edge: y_min, moment: [-3 N*mm, 0 N*mm, 0 N*mm]}
contacts: [{between: [note, "*"], stiffness: 300 N/mm^1.5, friction: 0.3, smoothing: 10 mm/s}]
run: {duration: 3 ms, step: 0.01 ms, print_step: 0.1 ms, prune: false}
"""


def test_a_sheet_that_rolls_over_the_plane_is_reported() -> None:
    """Its halves would not see the roller of the other side, nor each other; solved whole it meets itself."""
    model = mdlgen.lower(mdlgen.loads(ROLLED))
    result = mdlgen.solve(model, "lattice")
    assert not as_asked(result)
    assert result.status.startswith("box note_0_1 has passed the plane of the scene's symmetry at 1.6")
    whole = mdlgen.solve(mdlgen.lower(mdlgen.loads(ROLLED, ["run.symmetry=false"])), "lattice")
    assert whole.status.startswith("sheet note lies in itself at 1.")
    # its halves meet where the box is as far before the plane as half of its width
    assert whole.position[:, 1, 1].max() > -1.0


PLATES = """planes:
  {name}: {{center: [0 mm, 3 mm, -2.1 mm], normal: z, size: [60 mm, 30 mm, 4 mm], mass: 8 g,
    press: {{direction: {direction}, stiffness: 0.3 N/mm, preload: 0.5 N}}}}
"""


def plated(direction: str, *more: str) -> str:
    """A note on a plate that presses it against a roller, which pulls it on."""
    start, end = MACHINE.index("rollers:"), MACHINE.index("run:")
    law = "stiffness: 300 N/mm^1.5, restitution: 0.4, friction: 0.8, smoothing: 10 mm/s"
    return (
        f"{MACHINE[:start]}rollers:\n  feed: {{center: [0 mm, 3 mm, 7.5 mm], axis: y, radius: 7.5 mm, "
        f"width: 12 mm, mass: 1 g,\n    drive: {{speed: -30 rad/s}}}}\n"
        f"{PLATES.format(name='plate', direction=direction)}{''.join(more)}"
        f'contacts: [{{between: [note, "*"], {law}}}]\n{MACHINE[end:]}'
    )


@pytest.mark.parametrize("direction", ["z", "[0.3, 0, 1]"])
def test_a_spring_plate_in_the_plane(direction: str) -> None:
    """Half of it is pushed by what is on one side."""
    half, whole = solved(plated(direction))
    assert half.statistics.max_force.min() > 0.1
    assert_same(half, whole)


def test_a_plate_that_goes_across_the_plane_is_solved_whole() -> None:
    whole, _ = solved(plated("[0, 0.3, 1]"))
    assert not whole.halved


def test_a_spring_plate_on_either_side() -> None:
    """Two plates that are each other's image: one is solved for, and the other one is seen."""
    other = (
        "  {}: {{center: [0 mm, {} mm, -2.1 mm], normal: z, size: [60 mm, 12 mm, 4 mm], mass: 8 g,\n"
        "    press: {{direction: [0, {}, 1], stiffness: 0.3 N/mm, preload: 0.3 N}}}}\n"
    )
    both = other.format("near", -13, 0.2) + other.format("far", 19, -0.2)
    text = plated("z").replace(PLATES.format(name="plate", direction="z"), f"planes:\n{both}")
    # at twice this step one iteration more or less, by round-off, halves a step of one of the two
    sets = ('contacts.0.between=[note, ["*ar", feed]]', "run.margin=0.5 mm", "run.step=0.01 ms")
    half, whole = solved(text, *sets)
    assert half.statistics.max_force.min() > 0.05
    assert_same(half, whole)
