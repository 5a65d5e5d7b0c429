"""Runs of sheets that yield: closed forms, both solvers, halves, wider bounds, and what yields nowhere."""

from __future__ import annotations

import numpy as np
import pytest
import ran
from same import bits

import mdlgen
from mdlgen.bench.case import BenchCase
from mdlgen.bench.suites.validation import yielding
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.io.store import hdf5
from mdlgen.results.residual import left
from mdlgen.results.result import Result
from mdlgen.results.strain import sheet_joints
from mdlgen.spec.load import load

CASES = {case.name: case for case in yielding.cases(False)}
SHORT = ("run.duration=3 ms", "run.step=0.02 ms", "run.print_step=0.1 ms")


def solved(sample: str, *sets: str, solver: str = "lattice") -> Result:
    return ran.solved(lower(load(samples() / f"{sample}.yaml", sets)), solver)


def case(name: str, solver: str) -> tuple[BenchCase, Result]:
    found = CASES[name]
    return found, solved("cantilever", *found.run.overrides, solver=solver)


@pytest.mark.parametrize(
    ("name", "solver"),
    [*((name, "lattice") for name in CASES), *((name, "exudyn") for name in list(CASES)[1:2])],
)
def test_closed_forms(name: str, solver: str) -> None:
    """Turns of a box that swings on its hinge and its energy, creases. The validation suite has the source of
    each number."""
    found, result = case(name, solver)
    for row in found.measure(result, None):
        assert row.tolerance is not None and row.error <= row.tolerance, (
            row.quantity,
            row.expected,
            row.found,
        )
    if result.plastic is not None:
        assert abs(result.energy.balance_error) < 1e-3
        assert result.energy.dissipated >= (result.energy.plastic or 0.0) > 0.0


@pytest.mark.parametrize(("rows", "share"), [(4, 0.2), (8, 0.2), (16, 0.2), (8, 0.4)])
def test_a_strip_under_a_moment_springs_back_by_the_moment_over_its_stiffness(
    rows: int, share: float
) -> None:
    """Pure bending at 1.5 times the yield moment, to which the strip creeps by its damping: the curvature is
    kappa_y + (m - m_y)/(h D), and (1 - h)(kappa - kappa_y) of it stays."""
    first, stiff, length, times = 0.01, 0.242, 20.0, 1.5  # [1/mm], [N mm], [mm]
    moment = times * stiff * first * 10.0
    result = solved(
        "cantilever",
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        f"materials.eur10.yield={{curvature: {first} 1/mm, hardening: {share}}}",
        "materials.eur10.damping={time: 5 ms}",
        *(
            f"sheets.note.size=[10 mm, {length} mm]",
            "sheets.note.mass=0.017 g",
            f"sheets.note.boxes=[1,{rows}]",
        ),
        f"loads=[{{sheet: note, edge: y_max, moment: [{moment!r} N*mm, 0 N*mm, 0 N*mm]}}]",
        "run={duration: 200 ms, print_step: 2 ms, step: 0.4 ms, tolerance: 0.01}",
    )
    bent = first * (1.0 + (times - 1.0) / share)
    w, x = result.rotation[-1, rows - 1, :2]
    # the strip is still on its way by 0.03 %
    assert 2.0 * np.arctan2(x, w) / (length - length / rows / 2) == pytest.approx(bent, rel=1e-3)
    residual = result.summary()["sheets"]["note"]["residual"]
    assert residual["curvature_per_mm"] == pytest.approx((1.0 - share) * (bent - first), rel=1e-3)
    assert residual["along"] == "cd"
    # the last half box does not bend
    flexible = 1.0 - 0.5 / rows
    assert residual["curl_cd_per_mm"] == pytest.approx(flexible * (1.0 - share) * (bent - first), rel=1e-3)


def test_creases_open_alike_on_all_grids() -> None:
    """With the factor of older scenes they do not."""
    angles = {}
    for key in ("crease: 0.005 N/rad", "stiffness: 0.1"):
        found = []
        for rows in yielding.ROWS:
            sets = [text.replace("crease: 0.005 N/rad", key) for text in yielding.crease_sets(rows)]
            found.append(yielding.opens(solved("cantilever", *sets), None)[0].found)
        angles[key] = np.ptp(found) / np.mean(found)
    assert angles["crease: 0.005 N/rad"] < 1e-6 < 0.1 < angles["stiffness: 0.1"]


