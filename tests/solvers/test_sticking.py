"""Friction that sticks, in runs: what it gives way by, where it slides, and that it does not creep.

With k_t the stiffness along the faces of a pair, what a force F below mu N holds by one box stands F/k_t
aside; a couple M turns it by M/(k_t r^2), r from the middle to a corner.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked
from stacks import stack

import mdlgen
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.rotations import turns
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

G = 9.81e-3  # [mm/ms^2]
MASS, K, K_T = 0.5, 2000.0, 50.0  # [g], [N/mm^1.5], [N/mm]
REST = (MASS * G / K) ** (2.0 / 3.0)  # how deep it lies [mm]
STICKING = f"{{static: 0.3, dynamic: 0.3, sticking: {K_T:g} N/mm}}"


def slope(
    degrees: float, friction: str = STICKING, boxes: str = "[1, 1]", more: str = "", run: str = ""
) -> str:
    """A stiff sheet of 10 mm on a fixed face, under weight that leans along x; it begins at rest."""
    lean = math.radians(degrees)
    asked = {"duration": "100 ms", "print_step": "1 ms", "step": "0.1 ms"}
    asked |= dict(item.split(": ") for item in run.split(", ") if item)
    n_x, n_y = map(int, boxes.strip("[]").split(","))
    deep = REST * (math.cos(lean) / (n_x * n_y)) ** (2.0 / 3.0)
    return f"""
name: slope
gravity: [{G * math.sin(lean) * 1e3!r} m/s^2, 0 m/s^2, {-G * math.cos(lean) * 1e3!r} m/s^2]
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 1e4 N*mm, D_cd: 1e4 N*mm}}}}
sheets:
  low:
    {{material: paper, size: [80 mm, 40 mm], thickness: 0.1 mm, mass: 1 g, boxes: [2, 1],
    center: [20 mm, 0 mm, -0.05 mm], clamp: {{edge: x_min, length: 40 mm}}}}
  top:
    {{material: paper, size: [10 mm, 10 mm], thickness: 0.1 mm, mass: {MASS} g, boxes: {boxes},
    center: [0 mm, 0 mm, {0.05 - deep!r} mm], {more}}}
contacts:
  - {{between: [low, top], stiffness: {K:g} N/mm^1.5, restitution: 0.2, friction: {friction}}}
