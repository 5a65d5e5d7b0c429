"""What rolls or slides at a constant depth loses nothing to the damping of contacts (Eq. 11): sheets that
coast through frictionless nips of free rollers keep their speed, and a nip pulls with mu N."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import ran
from asked import as_asked
from papers import on_paper
from solids import binary, cylinder

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.mechanics.point import MOST_POINTS, OUT, POINT, resist_rolling
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.compare import compare
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads

pytestmark = pytest.mark.usefixtures("as_python")

# a sheet of 100 g at 0.5 m/s between rollers that press with 3 N
COAST = on_paper("""
name: coast
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: PLATE_PAPER}
sheets: {n: {material: p, size: [100 mm, 60 mm], thickness: 0.1 mm, mass: 100 g, boxes: [20, 6],
  layout: plate, velocity: [0.5 m/s, 0 m/s, 0 m/s]}}
rollers:
  low: {center: [0 mm, 0 mm, -7.5036 mm], axis: y, radius: 7.5 mm, width: 50 mm, mass: 10 g}
  top: {center: [0 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, width: 50 mm, mass: 5 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts:
  - {between: [n, "???"], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0, smoothing: 5 mm/s}
  - {between: [low, top], stiffness: 30 N/mm^1.5, friction: 0}
run: {duration: 20 ms, margin: 30 mm}
""")
PLANE = """
planes: {bed: {center: [0 mm, 0 mm, -5.0517 mm], normal: z, size: [227 mm, 300 mm, 10 mm], mass: 681 g}}
"""
LARGE = (
    "rollers.low.radius=20 mm",
    "rollers.low.center=[0 mm, 0 mm, -20.0503 mm]",
    "rollers.top.radius=12 mm",
    "rollers.top.center=[0 mm, 0 mm, 12.05 mm]",
)
LAYOUTS = {
    "plate": (),
    "e2e": ("sheets.n.layout=edge_to_edge", "sheets.n.boxes=[12, 3]"),
    "graded": ("sheets.n.grading={x: {near: [40 mm], width: 30 mm, ratio: 4}}",),
    "large": LARGE,
}


def solved(text: str, solver: str, *overrides: str, folder: Path | None = None) -> Result:
    return ran.solved(lower(loads(text, "rolling", overrides, folder=folder)), solver)


def damped(c_r: float) -> tuple[str, ...]:
    return (f"contacts.0.restitution={c_r}",)


def speed(result: Result, at: int = -1) -> float:
    """Of the sheet's centre of mass along x [mm/ms]."""
    part = result.model.sheets[0]
    boxes = slice(part.first, part.first + part.count)
    mass = result.model.bodies.mass[boxes]
    return float(mass @ result.velocity[at, boxes, 0] / mass.sum())


def loss(result: Result) -> float:
    """Part of the speed that is lost, with the elastic energy's share of the kinetic energy given back."""
    return 1.0 - speed(result) / speed(result, 0)


@pytest.mark.parametrize("c_r", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_sheet_coasts_through_a_frictionless_nip(layout: str, c_r: float) -> None:
    """No force but along the normals of rollers that turn freely: no power, so no loss."""
    assert abs(loss(solved(COAST, "lattice", *LAYOUTS[layout], *damped(c_r)))) < 1e-3


@pytest.mark.parametrize("c_r", [0.0, 0.5])
def test_a_sheet_coasts_through_a_frictionless_nip_in_exudyn(c_r: float) -> None:
    assert abs(loss(solved(COAST, "exudyn", *damped(c_r)))) < 1e-3


@pytest.mark.parametrize("c_r", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("plane", [300, 30000])
def test_a_sheet_coasts_under_one_roller_over_a_plane(plane: int, c_r: float) -> None:
    """The plane gives back all that it takes. Boxes sink into a soft one, each on its own as the roller comes
    to it, but slowly for the speed at which the nip presses in what passes."""
    text = "\n".join(line for line in COAST.splitlines() if "low" not in line) + PLANE
    bed = f"  - {{between: [n, bed], stiffness: {plane} N/mm^1.5, restitution: 1, friction: 0}}"
    text = text.replace('"???"', "top").replace("contacts:", f"contacts:\n{bed}")
    assert abs(loss(solved(text, "lattice", f"contacts.1.restitution={c_r}"))) < 1e-3


@pytest.mark.parametrize("c_r", [0.0, 0.35, 1.0])
@pytest.mark.parametrize("mass", ["10 g", "1 g", "0.3 g"])
@pytest.mark.parametrize("boxes", [(20, 6), (40, 6), (7, 3)])
def test_a_light_sheet_coasts(boxes: tuple[int, int], mass: str, c_r: float) -> None:
    """Its rollers differ in radius, but as a joint passes they press alike on both of its boxes, and neither
    fling the sheet about nor brake it. (Else 3.5 % of 1 g and 12 % of 0.3 g were lost in 20 ms.)"""
    grid = f"sheets.n.boxes=[{boxes[0]}, {boxes[1]}]"
    result = solved(COAST.replace("mass: 100 g", f"mass: {mass}"), "lattice", grid, *damped(c_r))
    assert abs(loss(result)) < 2e-4
    if boxes == (20, 6):
        assert np.ptp(result.position[:, :120, 2]) < 2e-3  # of 0.1 mm of thickness


def test_a_light_sheet_coasts_in_exudyn() -> None:
    result = solved(COAST.replace("mass: 100 g", "mass: 1 g"), "exudyn", *damped(0.35))
    assert abs(loss(result)) < 5e-4


@pytest.mark.parametrize("c_r", [0.0, 0.35, 1.0])
@pytest.mark.parametrize("radius", [5.0, 15.0])
def test_a_light_sheet_coasts_between_a_hard_and_a_soft_roller(radius: float, c_r: float) -> None:
    """Ten times as hard a roller is 4.6 times less deep: it reaches as far with a flatter pressure."""
    hard = (
        f"{{between: [n, top], stiffness: 3000 N/mm^1.5, restitution: {c_r}, friction: 0, smoothing: 5 mm/s}}"
    )
    text = COAST.replace("mass: 100 g", "mass: 1 g").replace('"???"', "low")
    text = text.replace("contacts:", f"contacts:\n  - {hard}")
    round_ = (f"rollers.top.radius={radius} mm", f"rollers.top.center=[0 mm, 0 mm, {radius + 0.05} mm]")
    assert abs(loss(solved(text, "lattice", *round_, f"contacts.1.restitution={c_r}"))) < 1e-3


# a sheet of 0.5 g between rollers of foam, each pressed in by 0.45 mm
FOAM = """
name: foam
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: {E_md: 3000 MPa, E_cd: 1500 MPa, D_md: 0.4 N*mm, D_cd: 0.24 N*mm}}
sheets: {n: {material: p, size: [67 mm, 60 mm], thickness: 0.1 mm, mass: 0.5 g, boxes: [10, 5], layout: plate,
  velocity: [0.4 m/s, 0 m/s, 0 m/s]}}
rollers:
  low: {center: [0 mm, 0 mm, -9.60186 mm], axis: y, radius: 10 mm, width: 30 mm, mass: 10 g}
  top: {center: [0 mm, 0 mm, 10.05 mm], axis: y, radius: 10 mm, width: 30 mm, mass: 5 g,
    press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts: [{between: [n, "???"], stiffness: 10 N/mm^1.5, restitution: 0.5, friction: 0, smoothing: 5 mm/s}]
run: {duration: 30 ms, margin: 30 mm, print_step: 0.25 ms}
"""


@pytest.mark.parametrize("c_r", [0.2, 1.0])
@pytest.mark.parametrize(("mass", "within"), [("0.5 g", 0.02), ("5 g", 0.003)])
def test_a_light_sheet_coasts_between_rollers_of_foam(mass: str, within: float, c_r: float) -> None:
    """At all times. (The lighter one went at 0.4 to 0.45 m/s in turns as joints passed, and 1 % of energy was
    made.) What is left comes as the roller finds its balance at first: damping leans with the round."""
    result = solved(FOAM.replace("mass: 0.5 g", f"mass: {mass}"), "lattice", *damped(c_r))
    speeds = [speed(result, k) for k in range(len(result.time))]
    assert np.ptp(speeds) < within * speeds[0]
    assert abs(result.energy.balance_error) < 1e-3


def test_a_foam_roller_on_a_hard_one_that_makes_energy_is_inaccurate_for_that_reason() -> None:
    """Thirty times as hard: where what the spread of the hard one gives is not small. The law makes as much
    at any step, so that the search ends with the first step that is fine enough, and the result is kept."""
    hard = "{between: [n, low], stiffness: 300 N/mm^1.5, restitution: 0.5, friction: 0, smoothing: 5 mm/s}"
    text = (
        FOAM.replace('"???"', "top")
        .replace("contacts: [", f"contacts: [{hard}, ")
        .replace("9.60186", "10.0036")
    )
    result = mdlgen.solve(lower(loads(text, "foam")), "lattice")
    assert result.status == "inaccurate" and result.time[-1] == pytest.approx(result.model.run.duration)
    assert "nips made" in result.error_unknown and "W105" in result.error_unknown
    assert "nips made" in result.summary()["mark"]
    assert abs(result.energy.balance_error) < 1e-3 and len(result.coarser) <= 2


# a card of 0.4 g is pushed out of a nip against a plate that stands aslant, and bends up or down
BENT = """
name: bent
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {card: {E_md: 4000 MPa, E_cd: 2000 MPa, D_md: 5.5 N*mm, D_cd: 2.8 N*mm}}
sheets: {card: {material: card, size: [66 mm, 30 mm], thickness: 0.27 mm, mass: 0.4 g, boxes: [22, 2],
  layout: plate, center: [-32 mm, 0 mm, 0 mm], velocity: [0.8 m/s, 0 m/s, 0 m/s]}}
rollers:
  motor: {center: [-10 mm, 0 mm, -10.13 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 12 g,
    drive: {speed: 80 rad/s}}
  idler: {center: [-10 mm, 0 mm, 6.13 mm], axis: y, radius: 6 mm, width: 20 mm, mass: 4 g,
    press: {direction: -z, stiffness: 0.5 N/mm, preload: 6 N}}
guides:
  way: {arc: {center: [0 mm, 0 mm, 40 mm], axis: -y, radius: 41 mm, from: -90 deg, to: 0 deg, side: inside},
    width: 34 mm}
contacts:
  - {between: [card, "?????"], stiffness: 400 N/mm^1.5, friction: 0.8, smoothing: 10 mm/s}
  - {between: [card, way], stiffness: 50 N/mm^1.5, restitution: 0.2, friction: 0.25, smoothing: 10 mm/s}
run: {duration: 30 ms, step: 0.02 ms, print_step: 0.2 ms}
"""
DOWN = (
    "guides.way.arc={center: [0 mm, 0 mm, -40 mm], axis: y, radius: 41 mm, from: -90 deg, to: 0 deg,"
    " side: inside}",
)


@pytest.mark.parametrize("sets", [(), DOWN], ids=["up", "down"])
@pytest.mark.parametrize(("solver", "within"), [("lattice", 1e-3), ("exudyn", 0.015)])
def test_energies_balance_where_unequal_rollers_push_a_bent_card(
    solver: str, within: float, sets: tuple[str, ...]
) -> None:
    """The rollers' radii differ, so does what they press on both sides of a joint (mechanics.contact). In
    Exudyn what is left halves with the step."""
    result = solved(BENT, solver, *sets)
    assert result.energy.elastic > 0.3  # it is bent
    assert abs(result.energy.balance_error) < within


@pytest.mark.parametrize("c_r", [0.0, 0.5])
def test_a_sheet_coasts_over_a_mesh_on_a_roller(tmp_path: Path, c_r: float) -> None:
    """The lower roller is a round mesh of 500 sides; its friction is that of the sheet's inertia alone."""
    (tmp_path / "round.stl").write_bytes(binary(*cylinder(7.5, 20.0, 500)))
    text = COAST + "meshes: {m: {file: round.stl, on: low, center: [0 mm, 0 mm, -7.5036 mm], mass: 9 g}}\n"
    text = text.replace("radius: 7.5 mm, width: 50 mm, mass: 10 g", "radius: 7 mm, width: 20 mm, mass: 1 g")
    text = text.replace('"???"', "top").replace(
        "contacts:", "contacts:\n  - {between: [n, m], stiffness: 300 N/mm^1.5, friction: 0.5}"
    )
    both = (f"contacts.0.restitution={c_r}", f"contacts.1.restitution={c_r}", "run.duration=10 ms")
    result = solved(text, "lattice", *both, folder=tmp_path)
    inertia = 0.0
    for roller in result.model.rollers:
        if roller.name == "low":
            inertia = roller.loaded_inertia / 7.5**2
    moving = 100.0 / (100.0 + inertia)  # the mesh is taken along without slip
    assert speed(result) / 0.5 == pytest.approx(moving, rel=1e-3)


@pytest.mark.parametrize("c_r", [0.0, 0.5, 1.0])
def test_a_sheet_coasts_through_a_nip_with_a_rim(c_r: float) -> None:
    """The rim is as round as the roller was; its sectors differ in nothing but their names."""
    rim = "rollers.low.rim={sectors: [{from: 60 deg, to: 150 deg, radius: 7.5 mm}]}"
    assert abs(loss(solved(COAST, "lattice", rim, *damped(c_r)))) < 1e-3


@pytest.mark.parametrize("c_r", [0.0, 0.5, 1.0])
def test_a_block_coasts_over_a_free_roller(c_r: float) -> None:
    """A block of 100 g that two rollers carry, pressed by a third."""
    text = COAST.replace("boxes: [20, 6]", "boxes: [1, 1]").replace(", layout: plate", "")
    text = text.replace("  layout: plate, velocity", "  velocity")
    assert abs(loss(solved(text, "lattice", *damped(c_r)))) < 1e-3


# -- the pull of a nip


@pytest.mark.parametrize("c_r", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("both", [False, True])
def test_a_slipping_nip_pulls_with_mu_n(both: bool, c_r: float) -> None:
    """Rollers that stand still brake a sheet: by mu N of one, by 2 mu N where both rub."""
    grip = 'contacts.0.between=[n, "???"]' if both else "contacts.0.between=[n, low]"
    text = (
        COAST
        if both
        else COAST.replace(
            "contacts:",
            "contacts:\n  - {between: [n, low], stiffness: 300 N/mm^1.5, smoothing: 5 mm/s, friction: 0}",
        ).replace('"???"', "top")
    )
    still = ("rollers.low.drive={speed: 0 rad/s}", "rollers.top.drive={speed: 0 rad/s}", grip)
    limits = [f"contacts.{k}.restitution={c_r}" for k in range(2)]
    result = solved(text, "lattice", *still, *limits, "contacts.0.friction=0.5", "run.duration=10 ms")
    normal = result.contact_force[:, : 2 if both else 1].sum(axis=1)
    # from the first stored state on, as the nip begins out of balance
    begin = len(result.time) // 4
    pulled = 100.0 * (speed(result, begin) - speed(result)) / (result.time[-1] - result.time[begin])
    assert pulled == pytest.approx(0.5 * normal[begin:].mean(), rel=0.01)


# -- the law


# -- rolling resistance

RESIST = (
    "contacts.0.rolling_resistance=0.02",
    "contacts.0.friction=1",
    "run.duration=16 ms",
)


def test_a_couple_is_f_n_r_and_its_power_is_lost() -> None:
    """By hand: f N R s(omega R / v_s), s the cubic STEP, against the relative angular velocity."""
    for rate in (0.4, 0.05, -0.05):
        out = np.zeros(OUT + 1 + POINT * MOST_POINTS)
        out[12] = 3.0
        resist_rolling(out, (0.1, 0.0, 0.0), (0.0, rate, 0.0), (0.0, 1.0, 0.0), 2.0, 0.01, 0.2)
        x = min(max(2.0 * rate / 0.2, -1.0), 1.0)
        couple = 0.01 * 3.0 * 2.0 * 0.5 * x * (3.0 - x * x)
        np.testing.assert_allclose(out[3:6], (0.0, couple, 0.0), atol=1e-15)
        np.testing.assert_allclose(out[9:12], (0.0, -couple, 0.0), atol=1e-15)
        assert out[14] == pytest.approx(couple * rate)


def _held(result: Result) -> float:
    """What holds sheet and rollers back once both turn with it: (m + I1/R1^2 + I2/R2^2) a [N]."""
    begin = len(result.time) // 4
    boxes = result.model.bodies.mass[: result.model.sheets[0].count]
    moved = float(boxes.sum()) + 0.5 * (10.0 + 5.0)  # even discs
    return moved * (speed(result, begin) - speed(result)) / (result.time[-1] - result.time[begin])


@pytest.mark.parametrize("c_r", [0.0, 0.5])
@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_rollers_that_resist_rolling_hold_a_sheet_back_by_f_n_each(solver: str, c_r: float) -> None:
    """The couple is f N R, and the lever of the friction that bears it R."""
    sets = (*RESIST, *damped(c_r), "sheets.n.boxes=[20,2]")
    result = solved(COAST, solver, *sets)
    without = solved(COAST, solver, *sets, "contacts.0.rolling_resistance=0")
    normal = result.contact_force[len(result.time) // 4 :, :2].mean(axis=0).sum()
    assert abs(_held(without)) < 2e-4 * normal
    assert _held(result) - _held(without) == pytest.approx(0.02 * normal, rel=5e-3)
    # what the run misses of its energy is the same without: the couple's work is all in the account
    missed, had = (r.energy.balance_error * r.energy.scale for r in (result, without))
    lost = result.energy.dissipated - without.energy.dissipated
    assert lost > 0.5
    assert abs(missed - had) < 5e-3 * lost


def test_rollers_that_resist_a_driven_one_take_f_n_v_of_its_power() -> None:
    """Two rollers, no sheet: 1/R = 1/R1 + 1/R2, so the couple takes f N v, v the speed of both rounds."""
    lines = [line for line in COAST.splitlines() if "between: [n" not in line]
    text = "\n".join(lines).replace("center: [0 mm, 0 mm, -7.5036 mm]", "center: [0 mm, 0 mm, -7.5 mm]")
    text = text.replace("center: [0 mm, 0 mm, 5.05 mm]", "center: [0 mm, 0 mm, 5 mm]")
    text = text.replace("velocity: [0.5 m/s, 0 m/s, 0 m/s]", "center: [0 mm, 0 mm, 90 mm]")
    rub = ("contacts.0.friction=1", "rollers.low.drive={speed: 40 rad/s, ramp: 1 ms}", "run.step=0.02 ms")
    lost = []
    for f in (0.0, 0.05):
        result = solved(text, "lattice", *rub, f"contacts.0.rolling_resistance={f}", "run.duration=30 ms")
        lost.append(result.energy.dissipated)
        normal = result.contact_force[:, 0].mean()
    way = 0.04 * 7.5 * (30.0 - 0.5)
    assert lost[1] - lost[0] == pytest.approx(0.05 * normal * way, rel=0.02)


@pytest.mark.parametrize("backend", ["motionview", "motionsolve"])
def test_a_text_that_cannot_say_it_refuses_by_name(backend: str) -> None:
    model = lower(loads(COAST, "rolling", RESIST))
    with pytest.raises(RefusedError, match=r"rolling_resistance of 0\.02"):
        mdlgen.emit(model, backend)


def test_a_resistance_where_nothing_rolls_is_found() -> None:
    idle = "contacts=[{between: [n, bed], stiffness: 300 N/mm^1.5, rolling_resistance: 0.1, friction: 0}]"
    found = [lint.code for lint in lints(lower(loads(COAST + PLANE, "rolling", (idle,))))]
    assert "W125" in found
    assert "W125" not in [lint.code for lint in lints(lower(loads(COAST, "rolling", RESIST)))]


@pytest.mark.parametrize("value", ["-0.1", "2", "nan"])
def test_a_coefficient_that_is_none_is_refused_where_it_stands(value: str) -> None:
    with pytest.raises(SpecError, match=r"contacts\.0\.rolling_resistance"):
        loads(COAST, "rolling", (f"contacts.0.rolling_resistance={value}",))


# -- the machine of the paper

SAMPLE = samples() / "transport_4x4.yaml"


def test_nip_forces_and_power_of_the_transport_at_the_step_that_it_chooses() -> None:
    """Nip forces that carry 5 % of the largest: below 1 % from those of a run at 4 us, in the mean over time.
    The drives give what the note and the rollers have of kinetic energy and what friction takes while they
    are brought to speed, not a power that goes on."""
    scene = load(SAMPLE)
    chosen = mdlgen.solve(lower(scene), "lattice")
    run = scene.run.model_copy(update={"step": 0.004})
    fine = mdlgen.solve(lower(scene.model_copy(update={"run": run})), "lattice")
    assert as_asked(chosen) and as_asked(fine)
    names = [
        f"{a} / {b}" for a, b in zip(chosen.model.contacts.part_a, chosen.model.contacts.part_b, strict=True)
    ]
    mean = fine.contact_force.mean(axis=0)
    off = compare(chosen, fine).nip_force
    carrying = [name for name, force in zip(names, mean, strict=True) if force > 0.05 * mean.max()]
    assert len(carrying) == 12
    assert max(off[name] for name in carrying) < 0.01
    assert chosen.energy.driven < 2.0 * chosen.energy.kinetic
    assert chosen.energy.driven == pytest.approx(chosen.energy.kinetic + chosen.energy.dissipated, rel=0.03)
