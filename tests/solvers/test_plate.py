"""Layout plate: an orthotropic plate in bending, twist, membrane and shear on any grid, and what holds it
together at the corners, beside the paper's two layouts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from corners import gaps

import mdlgen
from mdlgen.bench.oracles import plate
from mdlgen.bench.oracles.elastica import drop as elastica
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.lowering.plate import SHEAR_RATIO
from mdlgen.model.tables import CLAMP, JOINT_X, JOINT_Y, Model
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.results.strain import strains
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

PLATE = "sheets.note.layout=plate"
C2C = "sheets.note.layout=center_to_center"
E_MD, E_CD, D_MD, D_CD = 3530.0, 1113.0, 0.40, 0.242  # MPa, N mm: the sample cantilever
STILL = "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"
BOTH = pytest.mark.parametrize("solver", ["lattice", "exudyn"])
PATCH = """
name: patch
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.40 N*mm, D_cd: 0.242 N*mm{material}}}}}
sheets:
  note:
    {{material: p, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: {boxes}, layout: {layout}}}
supports: {supports}
loads: {loads}
probes: {probes}
run: {{analysis: static}}
"""


def model(name: str, *overrides: str) -> Model:
    return lower(load(samples() / f"{name}.yaml", overrides))


def solved(made: Model, solver: str = "lattice") -> Result:
    result = mdlgen.solve(made, solver)
    assert result.usable, result.status
    return result


def moved(made: Model, solver: str = "lattice") -> dict[str, np.ndarray]:
    """Displacement of each probe at rest [mm]."""
    result = solved(made, solver)
    motions = [result.anchor_motion(k)[0] for k in range(len(made.probes))]
    start = [made.sheets[0].center + np.array([*probe.at, 0.0]) for probe in made.probes]
    return {p.name: m[-1] - s for p, m, s in zip(made.probes, motions, start, strict=True)}


def free_edges(boxes: tuple[int, int]) -> float:
    """Part of the plate's compliance that the lattice has where loads put shear on all edges: the outer half
    of boxes there is rigid."""
    return 1 - (1 / boxes[0] + 1 / boxes[1]) / 2


def rigid_corners(boxes: tuple[int, int]) -> float:
    """Deflection of a corner in parts of the plate's: a box does not twist itself."""
    return 1 - 1 / (boxes[0] * boxes[1])


# -- bending


@BOTH
@pytest.mark.parametrize(
    ("edge", "length", "stiffness", "tolerance"),
    [("y", 127.0, D_CD, 0.0025), ("x", 67.0, D_MD, 0.01)],
    ids=["20 boxes along y", "10 boxes along x"],
)
def test_a_cantilever_is_the_heavy_elastica(
    solver: str, edge: str, length: float, stiffness: float, tolerance: float
) -> None:
    """The hinge chain is off by 0.19 % with 20 boxes, and by four times that with 10 (oracles)."""
    ends = (f"sheets.note.clamp.edge={edge}_min", f"probes.tip.edge={edge}_max")
    fallen = -moved(model("cantilever", PLATE, *ends), solver)["tip"][2]
    group = 0.72e-3 / (67 * 127) * 1e3 * 9.81e-3 * length**3 / stiffness
    assert fallen == pytest.approx(elastica(group) * length, rel=tolerance)


@BOTH
@pytest.mark.parametrize(("axis", "stiffness"), [("x", D_MD), ("y", D_CD)])
def test_an_end_moment_closes_the_strip(solver: str, axis: str, stiffness: float) -> None:
    """M = 2 pi D W/L: a circle on any grid; what is left is the membrane's own stretch."""
    size = {"x": 67.0, "y": 127.0}
    boxes = [10, 20] if solver == "lattice" else [2, 8] if axis == "y" else [8, 2]
    width = size["y" if axis == "x" else "x"]
    moment = 2 * math.pi * stiffness * width / size[axis]
    about = [moment, 0.0, 0.0] if axis == "y" else [0.0, -moment, 0.0]
    message = ", ".join(f"{m!r} N*mm" for m in about)
    made = model(
        "cantilever",
        PLATE,
        STILL,
        f"sheets.note.boxes={boxes}",
        f"sheets.note.clamp.edge={axis}_min",
        f"probes.tip.edge={axis}_max",
        f"loads=[{{sheet: note, edge: {axis}_max, moment: [{message}]}}]",
    )
    shut = moved(made, solver)["tip"]
    there = np.array([-67.0, 0.0, 0.0]) if axis == "x" else np.array([0.0, -127.0, 0.0])
    assert np.abs(shut - there).max() < 1e-5 * size[axis]


