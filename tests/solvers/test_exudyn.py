"""The Exudyn backend against closed forms (oracles), conservation laws, and its own checks."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from asked import as_asked
from by_exudyn import CANTILEVER, POST, run, run_text
from papers import on_paper

from mdlgen.backends.exudyn_local import solve
from mdlgen.cli import app
from mdlgen.model.lower import lower
from mdlgen.spec.load import load, loads

# in which a block comes to rest, or to an even acceleration, at a step that sliding needs
SHORT = ("run.duration=200 ms", "run.step=0.1 ms")


def drop_of(*overrides):
    return -run(CANTILEVER, *overrides).anchor_motion(0)[0][-1, 2]


def test_cantilever_is_the_heavy_elastica_and_second_order():
    # drop of D = 2.42e-4 N m, L = 127 mm: 0.602604470 L; relative lattice errors 0.772, 0.193, 0.048 %
    exact = 0.602604470 * 127
    errors = [drop_of(f"sheets.note.boxes=[2,{rows}]") / exact - 1 for rows in (10, 20, 40)]
    assert abs(errors[1]) < 0.005
    for coarse, fine in pairwise(errors):
        assert math.log2(coarse / fine) >= 1.8
    assert errors[1] == pytest.approx(0.00193, rel=0.01)  # the half-cell hinge chain, to 1 % of its error


@pytest.mark.parametrize(("stiffness", "exact"), [("0.1 N*mm", 102.4555), ("0.5 N*mm", 47.7240)])
def test_cantilever_of_other_stiffness(stiffness, exact):
    drop = drop_of("sheets.note.boxes=[2,40]", f"materials.eur10.D_cd={stiffness}")
    assert drop == pytest.approx(exact, rel=0.003)  # 40 rows are within 0.15 % of the continuum at Gamma = 17


def test_cantilever_does_not_see_the_worlds_turn_nor_the_layout():
    straight = drop_of("sheets.note.boxes=[2,20]")
    turned = drop_of("sheets.note.boxes=[2,20]", "sheets.note.turn=30 deg")
    central = drop_of("sheets.note.boxes=[2,20]", "sheets.note.layout=center_to_center")
    assert turned == pytest.approx(straight, rel=1e-6)
    assert central == pytest.approx(straight, rel=1e-6)


def test_the_papers_clamp_over_two_rows():
    # 0.234 N mm/rad gives 60.76 mm with 12.7 mm clamped on the tiled grid, to 2 % in k_tx: 1 % in the drop
    drop = drop_of(
        "sheets.note.boxes=[2,20]",
        "sheets.note.layout=center_to_center",
        "sheets.note.clamp={edge: y_min, length: 12.7 mm}",
        "materials.eur10.k_tx=0.234 N*mm/rad",
        "sheets.note.size=[13.4 mm, 127 mm]",  # two of the ten columns
        "sheets.note.mass=0.144 g",
    )
    assert drop == pytest.approx(60.76, rel=0.01)


@pytest.mark.parametrize(
    ("high", "overrides"),
    [
        (10.0, {"run.step": "0.0125 ms"}),
        (50.0, {"contacts.0.restitution": "0.5", "contacts.0.stiffness": "300 N/mm^1.5"}),
        (50.0, {"sheets.block.mass": "100 g", "contacts.0.restitution": "0.9"}),
    ],
)
def test_apexes_of_a_dropped_block(high, overrides):
    c = float(overrides.get("contacts.0.restitution", "0.7"))
    fall = math.sqrt(2 * high / 9.81e-3)
    end = f"run.duration={math.ceil(fall * (1 + 2 * c + 2 * c**2 + c**3)) + 10} ms"  # after three apexes
    begin = f"sheets.block.center=[0 mm, 0 mm, {5.0 + high} mm]"
    result = run("samples/verify/drop.yaml", *(f"{k}={v}" for k, v in overrides.items()), begin, end)
    height = result.sheet_motion(0)[0][:, 2] - 5.0
    inner = (height[1:-1] >= height[:-2]) & (height[1:-1] > height[2:])
    apexes = height[1:-1][inner][:3]
    k, m, g = result.model.contacts.stiffness[0], result.model.bodies.mass[0], 9.81e-3
    rise = high
    for apex in apexes:
        # e^2 = c^2 - (1 - c^2) 2 g z_m / v0^2 with gravity during the contact; on the way in the force is
        # k z^1.5 (1 + beta), which gives z_m
        v2 = 2 * g * rise
        depth = (5 * m * v2 / (4 * k * (2 / (1 + c**2)))) ** 0.4
        rise *= c**2 - (1 - c**2) * 2 * g * depth / v2
        assert apex == pytest.approx(rise, rel=0.005)
    assert len(apexes) == 3


@pytest.mark.parametrize(("speed", "mu"), [(0.5, 0.3), (0.4, 0.5)])
def test_a_sliding_block_stops(speed, mu):
    result = run(
        "samples/verify/slide.yaml",
        f"contacts.0.friction={mu}",
        f"sheets.block.velocity=[{speed} m/s, 0 m/s, 0 m/s]",
        *SHORT,
    )
    place, rate, _ = result.sheet_motion(0)
    assert place[-1, 0] - place[0, 0] == pytest.approx(speed**2 / (2 * mu * 9.81e-3), rel=0.005)
    assert abs(rate[-1, 0]) < 1e-3


def slope(angle):
    g = 9.81
    return f"gravity=[{g * math.sin(angle)!r} m/s^2, 0 m/s^2, {-g * math.cos(angle)!r} m/s^2]"


@pytest.mark.parametrize(("degrees", "mu"), [(20, 0.3), (30, 0.4)])
def test_a_block_slides_down_a_slope(degrees, mu):
    angle = math.radians(degrees)
    result = run("samples/verify/incline.yaml", slope(angle), f"contacts.0.friction={mu}", *SHORT)
    _, rate, _ = result.sheet_motion(0)
    half = len(result.time) // 2
    mean = (rate[-1, 0] - rate[half, 0]) / (result.time[-1] - result.time[half])
    assert 1e3 * mean == pytest.approx(9.81 * (math.sin(angle) - mu * math.cos(angle)), rel=0.005)


def test_a_block_that_sticks_creeps_as_the_regularisation_says():
    result = run(
        "samples/verify/incline.yaml", "contacts.0.friction=0.5", "contacts.0.smoothing=1 mm/s", *SHORT
    )
    assert result.sheet_motion(0)[1][-1, 0] == pytest.approx(0.536876e-3, rel=0.005)


FREE = on_paper("""
name: free
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {s: HINGED_PAPER}
sheets:
  note: {material: s, size: [40 mm, 60 mm], thickness: 0.1 mm, mass: 0.2 g, boxes: [3, 5],
         spin: [20 rad/s, 30 rad/s, 200 rad/s], velocity: [1 m/s, 0 m/s, 0 m/s]}
