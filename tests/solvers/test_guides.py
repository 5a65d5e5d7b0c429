"""Guides: their contact law, a block on arcs in closed form, a note in a channel, text and deck, errors."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from asked import as_asked
from laws import box_guide
from papers import on_paper

import mdlgen
from mdlgen.backends.lattice import solve as lattice
from mdlgen.checks import lints
from mdlgen.errors import SpecError
from mdlgen.mechanics.frame import Box, Frame, Law, Plate
from mdlgen.mechanics.guide import BOTH, INSIDE, OUTSIDE, upper
from mdlgen.mechanics.point import OUT
from mdlgen.model.lower import lower
from mdlgen.model.parts.guide import SAG, facets
from mdlgen.paths import samples
from mdlgen.registry import emitter
from mdlgen.results.io.series import series
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

pytestmark = pytest.mark.usefixtures("as_python")

ZERO, EYE = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
K, HALF, PLAIN = 300.0, (2.0, 0.05, 3.0), (0.0, 0.0, 0.0, 1.0, 1.0, 1.0)  # thin along y, the guide's normal
CHANNEL = samples() / "channel.yaml"

BLOCK = """
name: bead
gravity: {gravity}
materials: {{m: {{E_md: 3530 MPa, E_cd: 1113 MPa, k_tx: 1 N*mm/rad, k_ty: 1 N*mm/rad}}}}
sheets:
  block: {{material: m, size: [0.5 mm, 0.5 mm], thickness: 0.5 mm, mass: 1 g, boxes: [1, 1],
           center: {center}, velocity: {velocity}}}
guides:
  way: {guide}