# -- twist


def twisted(
    boxes: tuple[int, int],
    layout: str,
    near: float,
    material: str = "",
    solver: str = "lattice",
    more: str = "",
) -> float:
    """D66 [N mm] of a sheet held at three of its corners and pressed at the fourth, w = P a b / (4 D66)
    (Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells, section 11).

    `near` is about what is expected: the corner moves by the thickness then; more would stretch the sheet.
    """
    force = 0.1 * 4 * near / (67 * 127)
    corners = [(sx, sy) for sy in (-1, 1) for sx in (-1, 1)]
    at = [f"[{sx * 33.5} mm, {sy * 63.5} mm]" for sx, sy in corners]
    fixed = ("[x, y, z]", "[y, z]", "[z]")
    text = PATCH.format(
        boxes=list(boxes),
        layout=layout,
        material=material,
        supports=[f"{{sheet: note, at: {a}, fix: {f}}}" for a, f in zip(at, fixed, strict=False)],
        loads=f"[{{sheet: note, at: {at[3]}, force: [0 N, 0 N, {force!r} N]}}]",
        probes=f"{{corner: {{sheet: note, at: {at[3]}}}}}",
    ).replace("'", "")
    text = text.replace(f"layout: {layout}", f"layout: {layout}{more}")
    lifted = moved(lower(loads(text)), solver)["corner"][2]
    return force * 67 * 127 / (4 * lifted)


@pytest.mark.parametrize(
    ("solver", "boxes"),
    [
        *(("lattice", boxes) for boxes in ((10, 20), (8, 4), (3, 2), (1, 5))),
        *(("exudyn", boxes) for boxes in ((10, 20), (3, 2))),  # whose statics do not converge with 8 x 4
    ],
    ids=str,
)
def test_a_corner_twists_as_that_of_a_plate(solver: str, boxes: tuple[int, int]) -> None:
    """But for the corner box itself within 0.1 %: what the sheet stretches; D_twist given and left out."""
    given = twisted(boxes, "plate", 20.0, ", D_twist: 20 N*mm", solver)
    assert given * rigid_corners(boxes) == pytest.approx(20.0, rel=1e-3)
    if solver == "lattice":
        own = SHEAR_RATIO * math.sqrt(D_MD * D_CD)
        assert twisted(boxes, "plate", own) * rigid_corners(boxes) == pytest.approx(own, rel=0.01)


def test_a_corner_twists_so_on_a_graded_grid_too() -> None:
    """The corner boxes have 3/8 and 1/4 of the sides: a part 3/8 * 1/4 of the deflection is theirs."""
    graded = ", grading: {x: [3, 2, 3], y: [2, 1, 1, 2, 2]}"
    given = twisted((3, 5), "plate", 20.0, ", D_twist: 20 N*mm", more=graded)
    missing = sum(x * y for x in (3 / 8, 3 / 8) for y in (2 / 8, 2 / 8)) / 4
    assert given * (1 - missing) == pytest.approx(20.0, rel=1e-3)


@pytest.mark.parametrize("boxes", [(10, 20), (8, 4)], ids=str)
def test_a_corner_twists_in_c2c_where_d_twist_is_given(boxes: tuple[int, int]) -> None:
    given = twisted(boxes, "center_to_center", 20.0, ", D_twist: 20 N*mm")
    assert given * rigid_corners(boxes) == pytest.approx(20.0, rel=1e-3)