run: {{{", ".join(f"{k}: {v}" for k, v in asked.items())}}}
"""


def solved(text: str, sets: tuple[str, ...] = ()) -> Result:
    result = mdlgen.solve(lower(loads(text, overrides=list(sets))), "lattice")
    assert as_asked(result), result.status
    return result


def middle(result: Result, name: str) -> np.ndarray:
    """Of a sheet [mm], (t, 3)."""
    part = next(s for s in result.model.sheets if s.name == name)
    return result.position[:, part.first : part.first + part.count].mean(axis=1)


@pytest.mark.parametrize("step", ["0.2 ms", "0.1 ms", "0.02 ms"])
def test_below_the_angle_of_friction_a_sheet_stays(step) -> None:
    result = solved(slope(5.0, run=f"step: {step}"))
    x = middle(result, "top")[:, 0]
    along = MASS * G * math.sin(math.radians(5.0))
    # the box also tilts by what its weight turns about the face, 1e-9 mm
    assert x[-1] == pytest.approx(along / K_T, rel=5e-4)
    assert np.abs(result.velocity[-1, 2]).max() < 1e-9, "1 nm/s"
    late = result.time > 50.0
    assert np.ptp(x[late]) < 1e-12
    assert abs(result.energy.balance_error) < 1e-8


def test_several_boxes_share_the_load_and_their_springs() -> None:
    """9 boxes have 9 pairs: each has k_t."""
    result = solved(slope(5.0, boxes="[3, 3]"))
    along = MASS * G * math.sin(math.radians(5.0))
    x = middle(result, "top")[:, 0]
    assert x[-1] - x[0] == pytest.approx(along / (9.0 * K_T), rel=0.1)
    assert np.ptp(x[result.time > 50.0]) < 1e-11


def test_above_the_angle_of_friction_it_slides() -> None:
    result = solved(slope(30.0, run="duration: 40 ms"))
    faster = G * (math.sin(math.pi / 6) - 0.3 * math.cos(math.pi / 6))
    v = result.velocity[:, 2, 0]
    # until its spring is at the limit it is held back by less
    assert v[-1] - v[20] == pytest.approx(faster * (result.time[-1] - result.time[20]), rel=1e-6)
    assert v[-1] == pytest.approx(faster * 40.0, rel=3e-3)
    assert abs(result.energy.balance_error) < 1e-6


def test_it_sticks_by_the_static_coefficient_and_slides_by_the_dynamic_one() -> None:
    friction = (
        f"{{static: 0.3, dynamic: 0.1, sticking: {K_T:g} N/mm, stiction_velocity: 1 mm/s, "
        "friction_velocity: 2 mm/s}"
    )
    held = solved(slope(12.0, friction, run="step: 0.05 ms"))  # tan 12 deg = 0.21
    assert np.ptp(middle(held, "top")[50:, 0]) < 1e-12
    slides = solved(slope(20.0, friction, run="duration: 40 ms, step: 0.05 ms"))  # 0.36
    v = slides.velocity[:, 2, 0]
    faster = G * (math.sin(math.radians(20.0)) - 0.1 * math.cos(math.radians(20.0)))
    assert v[-1] - v[20] == pytest.approx(faster * 20.0, rel=1e-6)
    # what moves at the same angle as the one that is held goes on
    moving = solved(slope(12.0, friction, more="velocity: [10 mm/s, 0 mm/s, 0 mm/s]", run="duration: 40 ms"))
    v = moving.velocity[:, 2, 0]
    faster = G * (math.sin(math.radians(12.0)) - 0.1 * math.cos(math.radians(12.0)))
    assert v[-1] - v[20] == pytest.approx(faster * 20.0, rel=1e-6)


def test_what_is_pushed_below_the_limit_comes_back_and_beyond_it_does_not() -> None:
    """A sheet that begins at v has moved v sqrt(m/k_t) where its spring would stop it: the limit is reached
    there at mu N sqrt(1/(k_t m)) = 0.294 mm/s."""
    run = "step: 0.01 ms, duration: 60 ms, print_step: 0.1 ms"
    back = solved(slope(0.0, more="velocity: [0.2 mm/s, 0 mm/s, 0 mm/s]", run=run))
    x = middle(back, "top")[:, 0]
    assert x.max() == pytest.approx(0.2e-3 * math.sqrt(MASS / K_T), rel=0.15)
    assert abs(x[-1]) < 1e-9
    gone = solved(slope(0.0, more="velocity: [20 mm/s, 0 mm/s, 0 mm/s]", run=run))
    x = middle(gone, "top")[:, 0]
    # it stops after v^2/(2 mu g), and springs back from the limit
    assert x[-1] == pytest.approx(0.02**2 / (2.0 * 0.3 * G), rel=1e-2)
    # at so fine a step its spring rings for long
    assert np.ptp(x[gone.time > 50.0]) < 1e-8
    assert gone.energy.dissipated == pytest.approx(0.5 * MASS * 0.02**2, rel=5e-3)


def test_a_stuck_sheet_gives_way_to_a_load_and_a_couple() -> None:
    load = "loads: [{{sheet: top, edge: x_max, {0}: [{1}]}}]"
    pulled = solved(slope(0.0) + load.format("force", "0 N, 0.0002 N, 0 N"))
    # about the middle, too, since it pulls at an edge
    assert middle(pulled, "top")[-1, 1] == pytest.approx(0.0002 / K_T, rel=1e-3)
    couple = 0.002  # N mm
    turned = solved(slope(0.0) + load.format("moment", f"0 N*mm, 0 N*mm, {couple} N*mm"))
    angle = turns(turned.rotation[-1, 2:3])[0, 1, 0]
    assert angle == pytest.approx(couple / (K_T * 50.0), rel=1e-3)
    assert np.abs(turned.spin[-1, 2]).max() < 1e-12
    over = solved(slope(0.0, run="duration: 20 ms") + load.format("moment", "0 N*mm, 0 N*mm, 0.02 N*mm"))
    # the limit is mu N r = 0.0104 N mm
    faster = (0.02 - 0.3 * MASS * G * math.sqrt(50.0)) / (MASS * 200.0 / 12.0)
    assert over.spin[-1, 2, 2] == pytest.approx(faster * 20.0, rel=2e-2)


PILE = "{static: 0.15, dynamic: 0.15, sticking: 50 N/mm}"


def pile(count: int, boxes: str) -> list[str]:
    contact = f"{{stiffness: 20000 N/mm^1.5, restitution: 0.2, friction: {PILE}, smoothing: 1 mm/s}}"
    return [
        f"piles.cassette.count={count}",
        f"sheets.note.boxes={boxes}",
        "rollers.pick.center=[0 mm, 0 mm, 130 mm]",
        "rollers.pick.drive=null",
        "rollers.pick.press=null",
        f"piles.cassette.contact={contact}",
        "contacts.floor.stiffness=20000 N/mm^1.5",
        f"contacts.pick.between=[cassette_{count}, pick]",
        f"probes.lead.sheet=cassette_{count}",
        "run={duration: 100 ms, print_step: 1 ms, step: 0.1 ms}",
        "require=[]",
    ]


@pytest.mark.parametrize(("count", "boxes"), [(5, "[4, 6]"), (20, "[2, 3]")])
def test_a_pile_at_rest_does_not_creep(count, boxes) -> None:
    from mdlgen.paths import samples

    result = mdlgen.solve(lower(mdlgen.load(samples() / "pile.yaml", pile(count, boxes))), "lattice")
    assert as_asked(result), result.status
    places = [middle(result, sheet.name)[:, :2] for sheet in result.model.sheets]
    moved = [place[-1] - place[50] for place in places]
    assert np.abs(moved).max() < 5e-8, "1 nm/s for 50 ms"
    # what impacts make as they settle, as with smoothed friction
    assert abs(result.energy.balance_error) < 5e-3


def momenta(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum at all times, (t, 3) each."""
    bodies = result.model.bodies
    count = sum(s.count for s in result.model.sheets)
    mass, inertia = bodies.mass[:count, None], bodies.inertia[:count]
    x, v, w = (a[:, :count] for a in (result.position, result.velocity, result.spin))
    turn = turns(result.rotation[:, :count])
    own = np.einsum("tnij,nj,tnkj,tnk->tni", turn, inertia, turn, w)
    return (mass * v).sum(axis=1), (np.cross(x, mass * v) + own).sum(axis=1)


