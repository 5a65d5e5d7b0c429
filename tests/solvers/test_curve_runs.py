"""Runs of sheets that follow measured curves: the closed form on any grid, both solvers, honest ends."""

from __future__ import annotations

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.cli import main
from mdlgen.model import curves
from mdlgen.paths import samples
from mdlgen.results.compare import compare
from mdlgen.results.result import Result
from mdlgen.spec.load import load

SOLVERS = pytest.mark.parametrize("solver", ["lattice", "exudyn"])
TENSION = samples() / "verify" / "tension.yaml"
# a blow on the end of the free strip's other side: it swings along x, far into the curve
SWING = (
    "loads=[]",
    "sheets.strip.boxes=[6,1]",
    "run={duration: 2 ms, step: 0.5 us, print_step: 20 us}",
    "sheets.strip.velocity=[12 m/s, 0 m/s, 0 m/s]",
    "materials.elastic.damping={ratio: 0}",
)


def run(solver: str, *overrides: str) -> Result:
    return mdlgen.solve(mdlgen.lower(load(TENSION, overrides)), solver)


def strain(solver: str, *overrides: str) -> float:
    result = run(solver, *overrides)
    assert as_asked(result), result.status
    return result.summary()["strain"]


@SOLVERS
@pytest.mark.parametrize("layout", ["edge_to_edge", "center_to_center"])
@pytest.mark.parametrize(("stress", "exact"), [(30, 0.031573804), (10, 0.010050765)])
def test_any_grid_gives_the_curve_itself(solver: str, layout: str, stress: float, exact: float) -> None:
    """1e-4 is the table's pitch (its cubics are better than 1e-6); grids are equal to 1e-9."""
    grids = ("[1,1]", "[5,1]", "[20,1]", "[7,3]")
    found = [
        strain(
            solver,
            f"sheets.strip.boxes={n}",
            f"sheets.strip.layout={layout}",
            f"loads.0.stress={stress} MPa",
        )
        for n in grids
    ]
    assert found == pytest.approx([exact] * len(grids), rel=1e-4)
    assert found == pytest.approx([exact] * len(grids), rel=1e-6)
    assert max(found) - min(found) < 1e-9 * exact


def test_what_is_left_to_the_end_of_the_curve() -> None:
    found = run("lattice", "sheets.strip.boxes=[5,1]").summary()["sheets"]["strip"]["strain"]
    assert found["margin"] == pytest.approx(1 - 0.031573804 / 0.05, rel=1e-5)
    assert found["max_md"] == pytest.approx(0.031573804, rel=1e-5)


@SOLVERS
@pytest.mark.parametrize("stress", [0.1999, 0.3999968, 13.47, 24.999, -10.0])
def test_on_and_between_points_and_in_compression(solver: str, stress: float) -> None:
    """The strain at which the interpolated table has the stress; 1e-8 of the load may be left. Pushed, the
    strip is held from buckling by its own stiffness, 1e4 times that of the sample."""
    stiff = (
        "materials.elastic.D_md=1e6 N*mm",
        "materials.elastic.D_cd=1e6 N*mm",
        "materials.elastic.k_tz=1e5 N*m/rad",
    )
    sets = ("sheets.strip.boxes=[1,1]", f"loads.0.stress={stress!r} MPa", *(stiff if stress < 0.0 else ()))
    made = mdlgen.lower(load(TENSION, sets))
    found = strain(solver, *sets)
    assert curves.stress(made.curves, 0, np.array([found]))[0] == pytest.approx(stress, rel=1e-8)
    assert np.sign(found) == np.sign(stress)


@SOLVERS
def test_a_strip_that_is_pushed_beyond_eulers_load_is_unstable(solver: str) -> None:
    """One box on a hinge of 2 D W/L or so: it stands up to 0.03 N, and has 100 N."""
    result = run(solver, "sheets.strip.boxes=[1,1]", "loads.0.stress=-10 MPa")
    assert not as_asked(result) and "the balance is unstable: it falls in" in result.status


