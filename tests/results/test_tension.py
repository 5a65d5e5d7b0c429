"""Tension of sheets and the drag of what they slide on, against closed forms, in both solvers."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from ran import solved

from mdlgen.bench.oracles import belt
from mdlgen.bench.suites.validation import belts
from mdlgen.mechanics.curve import curve_points, curve_spring
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.io.series import series
from mdlgen.results.result import Result
from mdlgen.results.strain import sheet_joints, stretched
from mdlgen.results.tension import Tension, _Moves, curve_stress
from mdlgen.results.verdict import judge
from mdlgen.spec.load import load, loads

SOLVERS = ("lattice", "exudyn")
VERIFY = samples() / "verify"
FINE = "run.tolerance=1e-5"  # a step of 0.1 ms rings at a tenth of what a spinning sheet bears


def run(path: str, solver: str, *sets: str) -> Result:
    return solved(lower(load(VERIFY / f"{path}.yaml", sets)), solver)


def tension(result: Result, index: int = 0) -> Tension:
    found = result.tensions[index]
    assert found is not None
    return found


# -- a strip that hangs


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(("edge", "way", "boxes"), [("x_min", 1, "[20, 2]"), ("x_max", -1, "[7, 3]")])
@pytest.mark.parametrize("layout", ["edge_to_edge", "plate"])
def test_a_strip_that_hangs_bears_what_is_below(
    solver: str, edge: str, way: int, boxes: str, layout: str
) -> None:
    """T = m g (1 - s/L), s from the clamp, at the line between any two boxes."""
    sets = [f"sheets.strip.clamp.edge={edge}", f"gravity=[{9.81 * way} m/s^2, 0 m/s^2, 0 m/s^2]"]
    sets += [f"sheets.strip.boxes={boxes}", f"sheets.strip.layout={layout}"]
    result = run("hanging", solver, *sets)
    found = tension(result)
    assert found.axis == 0
    # statics in closed form; the solvers stop at 1e-6 of the load or less
    expected = 4.0 * 9.81e-3 * (0.5 - way * found.at / 200.0)
    assert found.force[-1] == pytest.approx(expected, rel=1e-6)
    record = result.summary()["sheets"]["strip"]["tension"]
    assert (record["along"], record["max_n"]) == ("md", pytest.approx(0.03924, rel=1e-6))
    assert (record["at_mm"], record["mean_at_mm"]) == (-100.0 * way, -100.0 * way)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("boxes", ["[20, 1]", "[6, 2]"])
def test_a_strip_whose_material_follows_a_curve_bears_what_pulls_it(solver: str, boxes: str) -> None:
    """30 MPa on 10 mm^2, at 3.2 %: the first modulus times the strain would give 5 % more."""
    for stress in (30, 10):
        sets = (f"sheets.strip.boxes={boxes}", f"loads.0.stress={stress} MPa")
        found = tension(run("tension", solver, *sets))
        # Newton stops at a residual that is small beside the load
        assert found.force[-1] == pytest.approx(10.0 * stress, rel=1e-6)


def test_a_curve_gives_what_the_solvers_follow() -> None:
    curves = lower(load(VERIFY / "tension.yaml")).curves
    strain = np.concatenate([np.linspace(-0.06, 0.06, 241), curves.strain])
    joint = SimpleNamespace(
        first=int(curves.start[0]),
        last=int(curves.start[1]) - 1,
        length=2.0,
        area=3.0,
        rise=float(curves.rise[0]),
    )
    points = curve_points(curves).view(np.recarray)  # fields by name, as compiled code has them
    law = [curve_spring.py_func(points, joint, 2.0 * e)[0] for e in strain]
    assert 3.0 * curve_stress(curves, 0, strain) == pytest.approx(law, rel=1e-12, abs=1e-12)


# -- dampers


def later(result: Result, after: float) -> Result:
    """All bodies a little later, each with the speed and the spin that it has."""
    turn = result.spin * after
    angle = np.linalg.norm(turn, axis=-1, keepdims=True)
    a, b = np.cos(0.5 * angle), 0.5 * np.sinc(0.5 * angle / np.pi) * turn
    c, d = result.rotation[..., :1], result.rotation[..., 1:]
    turned = [a * c - (b * d).sum(-1, keepdims=True), a * d + c * b + np.cross(b, d)]
    return replace(
        result, position=result.position + after * result.velocity, rotation=np.concatenate(turned, axis=-1)
    )


@pytest.mark.parametrize("scene", ["transport_4x4", "channel"])
def test_dampers_see_how_fast_joints_open(scene: str) -> None:
    """The rate is that of the elongations as states go on by what they have of speed and spin."""
    sets = ["sheets.note.boxes=[6, 5]", "sheets.note.turn=20 deg"] if scene == "transport_4x4" else []
    result = solved(lower(load(samples() / f"{scene}.yaml", [*sets, "run.duration=10 ms"])), "lattice")
    joints = sheet_joints(result.model)
    after = 1e-4
    for axis in sorted(set(joints.axis.tolist())):
        mine = np.flatnonzero(joints.axis == axis)
        every = slice(None)
        moves = _Moves(result.model, result.model.sheets[0], joints, mine, axis)
        rate, _ = moves.rates(result, every)
        one, two = (
            0.5 * sum(stretched(later(result, t), every, mine, axis)) * joints.length[mine]
            for t in (-after, after)
        )
        # of the second order in `after`, and 1e-14 mm of round-off over it
        assert np.abs(rate).max() > 5e-4
        assert rate == pytest.approx((two - one) / (2.0 * after), abs=1e-8)


# -- a strip that is pulled over a table, and over a drum

PULLED = """
name: pulled
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {p: {E_md: 50 MPa, E_cd: 50 MPa, D_md: 0.4 N*mm, D_cd: 0.4 N*mm, damping: {time: 0.3 ms}}}
sheets:
  strip: {material: p, size: [60 mm, 10 mm], thickness: 0.1 mm, mass: 1 g, boxes: [12, 1], layout: plate,
    center: [0 mm, 0 mm, 0.0497 mm], velocity: [0.1 m/s, 0 m/s, 0 m/s]}
