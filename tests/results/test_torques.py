"""Torques and power of drives, and the grip of contacts, against closed forms, in both solvers."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from nip import FORTH_AND_BACK
from papers import on_paper
from ran import solved
from solids import binary, cylinder

from mdlgen.backends.lattice.arrays import build
from mdlgen.mechanics.driven import clutch
from mdlgen.model.lower import lower
from mdlgen.results import torques
from mdlgen.results.begun import begun_of
from mdlgen.results.io.series import series
from mdlgen.results.result import Result
from mdlgen.results.verdict import judge
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

SOLVERS = ("lattice", "exudyn")
# A motor and a pressed roller in contact, far from a block that only has to be there. Without gravity the
# force is the preload at the touching place, less what the spring gives on 0.2 mm.
PAIR = on_paper("""
name: pair
gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]
materials: {p: PLATE_PAPER}
sheets: {block: {material: p, size: [10 mm, 10 mm], thickness: 0.1 mm, mass: 1 g, boxes: [1, 1],
  center: [0 mm, 0 mm, 200 mm]}}
rollers:
  motor: {center: [0 mm, 0 mm, 0 mm], axis: y, radius: 20 mm, width: 20 mm, mass: 40 g,
    drive: {speed: 100 rad/s, ramp: 10 ms}}
  top: {center: [0 mm, 0 mm, 30 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 10 g,
    press: {direction: -z, stiffness: 0.001 N/mm, preload: 3 N, damping_ratio: 0.5}}
contacts: [{between: [motor, top], stiffness: 3000 N/mm^1.5, friction: 0.4, smoothing: 5 mm/s}]
run: {duration: 20 ms, print_step: 0.05 ms}
""")
ALPHA, INERTIA, R, R_TOP, PRELOAD, MU = 0.01, 8000.0, 20.0, 10.0, 3.0, 0.4  # rad/ms^2, g mm^2, mm, N
DEPTH = (PRELOAD / 3000.0) ** (2 / 3)  # 0.01 mm: arms to the contact point are half of it shorter


def run(text: str, solver: str, *overrides: str) -> Result:
    return solved(lower(loads(text, "torques", overrides)), solver)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_ramp_takes_the_inertia_of_both_rollers(solver: str) -> None:
    """Through friction the motor speeds up the other one, of (R/R_top)^2 times its inertia."""
    result = run(PAIR, solver)
    motor, top = result.rollers["motor"], result.rollers["top"]
    ramp = (result.time > 3.0) & (result.time < 9.0)
    after = result.time > 13.0
    own = 0.5 * 10.0 * R_TOP**2
    # creep of the regularised friction is steady after 1 ms; the arms lack half of the depth
    arms = pytest.approx(own * ALPHA * (R / R_TOP), rel=1e-3 + DEPTH / R_TOP)
    assert np.abs(top.contact_torque[ramp]).mean() == arms
    expected = INERTIA * ALPHA + own * ALPHA * (R / R_TOP) ** 2
    assert motor.drive_torque[ramp].mean() == pytest.approx(expected, rel=1e-3)
    assert np.abs(motor.drive_torque[after]).max() < 1e-3 * expected
    assert not top.drive_torque.any() and not top.drive_power.any()
    # power is torque times speed, and what it adds up to is the energy of both at the end
    np.testing.assert_allclose(motor.drive_power, motor.drive_torque * 1e-3 * motor.rate, rtol=1e-9)
    given = torques.over_time(result, motor.drive_power) * result.time[-1]
    energy = result.energy.driven + 0.5 * INERTIA * 0.1**2
    assert given == pytest.approx(energy, rel=0.01)  # half of what is stored at the corner, 0.05 ms long


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_nip_that_slips_takes_mu_n_r(solver: str) -> None:
    """Two driven rollers that turn alike, so that their surfaces slip."""
    result = run(PAIR, solver, "rollers.top.drive={speed: 50 rad/s}")
    motor, top = result.rollers["motor"], result.rollers["top"]
    late = result.time > 12.0
    force = float(result.contact_force[-1, 0])
    assert force == pytest.approx(PRELOAD, rel=1e-3)
    slips = MU * force
    assert motor.drive_torque[late] == pytest.approx(slips * (R - DEPTH / 2), rel=1e-3)
    assert top.drive_torque[late] == pytest.approx(slips * (R_TOP - DEPTH / 2), rel=1e-3)
    # friction holds both back, each against the way that it turns
    assert motor.tangential["top"][-1] == pytest.approx(-slips, rel=1e-6)
    assert top.tangential["motor"][-1] == pytest.approx(-slips, rel=1e-6)
    assert motor.traction["top"][late] == pytest.approx(1.0, rel=1e-6)
    record = result.summary()["rollers"]["motor"]
    assert record["traction"]["top"]["least_reserve"] == pytest.approx(0.0, abs=1e-6)
    assert record["power_w"] == pytest.approx(record["torque_n_mm"] * 0.1, rel=1e-9)
    assert motor.power == pytest.approx(slips * 2.0, rel=2e-3)  # N times m/s


@pytest.mark.parametrize("solver", SOLVERS)
def test_an_axis_that_is_turned_round_turns_the_signs(solver: str) -> None:
    overrides = ("rollers.top.drive={speed: -50 rad/s}", "rollers.top.axis=-y")
    one = run(PAIR, solver, "rollers.top.drive={speed: 50 rad/s}").rollers
    two = run(PAIR, solver, *overrides).rollers
    assert two["top"].drive_torque == pytest.approx(-one["top"].drive_torque, rel=1e-6, abs=1e-9)
    assert two["top"].tangential["motor"] == pytest.approx(-one["top"].tangential["motor"], rel=1e-6)
    assert two["motor"].tangential["top"] == pytest.approx(one["motor"].tangential["top"], rel=1e-6)
    assert two["top"].power == pytest.approx(one["top"].power, rel=1e-6)


@pytest.mark.parametrize("solver", SOLVERS)
def test_rolling_resistance_is_no_friction(solver: str) -> None:
    """The free roller is turned by friction against a couple f N R', 1/R' = 1/R + 1/R_top: the motor gives
    f N R for it."""
    f = 0.05
    result = run(PAIR, solver, f"contacts.0.rolling_resistance={f}", "rollers.motor.drive={speed: 100 rad/s}")
    motor, top = result.rollers["motor"], result.rollers["top"]
    late = result.time > 15.0
    couple = f * PRELOAD * R * R_TOP / (R + R_TOP)
    # a steady state is come to within 2e-3; arms lack half of the depth
    assert motor.drive_torque[late] == pytest.approx(f * PRELOAD * R, rel=5e-3)
    assert np.abs(top.tangential["motor"][late]) == pytest.approx(couple / R_TOP, rel=5e-3)
    assert np.abs(top.contact_torque[late]).max() < 0.02 * couple


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_nip_that_pulls_a_sheet_takes_m_a_r(solver: str) -> None:
    """The motor speeds up a note and an idler on it: (m a + I a/r^2) R."""
    result = run(FORTH_AND_BACK, solver)
    motor, idler = result.rollers["motor"], result.rollers["idler"]
    arm, over = 7.5, 5.0
    for begin, end, alpha in ((1.5, 4.5, 0.02), (9.0, 11.0, -0.04)):
        inside = (result.time > begin) & (result.time < end)
        a = alpha * arm
        free = 0.5 * 5.0 * 5.0**2 * a / over  # I a / r of the idler
        pull = 0.17 * a + free / over
        # the note buckles a little between its boxes, and the nip has a length
        assert idler.contact_torque[inside].mean() == pytest.approx(-free, rel=0.005)
        assert motor.tangential["note"][inside].mean() == pytest.approx(-pull, rel=0.01)
        own = 0.5 * 10.0 * 7.5**2 * alpha
        assert motor.drive_torque[inside].mean() == pytest.approx(own + pull * arm, rel=0.005)
        limit = 0.8 * result.contact_force[inside, 0]
        assert motor.traction["note"][inside] * limit == pytest.approx(
            np.abs(motor.tangential["note"][inside]), rel=1e-3
        )


def test_a_drive_that_overruns_gives_what_its_clutch_takes() -> None:
    sets = (
        "rollers.motor.drive={speed: 50 rad/s, ramp: 2 ms}",
        "rollers.motor.one_way={direction: 1, torque: 40 N*mm, creep: 0.1 rad/s}",
    )
    model = lower(loads(FORTH_AND_BACK, "clutch", sets))
    result = solved(model, "lattice")
    roller = model.roller("motor")
    body = build(model).bodies[roller.body]
    spin = result.spin[:, roller.body] @ roller.axis
    law = [clutch(body, rate, t)[0] for rate, t in zip(spin.tolist(), result.time.tolist(), strict=True)]
    assert torques.drive_torque(result, roller) == pytest.approx(law, rel=1e-9, abs=1e-12)
    assert result.rollers["motor"].drive_torque.max() > 1.0


def test_torques_are_saved_required_and_shown(tmp_path: Path) -> None:
    sets = (
        'require=["rollers.motor.max_torque within 30 N*mm", "rollers.motor.power below 3 W throughout", '
        '"rollers.motor.traction.note.reserve above 5 %", "rollers.motor.torque within 1 N*mm throughout"]',
    )
    result = run(FORTH_AND_BACK, "lattice", *sets)
    result.save(tmp_path)
    again = Result.load(tmp_path)
    for name in ("drive_torque", "drive_power", "contact_torque"):
        np.testing.assert_array_equal(
            getattr(again.rollers["motor"], name), getattr(result.rollers["motor"], name)
        )
    passed = [outcome.passed for outcome in judge(again, result.summary())]
    assert passed == [True, True, True, False]
    columns = (tmp_path / "series.csv").read_text().splitlines()[0].split(",")
    assert {"motor.torque_n_mm", "motor.power_w", "motor.note.tangential_n"} <= set(columns)
    assert "idler.torque_n_mm" not in columns and "idler.contact_torque_n_mm" in columns
    record = json.loads((tmp_path / "summary.json").read_text())["rollers"]
    assert record["motor"]["max_torque_n_mm"] == pytest.approx(
        torques.peak(result.rollers["motor"].drive_torque)
    )
    assert record["idler"]["max_power_w"] == 0.0
    shown = result.report(tmp_path / "page.html").read_text("utf-8")
    for words in ("Torque of each drive", "Power of each drive", "Used part of the grip"):
        assert words in shown
    assert "torque" in repr(result.rollers["motor"]) and result.rollers["motor"].units["torque"] == "N*mm"
    assert result.plot("torque").figure.axes[0].get_ylabel() == "N mm"


def test_a_file_of_an_older_version_has_no_torques(tmp_path: Path) -> None:
    import h5py

    result = run(FORTH_AND_BACK, "lattice")
    result.save(tmp_path)
    with h5py.File(tmp_path / "result.h5", "a") as file:
        del file["contact_torque"], file["contact_friction"]
    again = Result.load(tmp_path)
    assert again.contact_torque is None and np.isnan(again.rollers["motor"].torque)
    assert again.summary()["rollers"]["motor"]["max_torque_n_mm"] is None


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("place", [(0.0, 0.0, 30.0), (18.0, 0.0, 24.0)])
def test_a_pressed_roller_stands_where_its_spring_and_its_contact_balance(
    solver: str, place: tuple[float, float, float]
) -> None:
    """3000 N/mm^1.5 d^1.5 = 3 N - 5 N/mm d, along the direction of its press, which may lean."""
    towards = [-x / 30.0 for x in place]
    press = f"{{direction: {towards}, stiffness: 5 N/mm, preload: 3 N, damping_ratio: 0.5}}"
    center = f"[{place[0]} mm, {place[1]} mm, {place[2]} mm]"
    asked = (
        'require=["rollers.top.slide from 9.8 um to 9.95 um throughout", "rollers.top.max_slide below 9 um"]'
    )
    result = run(PAIR, solver, f"rollers.top.press={press}", f"rollers.top.center={center}", asked)
    depth = DEPTH
    for _ in range(20):
        depth = ((3.0 - 5.0 * depth) / 3000.0) ** (2 / 3)
    record = result.summary()["rollers"]["top"]
    # the run starts in balance and friction of the ramp is across the slide
    assert record["slide_mm"] == pytest.approx(depth, rel=1e-3)
    way = series(result)["top.slide_mm"]
    assert (record["max_slide_mm"], record["min_slide_mm"]) == (way.max(), way.min())
    assert way == pytest.approx(
        (np.array(place) - result.position[:, result.model.roller("top").body]) @ place / 30
    )
    assert [one.passed for one in judge(result, result.summary())] == [True, False]
    assert "slide_mm" not in result.summary()["rollers"]["motor"]


def test_what_is_on_a_roller_turns_it(tmp_path: Path) -> None:
    """Contacts of a mesh count for the roller that carries it."""
    (tmp_path / "tyre.stl").write_bytes(binary(*cylinder(7.5, 20.0, 24)))
    text = FORTH_AND_BACK + (
        "meshes: {tyre: {file: tyre.stl, on: motor, center: [0 mm, 0 mm, -7.5 mm], mass: 1 g}}\n"
    )
    text = text.replace('[note, "*r"]', "[note, [idler, tyre]]")
    model = lower(loads(text, "tyre", folder=tmp_path))
    found = [(side, other) for _, side, other in torques.rows_of(begun_of(model), model.roller("motor"))]
    assert found == [(1, "note")]