def strip_in_torsion(boxes: tuple[int, int], edge: str, more: str = "", solver: str = "lattice") -> float:
    """Rotation over torque [rad/(N mm)] of a strip of 100 by 20 mm clamped at one end, by forces at the
    corners of the other that turn it by about 1e-3 rad."""
    along = edge[0] == "x"
    far = -50.0 if edge.endswith("max") else 50.0
    at = [f"[{far} mm, {w} mm]" if along else f"[{w} mm, {far} mm]" for w in (-10.0, 10.0)]
    if not along:
        boxes = (boxes[1], boxes[0])
    size = "[100 mm, 20 mm]" if along else "[20 mm, 100 mm]"
    # the same plate, whichever way it lies
    stiff = "D_md: 0.4 N*mm, D_cd: 0.24 N*mm" if along else "D_md: 0.24 N*mm, D_cd: 0.4 N*mm"
    torque = 1e-4
    if solver == "exudyn":  # which loses less force to the round-off of its hinges in a stiffer sheet
        stiff, torque = stiff.replace("0.4 ", "400 ").replace("0.24 ", "240 "), 0.1
    twist = "120" if solver == "exudyn" else "0.12"
    made = lower(
        loads(f"""
name: torsion
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3530 MPa, E_cd: 1113 MPa, {stiff}, D_twist: {twist} N*mm}}}}
sheets:
  n: {{material: p, size: {size}, thickness: 0.1 mm, mass: 0.2 g, boxes: {list(boxes)}, layout: plate{more},
      clamp: {{edge: {edge}}}}}
loads:
- {{sheet: n, at: {at[0]}, force: [0 N, 0 N, {-torque / 20} N]}}
- {{sheet: n, at: {at[1]}, force: [0 N, 0 N, {torque / 20} N]}}
probes: {{one: {{sheet: n, at: {at[0]}}}, two: {{sheet: n, at: {at[1]}}}}}
run: {{analysis: static}}
""")
    )
    ends = moved(made, solver)
    found = (ends["two"][2] - ends["one"][2]) / 20 / torque
    return found * (1000.0 if solver == "exudyn" else 1.0)


@pytest.mark.parametrize("edge", ["x_min", "x_max", "y_min", "y_max"])
@pytest.mark.parametrize(
    ("boxes", "tolerance"), [((20, 1), 0.04), ((20, 2), 0.005), ((20, 4), 0.005), ((40, 8), 0.0025)], ids=str
)
def test_a_strip_in_torsion_is_the_plate(boxes: tuple[int, int], tolerance: float, edge: str) -> None:
    """By Ritz, which is not the lattice's. The outer half of boxes left out, it is off by 107, 34, 15.5 and
    7.4 %; one box across cannot warp, and so misses what the clamp does to that."""
    expected = plate.torsion(100.0, 20.0, 0.4, 0.24, 0.12)
    assert strip_in_torsion(boxes, edge) == pytest.approx(expected, rel=tolerance)


def test_a_strip_in_torsion_in_the_other_solver() -> None:
    expected = plate.torsion(100.0, 20.0, 0.4, 0.24, 0.12)
    assert strip_in_torsion((20, 4), "x_min", solver="exudyn") == pytest.approx(expected, rel=0.005)


def test_a_graded_strip_with_a_zone_in_torsion() -> None:
    """Rows that are narrow at the edges, and twice as stiff all over: half of the rotation. The widest row
    is a third of the strip, so what is of second order is 0.5 %."""
    expected = plate.torsion(100.0, 20.0, 0.4, 0.24, 0.12) / 2
    zone = "zones: {w: {x: [-50 mm, 50 mm], y: [-10 mm, 10 mm], stiffness: 2}}"
    found = strip_in_torsion((20, 5), "x_min", f", grading: {{y: [1, 2, 3, 2, 1]}}, {zone}")
    assert found == pytest.approx(expected, rel=0.006)


def test_the_papers_layouts_do_not() -> None:
    """Two corners lock the twist; one bushing has in it what the shape of its box makes of the hinges."""
    assert twisted((10, 20), "edge_to_edge", 1e4) > 1e3
    square, long = (twisted(boxes, "center_to_center", 0.2) for boxes in ((10, 20), (10, 5)))
    assert long > 2 * square


# -- in the plane


