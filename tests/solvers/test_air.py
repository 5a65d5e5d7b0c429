"""Air between sheets, in runs: closed forms of whole plates, momentum, energy, and notes that land.

A plate that a force F presses through its film sinks by 1/h^2 - 1/h0^2 = 2 F t/(C mu), C its closed form
(0.4217 L^4 of a square), once its own time m h^3/(C mu) is over.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.lower import lower
from mdlgen.model.rotations import turns
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.spec.load import load, loads

VISCOSITY = 18.2e-9  # [N ms/mm^2]
SQUARE = 0.4217  # of L^4
AIR = "air: {viscosity: 18.2 uPa*s, roughness: 0.01 um}"
TABLE = "planes: {table: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [227 mm, 300 mm, 10 mm]}}"
STIFF = "D_md: 1e7 N*mm, D_cd: 1e7 N*mm"
NOTE = "D_md: 0.4 N*mm, D_cd: 0.24 N*mm"


def scene(sheets, contacts, run, gravity=9.81, bend=NOTE, parts="") -> str:
    rows = "\n".join(f"  {name}: {{material: paper, thickness: 0.1 mm, {rest}}}" for name, rest in sheets)
    links = "\n".join(f"  - {{stiffness: 100 N/mm^1.5, friction: 0.3, {rest}}}" for rest in contacts)
    return f"""
