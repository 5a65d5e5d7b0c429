"""Friction that sticks on what is no sheet: in nips, on planes and guides, of rollers. It does not creep,
slides from its limit on, and lets go by rolling as Carter has it.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.model.rotations import turns
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

G = 9.81e-3  # [mm/ms^2]
FRICTION = "{static: 0.4, dynamic: 0.4, sticking: 40 N/mm}"


def solved(text: str, *sets: str) -> Result:
    result = mdlgen.solve(lower(loads(text, overrides=list(sets))), "lattice")
    assert as_asked(result), result.status
    assert abs(result.energy.balance_error) < 5e-3
    return result


def middle(result: Result, name: str = "n") -> np.ndarray:
    """Of a sheet [mm], (t, 3)."""
    part = next(s for s in result.model.sheets if s.name == name)
    return result.position[:, part.first : part.first + part.count].mean(axis=1)


def stopped_nip(mass: float, aside: float = 0.0, run: str = "duration: 300 ms, step: 0.2 ms") -> str:
    """A card of that mass [g] hangs in a nip that stands, and holds 2 x 0.35 N at most of about 1.2 N."""
    return f"""
name: hangs
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 6 N*mm, D_cd: 6 N*mm, damping: {{ratio: 0.2}}}}}}
sheets:
  n:
    {{material: p, size: [54 mm, 36 mm], thickness: 0.4 mm, mass: {mass} g, boxes: [6, 4], layout: plate,
    rotation: [0 deg, 90 deg, 0 deg], center: [0 mm, {aside} mm, -15 mm]}}
rollers:
  a:
    {{center: [-10.19 mm, 0 mm, 0 mm], axis: y, radius: 10 mm, width: 14 mm, mass: 20 g,
    drive: {{speed: 0 rad/s}}}}
  b:
    {{center: [10.19 mm, 0 mm, 0 mm], axis: y, radius: 10 mm, width: 14 mm, mass: 20 g,
    drive: {{speed: 0 rad/s}},
    press: {{direction: -x, stiffness: 0.4 N/mm, preload: 1.2 N, damping_ratio: 0.3}}}}
contacts:
  - between: [n, [a, b]]
    stiffness: 200 N/mm^1.5
    friction: {{static: 0.35, dynamic: 0.35, sticking: 30 N/mm}}
    restitution: 0.3
    smoothing: 5 mm/s
run: {{{run}, margin: 30 mm}}
"""


def test_a_card_hangs_in_a_nip_that_stands() -> None:
    """At 60 % of the limit."""
    result = solved(stopped_nip(0.6 * 2 * 0.35 * 1.2 / G))
    z = middle(result)[:, 2]
    late = result.time >= 150.0
    assert np.ptp(z[late]) / 150.0 < 1e-6, "1e-3 mm/s"
    # both springs hold it, and the nips' first milliseconds, as they close, let it fall by some more
    held = 0.6 * 2 * 0.35 * 1.2 / (2 * 30.0)
    assert held < z[0] - z[-1] < 1.6 * held


def test_above_the_limit_a_card_slides_out_of_the_nip() -> None:
    """At 115 % of the limit it falls as what is left of its weight asks for."""
    mass = 1.15 * 2 * 0.35 * 1.2 / G
    result = solved(stopped_nip(mass, run="duration: 60 ms, step: 0.1 ms"))
    v = result.velocity[:, :24, 2].mean(axis=1)
    late = result.time >= 30.0
    force = 0.35 * result.contact_force[late].sum(axis=1).mean()
    faster = G - force / mass
    assert faster > 0.08 * G
    fall = np.polyfit(result.time[late], v[late], 1)[0]
    assert -fall == pytest.approx(faster, rel=0.02)


def test_a_card_that_hangs_by_its_side_does_not_turn() -> None:
    """Its weight acts 3 mm beside the nip, which holds a couple of 0.6 N mm on a line of 14 mm; it swings."""
    result = solved(stopped_nip(0.2 / G, aside=3.0, run="duration: 600 ms, step: 0.2 ms"))
    about = turns(result.rotation[:, :24])[:, :, 2, 1].mean(axis=1)
    earlier, later = (about[(result.time >= t) & (result.time < t + 200.0)].mean() for t in (200.0, 400.0))
    # k_t of both, evenly along the line: k_t L^2/12 each
    exact = -0.2 * 3.0 / (2 * 30.0 * 14.0**2 / 12.0)
    assert later == pytest.approx(exact, rel=2e-2)
    assert abs(later - earlier) < 2e-2 * abs(exact)


def slope(
    degrees: float, mu: float, run: str = "duration: 200 ms, step: 0.1 ms", more: str = "", k_t: float = 40.0
) -> str:
    """A block on a plane, under weight that leans."""
    lean = math.radians(degrees)
    return f"""