def free(run: str) -> str:
    """Two sheets in space, askew, that meet while they slide past each other."""
    size = "material: paper, size: [60 mm, 60 mm], thickness: 0.1 mm, mass: 0.5 g"
    return f"""
name: free
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 10 N*mm, D_cd: 10 N*mm}}}}
sheets:
  low: {{{size}, boxes: [5, 6], center: [0 mm, 0 mm, 0 mm]}}
  top:
    {{{size}, boxes: [6, 5], center: [11 mm, 7 mm, 0.13 mm], turn: 23 deg,
    velocity: [0.3 m/s, 0.1 m/s, -0.1 m/s]}}
contacts:
  - between: [low, top]
    stiffness: 100 N/mm^1.5
    friction: {{static: 0.4, dynamic: 0.3, sticking: 5 N/mm}}
run: {{{run}}}
"""


def test_two_free_sheets_keep_their_momenta_and_their_energy() -> None:
    result = solved(free("duration: 3 ms, print_step: 0.1 ms, step: 0.02 ms"))
    linear, angular = momenta(result)
    assert np.abs(result.contact_friction).max() > 0.0
    assert np.abs(linear - linear[0]).max() < 1e-12
    assert np.abs(angular - angular[0]).max() < 1e-6  # of 10 N mm ms
    assert abs(result.energy.balance_error) < 1e-2
    assert result.energy.dissipated > 0.0


