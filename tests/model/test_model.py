"""Lowering: the paper's tables, the grid, the clamp, pressed rollers, and which contacts are kept."""

from __future__ import annotations

from importlib import import_module
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.tables import CLAMP, GROUND, JOINT_X, JOINT_Y, SUPPORT
from mdlgen.spec.load import load, loads
from mdlgen.spec.scene import Scene
from mdlgen.verify.expected.parts.kinds import KINDS as EXPECTED

TRANSPORT, CANTILEVER = "samples/transport_4x4.yaml", "samples/cantilever.yaml"


def model(path=TRANSPORT, *overrides):
    return lower(load(path, overrides))


def test_tables_are_frozen_and_the_same_each_time():
    one, two = model(), model()
    with pytest.raises(ValueError, match="read-only"):
        one.bodies.position[0, 0] = 1.0
    assert np.array_equal(one.bushings.k, two.bushings.k)
    assert one.parameters == two.parameters


def test_a_block_of_one_box_has_no_bushings():
    block = model("samples/verify/drop.yaml")
    assert len(block.bushings) == 0
    assert block.bodies.mass[0] == 10.0
    assert np.allclose(block.bodies.inertia[0], 10 / 12 * np.array([400 + 100, 400 + 100, 800]))


@pytest.mark.parametrize(("layout", "count"), [("edge_to_edge", 740), ("center_to_center", 370)])
def test_bushings_meet_their_neighbours(layout, count):
    m = model(TRANSPORT, f"sheets.note.layout={layout}", "sheets.note.turn=20 deg")
    b = m.bushings
    assert len(b) == count
    span = m.bodies.position[b.b] - m.bodies.position[b.a]
    local = span @ m.sheets[0].rotation
    expected = np.where((b.kind == JOINT_X)[:, None], [6.7, 0, 0], [0, 6.35, 0])
    assert np.allclose(local, expected, atol=1e-12)
    middle = 0.5 * (m.bodies.position[b.b] + m.bodies.position[b.a])
    across = np.abs((b.origin - middle) @ m.sheets[0].rotation)
    reach = 0.0 if layout == "center_to_center" else 0.5
    along = np.where((b.kind == JOINT_X)[:, None], [0, 6.35 * reach, 0], [6.7 * reach, 0, 0])
    assert np.allclose(across, along, atol=1e-12)


def test_corner_bushings_add_up_to_the_central_one():
    one = model(CANTILEVER, "sheets.note.layout=center_to_center").sheets[0].derived
    two = model(CANTILEVER).sheets[0].derived
    for name in ("k_x", "k_y", "k_z", "k_tx", "k_ty", "c_x", "c_y", "c_z", "c_tx", "c_ty"):
        assert 2 * two[name] == pytest.approx(one[name], rel=1e-12), name


def test_hinges_follow_the_plate_for_any_grid():
    for boxes in ("[10,20]", "[6,15]"):
        d = model(CANTILEVER, f"sheets.note.boxes={boxes}", "sheets.note.layout=center_to_center").sheets[0]
        assert d.derived["k_tx"] == pytest.approx(0.242 * d.d_x / d.d_y)
        assert d.derived["k_ty"] == pytest.approx(0.40 * d.d_y / d.d_x)


def test_clamp_is_a_half_cell_hinge_on_its_line():
    m = model(CANTILEVER, "sheets.note.clamp={edge: y_min, length: 12.7 mm}")
    b = m.bushings
    hinges = b.kind == CLAMP
    assert hinges.sum() == 20
    assert np.all(b.a[hinges] == GROUND)
    assert np.allclose(b.origin[hinges][:, 1], -63.5 + 12.7)
    ordinary = b.k[b.kind == JOINT_Y][0]
    assert np.allclose(b.k[hinges], 2 * ordinary)
    assert m.bodies.fixed[:200].sum() == 20
    held = np.flatnonzero(m.bodies.fixed[:200])
    assert not np.isin(b.a[~hinges], held).any(), "nothing springs between held boxes"


@pytest.mark.parametrize("edge", ["x_min", "x_max", "y_max"])
def test_clamp_on_each_edge(edge):
    m = model(CANTILEVER, f"sheets.note.clamp={{edge: {edge}, length: 0 mm}}")
    line = m.bushings.origin[m.bushings.kind == CLAMP]
    axis = 0 if edge[0] == "x" else 1
    assert np.allclose(line[:, axis], (-1 if edge.endswith("min") else 1) * (33.5, 63.5)[axis])


def test_clamp_between_lines_names_the_two_nearest():
    with pytest.raises(SpecError, match=r"6\.35 mm and 12\.7 mm"):
        model(CANTILEVER, "sheets.note.clamp={edge: y_min, length: 10 mm}")


def test_pressed_rollers_start_in_equilibrium():
    m = model()
    free, nip = m.roller("counter_2_left").press, m.roller("counter_1_left").press
    assert free is not None
    assert nip is not None
    force = 3.19 - 0.319 * (free.start - free.touch)
    weight = (0.39 + 0.39e-3) * 9.81e-3
    assert 30.5 * (free.start - free.touch) ** 1.5 == pytest.approx(force + weight, rel=1e-6)
    assert free.start - free.touch == pytest.approx(0.22, abs=0.01)
    depth = 5.0 + 0.05 - (5.0 - nip.start)
    assert 300 * depth**1.5 == pytest.approx(3.19 - 0.319 * (nip.start - nip.touch) + weight, rel=1e-6)