@pytest.mark.parametrize("moment", [yielding.MOMENT, 0.0])
def test_exudyn_balances_a_strip_that_starts_flat_with_a_crease(moment: float) -> None:
    """Its iteration diverges where all of the crease's moment comes at once: 8 rows, 20 deg."""
    sets = [text for text in yielding.crease_sets(8) if moment or not text.startswith("loads")]
    result = solved("cantilever", *sets, solver="exudyn")
    assert result.status == "ok"
    n, (w, x) = result.model.sheets[0].count, result.rotation[-1, 7, :2]
    bent = moment * (yielding.LENGTH - yielding.LENGTH / n / 2) / yielding.BENDING
    exact = yielding.FOLD + np.degrees(moment / yielding.CREASE + bent)
    assert np.degrees(2.0 * np.arctan2(x, w)) == pytest.approx(exact, rel=1e-6)


def test_what_does_not_yield_has_the_same_bits_as_without_the_key() -> None:
    high = solved("crease", *SHORT, "materials.eur10.yield.curvature=10 1/mm")
    none = solved("crease", *SHORT, "materials.eur10.yield=null")
    for name in ("position", "rotation", "velocity", "spin", "contact_force"):
        assert np.array_equal(getattr(high, name), getattr(none, name)), name
    assert high.plastic is not None and not high.plastic.any() and high.energy.plastic == 0.0
    assert none.plastic is None and none.energy.plastic is None


def test_one_half_keeps_what_the_whole_keeps() -> None:
    fine = ("sheets.strip.boxes=[10,2]", "run.duration=1 ms", "run.step=0.005 ms", "run.print_step=0.1 ms")
    half, whole = (solved("crease", *fine, f"run.symmetry={on}") for on in ("true", "false"))
    assert half.halved and not whole.halved
    one, two = left(half), left(whole)
    assert one is not None and two is not None
    # steps are halved at other places in the two: at 0.02 ms they differ by 3e-3, five times as much
    assert np.abs(one - two).max() < 1e-3 * np.abs(two).max()
    assert half.energy.plastic == pytest.approx(whole.energy.plastic, rel=2e-3)
    # both sides keep the same, joint by joint
    joints = sheet_joints(half.model)
    order = [np.lexsort((joints.at[:, 0], way * joints.at[:, 1])) for way in (1.0, -1.0)]
    assert np.array_equal(one[:, order[0]], one[:, order[1]])


def test_wider_bounds_keep_the_fold() -> None:
    """The strip leaves the bounds of a narrow margin after it has yielded."""
    wide, narrow = (solved("crease", *SHORT, f"run.margin={margin} mm") for margin in (30, 1))
    assert narrow.model.pairs.margin > 1.0
    assert wide.plastic is not None and narrow.plastic is not None and wide.plastic[-1].any()
    assert np.abs(narrow.plastic - wide.plastic).max() < 1e-9
    assert narrow.energy.plastic == pytest.approx(wide.energy.plastic, rel=1e-9)


def test_both_solvers_fold_alike() -> None:
    sets = ("sheets.strip.boxes=[12,1]", "run.duration=2 ms", "run.tolerance=0.01")
    fast, slow = (solved("crease", *sets, solver=solver) for solver in ("lattice", "exudyn"))
    one, two = left(fast), left(slow)
    assert one is not None and two is not None
    assert one[-1] == pytest.approx(two[-1], abs=0.02 * np.abs(two[-1]).max())
    assert fast.energy.plastic == pytest.approx(slow.energy.plastic, rel=0.02)


def test_a_result_is_read_as_it_was_written(tmp_path) -> None:
    result = solved("crease", *SHORT)
    result.save(tmp_path)
    again = mdlgen.Result.load(tmp_path)
    assert again.plastic is not None and result.plastic is not None
    assert np.array_equal(again.plastic, result.plastic) and again.energy == result.energy
    assert bits(hdf5(again)) == bits(hdf5(result))
    residual = again.summary()["sheets"]["strip"]["residual"]
    assert residual["along"] == "md" and residual["fold"]["at_mm"] == 0.0
    assert residual["strain"] == pytest.approx(0.05 * abs(residual["curvature_per_mm"]), rel=1e-12)