def test_results_converge_with_the_step() -> None:
    """Where a sheet that slides comes to rest; which step it sticks in makes the fall uneven."""
    ends = []
    for step in ("0.1 ms", "0.05 ms", "0.025 ms", "0.0125 ms", "0.00625 ms"):
        text = slope(3.0, more="velocity: [20 mm/s, 5 mm/s, 0 mm/s]", run=f"step: {step}")
        ends.append(middle(solved(text), "top")[-1, :2])
    misses = [float(np.linalg.norm(end - ends[-1])) for end in ends[:-1]]
    assert misses[0] < 1e-5 and misses[2] < misses[1] < 0.2 * misses[0] and misses[3] < 0.1 * misses[2]


def test_stretches_stay_where_pairs_are_searched_anew() -> None:
    """A sheet that flies over a leaning pile has all pairs searched, while the one below is held."""
    flies = "{material: paper, size: [10 mm, 10 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [2, 2], "
    flies += "center: [-20 mm, 0 mm, 1 mm], velocity: [1000 mm/s, 0 mm/s, 900 mm/s]}"
    contact = "{between: [top, fly], stiffness: 1 N/mm^1.5, friction: 0}"
    text = slope(5.0, run="duration: 150 ms").replace(
        "contacts:\n", f"  fly: {flies}\ncontacts:\n  - {contact}\n"
    )
    alone = solved(slope(5.0, run="duration: 150 ms"))
    result = solved(text)
    x, exact = middle(result, "top")[:, 0], middle(alone, "top")[:, 0]
    assert np.abs(x[100:] - exact[100:]).max() < 1e-11


def test_halves_of_a_scene_are_the_whole() -> None:
    text = stack(3, "[4, 6]").replace("friction: 0.3}", f"friction: {PILE}}}", 2)
    text = text.replace("name: stack", "name: stack\ngravity: [1 m/s^2, 0 m/s^2, -9.81 m/s^2]")
    # both end where iterations end, which is closer the less these may leave
    run = "run={{duration: 10 ms, print_step: 1 ms, step: 0.1 ms, tolerance: 1e-5, symmetry: {}}}"
    half, whole = (solved(text, (run.format(rule),)) for rule in ("true", "false"))
    assert half.halved and not whole.halved
    assert np.abs(half.position - whole.position).max() < 1e-8
    assert half.energy.dissipated == pytest.approx(whole.energy.dissipated, rel=1e-4)
    assert half.energy.elastic == pytest.approx(whole.energy.elastic, rel=1e-4)


def test_what_does_not_stick_is_said_in_one_line() -> None:
    with pytest.raises(SpecError, match=r"contacts\.0\.friction\.sticking: .*more than 0"):
        loads(slope(5.0, "{static: 0.3, dynamic: 0.3, sticking: 0 N/mm}"))
    with pytest.raises(SpecError, match=r"contacts\.0\.friction\.sticking: '0.5 um'"):
        loads(slope(5.0, "{static: 0.3, dynamic: 0.3, sticking: 0.5 um}"))
    model = lower(loads(slope(5.0)))
    assert model.contacts.sticking.tolist() == [K_T]
    for output in ("motionview", "motionsolve", "msolve"):
        with pytest.raises(RefusedError, match="low and top has friction that sticks"):
            mdlgen.emit(model, output)
    with pytest.raises(RefusedError, match="Exudyn: the contact of low and top has friction that sticks"):
        mdlgen.solve(model, "exudyn")
