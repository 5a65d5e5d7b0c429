"""Friction that sticks on what is no sheet, in Exudyn: as lattice has it (test_bristles), by another rule."""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import as_asked
from scipy.interpolate import CubicSpline
from test_bristles import G, hollow, middle, rolling, slip_of, slope, stopped_nip

import mdlgen
from mdlgen.errors import RefusedError
from mdlgen.model.lower import lower
from mdlgen.model.rotations import turns
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

LIMIT = 2 * 0.35 * 1.2  # that both sides of a nip hold [N]


def solved(text: str, *sets: str, solver: str = "exudyn") -> Result:
    result = mdlgen.solve(lower(loads(text, overrides=list(sets))), solver)
    assert as_asked(result), result.status
    assert abs(result.energy.balance_error) < 5e-3
    return result


def apart(text: str) -> float:
    """The greatest distance of the middles of a sheet by both solvers, at equal times [mm]."""
    one, two = solved(text, solver="lattice"), solved(text)
    # Exudyn's outputs are off by up to a step where it has divided steps
    return float(np.abs(middle(one) - CubicSpline(two.time, middle(two))(one.time)).max())


def test_a_card_hangs_in_a_nip_that_stands() -> None:
    """At 60 % of the limit it does not even move at 1e-3 mm/s."""
    result = solved(stopped_nip(0.6 * LIMIT / G, run="duration: 200 ms, step: 0.2 ms"))
    late = result.time >= 150.0
    assert np.abs(result.velocity[late, :24, 2].mean(axis=1)).max() < 1e-6
    z = middle(result)[:, 2]
    held = 0.6 * LIMIT / (2 * 30.0)
    assert held < z[0] - z[-1] < 1.6 * held


def test_above_the_limit_a_card_slides_out_of_the_nip() -> None:
    """At 115 % of the limit with (W - 2 mu N)/m."""
    mass = 1.15 * LIMIT / G
    result = solved(stopped_nip(mass, run="duration: 60 ms, step: 0.1 ms"))
    v, late = result.velocity[:, :24, 2].mean(axis=1), result.time >= 30.0
    faster = G - 0.35 * result.contact_force[late].sum(axis=1).mean() / mass
    assert -np.polyfit(result.time[late], v[late], 1)[0] == pytest.approx(faster, rel=5e-3)


def test_a_block_stays_on_a_slope_where_lattice_has_it() -> None:
    text = slope(5.0, 0.35, "duration: 300 ms, step: 0.5 ms")
    x = middle(solved(text))[:, 0]
    assert np.ptp(x[-20:]) < 1e-12
    assert x[-1] == pytest.approx(middle(solved(text, solver="lattice"))[-1, 0], rel=1e-5)


def test_a_block_that_is_turned_about_the_normal_turns_back() -> None:
    """k_t at four corners resists by k_t r^2, r^2 = 15^2 + 10^2."""
    couple = "loads: [{sheet: n, edge: x_max, moment: [0 N*mm, 0 N*mm, 0.4 N*mm]}]\n"
    angle = turns(solved(slope(0.0, 0.35) + couple).rotation[:, :1])[:, 0, 1, 0]
    assert angle[-1] == pytest.approx(0.4 / (40.0 * 325.0), rel=1e-3)


def test_a_nip_creeps_by_its_traction_as_carter_has_it() -> None:
    """xi = 2 mu N/(k_t a) (1 - sqrt(1 - F/(mu N))), whatever boxes pass."""
    force = 0.3
    text = rolling(force, "duration: 60 ms, step: 0.1 ms")
    slip, nip = slip_of(solved(text, "sheets.n.boxes=[20, 2]"))
    half = math.sqrt(2.0 * 8.0 * (nip / 300.0) ** (2.0 / 3.0))
    exact = 2.0 * 0.4 * nip / (40.0 * half) * (1.0 - math.sqrt(1.0 - force / (0.4 * nip)))
    assert slip == pytest.approx(exact, rel=5e-3)


def test_both_solvers_let_a_card_into_a_nip_alike() -> None:
    """It slides, is held, and swings by 9 um. Both damp its spring by their step, in the first order."""
    coarse, fine = (
        apart(stopped_nip(0.6 * LIMIT / G, run=f"duration: 10 ms, print_step: 0.5 ms, step: {step} ms"))
        for step in (0.05, 0.0125)
    )
    assert fine < 0.4e-3
    assert fine < 0.4 * coarse


@pytest.mark.parametrize(("lean", "time", "by"), [(10.0, 30.0, 3e-3), (30.0, 40.0, 0.02)])
def test_a_strip_that_falls_into_a_hollow_guide_does_as_in_lattice(
    lean: float, time: float, by: float
) -> None:
    """A step in which a box touches slides by many limits; at 10 deg it stays, at 30 deg it slides 1.2 mm."""
    run = f"duration: {time} ms, step: 0.1 ms, print_step: 0.5 ms"
    assert apart(hollow(lean, run)) < by


def test_both_solvers_start_and_stop_a_note_alike() -> None:
    """It goes 7.6 mm."""
    profile = "profile: [[0 ms, 0 rad/s], [10 ms, 60 rad/s], [16 ms, 60 rad/s], [26 ms, 0 rad/s]]"

    def at(step: float) -> float:
        text = rolling(0.1, f"duration: 40 ms, print_step: 0.5 ms, step: {step} ms")
        text = text.replace("speed: 125 rad/s, ramp: 20 ms", profile).replace(
            "boxes: [40, 2]", "boxes: [10, 1]"
        )
        return apart(text)

    coarse, fine = at(0.2), at(0.05)
    assert fine < 2e-3
    assert fine < 0.6 * coarse


def test_two_sheets_that_stick_are_refused_by_name() -> None:
    """Alone: the contact before theirs sticks, too."""
    sheet = "{material: solid, size: [30 mm, 20 mm], thickness: 1 mm, mass: 1 g, boxes: [1, 1]}"
    friction = "{static: 0.3, dynamic: 0.3, sticking: 9 N/mm}"
    contact = f"{{between: [n, o], stiffness: 9 N/mm^1.5, restitution: 0.3, friction: {friction}}}"
    text = (
        slope(5.0, 0.35).replace("planes:", f"  o: {sheet}\nplanes:").replace("run:", f"  - {contact}\nrun:")
    )
    with pytest.raises(RefusedError, match="contact of n and o has friction that sticks"):
        mdlgen.solve(lower(loads(text)), "exudyn")