@BOTH
@pytest.mark.parametrize("boxes", [(10, 20), (3, 5)], ids=str)
def test_a_sheet_shears_as_a_plate(solver: str, boxes: tuple[int, int]) -> None:
    """Shear all round: angle = tau/G, for the part of the lattice that shears; both edges' turns added."""
    stress = 1e-3  # MPa: far more would buckle it
    over = {"x": stress * 0.1 * 127, "y": stress * 0.1 * 67}
    pulls = [
        f"{{sheet: note, edge: {axis}_{end}, force: {force}}}"
        for axis, form in (("x", "[0 N, {} N, 0 N]"), ("y", "[{} N, 0 N, 0 N]"))
        for end, force in (("min", form.format(-over[axis])), ("max", form.format(over[axis])))
    ]
    text = PATCH.format(
        boxes=list(boxes),
        layout="plate",
        material=", G: 600 MPa",
        supports="[{sheet: note, at: [3 mm, 3 mm], fix: [x, y, z]}, "
        "{sheet: note, at: [30 mm, 3 mm], fix: [y, z]}, {sheet: note, at: [3 mm, 60 mm], fix: [z]}]",
        loads=pulls,
        probes="{west: {sheet: note, edge: x_min}, east: {sheet: note, edge: x_max}, "
        "south: {sheet: note, edge: y_min}, north: {sheet: note, edge: y_max}}",
    ).replace("'", "")
    ends = moved(lower(loads(text)), solver)
    angle = (ends["east"] - ends["west"])[1] / 67 + (ends["north"] - ends["south"])[0] / 127
    assert angle == pytest.approx(stress / 600 * free_edges(boxes), rel=1e-3)


@pytest.mark.parametrize("boxes", [(1, 20), (3, 20), (10, 20), (10, 7)], ids=str)
def test_a_strip_bends_in_its_plane_as_a_beam(boxes: tuple[int, int]) -> None:
    """Tip M L^2/(2 E I), I = s W^3/12, on any grid: joints side by side and their own turn add up to it.

    The end has the stress of bending, a force and a moment for each box, so that the whole sheet bends alike.
    """
    bend, width = 1e-7, 67 / boxes[0]  # 1/mm; at 2.5e-7 the sheet buckles aside
    places = [(k + 0.5) * width - 33.5 for k in range(boxes[0])]
    pulls = [
        f"{{sheet: note, at: [{x!r} mm, 63.5 mm], force: [0 N, {E_CD * 0.1 * width * bend * x!r} N, 0 N]}}"
        for x in places
    ]
    own = boxes[0] * E_CD * 0.1 * width**3 / 12 * bend
    pulls.append(f"{{sheet: note, edge: y_max, moment: [0 N*mm, 0 N*mm, {own!r} N*mm]}}")
    sets = (f"sheets.note.boxes={list(boxes)}", f"loads=[{', '.join(pulls)}]")
    made = model("cantilever", PLATE, STILL, *sets)
    assert -moved(made)["tip"][0] == pytest.approx(bend * 127**2 / 2, rel=1e-3)
    message = strains(solved(made))
    assert message is not None  # and at the sheet's edges each joint has the beam's strain
    assert message.stretch.value.max() == pytest.approx(bend * 33.5, rel=1e-3)
    assert message.squeeze.value.min() == pytest.approx(-bend * 33.5, rel=1e-3)


def test_stiffness_of_each_joint() -> None:
    """As the formulas have it, clamps twice that, and at free edges half as much more in twist; the
    material's k_tz has no part in it."""
    made = model("cantilever", PLATE, "materials.eur10.G=700 MPa", "materials.eur10.D_twist=0.2 N*mm")
    rows, d_x, d_y = made.bushings, 6.7, 6.35
    for kind, times in ((JOINT_X, 1.0), (JOINT_Y, 1.0), (CLAMP, 2.0)):
        along_x = kind == JOINT_X
        length, width = (d_x, d_y) if along_x else (d_y, d_x)
        modulus, bending = (E_MD, D_MD) if along_x else (E_CD, D_CD)
        shape = width / length
        pull, shear = modulus * 0.1 * shape, 2 * 700 * 0.1 * shape
        roll, bend = 2 * 0.2 * shape, bending * shape
        across, turn = 10 * 3530 * 0.1 * d_y / d_x, pull * width**2 / 12
        six = [pull, shear, across, roll, bend, turn] if along_x else [shear, pull, across, bend, roll, turn]
        mine = rows.kind == kind
        found, own = rows.k[mine], np.tile(times * np.array(six), (int(mine.sum()), 1))
        # the first and the last row; of columns, too, also where they begin at the clamp along y_min
        strip, strips = (rows.node[mine, 1], 20) if along_x else (rows.node[mine, 0], 10)
        free = strip == 2 * strips - 1
        free |= (strip == 1) & (not along_x)
        own[free, 3 if along_x else 4] *= 1.5
        np.testing.assert_allclose(found, own, rtol=1e-12)
        assert free.sum() == {JOINT_X: 9, JOINT_Y: 38, CLAMP: 2}[kind]