name: air
gravity: [0 m/s^2, 0 m/s^2, {-gravity} m/s^2]
materials: {{paper: {{E_md: 3530 MPa, E_cd: 1113 MPa, {bend}}}}}
sheets:
{rows}
{parts}
contacts:
{links}
run: {{{run}}}
"""


def solved(text: str, solver: str = "lattice") -> Result:
    result = mdlgen.solve(lower(loads(text)), solver)
    assert as_asked(result), result.status
    return result


def heights(result: Result, sheet: int) -> np.ndarray:
    """Of the middle of a sheet [mm], (t,)."""
    part = result.model.sheets[sheet]
    return result.position[:, part.first : part.first + part.count, 2].mean(axis=1)


def sinking(boxes: str, step: str = "0.1 ms", solver: str = "lattice") -> Result:
    """A stiff square of 30 mm and 0.72 g that ten times its weight presses through 0.1 mm of air."""
    sheet = f"size: [30 mm, 30 mm], mass: 0.72 g, boxes: {boxes}, center: [0 mm, 0 mm, 0.15 mm]"
    run = f"duration: 20 ms, print_step: 0.5 ms, step: {step}"
    contact = f"between: [note, table], {AIR}"
    return solved(scene([("note", sheet)], [contact], run, gravity=98.1, bend=STIFF, parts=TABLE), solver)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize("boxes", ["[1, 1]", "[4, 4]", "[8, 8]", "[5, 10]", "[10, 20]"])
def test_a_note_sinks_through_its_air_as_the_closed_form_on_any_grid(boxes, solver) -> None:
    result = sinking(boxes, solver=solver)
    h, force = heights(result, 0) - 0.05, 0.72 * 98.1e-3
    t = result.time - 0.72 * 0.1**3 / (SQUARE * 30.0**4 * VISCOSITY)
    exact = (0.1**-2 + 2.0 * force * t / (SQUARE * 30.0**4 * VISCOSITY)) ** -0.5
    late = result.time > 2.0
    # a grid of a few cells has 0.7 % of the force, and h goes with its root
    assert h[late] == pytest.approx(exact[late], rel=6e-3)
    assert h[-1] < 0.05
    assert result.energy.balance_error < 2e-3
    # what its weight gave has gone into the air
    assert result.energy.dissipated == pytest.approx(force * (0.1 - h[-1]), rel=5e-3)


def test_the_step_hardly_matters() -> None:
    fine, coarse = (heights(sinking("[4, 4]", step), 0)[-1] - 0.05 for step in ("0.05 ms", "0.2 ms"))
    assert coarse == pytest.approx(fine, rel=2e-3)


PAIR = "duration: 1 ms, print_step: 0.05 ms, step: 0.01 ms"
# What Exudyn loses to the air is summed up from powers at the ends of its steps.
FINER = PAIR.replace("0.01", "0.005")


def approaching(low: str, top: str, more: str = "", solver: str = "lattice") -> Result:
    return solved(approaching_text(low, top, more, PAIR if solver == "lattice" else FINER), solver)


def approaching_text(low: str, top: str, more: str = "", run: str = PAIR) -> str:
    """Two sheets in space, 0.3 mm apart, that come together at 1 m/s."""
    size = "size: [60 mm, 60 mm], mass: 0.5 g"
    sheets = [
        ("low", f"{size}, boxes: {low}, center: [0 mm, 0 mm, 0 mm]"),
        ("top", f"{size}, boxes: {top}, velocity: [0 m/s, 0 m/s, -1 m/s], {more}"),
    ]
    if "center" not in more:
        sheets[1] = ("top", f"{sheets[1][1]}center: [0 mm, 0 mm, 0.4 mm]")
    return scene(sheets, [f"between: [low, top], {AIR}"], run, gravity=0.0, bend=STIFF)


@pytest.mark.parametrize("solver", ["lattice", "exudyn"])
@pytest.mark.parametrize(("low", "top"), [("[4, 4]", "[4, 4]"), ("[8, 8]", "[3, 5]"), ("[3, 5]", "[10, 20]")])
def test_two_plates_stop_each_other_as_the_closed_form_whichever_carries_the_air(low, top, solver) -> None:
    """With half of the mass m' and c V/h^3 the speed is v0 - c/(2 m') (1/h^2 - 1/h0^2): the gap ends where
    that is 0."""
    result = approaching(low, top, solver=solver)
    gap = heights(result, 1) - heights(result, 0) - 0.1
    c, mass = SQUARE * 60.0**4 * VISCOSITY, 0.25
    end = (0.3**-2.0 + 2.0 * mass / c) ** -0.5
    assert end < 0.26
    # of what they come closer by; a grid of a few cells has 0.7 % of the force
    assert 0.3 - gap[-1] == pytest.approx(0.3 - end, rel=1.5e-2)
    count = result.model.sheets[0].count
    speed = result.velocity[:, :count, 2].mean(axis=1) - result.velocity[:, count:, 2].mean(axis=1)
    exact = 1.0 - c / (2.0 * mass) * (gap**-2.0 - 0.3**-2.0)
    assert speed == pytest.approx(exact, abs=2e-2)
    # both go on with the speed that they have in common
    model = result.model
    for sheet in model.sheets:
        v = result.velocity[-1, sheet.first : sheet.first + sheet.count, 2]
        assert v.mean() == pytest.approx(-0.5, rel=2e-3)
    assert result.energy.dissipated == pytest.approx(0.5 * mass, rel=5e-3)
    assert result.energy.balance_error < 2e-3


def momenta(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Linear and angular momentum at all times, (t, 3) each."""
    bodies = result.model.bodies
    count = sum(s.count for s in result.model.sheets)
    mass, inertia = bodies.mass[:count, None], bodies.inertia[:count]
    x, v, w = (a[:, :count] for a in (result.position, result.velocity, result.spin))
    turn = turns(result.rotation[:, :count])
    own = np.einsum("tnij,nj,tnkj,tnk->tni", turn, inertia, turn, w)
    return (mass * v).sum(axis=1), (np.cross(x, mass * v) + own).sum(axis=1)