name: slope
gravity: [{G * math.sin(lean) * 1e3!r} m/s^2, 0 m/s^2, {-G * math.cos(lean) * 1e3!r} m/s^2]
materials: {{solid: {{E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}}}
sheets:
  n: {{material: solid, size: [30 mm, 20 mm], thickness: 12 mm, mass: 14 g, boxes: [1, 1],
    center: [0 mm, 0 mm, {6.0 - (14 * G * math.cos(lean) / 900) ** (2 / 3)!r} mm]{more}}}
planes: {{t: {{center: [100 mm, 0 mm, -5 mm], normal: z, size: [500 mm, 300 mm, 10 mm], mass: 100 g}}}}
contacts:
  - between: [n, t]
    stiffness: 900 N/mm^1.5
    restitution: 0.3
    friction: {{static: {mu}, dynamic: {mu}, sticking: {k_t:g} N/mm}}
run: {{{run}}}
"""


@pytest.mark.parametrize(("degrees", "k_t"), [(5.0, 40.0), (19.0, 400.0)])
def test_a_block_stays_on_a_slope_below_its_angle(degrees, k_t) -> None:
    """tan 19.3 deg = 0.35. It begins with its spring at rest, and swings up to the limit at first."""
    result = solved(slope(degrees, 0.35, "duration: 1000 ms, step: 0.5 ms", k_t=k_t))
    x = middle(result)[:, 0]
    assert np.abs(x - x[0]).max() < 0.01
    late = result.time >= 200.0
    assert np.ptp(x[late]) < 1e-9
    along = 14 * G * math.sin(math.radians(degrees))
    # it tilts by what its weight turns about the face, which moves its middle
    tilt = turns(result.rotation[-1, :1])[0, 0, 2]
    if degrees < 9.0:  # what swings twice as far does not slide
        assert x[-1] - 6.0 * tilt == pytest.approx(along / k_t, rel=1e-2)


def test_a_block_slides_on_a_slope_above_its_angle() -> None:
    result = solved(slope(20.0, 0.35))
    v = result.velocity[:, 0, 0]
    lean = math.radians(20.0)
    faster = G * (math.sin(lean) - 0.35 * math.cos(lean))
    assert v[-1] - v[len(v) // 2] == pytest.approx(faster * 100.0, rel=1e-3)


def test_a_block_swings_on_its_spring() -> None:
    """A push below the limit: a mass on k_t, with the energy that it had at first."""
    more = ", velocity: [1 mm/s, 0 mm/s, 0 mm/s]"
    result = solved(slope(0.0, 0.35, "duration: 12 ms, step: 0.005 ms, print_step: 0.02 ms", more))
    x, t = middle(result)[:, 0], result.time
    zeros = [
        t[i] - x[i] * (t[i + 1] - t[i]) / (x[i + 1] - x[i])
        for i in range(len(x) - 1)
        if x[i] * x[i + 1] < 0.0
    ]
    assert len(zeros) >= 3
    # its weight turns with it by 6 mm above the face: stiffness and inertia of the tilt take part
    assert np.diff(zeros).mean() == pytest.approx(math.pi * math.sqrt(14.0 / 40.0), rel=0.1)
    assert abs(result.energy.balance_error) < 1e-6
    assert np.abs(x).max() == pytest.approx(1e-3 * math.sqrt(14.0 / 40.0), rel=0.1)


def test_a_block_that_is_turned_about_the_normal_turns_back() -> None:
    """k_t at four corners resists by k_t r^2, r^2 = 15^2 + 10^2."""
    couple = "loads: [{sheet: n, edge: x_max, moment: [0 N*mm, 0 N*mm, 0.4 N*mm]}]\n"
    result = solved(slope(0.0, 0.35) + couple)
    angle = turns(result.rotation[:, :1])[:, 0, 1, 0]
    assert angle[-1] == pytest.approx(0.4 / (40.0 * 325.0), rel=1e-3)
    assert np.ptp(angle[result.time > 100.0]) < 1e-12


def rolling(force: float, run: str = "duration: 100 ms, step: 0.1 ms") -> str:
    """A note that a driven roller pulls against a force [N]; the roller above turns freely."""
    return f"""
name: creep
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 1 N*mm, D_cd: 1 N*mm, damping: {{ratio: 0.3}}}}}}
sheets:
  n: {{material: p, size: [200 mm, 40 mm], thickness: 0.2 mm, mass: 2 g, boxes: [40, 2], layout: plate,
    center: [-80 mm, 0 mm, 0 mm]}}