@SOLVERS
def test_beyond_the_last_point_a_run_is_refused(solver: str) -> None:
    result = run(solver, "loads.0.stress=45 MPa")
    assert not as_asked(result)
    assert "joint strip_" in result.status and "at rest" in result.status
    assert "beyond the last point of its curve strip_md (0.05)" in result.status
    message = float(result.status.split("a strain of ")[1].split()[0])
    assert message > 0.05


def test_the_command_ends_with_exit_code_4(tmp_path, capsys, monkeypatch) -> None:
    for solver in ("lattice", "exudyn"):
        args = [
            "run",
            str(TENSION),
            "--set",
            "loads.0.stress=45 MPa",
            "--solver",
            solver,
            "-o",
            str(tmp_path),
        ]
        monkeypatch.setattr("sys.argv", ["mdlgen", *args])
        with pytest.raises(SystemExit) as ended:
            main()
        assert ended.value.code == 4
        assert "beyond the last point" in capsys.readouterr().err


@SOLVERS
def test_beyond_the_last_point_it_goes_on_straight_by_choice(solver: str) -> None:
    points = "[[0, 0 MPa], [1 %, 8 MPa], [2 %, 12 MPa]]"
    bent = f"materials.elastic.curve_md={{points: {points}, extrapolate: linear}}"
    found = strain(solver, bent, "loads.0.stress=20 MPa")
    # the parabola through the last three points has this slope at the last one
    slope = 1.5 * 400 - 0.5 * 800
    assert found == pytest.approx(0.02 + 8 / slope, rel=1e-7)


@SOLVERS
def test_along_y_the_other_curve_counts(solver: str) -> None:
    crosswise = (
        "sheets.strip.size=[10 mm, 100 mm]",
        "sheets.strip.clamp={edge: y_min, length: 0 mm}",
        "loads=[{sheet: strip, edge: y_max, stress: 10 MPa}]",
        "probes={}",
        "materials.elastic.curve_cd=[[0, 0 MPa], [1 %, 8 MPa], [2 %, 12 MPa]]",
    )
    made = mdlgen.lower(load(TENSION, (*crosswise, "sheets.strip.boxes=[1,7]")))
    for boxes in ("[1,7]", "[3,4]"):
        found = strain(solver, *crosswise, f"sheets.strip.boxes={boxes}")
        number = made.curves.name.index("strip_cd")
        assert curves.stress(made.curves, number, np.array([found]))[0] == pytest.approx(10, rel=1e-8)


def test_both_solvers_swing_alike_and_keep_the_energy() -> None:
    """Without damping; each box within 1e-3 of the stretch, energies to a part of what passes through."""
    fast, slow = run("lattice", *SWING), run("exudyn", *SWING)
    assert as_asked(fast) and as_asked(slow), (fast.status, slow.status)
    stretched = np.abs(fast.position - fast.position[0]).max()
    assert stretched > 0.01 * 100  # the curve is bent there by 1.5 %, which 1e-3 would show
    assert compare(slow, fast).position_max_mm < 1e-3 * stretched
    assert abs(fast.energy.balance_error) < 1e-4
    linear = run("lattice", *SWING, "materials.elastic.E_md=1000 MPa")
    assert compare(linear, fast).position_max_mm > 1e-2 * stretched


@SOLVERS
def test_a_run_ends_where_a_joint_goes_beyond_its_curve(solver: str) -> None:
    result = run(solver, *SWING, "sheets.strip.velocity=[60 m/s, 0 m/s, 0 m/s]")
    assert not as_asked(result)
    assert "joint strip_c_0_0_" in result.status and " ms, beyond the last point" in result.status
    at = float(result.status.split(" ms, beyond")[0].split()[-1])
    assert 0.0 < at < 2.0


def test_joints_with_curves_are_not_folded() -> None:
    from mdlgen.backends.lattice.arrays import build

    bent = mdlgen.lower(load(TENSION, ["sheets.strip.boxes=[4,3]"]))
    system = build(bent)
    assert (system.joints["first"] >= 0).sum() == (bent.curves.of >= 0).sum() == 2 * 3 * 4
    assert system.folded == 4 * 2
    assert np.array_equal(
        system.joints["row"][system.joints["first"] >= 0], np.flatnonzero(bent.curves.of >= 0)
    )
