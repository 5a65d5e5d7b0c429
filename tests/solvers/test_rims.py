"""Rims of rollers in sectors: their profile, what they store and give back, transport, text, deck, spec."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from laws import pair_force
from papers import on_paper
from ran import solved

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.motionsolve import validate
from mdlgen.errors import SpecError
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.point import OUT
from mdlgen.mechanics.rim import profile
from mdlgen.model.lower import lower
from mdlgen.model.rims import pieces, touched
from mdlgen.model.tables import Floats, Model
from mdlgen.registry import emitter
from mdlgen.results.compare import compare
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads
from mdlgen.verify.verification import verify

pytestmark = pytest.mark.usefixtures("as_python")

# 90 deg of rubber: it grips where its friction is above 0.5, which is in the middle of the blend
FEED = on_paper("""
name: feed
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials:
  paper: HINGED_PAPER
sheets:
  note: {material: paper, size: [100 mm, 30 mm], thickness: 0.1 mm, mass: 0.17 g, boxes: [12, 2],
    center: [20 mm, 0 mm, 0 mm]}
rollers:
  feed: {center: [0 mm, 0 mm, -15.05 mm], axis: y, radius: 15 mm, width: 20 mm, mass: 10 g,
    drive: {speed: 80 rad/s, ramp: 2 ms}, rim: {sectors: [{from: 60 deg, to: 150 deg, friction: 4}]}}
  hold: {center: [0 mm, 0 mm, 5.05 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g,
    drive: {speed: 0 rad/s}, press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}
contacts:
  - {between: [note, feed], stiffness: 300 N/mm^1.5, friction: 0.2, smoothing: 1 mm/s}
  - {between: [note, hold], stiffness: 300 N/mm^1.5, friction: 0.5, smoothing: 1 mm/s}
run: {duration: 60 ms, print_step: 0.25 ms}
""")
TOOTH = (
    "rollers.feed.rim.sectors=[{from: 180 deg, to: 220 deg, radius: 15.3 mm, stiffness: 0.5}]",
    "rollers.feed.drive.speed=30 rad/s",
    "contacts.0.friction=1.5",
    "contacts.1.friction=0.1",
    "run.duration=55 ms",
)
SOLVERS = ("lattice", "exudyn")
TWO = (
    "[{from: -20 deg, to: 20 deg, radius: 15.3 mm, friction: 3}, "
    "{from: 20 deg, to: 60 deg, radius: 15.2 mm}, "
    "{from: 100 deg, to: 110 deg, radius: 14.9 mm, stiffness: 0.5, restitution: 0.2}]"
)


def model(*overrides: str) -> Model:
    return lower(loads(FEED, "rims", overrides))


def way(result: Result) -> Floats:
    """Of the sheet's centre along x [mm]."""
    moved = result.sheet_motion(0)[0][:, 0]
    return moved - moved[0]


# -- the profile


def test_the_profile_is_the_support_function_of_the_rim() -> None:
    """Against the farthest of 40000 points of the round, away from the blends between pieces."""
    made = model(f"rollers.feed.rim.sectors={TWO}", "rollers.feed.rim.blend=0.2 deg")
    roller = made.roller("feed")
    system = build(made)
    body, rims = system.bodies[roller.body], system.shapes.rims
    rim = roller.rim
    assert rim is not None and rim.name == ("s0", "s1", "g1", "s2", "g2")
    round_ = np.linspace(0.0, 2 * np.pi, 40001)
    sector = [
        next(k for k in range(len(rim)) if (a - rim.begin[k]) % (2 * np.pi) <= rim.end[k] - rim.begin[k])
        for a in round_
    ]
    # at a border both sectors have their edge
    points = np.concatenate(
        [np.stack([round_, rim.radius[sector]]), [[*rim.begin, *rim.end], [*rim.radius] * 2]], 1
    )
    begins = np.degrees([piece.begin for piece in pieces(rim)])
    angles = np.arange(0.5, 360.0, 1.7)
    angles = np.radians(angles[np.abs(angles[:, None] - begins).min(axis=1) > 0.1])
    due = np.array([(points[1] * np.cos(a - points[0])).max() for a in angles])
    found = np.array([profile(body, rims, a, 0.3) for a in angles])
    assert np.abs(found[:, 0] - due).max() < 1e-6
    assert np.allclose(found[:, 0], [touched(rim, a)[0] for a in angles], rtol=0, atol=1e-6)


def test_the_profile_is_smooth_and_its_derivatives_are_right() -> None:
    made = model(f"rollers.feed.rim.sectors={TWO}")
    system = build(made)
    body, rims = system.bodies[made_body(made)], system.shapes.rims
    step = 1e-6
    for angle in np.linspace(-7.0, 7.0, 1501):
        here = profile(body, rims, angle, 0.3)
        ahead, behind = profile(body, rims, angle + step, 0.3), profile(body, rims, angle - step, 0.3)
        assert (ahead[0] - behind[0]) / (2 * step) == pytest.approx(here[1], abs=2e-3)
        assert (ahead[2] - behind[2]) / (2 * step) == pytest.approx(here[4], abs=2e-3)
        assert np.abs(np.subtract(ahead, behind))[[0, 2, 3, 5]].max() < 1e-3


def made_body(made: Model) -> int:
    return made.roller("feed").body


def test_a_turning_rim_gives_back_what_it_stores() -> None:
    """Without damping and friction the torque's work over any way is what the stored energy falls by."""
    made = model(
        f"rollers.feed.rim.sectors={TWO}", "contacts.0.restitution=1", "contacts.0.friction=0",
        "sheets.note.boxes=[1, 1]", "rollers.feed.center=[0 mm, 0 mm, -14.85 mm]",
    )  # fmt: skip
    system = build(made)
    pair = next(p for p in system.pairs if p["b"] == made_body(made))
    count = len(system.bodies)
    x, still = np.zeros((count, 3)), np.zeros((count, 3))
    x[:-1] = made.bodies.position
    r = np.tile(np.eye(3).ravel(), (count, 1))
    r[:-1] = made.bodies.rotation.reshape(-1, 9)
    begin, angles = r[pair["b"]].reshape(3, 3).copy(), np.linspace(0.0, 2 * np.pi, 20001)
    rows = np.zeros((len(angles), OUT))
    for angle, out in zip(angles.tolist(), rows, strict=True):
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        r[pair["b"]] = (turn @ begin).ravel()
        pair_force(system.bodies, pair, system.shapes, Motion(x, r, still, still), out)
    energy, torque = rows[:, 13], rows[:, 10]
    # about the origin nothing comes from nowhere
    arms = np.cross(x[pair["a"]], rows[:, :3]) + np.cross(x[pair["b"]], rows[:, 6:9])
    opposite = np.abs(arms + rows[:, 3:6] + rows[:, 9:12])
    work = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(angles))])
    assert np.ptp(energy) > 1.0
    assert np.abs(work + energy - energy[0]).max() < 0.002 * np.ptp(energy)
    assert opposite.max() < 1e-9