@pytest.mark.parametrize(("solver", "gap"), [("lattice", 0.03), ("exudyn", 0.2)])
def test_momenta_are_kept_where_sheets_slide_askew_over_a_part_of_each_other(solver, gap) -> None:
    """In Exudyn from further apart: its energies do not balance where air stops a sheet within a step."""
    more = f"turn: 23 deg, center: [21 mm, 17 mm, {0.1 + gap} mm]"
    run = f"duration: 1 ms, print_step: 0.1 ms, step: {0.05 if solver == 'lattice' else 0.005} ms"
    text = approaching_text("[5, 6]", "[6, 5]", more, run)
    assert "velocity: [0 m/s, 0 m/s, -1 m/s]" in text
    text = text.replace("velocity: [0 m/s, 0 m/s, -1 m/s]", "velocity: [1 m/s, 0 m/s, -1 m/s]")
    linear, angular = momenta(solved(text, solver))
    assert np.abs(linear - linear[0]).max() < 1e-12
    # of 10 N mm ms; Exudyn's rule keeps it to the square of its step
    assert np.abs(angular - angular[0]).max() < (1e-6 if solver == "lattice" else 1e-4)


@pytest.mark.parametrize("place", ["[20 mm, 0 mm, 0.4 mm]", "[21 mm, 17 mm, 0.4 mm]"])
def test_it_does_not_matter_which_of_two_sheets_carries_the_air(place) -> None:
    """Over a part of each other, one of them turned."""
    losses = []
    for low, top in (("[10, 10]", "[5, 5]"), ("[5, 5]", "[10, 10]"), ("[8, 9]", "[9, 9]")):
        result = approaching(low, top, f"turn: 20 deg, center: {place}")
        losses.append(result.energy.dissipated)
    assert losses[1] == pytest.approx(losses[0], rel=2e-2)
    assert losses[2] == pytest.approx(losses[0], rel=2e-2)


def landing(air: str) -> Result:
    """A note that falls 0.4 mm onto another, one side first, which lies on a table."""
    size = "size: [67 mm, 127 mm], mass: 0.72 g, boxes: [5, 8]"
    sheets = [
        ("low", f"{size}, center: [0 mm, 0 mm, 0.05 mm]"),
        ("top", f"{size}, center: [0 mm, 0 mm, 0.55 mm], rotation: [0 deg, 0.4 deg, 0 deg]"),
    ]
    contacts = [f"between: [low, top], restitution: 0.8, {air}", "between: [low, table], restitution: 0.5"]
    run = "duration: 40 ms, print_step: 0.2 ms, step: 0.1 ms"
    return solved(scene(sheets, contacts, run, parts=TABLE))


def test_a_note_that_lands_on_another_does_not_clap() -> None:
    speeds = []
    for result in (landing("air: {viscosity: 18.2 uPa*s}"), landing("smoothing: 1 mm/s")):
        top = result.model.sheets[1]
        v = result.velocity[:, top.first : top.first + top.count, 2]
        speeds.append(v[result.time > 15.0].max())
    # no box goes up any more; without air some do, at a part of the 80 mm/s of the fall
    assert speeds[1] > 5e-3
    assert speeds[0] < 1e-3


def test_a_note_with_air_over_all_of_its_table_needs_no_finer_step() -> None:
    """What 0.1 mm of air stops in 7 us is right at steps of 0.2 ms."""
    size = "size: [67 mm, 127 mm], mass: 0.72 g, boxes: [5, 8], center: [0 mm, 0 mm, 0.15 mm]"
    ends = []
    for step in (0.2, 0.02):
        run = f"duration: 20 ms, print_step: 1 ms, step: {step} ms"
        contact = "between: [note, table], air: {viscosity: 18.2 uPa*s, roughness: 5 um}"
        fall = f"{size}, velocity: [0 m/s, 0 m/s, -0.1 m/s]"
        result = solved(scene([("note", fall)], [contact], run, parts=TABLE))
        assert result.energy.balance_error < 1e-3
        ends.append((heights(result, 0) - 0.05, result.velocity[:, 0, 2]))
    (coarse, slow), (fine, _) = ends
    # the first step stops it: 20 mm/s us of a fall of 0.1 mm
    assert coarse[5:] == pytest.approx(fine[5:], rel=5e-3)
    assert np.abs(slow[5:]).max() < 1e-3