run: {duration: 30 ms}
""")


def momentum(result):
    """Linear [g mm/ms] and angular momentum about the origin [g mm^2/ms] at the stored times."""
    from scipy.spatial.transform import Rotation

    bodies = result.model.bodies
    linear = np.einsum("b,tbi->ti", bodies.mass, result.velocity)
    angular = np.cross(result.position, bodies.mass[:, None] * result.velocity).sum(axis=1)
    for b in range(len(bodies.name)):
        turn = Rotation.from_quat(np.roll(result.rotation[:, b], -1, axis=1))
        angular += turn.apply(bodies.inertia[b] * turn.inv().apply(result.spin[:, b]))
    return linear, angular


def test_a_spinning_sheet_keeps_its_momentum():
    linear, angular = momentum(run_text(FREE, "run.step=0.02 ms"))
    assert np.ptp(linear, axis=0) == pytest.approx(0, abs=1e-9 * float(np.linalg.norm(linear[0])))
    drift = np.abs(angular - angular[0]).max() / np.linalg.norm(angular[0])
    assert drift < 1e-4  # generalised-alpha at 0.02 ms; the law itself conserves to round-off


def test_free_fall_has_no_bushing_force():
    result = run_text(
        FREE,
        "gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]",
        "sheets.note.spin=[0 rad/s, 0 rad/s, 0 rad/s]",
        "run.step=0.1 ms",
    )
    fall = result.position[-1, :, 2]
    assert fall == pytest.approx(-0.5 * 9.81e-3 * 30**2, rel=1e-9)
    assert result.energy.elastic < 1e-12


def test_a_block_turns_over():
    # Euler's top about its middle axis: rotation through all angles, against the closed energy and momentum
    text = FREE.replace("boxes: [3, 5]", "boxes: [1, 1]").replace("thickness: 0.1 mm", "thickness: 10 mm")
    result = run_text(
        text, "sheets.note.spin=[50 rad/s, 0.5 rad/s, 0.5 rad/s]", "run.duration=600 ms", "run.step=0.1 ms"
    )
    _, angular = momentum(result)
    assert np.abs(angular - angular[0]).max() < 2e-3 * np.linalg.norm(angular[0])
    from scipy.spatial.transform import Rotation

    along = Rotation.from_quat(np.roll(result.rotation[:, 0], -1, axis=1)).apply([1, 0, 0])
    assert result.status == "ok"
    # the middle axis does not keep its direction: it turns over, and all but against where it was
    assert along[0] == pytest.approx([1.0, 0.0, 0.0]) and along[:, 0].min() < -0.9
    inertia = result.model.bodies.inertia[0]
    own = Rotation.from_quat(np.roll(result.rotation[:, 0], -1, axis=1)).inv().apply(result.spin[:, 0])
    energy = 0.5 * (own**2 @ inertia)
    assert energy == pytest.approx(
        np.full(len(energy), energy[0]), rel=4e-3
    )  # twice the part of the momentum


def test_the_step_error_falls_with_second_order():
    text = FREE.replace("spin: [20 rad/s, 30 rad/s, 200 rad/s]", "spin: [20 rad/s, 0 rad/s, 50 rad/s]")
    ends = [run_text(text, "run.duration=5 ms", f"run.step={h} ms").position[-1] for h in (0.08, 0.04, 0.02)]
    coarse, fine = (np.abs(a - b).max() for a, b in pairwise(ends))
    assert math.log2(coarse / fine) > 1.6


def test_a_sheet_that_leaves_its_bounds_begins_again():
    text = """