planes: {table: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [400 mm, 100 mm, 10 mm], mass: 100 g}}
contacts: [{between: [strip, table], stiffness: 150 N/mm^1.5, restitution: 0, friction: 0.4,
  smoothing: 1 mm/s}]
loads: [{sheet: strip, edge: x_max, force: [0.01 N, 0 N, 0 N]}]
run: {duration: 30 ms, print_step: 0.1 ms}
"""
WEIGHT, MU, PULL = 9.81e-3, 0.4, 0.01  # [N], [N]


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_strip_that_is_pulled_over_a_table(solver: str) -> None:
    """The table takes mu m g; a section has in tow what is behind it: T = F (s/L), as friction and inertia
    are alike all along."""
    asked = (
        'require=["planes.table.contacts.strip.max_drag below 5 mN", "tension below 12 mN throughout",'
        ' "planes.table.contacts.strip.drag from 3.8 mN to 4 mN at 29 ms", "tension.min above -1 mN",'
        ' "planes.table.contacts.strip.drag below 3.9 mN throughout"]'
    )
    result = solved(lower(loads(PULLED, "pulled", (asked,))), solver)
    late = result.time > 15.0
    found = tension(result)
    drag = series(result)["table.strip.drag_n"]
    # the table holds the weight as soon as the strip lies still in it; by 1 % more while it does
    assert drag[late] == pytest.approx(MU * WEIGHT, rel=1e-4)
    # friction acts on the lower face: its couple moves mu m g (t/2) / L of the weight to the leading boxes
    couple = MU * MU * WEIGHT * 0.05 / 60.0
    assert couple < 2e-4 * PULL
    pulled = PULL * (found.at + 30.0) / 60.0
    assert found.force[late].mean(axis=0) == pytest.approx(pulled, abs=2e-4 * PULL)
    record = result.summary()
    contact = record["planes"]["table"]["contacts"]["strip"]
    touches = result.contact_force[:, 0] > 0.0
    assert contact["mean_drag_n"] == pytest.approx(drag[touches].mean(), rel=1e-12)
    assert (contact["max_drag_n"], contact["drag_n"]) == (drag.max(), drag[-1])
    outcomes = judge(result, record)
    assert [one.passed for one in outcomes] == [True, True, True, True, False]
    assert outcomes[0].value == pytest.approx(1e3 * drag.max()) and outcomes[0].unit == "mN"


# A strip in the shape of the arc that it slides over, pulled at both ends; polygons touch with their middles.
RADIUS, BAND, BOXES, END, HOLD, SPEED = 20.0, 0.1, 24, 4, 0.3, 0.05  # [mm], [mm], [N], [mm/ms]


def over_an_arc(degrees: float, mu: float) -> str:
    middle, angle = RADIUS + BAND / 2, math.radians(degrees)
    link = 0.5 * angle / BOXES
    length, top = BOXES * 2 * middle * math.tan(link), middle / math.cos(link)
    lead = HOLD * belt.polygon(mu * RADIUS / middle, angle, BOXES)
    x, z = math.cos(0.5 * angle), math.sin(0.5 * angle)
    return f"""
