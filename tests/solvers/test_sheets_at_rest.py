"""Sheets that lie on each other: at rest, leaning, in one place, and what texts say of them."""

from __future__ import annotations

import numpy as np
import pytest
from laws import no_drift
from papers import HINGED_PAPER
from scipy.spatial.transform import Rotation
from stacks import ran, stack

import mdlgen
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.integrate.room import sticks
from mdlgen.backends.lattice.kernels.state import FACE, Midpoint
from mdlgen.checks import lints
from mdlgen.errors import RefusedError
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.overlap import OVERLAP
from mdlgen.mechanics.point import OUT
from mdlgen.model import sheet_pairs
from mdlgen.model.lower import lower
from mdlgen.model.tables import BOX_BOX
from mdlgen.registry import chosen, emitter
from mdlgen.results.stacked import stacked
from mdlgen.spec.load import loads
from mdlgen.verify.verification import verify

pytestmark = pytest.mark.usefixtures("as_python")

# notes that were laid on each other by hand: x, y [mm], turn [deg]
LAID = [(0.4, -0.3, 0.3), (-0.5, 0.2, -0.4), (0.1, 0.6, 0.2), (0.7, -0.2, -0.1), (-0.3, 0.4, 0.5)]


def test_a_stack_at_rest_does_not_creep_or_gain_energy():
    laid = [
        put
        for k, (x, y, turn) in enumerate(LAID)
        for put in (
            f"sheets.note_{k}.center=[{x} mm, {y} mm, {0.05 + 0.1 * k:g} mm]",
            f"sheets.note_{k}.turn={turn} deg",
        )
    ]
    run = ["run.duration=1000 ms", "run.print_step=10 ms"]
    result = ran(lower(loads(stack(5, "[2, 2]"), overrides=[*laid, *run])), "lattice")
    count = 20
    moved = result.position[:, :count] - result.position[0, :count]
    assert np.abs(moved[..., :2]).max() < 1e-2, "10 um"
    late = result.time >= 100.0
    assert np.ptp(result.position[late, :count, 2], axis=0).max() < 1e-6
    speed = np.linalg.norm(result.velocity[:, :count], axis=2).max(axis=1)
    # all that is left is the creep of smoothed friction [mm/ms]
    assert speed[late].max() < 1e-7
    assert abs(result.energy.balance_error) < 5e-3
    together = stacked(result)
    assert together is not None and together[-1].all()


def test_what_slides_on_a_stack_at_rest_is_not_held_by_steps_without_a_solve():
    """A note without friction on one that lies still, under a weight with a small part along it: its
    velocity is that part times the time."""
    text = stack(2, "[4, 4]").replace("restitution: 0.5, friction: 0.3}", "restitution: 0.5, friction: 0}", 1)
    along = 1e-3
    run = [f"gravity=[{9.81 * along} m/s^2, 0 m/s^2, -9.81 m/s^2]", "run.duration=60 ms", "run.step=0.1 ms"]
    result = ran(lower(loads(text, overrides=run)), "lattice")
    upper = result.velocity[:, 16:32, 0].mean(axis=1)
    late = result.time >= 5.0
    expected = 9.81e-3 * along * result.time
    assert np.abs(upper - expected)[late].max() < 2e-3 * expected[-1]


def test_boxes_that_lean_have_not_crossed_where_a_centre_passes_a_plane():
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.kernels.contact import search, sides

    model = lower(loads(stack(2, "[1, 1]")))
    system = build(model)
    count = len(system.bodies)

    def through(x: float, lean: float, begin: float, end: float) -> bool:
        """The second note is moved by x and leans about y; its centre's height over the first's."""
        places = np.zeros((2, count, 3))
        places[0, 1], places[1, 1] = (x, 0.0, begin), (x, 0.0, 0.5 * (begin + end))
        turned = np.tile(np.eye(3).ravel(), (count, 1))
        turned[1] = Rotation.from_rotvec([0.0, lean, 0.0]).as_matrix().ravel()
        assert search.look(system.pairs, system.search, places[0])
        near = np.array([system.search.first])
        still = np.zeros((count, 3))
        begins, middle = (Motion(place, turned, still, still) for place in places)
        # of nothing that is kept is it known that faces lie on each other
        mid = Midpoint(
            motion=middle,
            forces=still,
            touched=near,
            results=np.zeros((1, OUT)),
            rows=np.zeros(1, np.int64),
            faces=np.zeros((1, FACE)),
            totals=np.zeros(2),
            spent=np.zeros((0, 2)),
            near=near,
            overlaps=np.zeros(1, OVERLAP).view(np.recarray),
            spare=np.zeros(1, OVERLAP).view(np.recarray),
            does=np.zeros(1, np.int64),
            lies=np.zeros(1, np.bool_),
            fastest=np.zeros((2, count)),
            sticks=sticks(0, 0),
            drift=no_drift(),
        )
        return sides.crossed(system.tables, mid, (0, 1), begins, system.search.first, 1.0) >= 0

    assert through(0.0, 0.0, 0.05, -0.05) and not through(0.0, 0.0, 0.05, 0.02)
    assert not through(70.0, 0.0, 0.05, -0.05), "beside it"
    # in the middle of where they overlap, 30 mm before its centre, it stands 0.3 mm higher than there
    assert not through(60.0, 0.01, 0.05, -0.05)
    assert through(60.0, 0.01, -0.25, -0.35)


