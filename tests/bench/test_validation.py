"""The validation: its oracles against published digits, its quick rows with both solvers, its page."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from mdlgen import registry
from mdlgen.bench.case import BenchCase
from mdlgen.bench.child import Job, perform
from mdlgen.bench.oracles import belt, loaded, rigid, swing
from mdlgen.bench.page import page
from mdlgen.bench.row import OK, Outcome, rows
from mdlgen.bench.run import Bench
from mdlgen.bench.suites import cases
from mdlgen.bench.suites.validation.bending import BUCKLED, TABLE

SOLVERS = tuple(sorted(registry.SOLVERS))
QUICK = cases("validation", "lattice", SOLVERS, True)


# -- oracles


@pytest.mark.parametrize("load", TABLE)
def test_the_loaded_elastica_is_the_published_table(load: float) -> None:
    """Bisshopp and Drucker (1945), digits of Mattiasson (1981): five of them."""
    end = loaded.end(0.0, load)
    assert (end.z, 1.0 - end.x) == pytest.approx(TABLE[load], abs=6e-6)


@pytest.mark.parametrize(
    ("times", "x", "z"), [(1.015, 0.970, 0.220), (1.518, 0.349, 0.792), (4.029, -0.340, 0.625)]
)
def test_the_buckled_column_is_the_published_table(times: float, x: float, z: float) -> None:
    """Timoshenko and Gere, table 2-4: three digits, and P/P_Euler to four."""
    end = loaded.end(times * math.pi**2 / 4, 1e-7)
    assert (end.x, end.z) == pytest.approx((x, z), abs=4e-3 if times < 1.1 else 1e-3)


@pytest.mark.parametrize("times", BUCKLED)
def test_the_slope_of_the_buckled_column_is_the_published_one(times: float) -> None:
    end = loaded.end(times * math.pi**2 / 4, 1e-7)
    assert math.degrees(end.slope) == pytest.approx(BUCKLED[times], abs=0.1)  # P/P_Euler has four digits


def test_a_column_amplifies_as_the_elastica_does() -> None:
    for part in (0.3, 0.7):
        exact = loaded.end(part * math.pi**2 / 4, 1e-4).z
        assert loaded.column(1e-4, part * math.pi**2 / 4) == pytest.approx(exact, rel=1e-6)


def test_the_pendulum_is_the_benchmark() -> None:
    """IFToMM A01: 1 m, let go level; period 2.367842 s, and the place after 10 s."""
    angle = rigid.pendulum(10.0, 1.0, 9.81)
    assert (math.sin(angle), -math.cos(angle)) == pytest.approx((0.275087463, -0.961419205), abs=1e-9)
    assert rigid.period(1.0, 9.81, math.pi / 2) == pytest.approx(2.367842, abs=1e-6)


def test_a_tumbling_body_keeps_energy_and_angular_momentum() -> None:
    inertia, spin = np.array([2.0, 3.0, 1.0]), np.array([1.0, 0.01, 0.02])
    found = rigid.tumble(inertia, spin, np.linspace(0.0, 60.0, 50))
    assert np.ptp((inertia * found**2).sum(axis=1)) < 1e-10
    assert np.ptp(((inertia * found) ** 2).sum(axis=1)) < 1e-10
    unstable = rigid.tumble(np.array([2.0, 3.0, 1.0]), np.array([1.0, 1e-9, 0.0]), np.array([0.0, 5.0]))
    growth = abs(unstable[-1, 1]) / 1e-9  # cosh(t sqrt((I1 - I2)(I3 - I1)/(I2 I3))) for a spin of 1
    assert growth == pytest.approx(math.cosh(5 * math.sqrt(1.0 / 3.0)), rel=1e-6)


def test_a_fit_finds_rates_and_damping() -> None:
    time = np.linspace(0.0, 30.0, 600)
    values = 0.3 + np.exp(-0.02 * 1.1 * time) * np.cos(1.1 * math.sqrt(1 - 0.02**2) * time + 0.3)
    values += 0.1 * np.exp(-0.05 * 6.0 * time) * np.sin(6.0 * math.sqrt(1 - 0.05**2) * time)
    one, two = swing.fit(time, values, [1.08, 6.1])
    assert (one.rate, one.ratio, two.rate, two.ratio) == pytest.approx((1.1, 0.02, 6.0, 0.05), rel=1e-6)


def test_belts() -> None:
    assert belt.polygon(0.3, math.pi, 10**6) == pytest.approx(2.566332, rel=1e-6)  # e^(mu phi)
    assert belt.creep(0.4, 1.0, 2.0) == pytest.approx(
        2.0 * min(abs(np.roots([-0.5, 0.0, 1.5, -0.4]))), rel=1e-9
    )
    times = np.array([0.0, 30.0, 1e4])
    strain = belt.web(times, 50.0, 0.5, 1e-5, 1.0, 1e9, 0.0)
    assert strain == pytest.approx(1e-5 * (1 - np.exp(-0.5 * times / 50.0)), rel=1e-4, abs=1e-12)


# -- rows


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
def test_a_quick_row(case: BenchCase, solver: str) -> None:
    """Each within what its table allows, for the reason that stands there."""
    found = rows(case, solver, perform(Job(case, solver, registry.SOLVERS[solver], 1, None)))
    assert found
    for row in found:
        assert row.status == OK, f"{row.quantity}: {row.reason}"
        assert row.expected is not None and row.found is not None and row.source and row.because


def test_every_group_has_a_quick_row_and_every_row_its_own_name() -> None:
    made = cases("validation", "lattice", SOLVERS, False)
    assert {case.group for case in QUICK} == {case.group for case in made}
    names = [(case.group, case.name) for case in made]
    assert len(set(names)) == len(names)
    assert {case.name for case in QUICK} <= {case.name for case in made}


def test_the_page_shows_what_is_wrong_and_what_failed() -> None:
    from mdlgen.bench.suites.validation.rows import Basis, against

    (case, *_), basis = QUICK, Basis("Newton", "round-off")
    right = against("speed", 2.0, 2.001, 1e-2, "m/s", basis)
    wrong = against("way", 3.0, 3.3, 1e-2, "mm", basis)
    assert wrong.error == pytest.approx(0.1) and not math.isnan(right.error)
    made = [
        *rows(case, "lattice", Outcome(OK, [right, wrong], estimate=1e-5)),
        *rows(case, "exudyn", Outcome("no | convergence")),
    ]
    text = page("validation", Bench({}, {}, {}, made))
    assert f"## {case.group}" in text
    assert (
        f"| {case.name} | speed | 2 m/s | 2.001 m/s | 0.0005 | 1e-05 | failed | **failed** |  | 0.01 |"
        in text
    )
    assert (
        f"| {case.name} | way | 3 mm | 3.3 mm | **wrong** 0.1 | 1e-05 | failed | **failed** |  | 0.01 |"
        in text
    )
    assert "- speed, way: Newton. Allowed: round-off." in text
    assert "the solver said ok, but the error 0.1 is above 0.01" in text and "no / convergence" in text
    fine = page(
        "validation", Bench({}, {}, {}, rows(replace(case, name="x"), "lattice", Outcome(OK, [right])))
    )
    assert "All rows are right." in fine