name: over_an_arc
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 1500 MPa, E_cd: 1500 MPa, D_md: 0.01 N*mm, D_cd: 0.01 N*mm,
  damping: {{ratio: 0.3}}}}}}
sheets:
  strip: {{material: p, size: [{length!r} mm, 12 mm], thickness: {BAND} mm, mass: 30 mg, boxes: [{BOXES}, 1],
    layout: plate, center: [0 mm, 0 mm, {top!r} mm],
    shape: {{curl: {{radius: {-length / angle!r} mm, along: x}}}},
    velocity: [{SPEED} m/s, 0 m/s, 0 m/s], spin: [0 rad/s, {1e3 * SPEED / middle!r} rad/s, 0 rad/s]}}
guides:
  way: {{arc: {{center: [0 mm, 0 mm, 0 mm], axis: -y, radius: {RADIUS} mm, from: 0 deg, to: 180 deg,
    side: outside}}, width: 30 mm}}
contacts: [{{between: [strip, way], stiffness: 200 N/mm^1.5, restitution: 0, friction: {mu},
  smoothing: 5 mm/s}}]
loads:
  - {{sheet: strip, edge: x_min, force: [{-HOLD * x!r} N, 0 N, {-HOLD * z!r} N]}}
  - {{sheet: strip, edge: x_max, force: [{lead * x!r} N, 0 N, {-lead * z!r} N]}}
run: {{duration: 4 ms, print_step: 0.02 ms}}
"""


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(("degrees", "mu"), [(90.0, 0.25), (120.0, 0.35)])
def test_a_strip_that_slides_over_an_arc_guide(solver: str, degrees: float, mu: float) -> None:
    """T2 / T1 = e^(mu phi), of links [(1 + mu tan h) / (1 - mu tan h)]^n, and the guide takes T2 - T1."""
    result = solved(lower(loads(over_an_arc(degrees, mu), "arc")), solver)
    late = result.time > 2.0
    found = tension(result)
    force = found.force[late].mean(axis=0)
    r, angle = mu * RADIUS / (RADIUS + BAND / 2), math.radians(degrees)
    inner = np.arange(END, BOXES - END)  # joints at whose sides no load bends the strip
    grows = [belt.polygon(r, angle * k / BOXES, k) for k in (inner - END + 1).tolist()]
    # the band's bending is a thousandth of its tension; links lie on the arc by turns with more and less
    assert force[inner] / force[END - 1] == pytest.approx(grows, rel=2e-3)
    drag = series(result)["way.strip.drag_n"][late].mean()
    # loads keep their direction while the strip turns by 0.03 rad: 3 % of the trailing one press on the arc
    assert drag == pytest.approx(HOLD * (belt.polygon(r, angle, BOXES) - 1.0), rel=3e-3)
    assert drag == pytest.approx(HOLD * (math.exp(r * angle) - 1.0), rel=5e-3)
    record = result.summary()
    assert record["sheets"]["strip"]["tension"]["mean_at_mm"] == found.at[-1]
    assert record["guides"]["way"]["contacts"]["strip"]["mean_drag_n"] == pytest.approx(drag, rel=0.05)


# -- a web between two nips


def test_a_web_that_is_drawn_between_two_nips() -> None:
    """The scene of the validation: L de/dt = v2 - v1 (1 + e), less the creep of both nips."""
    case = next(case for case in belts.cases(quick=False) if case.name.startswith("web"))
    result = solved(case.run.model(), "lattice")
    late = result.time >= result.time[-1] - 10.0
    found = tension(result)
    middle = result.sheet_motion(0)[0][late, 0].mean()  # it goes 5 mm meanwhile
    between = np.abs(found.at + middle) < belts.SPAN / 2 - 8.0
    assert between.sum() > 6
    force = found.force[late].mean(axis=0)
    expected = case.measure(result, None)[0].expected
    assert expected is not None
    assert expected == pytest.approx(1.47547, rel=1e-4)
    # nips of 46 um have a length, by which the span between them is not known better
    assert force[between] == pytest.approx(expected, rel=2e-3)
    # before the first nip and behind the second the web is free
    assert np.abs(force[[0, 1, -2, -1]]).max() < 1e-3 * expected


# -- sheets that bear nothing, and those that cannot

FREE = """
name: free
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {paper: {E_md: 3530 MPa, E_cd: 1113 MPa}}
sheets: {note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [4, 6],
  velocity: [0.6 m/s, 0.2 m/s, 0 m/s]}}