def test_a_thin_note_that_sleeps_limits_how_far_a_change_may_move_another_one():
    from mdlgen.backends.lattice.arrays import build
    from mdlgen.backends.lattice.kernels.contact import search, sides

    model = lower(loads(stack(2, "[1, 1]"), overrides=["sheets.note_0.thickness=0.02 mm"]))
    system = build(model)
    assert search.look(system.pairs, system.search, model.bodies.position)
    system.bodies["node"] = -1
    system.bodies["node"][1] = 0
    tables = system._replace(nodes=np.array([1]), sheets=np.array([1])).tables
    assert tables.thinnest == pytest.approx(0.01)
    near, h, falls = np.array([system.search.first]), 1.0, np.array([0.0, 0.0, 0.01, 0.0, 0.0, 0.0])
    upright = np.tile(np.eye(3).ravel(), (len(system.bodies), 1))
    # by its own half thickness alone this change would need no look at the pair
    assert 2.0 * h * falls[2] < tuning.CLOSER * 0.05
    assert sides.part_of_change(tables, near, 1, upright, h, falls) == pytest.approx(tuning.CLOSER)


def test_notes_in_one_place_end_with_a_reason():
    scene = stack(2, "[1, 1]").replace("center: [0 mm, 0 mm, 0.15 mm]", "center: [0 mm, 0 mm, 0.05 mm]")
    result = mdlgen.solve(lower(loads(scene)), "lattice")
    assert "box note_0_0_0 would pass through box note_1_0_0 of another sheet at 0 ms" in result.status


def test_a_static_scene_with_two_sheets_goes_to_the_reference_solver():
    made = lower(loads(stack(2, "[2, 2]"), overrides=["run.analysis=static"]))
    solver, why = chosen("auto", made)
    assert solver == "exudyn" and "two sheets" in why


def test_two_clamped_notes_rest_on_each_other():
    sheet = "size: [20 mm, 40 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [1, 4], clamp: {edge: y_min}"
    made = lower(
        loads(f"""
name: two
materials:
  soft: {HINGED_PAPER}
  hard: {{E_md: 3530 MPa, E_cd: 1113 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad, k_tz: 5 N*mm/rad}}
sheets:
  low: {{material: hard, {sheet}}}
  top: {{material: soft, {sheet}, center: [0 mm, 0 mm, 0.1 mm]}}
contacts:
  - {{between: [low, top], stiffness: 100 N/mm^1.5, friction: 0}}
run: {{analysis: static}}
""")
    )
    result = ran(made, "auto")
    assert result.solver == "exudyn"
    gap = result.position[-1, 4:8, 2] - result.position[-1, :4, 2]
    assert result.contact_force[-1, 0] > 0.0
    assert gap.min() > 0.09 and gap[-1] == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize("zoned", [(), ("note_0",), ("note_1",), ("note_0", "note_1")])
def test_text_deck_and_model_say_the_same_of_two_sheets(zoned):
    zone = "zones={stripe: {x: [-33.5 mm, -10 mm], y: [-63.5 mm, 63.5 mm], friction: 0.5}}"
    scene = loads(stack(2, "[2, 3]"), overrides=[f"sheets.{name}.{zone}" for name in zoned])
    model = lower(scene)
    assert (model.contacts.kind[model.pairs.contact] == BOX_BOX).sum() > 0
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    assert "Contact( con_note_0_0_0_note_1_0_0" in emitter("motionview").emit(model)


@pytest.mark.parametrize("backend", ["motionview", "motionsolve"])
def test_more_pairs_than_a_text_can_hold_are_refused_by_name(backend, monkeypatch):
    monkeypatch.setattr(sheet_pairs, "MOST_PAIRS", 20)
    made = lower(loads(stack(2, "[2, 3]")))
    assert list(made.pairs.searched) == [0]
    with pytest.raises(RefusedError, match="note_0 and note_1 can meet in more than 20"):
        emitter(backend).emit(made)


def test_sheets_that_start_in_each_other_are_reported():
    scene = stack(2, "[2, 3]").replace("center: [0 mm, 0 mm, 0.15 mm]", "center: [0 mm, 0 mm, 0.09 mm]")
    assert [lint.code for lint in lints(lower(loads(scene)))] == ["W112"]
    assert [lint.code for lint in lints(lower(loads(stack(2, "[2, 3]"))))] == []