# -- runs


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_sheet_moves_only_while_the_rubber_passes(solver: str) -> None:
    """90 deg of 15 mm; what is lost or won is creep of 1 mm/s smoothing, and where in the blend it grips."""
    result = solved(model(), solver)
    # the rim's angle where it is nearest to the sheet is 270 deg less what the roller has turned
    turned = np.degrees(result.model.roller("feed").turned(result.time))
    moved = way(result)
    assert np.abs(moved[turned < 115.0]).max() < 0.03  # creep of the plastic
    assert np.ptp(moved[turned > 220.0]) < 0.04  # it rings where it is let go: by 0.037 mm at any step
    assert moved[-1] == pytest.approx(15.0 * np.pi / 2, rel=0.01)
    during = (turned > 140.0) & (turned < 200.0)
    speed = np.gradient(moved, result.time)[during]
    assert speed.mean() == pytest.approx(15.0 * 0.08, rel=0.01)
    assert abs(result.energy.balance_error) < 0.01


def test_both_solvers_agree_about_rubber() -> None:
    one, two = (solved(model(), solver) for solver in SOLVERS)
    assert compare(two, one).relative < 0.01
    assert one.energy.driven == pytest.approx(float(two.energy.driven), rel=0.01)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_tooth_lifts_what_is_pressed_on_it(solver: str) -> None:
    """By its height less what it goes deeper, softer than the rest; the energies of the run close."""
    result = solved(model(*TOOTH), solver)
    made = result.model
    turned = np.degrees(made.roller("feed").turned(result.time))
    height = result.position[:, made.roller("hold").body, 2]
    on, before = (turned > 65.0) & (turned < 85.0), (turned > 10.0) & (turned < 35.0)
    deeper = (3.0 / 150.0) ** (2 / 3) - (3.0 / 300.0) ** (2 / 3)
    assert height[on].mean() - height[before].mean() == pytest.approx(0.3 - deeper, abs=0.02)
    assert abs(result.energy.balance_error) < 0.02


def test_both_solvers_agree_about_a_tooth() -> None:
    one, two = (solved(model(*TOOTH), solver) for solver in SOLVERS)
    assert compare(two, one).relative < 0.01


@pytest.mark.parametrize("solver", SOLVERS)
def test_rollers_feel_each_others_teeth(solver: str) -> None:
    """A free roller pressed on the rim, without a sheet between, is lifted by the tooth."""
    result = solved(
        model(
            *TOOTH[:2],
            "sheets.note.center=[90 mm, 0 mm, 30 mm]",
            # over a small speed the damping alone would hold a depth for a while
            "contacts=[{between: [hold, feed], stiffness: 300 N/mm^1.5, friction: 0.3, smoothing: 50 mm/s}]",
            "rollers.feed.center=[0 mm, 0 mm, -15 mm]",
            "rollers.hold={center: [0 mm, 0 mm, 5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g, "
            "press: {direction: -z, stiffness: 0.3 N/mm, preload: 3 N}}",
            "run.duration=55 ms",
        ),
        solver,
    )
    made = result.model
    turned = np.degrees(made.roller("feed").turned(result.time))
    height = result.position[:, made.roller("hold").body, 2]
    on, before = (turned > 65.0) & (turned < 85.0), (turned > 10.0) & (turned < 35.0)
    deeper = (3.0 / 150.0) ** (2 / 3) - (3.0 / 300.0) ** (2 / 3)
    assert height[on].mean() - height[before].mean() == pytest.approx(0.3 - deeper, abs=0.02)
    assert abs(result.energy.balance_error) < 0.02