def test_pruning_keeps_what_can_touch():
    m = model()
    assert m.pairs.possible == 1804
    assert len(m.pairs) < 0.3 * m.pairs.possible
    assert len(model(TRANSPORT, "run.prune=false").pairs) == 1804
    # a wider margin only adds
    sizes = [len(model(TRANSPORT, f"run.margin={w} mm").pairs) for w in (5, 10, 20, 200)]
    assert all(a <= b for a, b in pairwise(sizes))
    assert sizes[-1] == 1804


def test_every_box_that_can_pass_a_roller_is_kept():
    m = model()
    kept = {(int(a), int(b)) for a, b in zip(m.pairs.a, m.pairs.b, strict=True)}
    roller = m.roller("motor_2_right")
    for body in range(200):
        x, y, _ = m.bodies.position[body]
        passes = x + 3.35 <= 72 <= x + 70 + 3.35 and abs(y - 20.5) < 2.5 + 3.175
        assert not passes or (body, roller.body) in kept


def test_probe_on_a_line_is_the_mean_of_its_boxes():
    m = model()
    lead = next(p for p in m.probes if p.name == "lead")
    assert len(lead.body) == 2
    place = sum(
        s * (m.bodies.position[b] + loc) for b, loc, s in zip(lead.body, lead.local, lead.share, strict=True)
    )
    assert np.allclose(place, [33.5, 0, 0])


def test_supports_stand_with_their_bushings():
    m = model(
        CANTILEVER,
        "sheets.note.turn=20 deg",
        'supports=[{"sheet":"note","at":["3 mm","0 mm"],"fix":["z"]},'
        '{"sheet":"note","edge":"x_max","fix":["x","y"]}]',
    )
    inside, edge = m.supports
    assert (inside.name, inside.at, inside.edge) == ("support_0", (3.0, 0.0), None)
    assert (edge.name, edge.at, edge.edge) == ("support_1", (33.5, 0.0), "x_max")
    b = m.bushings
    rows = np.flatnonzero(b.kind == SUPPORT)
    assert [b.name[r] for r in rows] == ["support_0_0", "support_0_1", "support_1_0", "support_1_1"]
    assert b.b[rows].tolist() == [*inside.body, *edge.body]
    turn = m.sheets[0].rotation
    assert np.allclose(b.origin[rows], [turn @ [3, 0, 0]] * 2 + [turn @ [33.5, 0, 0]] * 2)
    k_z = m.sheets[0].derived["k_z"]
    assert np.allclose(b.k[rows[:2]], [0, 0, 50 * k_z, 0, 0, 0])
    assert np.allclose(b.k[rows[2:]], [50 * k_z, 50 * k_z, 0, 0, 0, 0])


def test_names_that_meet_are_refused(tmp_path):
    text = Path(TRANSPORT).read_text().replace("motor_1_left", "note_0_0")
    path = tmp_path / "scene.yaml"
    path.write_text(text)
    with pytest.raises(SpecError, match="note_0_0"):
        lower(load(path))


def test_pressed_rollers_count_what_they_stand_on():
    """The start balances the preload whatever the share rule and wherever the counterpart ends."""
    shared = model().roller("counter_1_left").press
    alone = model(TRANSPORT, "contacts.4.share=pair", "contacts.5.share=pair").roller("counter_1_left").press
    # two boxes in each row share the nip's width, so the roller sinks less by 2^(2/3)
    assert alone.start < shared.start < alone.start + 0.05
    half = (
        model(TRANSPORT, "rollers.counter_2_left.center=[72 mm, -18 mm, 5 mm]").roller("counter_2_left").press
    )
    force = 3.19 - 0.319 * (half.start - half.touch) + (0.39 + 0.39e-3) * 9.81e-3
    assert 0.5 * 30.5 * (half.start - half.touch) ** 1.5 == pytest.approx(force, rel=1e-6)


def test_rollers_pressed_against_each_other_are_refused():
    press = "{direction: z, stiffness: 0.3 N/mm, preload: 3 N}"
    with pytest.raises(SpecError, match="pressed against each other"):
        model(TRANSPORT, f"rollers.motor_2_left.press={press}")


def test_friction_speeds():
    speeds = model("samples/verify/slide.yaml", "contacts.0.friction={static: 0.5, dynamic: 0.3}").contacts
    assert (speeds.stiction_velocity[0], speeds.friction_velocity[0]) == pytest.approx((1e-3, 1.5e-3))
    with pytest.raises(SpecError, match="below the stiction velocity"):
        model(
            "samples/verify/slide.yaml",
            "contacts.0.friction={static: 0.5, dynamic: 0.3, friction_velocity: 0.2 mm/s}",
        )


def test_the_pulled_sheet_is_the_one_with_the_load():
    text = Path(CANTILEVER).read_text().replace("run: {analysis: static}", "")
    second = text + "loads: [{sheet: note, edge: y_max, stress: 1 MPa}]\nrun: {analysis: static}\n"
    tension = lower(loads(second)).tension
    assert tension is not None
    assert (tension.axis, tension.length) == (1, pytest.approx(19.5 * 6.35))


def test_every_kind_of_part_is_found_by_its_name_in_every_place() -> None:
    assert tuple(kind.table for kind in KINDS) == Scene.machine_tables()
    assert len({number for kind in KINDS for number in (kind.with_sheet, kind.with_roller)}) == 2 * len(KINDS)
    for place in ("backends.motionview.writer", "backends.motionsolve.writer", "backends.msolve.writer"):
        written = import_module(f"mdlgen.{place}.parts.kinds").WRITTEN
        assert list(written) == [kind.part for kind in KINDS]
    assert list(EXPECTED) == [kind.part for kind in KINDS]