name: thrown
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {s: {E_md: 1000 MPa, E_cd: 1000 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}
sheets:
  note: {material: s, size: [20 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1],
         center: [0 mm, 0 mm, 9 mm]}
rollers:
  r: {center: [6 mm, 0 mm, 0 mm], axis: y, radius: 9 mm, width: 20 mm, mass: 10 g}
contacts: [{between: [note, r], stiffness: 300 N/mm^1.5, friction: 0}]
run: {duration: 3 ms, step: 0.01 ms}
"""
    result = solve(lower(loads(text)))
    assert as_asked(result), result.status
    assert result.model.pairs.margin > 5.0
    free = solve(lower(loads(text, overrides=["run.prune=false"])))
    assert as_asked(free)
    np.testing.assert_allclose(result.position, free.position, rtol=0, atol=1e-9)


def test_an_unstable_static_scene_fails_with_a_reason():
    text = FREE.replace("run: {duration: 30 ms}", "run: {analysis: static}")
    result = solve(lower(loads(text, overrides=["gravity=[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"])))
    assert not as_asked(result)
    assert "Exudyn" in result.status or "residual" in result.status


def test_a_failed_static_scene_with_contacts_ends_with_its_reason(tmp_path, capsys, monkeypatch):
    """Nothing was observed of such a run, not even the force of its contacts."""
    text = POST.replace("run: {duration: 30 ms}", "run: {analysis: static}")
    text = text.replace("gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]", "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]")
    (tmp_path / "falls.yaml").write_text(text)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        app(["run", "falls.yaml", "--solver", "exudyn", "-o", "out"], prog_name="mdlgen")
    assert ended.value.code == 4
    assert "the run failed: Exudyn did not converge" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_energy_balances_in_a_bounce():
    low = "sheets.block.center=[0 mm, 0 mm, 10 mm]", "run.duration=45 ms"  # it comes down at 32 ms
    result = run("samples/verify/drop.yaml", *low)
    assert abs(result.energy.balance_error) < 1e-3
    assert result.energy.dissipated > 0


def test_pruning_changes_nothing():
    """The series of a piece of the transport is the same with all pairs kept."""
    short = ("run.duration=1 ms", "sheets.note.boxes=[5,8]")
    one = run("samples/transport_4x4.yaml", *short)
    two = run("samples/transport_4x4.yaml", *short, "run.prune=false")
    # the same forces in another order of unknowns: equal to Newton's tolerance
    assert np.abs(one.position - two.position).max() < 1e-6
    assert (len(one.model.pairs), len(two.model.pairs)) == (68, 364)


def test_a_block_rests_on_a_plate_smaller_than_itself():
    # it comes down in 4.5 ms
    small = "planes.floor.size=[15 mm, 15 mm, 10 mm]"
    narrow = "planes.floor.size=[6 mm, 100 mm, 10 mm]"
    low = "sheets.block.center=[0 mm, 0 mm, 5.1 mm]", "run.duration=40 ms", "run.step=0.02 ms"
    whole = run("samples/verify/drop.yaml", *low)
    assert abs(whole.velocity[-1, 0, 2]) < 1e-3
    for size in (small, narrow):
        result = run("samples/verify/drop.yaml", size, *low)
        assert np.abs(result.position - whole.position)[:, 0].max() < 1e-6


@pytest.mark.parametrize("height", [0.0, 0.9, 1.1, 5.0])
def test_a_roller_that_stands_across_the_sheet_stops_it(height):
    result = run_text(POST, f"rollers.post.center=[30 mm, 0 mm, {height} mm]")
    assert result.velocity[-1, 0, 0] == pytest.approx(-1.0, abs=0.01)


def test_a_run_that_makes_energy_fails():
    result = solve(lower(load("samples/verify/drop.yaml", ["run.step=0.5 ms", "run.prune=false"])))
    assert not as_asked(result)
    assert "energy" in result.status


SHOT = (
    "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
    "contacts.0.restitution=1",
    "contacts.0.stiffness=400 N/mm^1.5",
    "run.prune=false",
)


@pytest.mark.parametrize("step", [0.02, 0.05, 0.1, 0.2, 0.5])
@pytest.mark.parametrize("speed", [0.7, 2.3])
def test_an_elastic_impact_keeps_its_energy_or_fails(step, speed):
    """At any step: the energy audit sees what an impact made and what it lost."""
    sets = (*SHOT, "sheets.block.center=[0 mm, 0 mm, 5.1 mm]", "run.duration=3 ms", f"run.step={step} ms")
    result = solve(lower(load("samples/verify/drop.yaml", (*sets, _thrown(speed)))))
    if result.usable:
        after = float(np.sum(result.velocity[-1, 0] ** 2)) / speed**2
        assert abs(after - 1) <= 0.02, "the audit's 1 % of a loss and 2 % of a gain"
    else:
        assert "energy" in result.status and "N mm" in result.status


def _thrown(speed):
    return f"sheets.block.velocity=[0 m/s, 0 m/s, {-speed} m/s]"


def test_a_run_that_loses_energy_fails():
    sets = (*SHOT, "sheets.block.center=[0 mm, 0 mm, 5.1 mm]", "run.duration=2 ms", "run.step=0.1 ms")
    result = solve(lower(load("samples/verify/drop.yaml", (*sets, _thrown(1.0)))))
    assert "of energy" in result.status and "got lost" in result.status


@pytest.mark.parametrize("boxes", ["[1,1]", "[2,3]"])
@pytest.mark.parametrize(("depth", "restitution"), [(0.02, 0.8), (0.13, 0.35)])
def test_what_starts_in_a_plane_leaves_it_at_the_speed_of_its_energy(boxes, depth, restitution):
    """Steps follow the impact of which the overlap is the second half; the speed by quadrature."""
    from mdlgen.bench.oracles import impact

    sets = (
        *SHOT[:1],
        f"sheets.block.boxes={boxes}",
        "sheets.block.thickness=0.2 mm",
        "sheets.block.mass=0.3 g",
        f"sheets.block.center=[0 mm, 0 mm, {0.1 - depth} mm]",
        "contacts.0.stiffness=60 N/mm^1.5",
        f"contacts.0.restitution={restitution}",
        "run.duration=2 ms",
        "run.print_step=0.1 ms",
        "run.prune=false",
    )
    result = run("samples/verify/drop.yaml", *sets)
    model, count = result.model, result.model.sheets[0].count
    into = 0.4 * 60.0 * depth**2.5 / float(model.bodies.mass[0])
    exact = impact.rebound(into, impact.share(restitution), float(model.contacts.smoothing[0]))
    # 20 steps in an impact give 1 % and its tolerance less
    assert result.velocity[-1, :count, 2] == pytest.approx(exact, rel=2e-3)
    assert result.error_estimate is None or result.error_estimate <= model.run.tolerance


def test_an_estimate_covers_the_error_of_a_bounce():
    """Elastic, without gravity: the block goes back as fast as it came."""
    sets = (*SHOT, "sheets.block.center=[0 mm, 0 mm, 5.1 mm]", "run.duration=20 ms", "run.print_step=1 ms")
    result = run("samples/verify/drop.yaml", *sets, _thrown(1.7))
    lasts = 3.21806546 * (10.0**2 / (400.0**2 * 1.7)) ** 0.2
    end = 5.0 + 1.7 * (20.0 - lasts - 0.1 / 1.7)
    error = abs(float(result.position[-1, 0, 2]) - end) / end
    assert result.error_estimate is not None
    assert error <= 1.5 * result.error_estimate <= 1.5 * result.model.run.tolerance


def upright(across):
    """A clamped strip at 1.4 times Euler's load, with a small force across its end."""
    unit = 0.242 * 67 / 127**2  # D W / L^2
    load = f"force: [0 N, {-1.4 * math.pi**2 / 4 * unit!r} N, {across * unit!r} N]"
    still = ("gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]", "sheets.note.boxes=[1,20]")
    return (*still, f"loads=[{{sheet: note, edge: y_max, {load}}}]")


def test_a_balance_that_does_not_stand_fails():
    """Straight, beyond Euler's load: a balance, but an unstable one."""
    result = solve(lower(load(CANTILEVER, upright(0.0))))
    assert not as_asked(result)
    assert "unstable: it falls in one direction" in result.status


@pytest.mark.parametrize("across", [2e-3, -1e-2])
def test_a_buckled_column_is_the_elastica(across):
    from mdlgen.bench.oracles import loaded

    exact = loaded.end(1.4 * math.pi**2 / 4, abs(across))
    tip = run(CANTILEVER, *upright(across)).anchor_motion(0)[0][-1] / 127 - [0.0, 0.5, 0.0]
    # the lattice of 20 rows: 0.2 % of the critical load, which goes into the place by less than 1 %
    assert tip[2] == pytest.approx(math.copysign(exact.z, across), abs=0.01)
    assert 1.0 + tip[1] == pytest.approx(exact.x, abs=0.01)
