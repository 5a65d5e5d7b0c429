"""The fast solver: the same forces, momentum kept, closed forms, and the reference solver beside it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked
from papers import on_paper

import mdlgen
from mdlgen.bench.suites import flight
from mdlgen.bench.suites.impact import thrown
from mdlgen.errors import RefusedError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.registry import chosen
from mdlgen.results.compare import compare, travel
from mdlgen.results.mark import mark
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads

pytestmark = pytest.mark.usefixtures("as_python")

SHEET = on_paper("""
name: flight
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [4, 6],
         velocity: [1 m/s, 0.3 m/s, -0.2 m/s], spin: [30 rad/s, -20 rad/s, 50 rad/s]}
run: {duration: 20 ms, print_step: 1 ms}
""")


def model(name: str, *overrides: str) -> Model:
    return lower(load(samples() / f"{name}.yaml", overrides))


def run(made: Model, step: float | None = None) -> Result:
    result = mdlgen.solve(made, "lattice") if step is None else _fixed(made, step)
    assert as_asked(result), result.status
    return result


def _fixed(made: Model, step: float) -> Result:
    from mdlgen.backends.lattice import solve

    return solve(made, step=step)


# -- free flight


def momentum(result: Result) -> tuple[np.ndarray, np.ndarray]:
    bodies = result.model.bodies
    mass = bodies.mass[:, None]
    linear = (mass * result.velocity).sum(axis=1)
    e = result.rotation
    turn = np.stack(
        [
            1 - 2 * (e[..., 2] ** 2 + e[..., 3] ** 2),
            2 * (e[..., 1] * e[..., 2] - e[..., 0] * e[..., 3]),
            2 * (e[..., 1] * e[..., 3] + e[..., 0] * e[..., 2]),
            2 * (e[..., 1] * e[..., 2] + e[..., 0] * e[..., 3]),
            1 - 2 * (e[..., 1] ** 2 + e[..., 3] ** 2),
            2 * (e[..., 2] * e[..., 3] - e[..., 0] * e[..., 1]),
            2 * (e[..., 1] * e[..., 3] - e[..., 0] * e[..., 2]),
            2 * (e[..., 2] * e[..., 3] + e[..., 0] * e[..., 1]),
            1 - 2 * (e[..., 1] ** 2 + e[..., 2] ** 2),
        ],
        axis=-1,
    ).reshape(*e.shape[:2], 3, 3)
    own = np.einsum("tbji,tbj->tbi", turn, result.spin)
    spin = np.einsum("tbij,tbj->tbi", turn, bodies.inertia * own)
    angular = (np.cross(result.position, mass * result.velocity) + spin).sum(axis=1)
    return linear, angular


def test_momentum_is_kept_in_free_flight() -> None:
    result = run(lower(loads(SHEET, overrides=["run.tolerance=1e-5"])))
    linear, angular = momentum(result)
    assert np.abs(linear - linear[0]).max() < 1e-12 * np.abs(linear[0]).max()
    assert np.abs(angular - angular[0]).max() < 1e-6 * np.abs(angular[0]).max()
    assert np.abs(result.position[-1, 0] - result.position[0, 0]).max() > 5.0
    bodies = result.model.bodies
    start = 0.5 * float((bodies.mass * (bodies.velocity**2).sum(axis=1)).sum())
    start += 0.5 * float((bodies.inertia * bodies.spin**2).sum())  # its axes are the global ones
    # the rule is not exact in energy, its error goes with the square of the step
    assert start * 0.5 < result.energy.kinetic + result.energy.elastic <= start * (1 + 1e-6)


def test_what_spins_takes_no_more_iterations_than_what_rests() -> None:
    """A strip of short, stiff boxes: in axes that are half a step behind, stiff directions would be taken for
    soft ones."""
    result = run(model("verify/flip", "sheets.block.boxes=[400, 1]", "run.duration=0.5 ms"), 0.1)
    assert as_asked(result), result.status
    assert result.steps == 5 and result.iterations <= 3 * result.steps
    _, angular = momentum(result)
    assert np.abs(angular - angular[0]).max() < 1e-9 * np.abs(angular[0]).max()


def test_a_turned_world_gives_the_turned_motion() -> None:
    angles = "[20 deg, -35 deg, 50 deg]"
    rest = "sheets.note.velocity=[0 m/s, 0 m/s, 0 m/s]"
    plain = lower(loads(SHEET, "flight", [rest]))
    turned = lower(loads(SHEET, "flight", [rest, f"sheets.note.rotation={angles}"]))
    rotation = turned.sheets[0].rotation
    spin = rotation @ plain.sheets[0].spin * 1000
    turned = lower(
        loads(
            SHEET,
            "flight",
            [
                rest,
                f"sheets.note.rotation={angles}",
                "sheets.note.spin=[" + ", ".join(f"{v!r} rad/s" for v in spin.tolist()) + "]",
            ],
        )
    )
    one, two = run(plain, 0.1), run(turned, 0.1)
    assert np.abs(two.position - one.position @ rotation.T).max() < 1e-8 * 127


def test_the_error_falls_with_the_square_of_the_step() -> None:
    made = lower(loads(SHEET, "flight", ["run.duration=5 ms"]))
    fine = run(made, 0.003125)
    errors = [compare(fine, run(made, step)).position_rms_mm for step in (0.05, 0.025, 0.0125)]
    assert 1.7 < math.log2(errors[0] / errors[1]) < 2.3
    assert 1.7 < math.log2(errors[1] / errors[2]) < 2.4


# -- contact, against closed forms


@pytest.mark.parametrize("restitution", [0.3, 0.7])
def test_a_dropped_block_rebounds_by_its_restitution(restitution: float) -> None:
    result = run(model("verify/drop", f"contacts.0.restitution={restitution}", "run.duration=180 ms"))
    height = result.position[:, 0, 2]
    first = int(np.argmin(height))
    fall = height[0] - height[first:].min()
    rise = height[first:].max() - height[first:].min()
    # gravity acts in the contact, and the smoothing lifts it: both below half a percent here
    assert rise / fall == pytest.approx(restitution**2, rel=0.02, abs=0.002)
    assert result.error_estimate is not None and result.error_estimate <= result.model.run.tolerance


def test_a_block_slides_to_a_stop_where_friction_says() -> None:
    result = run(model("verify/slide"))
    travel = float(np.linalg.norm(result.position[-1, 0] - result.position[0, 0]))
    # v^2 / (2 mu g) and what the cubic step of the smoothing adds: 0.382263 m
    assert travel == pytest.approx(382.263, rel=1e-5)


# -- a sheet in nips, against the reference solver


def test_transport_agrees_with_the_reference_solver() -> None:
    scene = ["sheets.note.boxes=[5,10]", "run.duration=10 ms", "run.print_step=0.5 ms"]
    fast = run(model("transport_4x4", *scene))
    slow = mdlgen.solve(model("transport_4x4", *scene, "run.step=25 us"), "exudyn")
    assert as_asked(slow), slow.status
    away = compare(slow, fast)
    travel = float(np.linalg.norm(slow.position[-1, 0] - slow.position[0, 0]))
    assert away.position_rms_mm < 1e-3 * travel
    depth = fast.statistics.mean_depth / np.where(
        slow.statistics.mean_depth > 0, slow.statistics.mean_depth, 1
    )
    gripped = slow.statistics.mean_force > 1.0
    assert gripped.sum() >= 6 and np.abs(depth[gripped] - 1).max() < 0.02
    assert fast.error_estimate is not None and fast.error_estimate <= 1e-3
    assert 0.3 * away.relative <= fast.error_estimate


def test_a_strip_swings_as_the_reference_solver_has_it() -> None:
    scene = [
        "sheets.note.boxes=[2,8]",
        "run.analysis=transient",
        "run.duration=60 ms",
        "run.print_step=1 ms",
    ]
    fast = run(model("cantilever", *scene, "run.tolerance=1e-4"))
    slow = mdlgen.solve(model("cantilever", *scene, "run.step=50 us"), "exudyn")
    assert as_asked(slow)
    assert travel(slow)[2] < -5.0  # mm: it has fallen
    assert compare(slow, fast).relative < 1e-3


def test_a_fixed_step_is_taken_and_its_error_reported() -> None:
    scene = ["sheets.note.boxes=[2,3]", "run.duration=4 ms", "run.step=50 us"]
    result = run(model("transport_4x4", *scene))
    assert result.step == pytest.approx(0.05) and result.steps >= 80  # one that does not converge is halved
    assert result.error_estimate is not None


# -- at rest


@pytest.mark.parametrize(("rows", "drop"), [(10, 77.1216), (20, 76.6786), (40, 76.5678)])
def test_a_hanging_strip_is_the_heavy_elastica(rows: int, drop: float) -> None:
    """76.5308 mm, approached with the square of the rows; and the drops that exudyn finds, to round-off."""
    result = run(model("cantilever", f"sheets.note.boxes=[2,{rows}]"))
    found = -result.summary()["probes"]["tip"]["displacement_mm"][2]
    assert found == pytest.approx(drop, abs=1e-4)
    assert found / 76.5308 - 1 == pytest.approx(0.0772 / rows**2 * 10, rel=0.03)


def test_a_loaded_sheet_rests_where_the_reference_solver_has_it() -> None:
    load = "loads=[{sheet: note, edge: y_max, force: [0.002 N, 0 N, 0.004 N]}]"
    made = model("cantilever", "sheets.note.boxes=[3,6]", load, "gravity=[1 m/s^2, 0 m/s^2, -3 m/s^2]")
    fast, slow = run(made), mdlgen.solve(made, "exudyn")
    assert as_asked(slow)
    assert np.abs(fast.position - slow.position).max() < 1e-4 * 127


# -- what is refused, chosen, or fails


def test_auto_takes_the_fast_solver_where_it_can() -> None:
    assert chosen("auto", model("transport_4x4")) == ("lattice", "")
    assert chosen("auto", model("cantilever"))[0] == "lattice"
    static = model("transport_4x4", "run.analysis=static")
    name, why = chosen("auto", static)
    assert name == "exudyn" and "static" in why
    with pytest.raises(RefusedError, match="static"):
        mdlgen.solve(static, "lattice")


def test_a_box_that_leaves_its_bounds_does_not_end_the_run() -> None:
    scene = ["sheets.note.boxes=[2,3]", "run.margin=0.1 mm", "rollers.motor_1_left.drive.speed=-186.7 rad/s"]
    result = mdlgen.solve(model("transport_4x4", *scene, "run.step=0.1 ms"), "lattice")
    assert as_asked(result), result.status
    assert result.model.pairs.margin > 0.1


def test_a_run_that_cannot_converge_says_where() -> None:
    scene = ["sheets.note.boxes=[2,3]", "rollers.motor_1_left.drive.speed=1e7 rad/s", "run.duration=5 ms"]
    result = mdlgen.solve(model("transport_4x4", *scene), "lattice")
    assert not result.ok and " ms" in (mark(result) or "")


def test_a_block_that_loses_energy_unseen_has_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    from mdlgen.backends.lattice import run as solver

    made = thrown(1.0, 1.0).model()
    # a step of the user's own is halved where a contact would begin and end within it
    result = _fixed(made, 0.2)
    assert as_asked(result) and result.velocity[-1, 0, 2] == pytest.approx(1.0, abs=2e-3)
    assert _fixed(made, 0.002).ok
    # an elastic impact in two steps: the rule takes a fifth of the speed away
    monkeypatch.setattr(solver, "MAY_MAKE", 0.0)
    result = _fixed(made, 0.2)
    assert not as_asked(result) and "energy" in result.status


def test_a_tolerance_that_is_not_reached_leaves_the_finest_run(monkeypatch: pytest.MonkeyPatch) -> None:
    from mdlgen.backends.lattice import run as solver

    monkeypatch.setattr(solver, "MOST_REFINED", 1)
    monkeypatch.setattr(solver, "first_step", lambda _: 0.25)
    scene = ["sheets.note.boxes=[2,3]", "run.duration=5 ms", "run.tolerance=1e-9"]
    result = mdlgen.solve(model("transport_4x4", *scene), "lattice")
    assert result.status == "inaccurate" and result.time[-1] == pytest.approx(5.0)
    assert result.search_ended == "no step below 0.125 ms was tried" and result.step == pytest.approx(0.125)
    assert result.error_estimate is not None and result.error_estimate > 1e-9


def test_momentum_is_kept_after_a_touch() -> None:
    # the factor is of a sheet that has bent and turned since
    case = flight.cases("lattice", "lattice", quick=True)[0]
    result = mdlgen.solve(case.run.model(), "lattice")
    assert as_asked(result), result.status
    for finding in flight.drift(result, None):
        assert finding.tolerance is not None and finding.error <= finding.tolerance, finding


def test_forces_are_those_of_the_stored_times() -> None:
    """A block in an elastic impact: k z^1.5 of the depth that is stored beside it, where half a step earlier
    it would be off by 12 % of the peak."""
    sets = ["sheets.block.center.2=5.5 mm", "contacts.0.restitution=1", "run.duration=4 ms"]
    sets += ["sheets.block.velocity=[0 m/s, 0 m/s, -1 m/s]", "run.step=0.04 ms", "run.print_step=0.04 ms"]
    result = mdlgen.solve(lower(load(samples() / "verify" / "drop.yaml", sets)), "lattice")
    depth = np.maximum(5.0 - result.position[:, 0, 2], 0.0)
    force, peak = 1000.0 * depth**1.5, result.contact_force.max()
    assert as_asked(result) and np.count_nonzero(force) > 5
    assert np.abs(result.contact_force[1:-1, 0] - force[1:-1]).max() < 0.03 * peak