def test_the_solvers_agree_on_a_note_that_lands() -> None:
    """samples/landing.yaml: what is solved for with the velocities, and what has coordinates of its own."""
    model = lower(load(samples() / "landing.yaml", ("run.step=0.05 ms",)))
    ours, theirs = (mdlgen.solve(model, solver) for solver in ("lattice", "exudyn"))
    assert as_asked(ours) and as_asked(theirs)
    fall = ours.position[0] - ours.position[-1]
    assert fall[:, 2].max() > 0.4
    assert theirs.position[-1] == pytest.approx(ours.position[-1], abs=1e-4)
    assert theirs.energy.dissipated == pytest.approx(ours.energy.dissipated, rel=2e-3)
    assert theirs.energy.balance_error < 1e-4


def test_the_solvers_agree_on_a_pile_that_is_fed() -> None:
    """Three notes, of which a roller takes the upper one along: contacts, friction and two films at once."""
    sets = (
        *("piles.cassette.count=3", "rollers.pick.center=[0 mm, 0 mm, 12.7 mm]", "require=[]"),
        *("contacts.pick.between=[cassette_3, pick]", "probes.lead.sheet=cassette_3"),
        *("run.duration=4 ms", "run.step=0.0125 ms", "piles.cassette.contact.air={viscosity: 18.2 uPa*s}"),
    )
    model = lower(load(samples() / "pile.yaml", sets))
    assert (model.contacts.air_viscosity > 0.0).sum() == 2
    ours, theirs = (mdlgen.solve(model, solver) for solver in ("lattice", "exudyn"))
    assert as_asked(ours) and as_asked(theirs)
    boxes = sum(sheet.count for sheet in model.sheets)
    ways = (result.position[-1, :boxes] - result.position[0, :boxes] for result in (ours, theirs))
    first, second = ways
    assert first[-12:, 0].min() > 0.1  # of the upper note
    assert second == pytest.approx(first, abs=1e-3)


def test_what_has_no_air_is_said_in_one_line() -> None:
    roller = "rollers: {r: {center: [0 mm, 0 mm, 20 mm], axis: y, radius: 5 mm, width: 5 mm, mass: 1 g}}"
    sheet = "size: [30 mm, 30 mm], mass: 0.7 g, boxes: [2, 2], center: [0 mm, 0 mm, 0.15 mm]"

    def one(contact: str, parts: str = TABLE) -> str:
        return scene([("note", sheet)], [contact], "duration: 1 ms", parts=parts)

    with pytest.raises(SpecError, match=r"contacts\.0\.air: air between note and r is not modelled"):
        loads(one(f"between: [note, r], {AIR}", roller))
    press = "mass: 1 g, press: {direction: z, stiffness: 1 N/mm, preload: 1 N}"
    pressed = TABLE.replace("size:", f"{press}, size:")
    with pytest.raises(SpecError, match="a sheet and a fixed plane"):
        loads(one(f"between: [note, table], {AIR}", pressed))
    with pytest.raises(SpecError, match="more than 0"):
        loads(one("between: [note, table], air: {viscosity: 0 Pa*s}"))
    model = lower(loads(one(f"between: [note, table], {AIR}")))
    assert model.contacts.air_viscosity.tolist() == [pytest.approx(VISCOSITY, rel=1e-12)]
    for output in ("motionview", "motionsolve", "msolve"):
        with pytest.raises(RefusedError, match=r"note and table has air"):
            mdlgen.emit(model, output)
    assert math.isclose(float(model.contacts.air_roughness[0]), 1e-5)


def found(*sets: str) -> list[tuple[str, str]]:
    """Lints of samples/landing.yaml."""
    return [(lint.code, lint.where) for lint in lints(lower(load(samples() / "landing.yaml", sets)))]


def test_a_viscosity_that_no_gas_has_and_air_where_nothing_moves() -> None:
    assert found() == []
    assert found("contacts.landing.air.viscosity=18.2 Pa*s") == [("W136", "contacts.landing.air.viscosity")]
    # helium and neon are no findings, nor is steam
    for gas in (19.9, 31.7, 12.3):
        assert found(f"contacts.landing.air.viscosity={gas} uPa*s") == []
    assert ("W137", "contacts.landing.air") in found("run.analysis=static")
