"""Clutches that let rollers turn one way: a backstop, an overrunning drive, the law, what cannot say it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from machines import OVERRUN, WAY
from nip import FORTH_AND_BACK
from ran import solved

from mdlgen.backends.lattice.arrays import build
from mdlgen.backends.motionsolve import read, validate
from mdlgen.errors import SpecError
from mdlgen.mechanics.driven import clutch
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats, Model
from mdlgen.registry import emitter
from mdlgen.results.compare import compare
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

pytestmark = pytest.mark.usefixtures("as_python")

CREEP, TORQUE = 1e-4, 40.0  # rad/ms, N mm: more than friction, 0.8 of some 3 N, and inertia can bring up
BACKSTOP = f"rollers.idler.one_way={WAY % -1}"
SOLVERS = ("lattice", "exudyn")


def model(*overrides: str) -> Model:
    return lower(loads(FORTH_AND_BACK, "one_way", overrides))


def spin(result: Result, name: str) -> Floats:
    """Of a roller about its axis [rad/ms]."""
    roller = result.model.roller(name)
    return result.spin[:, roller.body] @ roller.axis


def test_the_law_is_smooth_passes_its_point_and_only_takes_energy() -> None:
    for sense, shaft in ((1, 0.0), (-1, 0.0), (1, 0.05), (-1, 0.05)):
        drive = "[[0 ms, 50 rad/s], [9 ms, 50 rad/s]]" if shaft else "[[0 ms, 0 rad/s], [9 ms, 0 rad/s]]"
        made = model(f"rollers.motor.drive={{profile: {drive}}}", f"rollers.motor.one_way={WAY % sense}")
        body = build(made).bodies[made.roller("motor").body]

        def law(rate: float, body=body) -> tuple[float, float, float]:
            return clutch(body, rate, 5.0)

        rates = shaft + np.linspace(-20 * CREEP, 20 * CREEP, 4001)
        torque, loss, seen = np.array([law(rate) for rate in rates]).T
        assert np.all(seen == shaft)
        assert np.all(torque * (rates - shaft) <= 0.0)  # of what turns against the shaft
        free = sense * (rates - shaft) >= 0.0
        assert not torque[free].any() and np.all(sense * torque[~free] > 0.0)
        assert law(shaft - sense * CREEP)[0] == pytest.approx(sense * TORQUE, rel=1e-9)
        assert np.all(loss >= 0.0) and np.abs(np.diff(loss)).max() < 0.05 * loss.max()
        quotient = -(torque[2:] - torque[:-2]) / (rates[2:] - rates[:-2])
        assert np.abs(quotient - loss[1:-1]).max() < 0.01 * loss.max()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_backstop_turns_forth_and_holds_back(solver: str) -> None:
    """The motor goes back and the sheet slides under the idler; without a backstop it takes it along."""
    held, free = solved(model(BACKSTOP), solver), solved(model(), solver)
    forth = held.time < 9.0
    assert np.abs(spin(held, "idler") - spin(free, "idler"))[forth].max() < 1e-3
    assert spin(held, "idler").min() < -0.14
    back = held.time > 11.5
    assert spin(free, "idler")[back].max() > 0.05
    assert spin(held, "idler")[back].min() > 0.0 and spin(held, "idler")[back].max() < CREEP
    assert abs(held.energy.balance_error) < 0.01


def test_the_creep_follows_from_the_torque() -> None:
    """Friction 0.8 F on the rim, or a little deeper; of the law s^2 / (1 + s) = torque / (2 * 40 N mm)."""
    result = solved(model(BACKSTOP), "lattice")
    late = result.time > 15.0
    row = next(k for k, b in enumerate(result.model.contacts.part_b) if b == "idler")
    part = 0.8 * result.contact_force[late, row].mean() * 5.0 / (2.0 * TORQUE)
    due = CREEP * 0.5 * (part + np.sqrt(part * part + 4.0 * part))
    assert spin(result, "idler")[late].mean() == pytest.approx(due, rel=0.03)


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_driven_roller_is_overrun_and_takes_over_again(solver: str) -> None:
    made = model(*OVERRUN)
    result = solved(made, solver)
    shaft, turns = made.roller("motor").prescribed(result.time), spin(result, "motor")
    assert (turns - shaft).min() > -CREEP
    dragged = np.abs(result.time - 10.0) < 1.5  # at up to 5/7.5 of the idler's speed
    due = 5.0 / 7.5 * -spin(result, "idler")
    assert np.abs(turns - due)[dragged].max() < 0.01 * due.max() and turns.max() > 0.065
    own = (result.time > 3.0) & (result.time < 7.0) | (result.time > 13.5)
    assert np.abs(turns - shaft)[own].max() < CREEP
    assert abs(result.energy.balance_error) < 0.01


@pytest.mark.parametrize("overrides", [(BACKSTOP,), OVERRUN], ids=["backstop", "overrun"])
def test_both_solvers_agree_about_a_clutch(overrides: tuple[str, ...]) -> None:
    one, two = (solved(model(*overrides), solver) for solver in SOLVERS)
    assert compare(two, one).relative < 3e-3


def test_the_energy_of_a_clutch_closes_as_the_step_falls() -> None:
    off = [
        solved(model(*OVERRUN, f"run.step={h} ms"), "lattice").energy.balance_error
        for h in (0.05, 0.025, 0.0125)
    ]
    assert abs(off[1] - off[2]) < 0.4 * abs(off[0] - off[1])


def test_a_driven_roller_begins_with_its_shaft() -> None:
    made = model(
        "rollers.motor.drive={speed: 50 rad/s}", f"rollers.motor.one_way={WAY % 1}", "run.duration=1 ms"
    )
    for solver in SOLVERS:
        assert spin(solved(made, solver), "motor")[0] == 0.05


@pytest.mark.parametrize("overrides", [(BACKSTOP,), OVERRUN], ids=["backstop", "overrun"])
def test_the_deck_has_the_torque_by_formula(overrides: tuple[str, ...]) -> None:
    made = model(*overrides)
    deck = emitter("motionsolve").emit(made)
    assert validate(deck) == []
    name = "motor" if made.roller("motor").one_way else "idler"
    roller = made.roller(name)
    element = re.search(rf"frc_{name}_clutch -->\s*<Force_Vector_OneBody(.*?)/>", deck, re.S)
    assert element is not None
    said = dict(re.findall(r'(\w+)\s*=\s*"([^"]*)"', element[1]))
    joint = read(deck).values["joints"][f"j_{name}"]
    assert joint["type"] == "REVOLUTE" and f"mot_{name}" not in read(deck).values["motions"]
    markers = re.search(
        rf'label\s*= "Axle of {name}".*?i_marker_id\s*= "(\d+)"\s*j_marker_id\s*= "(\d+)"', deck, re.S
    )
    assert markers is not None
    # it acts on the roller, at its centre, along the axes of the roller's side of the axle
    assert said["ref_marker_id"] == markers[1]
    own, axle = (
        re.search(rf'<Reference_Marker\s+id\s*= "{marker}".*?(body_id .*?pos_z[^\n]*)', deck, re.S)
        for marker in (said["marker_id"], markers[1])
    )
    assert own is not None and axle is not None and own[1] == axle[1]
    call = f"WZ({markers[1]},{markers[2]},{markers[2]})"
    assert said["type"] == "TorqueOnly" and said["tx_expression"] == said["ty_expression"] == "0"
    law, body = said["tz_expression"].replace(call, "W"), build(made).bodies[roller.body]
    assert "W" in law and call not in law
    for t in (0.0, 1.3, 7.0):
        for rate in (-0.2, -1e-4, 0.0, 3e-5, 0.0499, 0.0502, 0.2):
            names = {"__builtins__": {}, "MAX": max, "TIME": t / 1000, "W": rate * 1000}
            assert eval(law, names) == pytest.approx(clutch(body, rate, t)[0], rel=1e-9, abs=1e-9)


def test_a_clutch_in_a_static_run_is_refused_by_name() -> None:
    with pytest.raises(SpecError, match=r"rollers\.idler\.one_way: roller idler: one_way acts by speed"):
        model(BACKSTOP, "run.analysis=static", "rollers.motor.drive=null")


@pytest.mark.parametrize(
    "given",
    [
        "{direction: 2, torque: 1 N*mm}",
        "{torque: 1 N*mm}",
        "{direction: 1}",
        "{direction: 1, torque: 0 N*mm}",
        "{direction: 1, torque: 1 N*mm, creep: 0 rad/s}",
        "{direction: 1, torque: 1 N}",
    ],
)
def test_a_bad_clutch_is_reported_in_one_line(given: str) -> None:
    with pytest.raises(SpecError) as error:
        model(f"rollers.idler.one_way={given}")
    assert "rollers.idler.one_way" in str(error.value) and "\n" not in str(error.value)