rollers:
  a:
    {{center: [0 mm, 0 mm, -8.09 mm], axis: y, radius: 8 mm, width: 30 mm, mass: 20 g,
    drive: {{speed: 125 rad/s, ramp: 20 ms}}}}
  b:
    {{center: [0 mm, 0 mm, 8.09 mm], axis: y, radius: 8 mm, width: 30 mm, mass: 2 g,
    press: {{direction: -z, stiffness: 0.5 N/mm, preload: 2 N, damping_ratio: 0.3}}}}
contacts:
  - {{between: [n, a], stiffness: 300 N/mm^1.5, friction: {FRICTION}, restitution: 0.3, smoothing: 5 mm/s}}
  - {{between: [n, b], stiffness: 300 N/mm^1.5, friction: {FRICTION}, restitution: 0.3, smoothing: 5 mm/s}}
loads: [{{sheet: n, edge: x_min, force: [{-force} N, 0 N, 0 N]}}]
run: {{{run}, margin: 60 mm}}
"""


def slip_of(result: Result) -> tuple[float, float]:
    """How much slower the note goes than the roller, in parts of both; and the force of the nip [N]."""
    late = result.time >= 0.5 * result.time[-1]
    x = middle(result)[late, 0]
    v = (x[-1] - x[0]) / np.ptp(result.time[late])
    return (1.0 - v) / (0.5 * (1.0 + v)), float(result.contact_force[late, 0].mean())


@pytest.mark.parametrize("force", [0.1, 0.3, 0.5, 0.7])
def test_a_nip_creeps_by_its_traction_as_carter_has_it(force) -> None:
    """xi = 2 mu N/(k_t a) (1 - sqrt(1 - F/(mu N))), whatever boxes pass. The limit is 0.79 N."""
    slip, nip = slip_of(solved(rolling(force)))
    deep = (nip / 300.0) ** (2.0 / 3.0)
    half = math.sqrt(2.0 * 8.0 * deep)
    exact = 2.0 * 0.4 * nip / (40.0 * half) * (1.0 - math.sqrt(1.0 - force / (0.4 * nip)))
    assert slip == pytest.approx(exact, rel=1e-2)


def test_the_creep_of_a_nip_depends_on_no_step_and_no_grid() -> None:
    slips = [
        slip_of(solved(rolling(0.5), *sets))[0]
        for sets in ((), ("run.step=0.02 ms",), ("sheets.n.boxes=[16, 2]",), ("sheets.n.boxes=[40, 6]",))
    ]
    assert slips == pytest.approx([slips[0]] * 4, rel=3e-3)


def test_what_pulls_more_than_the_nip_holds_slides() -> None:
    result = solved(rolling(0.9, "duration: 24 ms, step: 0.05 ms"))
    v = result.velocity[:, :80, 0].mean(axis=1)
    late = result.time >= 14.0
    nip = float(result.contact_force[late, 0].mean())
    # the roller above resists by its inertia alone, as it turns with the note: half of its mass
    faster = (0.4 * nip - 0.9) / (2.0 + 0.5 * 2.0)
    assert np.polyfit(result.time[late], v[late], 1)[0] == pytest.approx(faster, rel=0.05)


def test_a_web_without_load_rolls_as_fast_as_its_roller() -> None:
    slip, _ = slip_of(solved(rolling(0.0)))
    assert abs(slip) < 1e-5


def test_a_nip_that_starts_and_stops_keeps_its_register() -> None:
    """By the turn of its roller, to less than 2 um each time: what is lost adds up, what gives way does
    not."""
    corners, starts = [[0.0, 0.0]], 4
    for k in range(starts):
        at = 40.0 * k
        corners += [[at + 6.0, 100.0], [at + 20.0, 100.0], [at + 26.0, 0.0]]
        corners += [[at + 40.0, 0.0]] if k < starts - 1 else []
    profile = ", ".join(f"[{t} ms, {w} rad/s]" for t, w in corners)
    end = corners[-1][0]
    text = rolling(0.0, f"duration: {end + 30} ms, step: 0.1 ms").replace(
        "speed: 125 rad/s, ramp: 20 ms", f"profile: [{profile}]"
    )
    result = solved(text)
    turned = sum(0.5 * (w1 + w2) * 1e-3 * (t2 - t1) for (t1, w1), (t2, w2) in pairwise(corners))
    x = middle(result)[:, 0]
    assert abs(x[-1] - x[0] - 8.0 * turned) < 0.002 * starts


HOUSE = """
name: house
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
materials: {p: {E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 8 N*mm, D_cd: 8 N*mm}}
sheets:
  a: {material: p, size: [80 mm, 60 mm], thickness: 0.3 mm, mass: 1.6 g, boxes: [6, 4], layout: plate,
    rotation: [0 deg, -70 deg, 0 deg], center: [-13.847 mm, 0 mm, 37.66 mm]}
  b: {material: p, size: [80 mm, 60 mm], thickness: 0.3 mm, mass: 1.6 g, boxes: [6, 4], layout: plate,
    rotation: [0 deg, 70 deg, 0 deg], center: [13.847 mm, 0 mm, 37.66 mm]}