def test_what_is_left_out_does_not_depend_on_how_bending_is_given() -> None:
    """k_tx, k_ty of a bushing and the D_cd, D_md that they stand for give the same joints."""
    plates = model("cantilever", PLATE)
    hinges = model(
        "cantilever",
        PLATE,
        f"materials.eur10.k_tx={D_CD * 6.7 / 6.35!r} N*mm/rad",
        f"materials.eur10.k_ty={D_MD * 6.35 / 6.7!r} N*mm/rad",
    )
    np.testing.assert_allclose(hinges.bushings.k, plates.bushings.k, rtol=1e-12)
    np.testing.assert_allclose(hinges.bushings.c, plates.bushings.c, rtol=1e-12)


@pytest.mark.parametrize(
    "given", [(), ("materials.eur10.G=700 MPa", "materials.eur10.D_twist=0.2 N*mm")], ids=len
)
def test_the_text_says_the_same_where_boxes_differ(given: tuple[str, ...]) -> None:
    sets = (
        "sheets.note.boxes=[3,4]",
        "sheets.note.clamp.edge=x_min",
        "sheets.note.grading={x: [1,2,1]}",
        "sheets.note.zones={w: {x: [3 mm, 20 mm], y: [-20 mm, 5 mm], density: 0.7, stiffness: 1.5}}",
    )
    scene = load(samples() / "cantilever.yaml", [PLATE, *sets, *given])
    found = verify(scene, lower(scene))
    assert found.ok, found.differences
    assert found.perturbed is not None and found.perturbed.values >= 19


@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
def test_g_is_refused_where_it_does_not_act(layout: str) -> None:
    with pytest.raises(SpecError, match=r"materials\.eur10\.G.*sheet note: G acts with layout plate only"):
        load(samples() / "cantilever.yaml", [f"sheets.note.layout={layout}", "materials.eur10.G=700 MPa"])


# -- cohesion

# the same bending for each layout: what two hinges of the sample have together
SAME = (
    "materials.eur10.D_md=0.3904 N*mm",
    "materials.eur10.D_cd=0.2843 N*mm",
)
PAPER_C2C = "materials.eur10.k_tz=10 N*mm/rad"  # Table 2


def test_corners_stay_together_where_the_sheet_is_pulled_in_its_plane() -> None:
    """Askew at a far corner, too little to buckle it: within 10 % of edge_to_edge; center_to_center opens
    more than twice as far."""
    pull = "loads=[{sheet: note, at: [20 mm, 60 mm], force: [0.01 N, 0.01 N, 0 N]}]"
    open_ = {
        name: gaps(solved(model("cantilever", STILL, pull, *sets))).opening.max()
        for name, sets in {"e2e": (), "c2c": (C2C, PAPER_C2C), "plate": (PLATE,)}.items()
    }
    assert open_["plate"] < 1.1 * open_["e2e"]
    assert open_["c2c"] > 2 * open_["e2e"]


def test_corners_under_the_nips_part_by_twist_alone() -> None:
    """In the sheet they open no more than twice as far as in edge_to_edge. Across it they part as rigid boxes
    must that twist; but for that, no more than twice as far, too. What hardly twists hardly steps, and takes
    no longer (linear solves of equal steps, whatever else the machine does)."""
    results = {
        name: solved(model("transport_4x4", "run.step=62.5 us", *SAME, *sets))
        for name, sets in {
            "e2e": (),
            "plate": (PLATE,),
            "stiff": (PLATE, "materials.eur10.D_twist=1000 N*mm"),
        }.items()
    }
    e2e, plate, stiff = (gaps(result) for result in results.values())
    assert plate.opening.max() < 2 * e2e.opening.max()
    assert np.abs(plate.step - plate.twist).max() < 2 * np.abs(e2e.step - e2e.twist).max()
    assert plate.step.max() > 10 * e2e.widest()  # the sheet does twist, which edge_to_edge does not
    assert stiff.widest() < 2 * e2e.widest()
    iterations = {name: result.iterations or 0 for name, result in results.items()}
    assert 0 < iterations["stiff"] < 1.2 * iterations["e2e"]
    assert iterations["plate"] < 1.6 * iterations["e2e"]