contacts:
- {{between: [block, way], stiffness: 1e4 N/mm^1.5, restitution: {c_R}, friction: {mu}, smoothing: 1 mm/s}}
run: {{duration: {time} ms, tolerance: 2e-4}}
"""


def block(**values) -> mdlgen.Result:
    result = lattice(lower(loads(BLOCK.format(**{"mu": 0, "c_R": 0, **values}))))
    assert as_asked(result), result.status
    return result


def force(place, turn=0.0, shape=(0.0, 0.0, 0.0), half_b=(10.0, 20.0, 0.5), side=INSIDE, shared=True):
    """What a box, turned about the guide's axis, gets of a guide: force, and the rest of `out`."""
    out = np.zeros(OUT)
    c, s = math.cos(turn), math.sin(turn)
    axes = (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
    plate = Plate(shape, half_b, upper(side, 2.0 * half_b[2]), 0, ZERO, 0)
    law = Law(K, shared, *PLAIN)
    box_guide(out, Frame(place, axes, ZERO, ZERO), Box(HALF, 15), Frame(ZERO, EYE, ZERO, ZERO), plate, law)
    return out


# -- the law


def test_a_flat_box_on_a_straight_guide_has_the_law_of_a_pair():
    assert force((0.0, 0.04, 0.0))[1] == pytest.approx(K * 0.01**1.5, rel=1e-9)
    assert force((0.0, -0.04, 0.0), side=OUTSIDE)[1] == pytest.approx(-K * 0.01**1.5, rel=1e-9)
    # touched on both sides, the faces are half of the thickness from the middle
    for sign in (1.0, -1.0):
        assert force((0.0, sign * 0.54, 0.0), side=BOTH)[1] == pytest.approx(sign * K * 0.01**1.5, rel=1e-9)
    # behind the plate, and beside it
    assert force((0.0, -1.2, 0.0))[12] == 0.0
    assert force((12.1, 0.04, 0.0))[12] == 0.0


@pytest.mark.parametrize("x", np.linspace(-3.0, 3.0, 13))
def test_two_guides_that_meet_count_as_one(x):
    """A straight one and a flat arc end at x = 10 and begin there: what one loses the other gains."""
    first, second = force((10.0 + x, 0.04, 0.0)), force((x - 10.0, 0.04, 0.0))
    assert first[1] + second[1] == pytest.approx(K * 0.01**1.5, rel=1e-9)
    alone = force((10.0 + x, 0.04, 0.0), shared=False)
    assert alone[1] == pytest.approx(K * 0.01**1.5 if x < 2.0 else 0.0, rel=1e-9)


def hollow(angle, depth, radius=20.0):
    """A box at an angle of a hollow, all four corners `depth` deep."""
    away = math.sqrt((radius + depth) ** 2 - HALF[0] ** 2) - HALF[1]
    return (away * math.cos(angle), away * math.sin(angle), 0.0), angle + math.pi / 2


@pytest.mark.parametrize("angle", [-0.6, 0.0, 0.9])
def test_corners_in_a_hollow_share_the_stiffness(angle):
    place, turn = hollow(angle, 0.01)
    out = force(place, turn, (20.0, 0.2, 1.0), (0.0, 20.0, 0.5))
    assert out[12] == pytest.approx(K * 0.01**1.5, rel=1e-9)
    # the corners push along their own radii, which lean by asin(2/20) of the middle's
    inward = -(out[0] * math.cos(angle) + out[1] * math.sin(angle))
    assert inward == pytest.approx(K * 0.01**1.5 * math.sqrt(1 - (2 / 20.01) ** 2), rel=1e-9)
    assert out[15] == pytest.approx(0.01, rel=1e-9)


@pytest.mark.parametrize("slope", [0.05, 0.3, 0.8])
def test_a_box_that_leaves_a_hollow_does_not_meet_the_face_behind(slope):
    """Its centre goes beyond the end, and farther from the axis than the plate: its rear is still inside."""
    radius, end = 20.0, 0.5 - math.pi / 2
    plate = Plate((radius, -math.pi / 2, 0.5), (0.0, 20.0, 0.5), 0.0, 0, ZERO, 0)
    c, s = math.cos(0.5 - slope), math.sin(0.5 - slope)
    axes, half = (c, 0.0, -s, s, 0.0, c, 0.0, -1.0, 0.0), (2.0, 3.0, 0.05)
    at, before = [radius * math.cos(end), radius * math.sin(end)], 0.0
    for way in np.linspace(0.0, 1.99, 200):
        # its face is 0.01 mm below the end of the arc
        place = (at[0] + way * c - 0.04 * s, at[1] + way * s + 0.04 * c, 0.0)
        out = np.zeros(OUT)
        law = Law(K, True, *PLAIN)
        box_guide(out, Frame(place, axes, ZERO, ZERO), Box(half, 0), Frame(ZERO, EYE, ZERO, ZERO), plate, law)
        # along the normal of the arc it is deeper by the slope
        assert out[15] < 0.0101 / math.cos(slope) and out[12] < K * 0.01**1.5
        assert abs(out[12] - before) < 0.1 * K * 0.01**1.5 or way == 0.0
        before = out[12]


@pytest.mark.parametrize("angle", [-0.6, 0.0, 0.9])
def test_a_box_on_a_round_face_has_the_law_of_a_pair(angle):
    away = 20.0 + HALF[1] - 0.01
    place = (away * math.cos(angle), away * math.sin(angle), 0.0)
    out = force(place, angle + math.pi / 2, (20.0, 0.2, 1.0), (0.0, 20.0, 0.5), OUTSIDE)
    # the foundation of `share: width` misses a few 1e-4 of the depth over the radius
    assert out[12] == pytest.approx(K * 0.01**1.5, rel=1e-3)
    single = force(place, angle + math.pi / 2, (20.0, 0.2, 1.0), (0.0, 20.0, 0.5), OUTSIDE, shared=False)
    assert single[12] == pytest.approx(K * 0.01**1.5, rel=1e-9)


def test_two_round_faces_that_meet_count_as_one():
    """One sector, and its two halves, under a box that lies across where they meet. The depth is z (1 - v^2)
    at v = u/c from its middle, c^2 = 2 r z: the half from u on has 1/2 - 3/4 (v - v^3/3) of the integral."""
    radius, depth = 20.0, 0.01
    for shift in (-0.02, -0.01, 0.0, 0.01, 0.02):
        away = radius + HALF[1] - depth
        place = (away * math.cos(shift), away * math.sin(shift), 0.0)
        whole, low, high = (
            force(place, shift + math.pi / 2, (20.0, middle, half), (0.0, 20.0, 0.5), OUTSIDE)[12]
            for middle, half in ((0.0, 0.8), (-0.4, 0.4), (0.4, 0.4))
        )
        # an arc is not quite a parabola: z/r = 5e-4, of which the halves lose less than the whole
        assert low + high == pytest.approx(whole, rel=1e-4)
        assert whole == pytest.approx(K * depth**1.5, rel=5e-4)
        v = -math.sin(shift) * radius / math.sqrt(2.0 * radius * depth)
        assert high / whole == pytest.approx(0.5 - 0.75 * (v - v**3 / 3.0), rel=2e-3)
    # and beyond its end a guide does not act
    place = ((20.0 + HALF[1] - 0.01) * math.cos(0.5), (20.0 + HALF[1] - 0.01) * math.sin(0.5), 0.0)
    assert force(place, 0.5 + math.pi / 2, (20.0, 0.0, 0.1), (0.0, 20.0, 0.5), OUTSIDE)[12] == 0.0


# -- closed forms


@pytest.mark.parametrize("axis", ["-y", [0.6, -0.8, 0]])
def test_a_block_slides_through_a_hollow_and_loses_as_on_a_capstan(axis):
    """Without gravity the wall pushes with m v^2/r, its friction turns about R: v = v0 e^(-mu phi R/r)."""
    across = np.array([0.0, -1.0, 0.0] if axis == "-y" else axis)
    way = np.cross(across, [0.0, 0.0, -1.0])  # in which angles grow at the lowest point
    velocity = ", ".join(f"{2 * v:.17g} m/s" for v in way)
    guide = (
        f"{{arc: {{center: [0 mm, 0 mm, 20 mm], axis: {axis}, radius: 20 mm, from: -120 deg, to: 50 deg, "
        "side: inside}, width: 5 mm}"
    )
    center = "[0 mm, 0 mm, 0.2515 mm]"
    sheet = {"gravity": "[0 m/s^2, 0 m/s^2, 0 m/s^2]", "center": center, "velocity": f"[{velocity}]"}
    made = lower(loads(BLOCK.format(guide=guide, mu=0.3, c_R=0, time=16, **sheet)))
    assert made.sheets[0].count == 1
    result = lattice(made)
    assert as_asked(result), result.status
    place = result.position[:, 0] - [0.0, 0.0, 20.0]
    angle = np.unwrap(np.arctan2(place @ way, -place[:, 2]))
    speed = np.linalg.norm(result.velocity[:, 0], axis=1)
    began, end = 20, int(np.searchsorted(angle, 1.2))
    assert angle[end] - angle[began] > 0.9
    r = float(np.linalg.norm(place[began:end] - np.outer(place[began:end] @ across, across), axis=1).mean())
    lost = math.exp(-0.3 * (angle[end] - angle[began]) * 20 / r)
    # that the block turns with its way is 1e-4 of its energy
    assert speed[end] / speed[began] == pytest.approx(lost, rel=5e-4)


DRAPED = """
name: draped
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, D_md: 0.05 N*mm, D_cd: 0.24 N*mm}}}}
sheets:
  note: {{material: paper, size: [30 mm, 6 mm], thickness: 0.1 mm, mass: 15 mg, boxes: [12, 1], layout: plate,
         center: [4 mm, 0 mm, 12.06 mm], velocity: [0.3 m/s, 0 m/s, 0 m/s]}}
{part}
contacts: [{{between: [note, bar], stiffness: 100 N/mm^1.5, friction: 0.3, smoothing: 10 mm/s, share: pair}}]
run: {{duration: 40 ms, step: 0.02 ms}}
"""


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_round_guide_is_a_roller_that_stands_still(solver):
    """A strip slides off a bar: half a round of a guide, or all round of a roller that is held."""
    arc = (
        "{arc: {center: [0 mm, 0 mm, 0 mm], axis: -y, radius: 12 mm, from: 0 deg, to: 180 deg, side: outside}"
    )
    guide = f"guides:\n  bar: {arc}, width: 20 mm}}"
    roller = (
        "rollers:\n  bar: {center: [0 mm, 0 mm, 0 mm], axis: -y, radius: 12 mm, width: 20 mm, mass: 1 g, "
        "drive: {speed: 0 rad/s}}"
    )
    one, two = (mdlgen.solve(lower(loads(DRAPED.format(part=part))), solver) for part in (guide, roller))
    assert as_asked(one) and as_asked(two), (one.status, two.status)
    assert two.statistics.max_force[0] > 1e-4
    # the sum over boxes goes another way; what is the same otherwise stays so to 1e-7 of a flexible run
    away = float(np.abs(one.position[:, :12] - two.position[:, :12]).max())
    assert away < 1e-6 * np.abs(two.position[-1, :12] - two.position[0, :12]).max()


def test_a_straight_guide_is_a_plane():
    """The same block, on the same face, of a plane and of a guide."""
    values = {
        "gravity": "[0 m/s^2, 0 m/s^2, -9.81 m/s^2]",
        "center": "[0 mm, 0 mm, 3 mm]",
        "velocity": "[0.5 m/s, 0 m/s, 0 m/s]",
        "time": 40,
        "mu": 0.2,
        "c_R": 0.5,
    }
    line = "{line: {from: [-50 mm, 0 mm, 0 mm], to: [50 mm, 0 mm, 0 mm], axis: -y, side: left}, width: 60 mm}"
    one = block(guide=line, **values)
    plane = (
        "planes:\n  way: {center: [0 mm, 0 mm, -0.5 mm], normal: z, size: [100 mm, 60 mm, 1 mm], mass: 1 g}"
    )
    text = re.sub(r"guides:\n  way: .*", plane, BLOCK.format(guide=line, **values))
    two = lattice(lower(loads(text)))
    assert as_asked(two) and one.time[-1] == two.time[-1]
    assert one.contact_force.max() > 0.1
    assert one.position[-1, 0] == pytest.approx(two.position[-1, 0], abs=1e-5)


# -- a note in a channel


def channel(boxes, step, solver="lattice"):
    """Speed of the leading edge over the 3 ms before it is out [mm/ms], and forces of both arcs [N]: of the
    outer one over the last 12 ms, of the inner one, which it meets now and then, over the last 24.

    A paper that damps nothing rattles on in its channel: its speed at one moment says little. This one has a
    loss factor of 3 % at 100 Hz.
    """
    damped = "materials.paper.damping={time: 0.05 ms}"
    model = lower(load(CHANNEL, [f"sheets.note.boxes=[{boxes},1]", f"run.step={step} ms", damped]))
    result = mdlgen.solve(model, solver)
    assert as_asked(result), result.status
    lead, record = result.anchor_motion(0)[0], series(result)
    assert lead[-1, 2] == pytest.approx(19.5, abs=0.1)  # it is there
    last = [result.time >= result.time[-1] - span for span in (3.0 + 1e-9, 12.0, 24.0)]
    speed = float(np.linalg.norm(lead[-1] - lead[last[0]][0])) / 3.0
    outer, inner = (
        record[f"guide_{n}.force_n"][at].mean() for n, at in zip(("outer", "inner"), last[1:], strict=True)
    )
    return np.array([speed, outer, inner])


def test_exit_speed_and_guide_force_of_a_channel_converge_and_the_solvers_agree():
    coarse, middle, fine = (channel(boxes, 0.04) for boxes in (10, 20, 40))
    shorter = channel(20, 0.02)
    other = channel(20, 0.04, "exudyn")
    far, near = np.abs(coarse / fine - 1), np.abs(middle / fine - 1)
    # down to what the steps change, the inner arc by single touches
    assert (near < [0.01, 0.01, 0.03]).all() and (near[:2] < np.maximum(0.5 * far[:2], 0.002)).all()
    assert (np.abs(shorter / middle - 1) < [0.002, 0.002, 0.02]).all()
    assert (np.abs(other / middle - 1) < [0.01, 0.002, 0.02]).all()


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
def test_a_run_ends_where_a_guide_does_not_hold_a_box(solver):
    made = lower(load(CHANNEL, ["contacts.0.stiffness=0.001 N/mm^1.5", "sheets.note.boxes=[10,1]"]))
    result = mdlgen.solve(made, solver)
    assert not as_asked(result) and "into guide guide_" in result.status


# -- text and deck

SHAPES = on_paper("""
name: shapes
materials: {m: PLATE_PAPER}
sheets: {note: {material: m, size: [4 mm, 4 mm], thickness: 0.1 mm, mass: 3 mg, boxes: [2, 1], layout: plate}}
guides:
  l: {line: {from: [-5 mm, 0 mm, -1 mm], to: [5 mm, 1 mm, 2 mm], axis: [0.3, -3, 0], side: left}, width: 9 mm}
  r: {line: {from: [-5 mm, 0 mm, 1 mm], to: [5 mm, 0 mm, 1 mm], axis: y, side: right}, width: 9 mm}
  b: {line: {from: [-5 mm, 0 mm, 1 mm], to: [5 mm, 0 mm, 3 mm], axis: -y, side: both}, width: 9 mm}
  i:
    arc: {center: [0 mm, 1 mm, 7 mm], axis: [1, 2, 1], radius: 7 mm, from: -100 deg, to: 20 deg, side: inside}
    width: 9 mm
  o:
    arc: {center: [0 mm, 1 mm, 7 mm], axis: x, radius: 7 mm, from: 0 deg, to: 180 deg, side: outside}
    width: 9 mm
  t:
    arc: {center: [0 mm, 1 mm, 7 mm], axis: y, radius: 6 mm, from: 10 deg, to: 11 deg, side: both}
    width: 9 mm
contacts: [{between: [note, "?"], stiffness: 30 N/mm^1.5, friction: 0.2}]
run: {duration: 1 ms}
""")


def shapes():
    scene = loads(SHAPES)
    return scene, lower(scene)


def test_guides_are_the_same_in_text_script_deck_and_model():
    scene, model = shapes()
    found = verify(scene, model)
    assert [str(d) for d in found.all_differences()] == []
    turned = {p.data_set for p in model.parameters if p.data_set in scene.guides}
    assert turned == set(scene.guides) and found.perturbed is not None and found.perturbed.largest <= 1e-12
    alone = verify(scene, model, only="sheets")
    assert [str(d) for d in alone.all_differences()] == []


def test_facets_keep_to_the_arc_and_do_not_leave_gaps():
    _, model = shapes()
    for guide in model.guides:
        if guide.radius == 0.0:
            continue
        shown = facets(guide)
        thick = guide.thickness / 2
        face = {"inside": thick, "outside": -thick, "both": thick}[guide.side]
        ends = []
        for f in shown:
            for end in (-0.5, 0.5):
                away = (f.center - guide.center + f.rotation @ [face, end * f.lengths[1], 0.0]) @ guide.axes
                ends.append(math.hypot(away[0], away[1]))
        radius = guide.radius - (thick if guide.side == "both" else 0.0)
        # the middle of a face is on the arc; its ends are farther out, to where the neighbour's begins
        assert min(ends) >= radius and max(ends) <= radius + (guide.thickness + radius) / radius * SAG * 1.5


def test_a_changed_facet_is_seen(tmp_path):
    scene, model = shapes()
    text = emitter("motionview").emit(model)
    for old, new in (
        ("ds_i.real_s.value, ds_i.real_chord.value", "ds_i.real_s.value, ds_i.real_s.value"),
        ("cos(ds_i.real_from.value*PI/180", "cos(ds_i.real_to.value*PI/180"),
        ("gbox_i_3, false", "gbox_i_2, false"),
    ):
        assert old in text, old
        changed = tmp_path / "changed.mdl"
        changed.write_text(text.replace(old, new, 1))
        found = verify(scene, model, text=changed)
        assert found.all_differences()
    assert not emitter("motionview").read(text, "own").notes.findings()


# -- what is refused, and what is reported


def test_a_sheet_that_begins_in_a_guide_is_reported():
    """The channel's note is clear of it; one that is too low by 0.55 mm is 0.1 mm in the floor."""
    assert [lint.code for lint in lints(lower(load(CHANNEL)))] == []
    low = lower(load(CHANNEL, ["sheets.note.center.2=-0.55 mm", "contacts.0.between=[note, guide_lower]"]))
    (found,) = [lint for lint in lints(low) if lint.code == "W112" and lint.where.startswith("guides")]
    assert found.where == "guides.guide_lower" and "starts 0.1 mm inside note" in found.message
    far = lower(load(CHANNEL, ["sheets.note.center.0=-20 mm"]))  # its edge, 5 mm into the arc
    (found,) = [lint for lint in lints(far) if lint.code == "W112" and lint.where.startswith("guides")]
    depth = math.hypot(5.0, 20.05) - 20.5
    assert found.where == "guides.guide_outer" and f"starts {depth:.3g} mm inside note" in found.message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("to: [5 mm, 1 mm, 2 mm]", "to: [5 mm, 9 mm, 2 mm]", "not square to its axis"),
        ("to: [5 mm, 0 mm, 3 mm]", "to: [-5 mm, 0 mm, 1 mm]", "one point"),
        ("from: 0 deg, to: 180 deg", "from: 0 deg, to: 190 deg", "180 deg at most"),
        ("from: 10 deg", "from: 12 deg", "more than 0"),
        ("from: 10 deg", "form: 10 deg", "did you mean 'from'"),
        ("axis: y, radius: 6 mm", "axis: y, radius: 0.9 mm", "not less than the radius"),
        (
            "  t:\n",
            "  t:\n    line: {from: [0 mm, 0 mm, 0 mm], to: [1 mm, 0 mm, 0 mm], axis: y, side: left}\n",
            "one of them",
        ),
        (
            "contacts: [{",
            "contacts: [{between: [l, r], stiffness: 1 N/mm^1.5, friction: 0}, {",
            "guide touches sheets and rollers only",
        ),
    ],
)
def test_what_is_not_a_guide_is_refused_in_one_line(old, new, message):
    assert old in SHAPES
    text = SHAPES.replace(old, new, 1)
    with pytest.raises(SpecError, match=message) as found:
        loads(text)
    assert "\n" not in str(found.value)