planes: {t: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [300 mm, 300 mm, 10 mm], mass: 100 g}}
contacts:
  - {between: [[a, b], t], stiffness: 300 N/mm^1.5, friction: FRICTION, restitution: 0.2, smoothing: 1 mm/s}
  - {between: [a, b], stiffness: 300 N/mm^1.5, friction: FRICTION, restitution: 0.2, smoothing: 1 mm/s}
run: {duration: 400 ms, step: 0.2 ms, margin: 60 mm}
"""


def test_cards_that_lean_on_each_other_stand_or_fall() -> None:
    """They stand where mu is above 0.18."""

    def lower_edge(mu: float) -> np.ndarray:
        friction = f"{{static: {mu}, dynamic: {mu}, sticking: 50 N/mm}}"
        result = solved(HOUSE.replace("FRICTION", friction))
        return result.position[:, 0, 0]

    stands, falls = lower_edge(0.5), lower_edge(0.1)
    assert abs(stands[-1] - stands[0]) < 0.05
    assert abs(falls[-1] - falls[0]) > 20.0


def test_a_scene_that_is_halved_sticks_as_the_whole_does() -> None:
    from mdlgen.paths import samples

    sets = ["contacts.*.friction={static: 0.32, dynamic: 0.32, sticking: 50 N/mm}", "require=[]"]
    sets += ["run.duration=25 ms", "run.step=0.05 ms", "run.tolerance=1e-5"]
    half, whole = (
        mdlgen.solve(
            lower(mdlgen.load(samples() / "transport_4x4.yaml", [*sets, f"run.symmetry={rule}"])), "lattice"
        )
        for rule in ("true", "false")
    )
    assert half.halved and not whole.halved
    assert np.abs(half.position - whole.position)[..., 0].max() < 1e-4
    assert half.energy.dissipated == pytest.approx(whole.energy.dissipated, rel=1e-2, abs=1e-3)


def test_what_passes_a_nip_changes_its_creep_by_nothing() -> None:
    """Boxes of different lengths, and another restitution."""
    widths = ", ".join("1" if k % 3 else "2.5" for k in range(40))
    slips = [
        slip_of(solved(text, *sets))[0]
        for text, sets in (
            (rolling(0.5), ()),
            (rolling(0.5), (f"sheets.n.grading={{x: [{widths}]}}",)),
            (rolling(0.5).replace("restitution: 0.3", "restitution: 0.9"), ()),
        )
    ]
    assert slips == pytest.approx([slips[0]] * 3, rel=1e-3)


@pytest.mark.parametrize("resistance", [0.1, 0.2])
def test_a_roller_that_another_one_drives_creeps_as_carter_has_it(resistance) -> None:
    """It is held back by the couple f N R of rolling resistance, R = 1/(1/10 + 1/6)."""
    text = f"""
name: rollers
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 3000 MPa}}}}
sheets:
  n: {{material: p, size: [10 mm, 10 mm], thickness: 0.2 mm, mass: 1 g, boxes: [1, 1],
    center: [99 mm, 0 mm, 0 mm]}}