# -- text, deck, spec


@pytest.mark.parametrize(
    "overrides",
    [
        (),
        (f"rollers.feed.rim.sectors={TWO}",),
        (f"rollers.feed.rim.sectors={TWO}", "rollers.feed.axis=[0.1, 1, 0.2]"),
        (
            f"rollers.feed.rim.sectors={TWO}",
            "contacts.1={between: [feed, hold], stiffness: 30 N/mm^1.5, friction: 0.2}",
        ),
    ],
    ids=["rubber", "teeth", "askew", "rollers"],
)
def test_text_deck_and_model_have_one_rim(tmp_path: Path, overrides: tuple[str, ...]) -> None:
    file = tmp_path / "feed.yaml"
    file.write_text(FEED.replace("boxes: [12, 2]", "boxes: [3, 2]"))
    made = load(file, overrides)
    found = verify(made, lower(made))
    assert [str(d) for d in found.all_differences()] == []
    assert all(c.largest <= 1e-12 for kinds in found.kinds.values() for c in kinds.values())
    assert found.perturbed is not None and found.perturbed.largest <= 1e-12
    assert validate(emitter("motionsolve").emit(lower(made))) == []


def test_the_sheets_alone_meet_each_sector(tmp_path: Path) -> None:
    made = loads(FEED, "rims", ("sheets.note.boxes=[3, 2]",))
    found = verify(made, lower(made), only="sheets")
    assert [str(d) for d in found.all_differences()] == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("real_s0_to, 150", "real_s0_to, 150.001"),
        ("cos($s0_from", "cos($s0_to"),
        ("gbox_feed_s0_0, false, ", "gbox_feed_g0_0, false, "),
        ("ds_contact_0.real_mu_s.value*ds_feed.real_s0_friction.value", "ds_contact_0.real_mu_s.value"),
    ],
)
def test_another_rim_in_the_text_is_caught(tmp_path: Path, old: str, new: str) -> None:
    made = loads(FEED, "rims", ("sheets.note.boxes=[3, 2]",))
    text = emitter("motionview").emit(lower(made), set_contact=True)
    old, new = (
        v.replace("$s0", "(ds_feed.real_s0").replace("cos(", "cos") if "$" in v else v for v in (old, new)
    )
    assert text.count(old) >= 1
    file = tmp_path / "rims.mdl"
    file.write_text(text.replace(old, new, 1))
    assert not verify(made, lower(made), text=file).ok


@pytest.mark.parametrize(
    ("sectors", "where", "message"),
    [
        ("[]", "rim", "0 sectors; allowed 1 to 8"),
        ("[{from: 10 deg, to: 10 deg}]", "sectors.0", "more than 0 and less than 360 deg"),
        ("[{from: 0 deg, to: 360 deg}]", "sectors.0", "more than 0 and less than 360 deg"),
        ("[{from: 0 deg, to: 30 deg}, {from: 29 deg, to: 40 deg}]", "rim", "sectors.0 ends at 30 deg"),
        ("[{from: 0 deg, to: 30 deg}, {from: 300 deg, to: 370 deg}]", "rim", "sectors.1 ends at 370 deg"),
        ("[{from: 0 deg, to: 30 deg, radius: 0 mm}]", "sectors.0.radius", "more than 0 mm"),
        ("[{from: 0 deg, to: 30 deg, friction: -1}]", "sectors.0.friction", "greater than or equal to 0"),
        ("[{from: 0 deg, to: 30 deg, restitution: 2}]", "sectors.0.restitution", "less than or equal to 1"),
        (f"{[{'from': f'{40 * k} deg', 'to': f'{40 * k + 9} deg'} for k in range(9)]}", "rim", "9 sectors"),
    ],
)  # fmt: skip
def test_a_bad_rim_is_reported_in_one_line(sectors: str, where: str, message: str) -> None:
    with pytest.raises(SpecError) as error:
        loads(FEED, "rims", (f"rollers.feed.rim.sectors={sectors}",))
    assert where in str(error.value) and message in str(error.value) and "\n" not in str(error.value)


def test_two_rims_do_not_meet() -> None:
    with pytest.raises(SpecError, match="both have a rim of sectors"):
        model(
            "rollers.hold.rim={sectors: [{from: 0 deg, to: 30 deg}]}",
            "contacts.1={between: [feed, hold], stiffness: 30 N/mm^1.5, friction: 0}",
        )