run: {duration: 10 ms, print_step: 0.1 ms}
"""


def free(*sets: str) -> Result:
    return solved(lower(loads(FREE, "free", sets)), "lattice")


def test_a_sheet_that_flies_has_no_tension_but_its_round_off() -> None:
    for sets in ((), ("sheets.note.turn=20 deg",), ("sheets.note.center=[900 mm, 800 mm, 700 mm]",)):
        assert not tension(free(*sets)).force.any()


def test_sections_are_across_the_way() -> None:
    for velocity, axis, count in (("[0.6 m/s, 0.2 m/s, 0 m/s]", 0, 3), ("[0.2 m/s, -0.6 m/s, 0 m/s]", 1, 5)):
        found = tension(free(f"sheets.note.velocity={velocity}"))
        assert (found.axis, found.force.shape[1]) == (axis, count)
        assert found.at == pytest.approx(-found.at[::-1], abs=1e-9) and (np.diff(found.at) > 0.0).all()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_spinning_sheet_bears_its_inertia(solver: str) -> None:
    """T(x) = m w^2 L/2 (1/4 - (x/L)^2) along its longer side. Between stored states of lattice and its forces
    half a step before there are 1.5 mN, as much as the twentieth part of it."""
    spin = 0.05
    turning = f"sheets.note.spin=[0 rad/s, 0 rad/s, {1e3 * spin} rad/s]"
    result = solved(
        lower(loads(FREE, "free", ("sheets.note.velocity=[0 m/s, 0 m/s, 0 m/s]", turning, FINE))), solver
    )
    found = tension(result)
    late = result.time > 6.0
    expected = 0.72 * spin**2 * 127.0 / 2.0 * (0.25 - (found.at / 127.0) ** 2)
    assert found.axis == 1
    # it begins without tension; what rings of that has its mean over a few periods
    assert found.force[late].mean(axis=0) == pytest.approx(expected, rel=1e-3)


def test_a_sheet_of_one_row_has_no_tension_along_it() -> None:
    result = free("sheets.note.boxes=[1, 6]")
    assert result.tensions == (None,)
    assert result.sheets["note"].tension is None
    assert result.summary()["sheets"]["note"]["tension"] is None
    assert "note.tension_max_n" not in series(result)
    assert free("sheets.note.boxes=[1, 1]").summary()["sheets"]["note"]["tension"] is None


def test_a_run_without_friction_in_its_file_has_no_drag() -> None:
    result = solved(lower(loads(PULLED, "pulled", ())), "lattice")
    older = replace(result, contact_friction=None)
    assert "table.strip.drag_n" in series(result) and "table.strip.drag_n" not in series(older)
    assert "drag_n" not in older.summary()["planes"]["table"]["contacts"]["strip"]