rollers:
  a:
    {{center: [0 mm, 0 mm, 0 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 20 g,
    drive: {{speed: 100 rad/s, ramp: 5 ms}}}}
  b:
    {{center: [0 mm, 0 mm, 15.98 mm], axis: y, radius: 6 mm, width: 20 mm, mass: 5 g,
    press: {{direction: -z, stiffness: 0.5 N/mm, preload: 3 N, damping_ratio: 0.3}}}}
contacts:
  - between: [a, b]
    stiffness: 400 N/mm^1.5
    friction: {{static: 0.4, dynamic: 0.4, sticking: 60 N/mm}}
    smoothing: 5 mm/s
    rolling_resistance: {resistance}
  - {{between: [n, a], stiffness: 400 N/mm^1.5, friction: 0.3, smoothing: 5 mm/s}}
run: {{duration: 80 ms, step: 0.05 ms}}
"""
    result = solved(text)
    late = result.time > 50.0
    bodies = {roller.name: roller.body for roller in result.model.rollers}
    one, two = (abs(result.spin[late, bodies[name], 1].mean()) for name in "ab")
    nip = result.contact_force[late].sum(axis=1).mean()
    deep, curved = (nip / 400.0) ** (2.0 / 3.0), 1.0 / 10.0 + 1.0 / 6.0
    # surfaces meet halfway in the overlap
    fast, slow = one * (10.0 - 0.5 * deep), two * (6.0 - 0.5 * deep)
    pull, half = resistance * nip / curved / 6.0, math.sqrt(2.0 * deep / curved)
    exact = 2.0 * 0.4 * nip / (60.0 * half) * (1.0 - math.sqrt(1.0 - pull / (0.4 * nip)))
    assert (fast - slow) / (0.5 * (fast + slow)) == pytest.approx(exact, rel=1e-2)


@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_a_card_stays_half_over_a_round_edge(restitution) -> None:
    """Its weight leans by 8 deg of 21.8. It sags over the end at first."""
    lean = math.radians(8.0)
    result = solved(f"""
name: edge
gravity: [{G * math.sin(lean) * 1e3!r} m/s^2, 0 m/s^2, {-G * math.cos(lean) * 1e3!r} m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 3 N*mm, D_cd: 3 N*mm, damping: {{ratio: 0.3}}}}}}
sheets:
  n: {{material: p, size: [60 mm, 20 mm], thickness: 0.3 mm, mass: 2 g, boxes: [12, 2],
    center: [-8 mm, 0 mm, 0.15 mm]}}
planes: {{t: {{center: [-60 mm, 0 mm, -5 mm], normal: z, size: [120 mm, 60 mm, 10 mm], edge_radius: 2 mm}}}}
contacts:
  - {{between: [n, t], stiffness: 300 N/mm^1.5, friction: {FRICTION}, restitution: {restitution}}}
run: {{duration: 400 ms, step: 0.1 ms}}
""")
    x = middle(result)[:, 0]
    assert abs(x[-1] - x[0]) < 0.01
    assert abs(x[-1] - x[result.time >= 300.0][0]) < 1e-4


def hollow(lean: float, run: str = "duration: 300 ms, step: 0.1 ms") -> str:
    """A strip in an arc guide, with gravity that leans along it [deg]."""
    along, down = 1e3 * G * math.sin(math.radians(lean)), 1e3 * G * math.cos(math.radians(lean))
    return f"""
name: arc
gravity: [{along!r} m/s^2, 0 m/s^2, {-down!r} m/s^2]
materials: {{p: {{E_md: 3000 MPa, E_cd: 3000 MPa, D_md: 2 N*mm, D_cd: 2 N*mm, damping: {{ratio: 0.3}}}}}}
sheets: {{n: {{material: p, size: [14 mm, 20 mm], thickness: 0.2 mm, mass: 1 g, boxes: [4, 2],
    center: [0 mm, 0 mm, 0.16 mm]}}}}
guides:
  g:
    arc: {{center: [0 mm, 0 mm, 500 mm], axis: -y, radius: 500 mm, from: -100 deg, to: -80 deg, side: inside}}
    width: 40 mm
contacts:
  - {{between: [n, g], stiffness: 300 N/mm^1.5, friction: {FRICTION}, restitution: 0.3}}
run: {{{run}, margin: 30 mm}}
"""


@pytest.mark.parametrize("lean", [10.0, 30.0])
def test_a_strip_in_a_hollow_guide_stays_or_slides(lean) -> None:
    """The angle of friction is 21.8 deg."""
    result = solved(hollow(lean))
    x = middle(result)[:, 0]
    assert (np.ptp(x[result.time >= 150.0]) < 1e-6) == (lean < 21.8)
    assert (x[-1] > 20.0) == (lean > 21.8)
