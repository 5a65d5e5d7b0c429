"""A value of a material from a measured drop or decay."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from called import Ended, Run, runner
from synthetic import moving

import mdlgen
from mdlgen import registry
from mdlgen.backend import Backend
from mdlgen.calibrate.calibration import calibrate
from mdlgen.calibrate.measured import Decay, read_measured
from mdlgen.calibrate.report import fragment, quantity, report_text
from mdlgen.calibrate.search import MAX_RUNS
from mdlgen.calibrate.value import FITS, Fit
from mdlgen.cli import shell
from mdlgen.errors import SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.result import Result

CANTILEVER = samples() / "cantilever.yaml"
CENTRAL = ["sheets.note.layout=center_to_center"]
NARROW = ["sheets.note.boxes=[1,20]"]
# A strip of 27 ms period, which a run of 80 ms sees swing three times.
SMALL = [
    "sheets.note.size=[10 mm, 30 mm]",
    "sheets.note.mass=0.0254 g",
    "sheets.note.boxes=[1,6]",
    "materials.eur10.D_cd=0.3 N*mm",
    "run.analysis=transient",
    "run.duration=80 ms",
    "run.tolerance=1e-4",  # the drop is a fiftieth of the length, to which it is relative
]


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs `mdlgen calibrate samples/cantilever.yaml` in an empty folder."""
    mdl = runner(capsys, tmp_path, monkeypatch)

    def run(*args: object, sets: list[str] = NARROW) -> Ended:
        options = [part for text in sets for part in ("--set", text)]
        return mdl("calibrate", CANTILEVER, *args, *options)

    return run


def drop_of(*sets: str) -> float:
    result = mdlgen.solve(mdlgen.lower(mdlgen.load(CANTILEVER, sets)))
    assert result.ok
    return -float(result.anchor_motion(0)[0][-1, 2])


def decay(*sets: str) -> Decay:
    """The strip's own drop at 40 times, by a run of it that is finer than those of the search."""
    result = mdlgen.solve(mdlgen.lower(mdlgen.load(CANTILEVER, [*SMALL, "run.tolerance=1e-5", *sets])))
    assert result.ok
    chosen = np.linspace(0, len(result.time) - 1, 40).round().astype(int)
    return Decay(result.time[chosen], -result.anchor_motion(0)[0][chosen, 2])


# ---------------------------------------------------------------- one drop


def test_bending_stiffness_of_the_paper_s_drop_at_full_length(cli: Run) -> None:
    ended = cli("--measured", "60.76 mm", "--fit", "D_cd", "--json", sets=[])
    # the first run of all has a line on compiling
    assert ended.code == 0 and ended.err.replace(f"{shell.COMPILING}\n", "") == ""
    record = json.loads(ended.out)
    # the heavy elastica (oracles.md); 20 boxes along the length give 0.3 % more
    assert record["value"] == pytest.approx(0.3591718857, rel=0.01)
    assert abs(record["residual_mm"]) < 1e-3
    assert record["runs"] <= MAX_RUNS
    assert (record["probe"], record["sheet"], record["unit"]) == ("tip", "note", "N*mm")
    assert record["free_length_mm"] == pytest.approx(127, abs=1e-9)


@pytest.mark.parametrize(
    ("options", "k_tx"),
    [
        # two of 20 rows in the clamp
        (["sheets.note.clamp.length=12.7 mm"], 0.234),
        # two rows of the paper's grid, whose outline is 133.7 mm: with the mass of Eq. 2 ...
        (["sheets.note.grid=paper", f"sheets.note.clamp.length={254 / 19!r} mm"], 0.269),
        # ... and with the note's mass per area on all of it
        (
            [
                "sheets.note.grid=paper",
                f"sheets.note.clamp.length={254 / 19!r} mm",
                f"sheets.note.mass={0.72 * 200 / 171!r} g",
            ],
            0.313,
        ),
    ],
)
def test_hinge_stiffness_with_two_rows_clamped(options: list[str], k_tx: float) -> None:
    found = calibrate(mdlgen.load(CANTILEVER, CENTRAL + options), 60.76, "k_tx")
    assert found.ok and found.runs <= MAX_RUNS
    # computed by others to three digits, with another chain
    assert found.value == pytest.approx(k_tx, rel=0.02)


@pytest.mark.parametrize("drop", [0.5, 5.0, 30.0, 76.0, 100.0, 115.0, 124.0])
def test_every_drop_is_found_in_fifteen_runs(drop: float) -> None:
    found = calibrate(mdlgen.load(CANTILEVER, NARROW), drop, "D_cd")
    assert found.ok and found.runs <= MAX_RUNS
    # the value is sought to 1e-6 of itself, and a drop changes at most as that
    assert found.drop[0] == pytest.approx(drop, rel=1e-5)
    assert drop_of(*NARROW, f"materials.eur10.D_cd={found.value!r} N*mm") == pytest.approx(drop, rel=1e-5)


def test_the_sensitivity_is_the_slope_of_the_drop() -> None:
    found = calibrate(mdlgen.load(CANTILEVER, NARROW), 60.76, "D_cd")
    more, less = (drop_of(*NARROW, f"materials.eur10.D_cd={f * found.value!r} N*mm") for f in (1.01, 0.99))
    # a one-sided difference over 2 %, against a central one over 2 %: half of 2 % of the curvature
    assert found.sensitivity[0] == pytest.approx((more - less) / 0.02, rel=0.02)


def test_each_way_of_bending_has_its_values() -> None:
    across = ["sheets.note.boxes=[20,1]", "sheets.note.clamp.edge=x_min", "probes.tip.edge=x_max"]
    start = drop_of(*across)
    # the other form of the same bending gives way, as with --set
    stiffness = calibrate(
        mdlgen.load(CANTILEVER, [*across, "materials.eur10.k_ty=9 N*mm/rad"]), start, "D_md"
    )
    assert stiffness.value == pytest.approx(0.40, rel=1e-4)
    hinge = calibrate(mdlgen.load(CANTILEVER, [*across, "materials.eur10.D_md=1 N*mm"]), start, "k_ty")
    # e2e has two bushings in a pair: k_ty = D_md d_y / d_x / 2 (docs/theory/sheet.md)
    assert hinge.value == pytest.approx(0.40 * 127 / (67 / 20) / 2, rel=1e-4)


def test_the_reference_solver_finds_the_same() -> None:
    scene = mdlgen.load(CANTILEVER, ["sheets.note.boxes=[1,6]"])
    fast, slow = (calibrate(scene, 60.76, "k_tx", solver=name) for name in ("lattice", "exudyn"))
    assert slow.solver == "exudyn"
    # statics of both agree to 1e-7 of the length; the search ends at 1e-6
    assert slow.value == pytest.approx(fast.value, rel=1e-5)


# ---------------------------------------------------------------- a curve


@pytest.mark.parametrize("ratio", [0.02, 0.3])
def test_damping_is_found_from_a_decay(ratio: float) -> None:
    measured = decay(f"materials.eur10.damping.ratio={ratio}")
    found = calibrate(mdlgen.load(CANTILEVER, SMALL), measured, "damping.ratio")
    assert found.ok and found.runs <= MAX_RUNS
    # what the steps damp by themselves is reported: the measured curve has a tenth of it, the rest is linear
    assert found.step_error is not None and abs(found.step_error) < 0.05
    assert found.value / ratio - 1 == pytest.approx(found.step_error, rel=0.25, abs=1e-3)
    assert found.residual < 1e-3 * measured.drop.max()


@pytest.mark.parametrize(
    ("fit", "truth", "begin"),
    [
        ("damping.time", 0.2, "{ratio: 0.12}"),
        ("damping.time", 0.031, "{time: [0.1 ms, 0.2 ms]}"),
        ("damping.loss_factor", 0.06, "{loss_factor: 0.2, at: 37 Hz}"),
    ],
)
def test_the_damping_of_the_paper_is_found(fit: str, truth: float, begin: str) -> None:
    """To 1 %, from the decay of a chain of rigid links with c = tau k, integrated to 1e-9 (oracles.chain)."""
    from mdlgen.bench.oracles.chain import chain_of, swing

    tau = truth if fit == "damping.time" else truth / (2 * np.pi * 37e-3)
    chain = chain_of(
        mdlgen.lower(mdlgen.load(CANTILEVER, [*SMALL, f"materials.eur10.damping={{time: {tau} ms}}"]))
    )
    times = np.linspace(2.0, 80.0, 40)
    slope = swing(chain, np.concatenate([[0.0], times]))[1:]
    measured = Decay(times, chain.length * np.sin(slope).sum(axis=1))
    found = calibrate(mdlgen.load(CANTILEVER, [*SMALL, f"materials.eur10.damping={begin}"]), measured, fit)
    assert found.ok and found.runs <= MAX_RUNS, found.status
    assert found.value == pytest.approx(truth, rel=0.01)
    assert found.numerical is not None and found.numerical < 0.01
    assert found.step_error is not None and abs(found.step_error) < 0.01


def test_the_report_says_how_much_of_the_damping_is_numerical() -> None:
    """A ratio is found too small by what the steps damp beside it."""
    measured = decay("materials.eur10.damping.ratio=0.02")  # made at a tenth of the steps' damping
    found = calibrate(mdlgen.load(CANTILEVER, SMALL), measured, "damping.ratio")
    assert found.numerical is not None and 1e-3 < found.numerical < 0.05
    assert found.value / 0.02 - 1 == pytest.approx(-found.numerical, rel=0.3, abs=2e-3)


def test_a_loss_factor_needs_its_frequency() -> None:
    with pytest.raises(SpecError, match="a loss factor belongs to a frequency"):
        calibrate(mdlgen.load(CANTILEVER, SMALL), decay(), "damping.loss_factor")


def test_damping_is_found_under_noise() -> None:
    clean = decay("materials.eur10.damping.ratio=0.05")
    noise = 0.02 * clean.drop.max() * np.random.default_rng(1).standard_normal(len(clean.drop))
    found = calibrate(mdlgen.load(CANTILEVER, SMALL), Decay(clean.time, clean.drop + noise), "damping.ratio")
    assert found.ok
    assert found.residual == pytest.approx(0.02 * clean.drop.max(), rel=0.2)
    # what the sensitivity says of 40 points of this noise, three times over
    slope = np.sqrt(np.mean(found.sensitivity**2))
    assert abs(np.log(found.value / 0.05)) < 3 * found.residual / slope / np.sqrt(40)


def test_stiffness_is_found_from_a_swing() -> None:
    found = calibrate(mdlgen.load(CANTILEVER, [*SMALL, "materials.eur10.D_cd=0.24 N*mm"]), decay(), "D_cd")
    assert found.ok and found.runs <= MAX_RUNS
    assert found.value == pytest.approx(0.3, rel=1e-3)


def test_a_value_that_the_spec_refuses_is_not_found(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = mdlgen.load(CANTILEVER, [*SMALL, "materials.eur10.damping.ratio=4"])
    measured = decay("materials.eur10.damping.ratio=9")
    assert calibrate(scene, measured, "damping.ratio").value == pytest.approx(9, rel=1e-3)
    monkeypatch.setitem(FITS, "damping.ratio", Fit("", greatest=8.0))
    assert "more damping.ratio than 8" in calibrate(scene, measured, "damping.ratio").status


@pytest.mark.parametrize(("fit", "times"), [("damping.ratio", 10.0), ("D_cd", 10.0)])
def test_a_curve_that_is_not_met_is_a_failure(fit: str, times: float) -> None:
    measured = decay()
    found = calibrate(mdlgen.load(CANTILEVER, SMALL), Decay(measured.time, times * measured.drop), fit)
    assert not found.ok and np.isnan(found.value) and "start nearer" in found.status


def test_a_curve_is_read_from_a_file(cli: Run, tmp_path: Path) -> None:
    curve = decay("materials.eur10.damping.ratio=0.05")
    rows = [f"{i};{d / 1e3};{t / 1e3}" for i, (t, d) in enumerate(zip(curve.time, curve.drop, strict=True))]
    (tmp_path / "decay.csv").write_text("# by hand\nno;Drop [m];time (s)\n" + "\n".join(rows) + "\n")
    ended = cli("--measured", "decay.csv", "--fit", "damping.ratio", "-o", "found.yaml", sets=SMALL)
    assert ended.code == 0
    record = json.loads(cli("--measured", "decay.csv", "--fit", "damping.ratio", "--json", sets=SMALL).out)
    assert record["value"] == pytest.approx(0.05, rel=0.02) and record["points"] == 40
    text = (tmp_path / "found.yaml").read_text()
    assert f"    damping:\n      ratio: {record['value']:.6g}\n" in text
    assert 0.0 < record["numerical_damping"] < 0.05


@pytest.mark.parametrize(
    ("header", "time", "drop"),
    [
        ("time_ms,drop_mm", 1.0, 1.0),
        ("time,drop", 1.0, 1.0),
        ("TIME [s], Drop [cm]", 1e3, 10.0),
        ("time us,drop um", 1e-3, 1e-3),
    ],
)
def test_units_stand_in_the_header(tmp_path: Path, header: str, time: float, drop: float) -> None:
    (tmp_path / "a.csv").write_text(f"{header}\n0,1\n1,3\n2,2\n")
    found = read_measured(str(tmp_path / "a.csv"))
    assert isinstance(found, Decay)
    np.testing.assert_allclose(found.time, [0, time, 2 * time], rtol=1e-14)
    np.testing.assert_allclose(found.drop, [drop, 3 * drop, 2 * drop], rtol=1e-14)


# ---------------------------------------------------------------- files


def test_the_fragment_is_a_piece_of_a_scene(cli: Run, tmp_path: Path) -> None:
    ended = cli("--measured", "60.76 mm", "--fit", "k_tx", "-o", "found.yaml")
    assert (ended.code, ended.err) == (0, "wrote found.yaml\n")
    text = (tmp_path / "found.yaml").read_text("ascii")
    value = next(line.partition(": ")[2] for line in text.splitlines() if line.startswith("    k_tx"))
    assert "D_cd" in text and f'"{value}"' in ended.out
    # six digits are written
    assert drop_of(*NARROW, f"materials.eur10.k_tx={value}") == pytest.approx(60.76, rel=1e-5)
    assert cli("--measured", "60.76 mm", "--fit", "k_tx", "-o", "-") == (0, text, "")
    assert cli("--measured", "60.76 mm", "--fit", "k_tx", "-q") == (0, f"{value}\n", "")
    assert cli("--measured", "60.76 mm", "--fit", "k_tx", "-q", "-o", "found.yaml") == (0, "", "")


@pytest.mark.parametrize("target", ["missing/found.yaml", "."])
def test_a_bad_place_is_reported(cli: Run, target: str) -> None:
    ended = cli("--measured", "60.76 mm", "--fit", "k_tx", "-o", target)
    assert ended.code == 3 and len(ended.err.splitlines()) == 1


# ---------------------------------------------------------------- what cannot be meant


@pytest.mark.parametrize(
    ("measured", "fit", "sets", "words"),
    [
        ("-3 mm", "k_tx", [], "along gravity"),
        ("0 mm", "k_tx", [], "along gravity"),
        ("127 mm", "k_tx", [], "less than 127 mm"),
        ("115 mm", "k_tx", ["sheets.note.clamp.length=12.7 mm"], "114.3 mm from the clamp line"),
        ("126.99 mm", "k_tx", [], "no k_tx lets the probe drop by 126.99 mm"),
        ("60.76", "k_tx", [], "no unit"),
        ("60.76 N", "k_tx", [], "wrong unit"),
        ("much", "k_tx", [], "not a number"),
        ("60 mm", "E_md", [], "there are: k_tx"),
        ("60 mm", "damping.ratio", [], "needs a curve"),
        ("60 mm", "k_ty", [], "does not depend on k_ty"),
        ("60 mm", "k_tx", ["gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]"], "gravity"),
        ("60 mm", "k_tx", ["run.analysis=transient"], "run.analysis: static"),
        ("60 mm", "k_tx", ["probes={}"], "no probe"),
        ("60 mm", "k_tx", ["probes.other={sheet: note, edge: x_max}"], "give --probe"),
        ("60 mm", "k_tx", ["nonsense=1"], "nonsense"),
    ],
)
def test_what_no_value_gives_is_one_line(
    cli: Run, measured: str, fit: str, sets: list[str], words: str
) -> None:
    ended = cli("--measured", measured, "--fit", fit, "-q", sets=[*NARROW, *sets])
    assert (ended.code, ended.out) == (2, ""), ended.err
    assert words in ended.err and len(ended.err.splitlines()) == 1


def test_a_probe_in_the_clamp_is_refused() -> None:
    sets = ["sheets.note.clamp.length=12.7 mm", "probes.tip={sheet: note, at: [0 mm, -60 mm]}"]
    with pytest.raises(SpecError, match="sits in the clamp"):
        calibrate(mdlgen.load(CANTILEVER, [*NARROW, *sets]), 60.0, "k_tx")


def test_a_probe_is_chosen_by_name() -> None:
    scene = mdlgen.load(CANTILEVER, [*NARROW, "probes.half={sheet: note, at: [0 mm, 0 mm]}"])
    with pytest.raises(SpecError, match=r"63\.5 mm from the clamp line"):
        calibrate(scene, 70.0, "k_tx", probe="half")
    with pytest.raises(SpecError, match="there is no probe 'third'; there are: half, tip"):
        calibrate(scene, 70.0, "k_tx", probe="third")
    assert calibrate(scene, 20.0, "k_tx", probe="half").ok


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "holds no table"),
        ("t,d\n0,1\n", "needs the columns time and drop"),
        ("time,drop [N]\n0,1\n1,1\n2,1\n", "wrong unit"),
        ("time,time,drop\n", "stands twice"),
        ("time,drop\n0,1\n1,2\n", "2 points"),
        ("time,drop\n0,1\n1,2\n1,3\n", "a.csv:4: time must grow"),
        ("time,drop\n-1,1\n1,2\n2,3\n", "a.csv:2: time must grow"),
        ("time,drop\n0,1\n1,nan\n2,1\n", "a.csv:3: 'nan' is not a finite number"),
        ("time,drop\n0,1\n1\n2,1\n", "a.csv:3: has 1 columns"),
        ("time,drop\n0,-1\n1,-2\n2,-1\n", "along gravity"),
        ("time,drop\n0,1\n50,2\n90,1\n", "the run at 80 ms already"),
    ],
)
def test_a_curve_that_cannot_be_meant(cli: Run, tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    ended = cli("--measured", "a.csv", "--fit", "damping.ratio", sets=SMALL)
    assert (ended.code, ended.out) == (2, "")
    assert words in ended.err and len(ended.err.splitlines()) == 1


def test_a_curve_needs_a_run_over_time(cli: Run, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,drop\n0,1\n1,2\n2,1\n")
    ended = cli("--measured", "a.csv", "--fit", "damping.ratio")
    assert ended.code == 2 and "run.analysis=transient" in ended.err
    assert cli("--measured", "none.csv", "--fit", "damping.ratio").code == 3


class Fake:
    """A solver that fails, or that gives the same whatever is asked."""

    def __init__(self, status: str):
        self.status = status

    def check(self, model: Model) -> None: ...

    def solve(self, model: Model, progress: object = None, step: float | None = None) -> Result:
        return moving(model, shift=-3.0).failed(self.status)


def test_a_failed_run_ends_with_its_reason(cli: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "solver", lambda name: Backend(solve=Fake("Newton at box note_1_1").solve))
    ended = cli("--measured", "60 mm", "--fit", "k_tx", "-o", "found.yaml")
    assert (ended.code, ended.out) == (4, "")
    assert "Newton at box note_1_1" in ended.err and len(ended.err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_help_has_an_example(cli: Run) -> None:
    ended = cli("--help", sets=[])
    assert ended.code == 0 and "Example: mdlgen calibrate" in " ".join(ended.out.split())


def test_a_parameter_of_the_scene_is_found() -> None:
    """That the stiffness follows from, as the stiffness itself is."""
    text = CANTILEVER.read_text("utf-8").replace("materials:", "parameters: {stiff: 0.2 N*mm}\nmaterials:", 1)
    scene = mdlgen.loads(text, [*NARROW, "materials.eur10.D_cd=1.5*stiff"])
    own = calibrate(mdlgen.load(CANTILEVER, NARROW), 60.0, "D_cd")
    found = calibrate(scene, 60.0, "parameters.stiff")
    assert found.ok and found.unit == "N*mm"
    assert found.value == pytest.approx(own.value / 1.5, rel=1e-6)
    assert fragment(found).endswith(f"parameters:\n  stiff: {quantity(found)}\n")
    assert f'--set parameters.stiff="{quantity(found)}"' in report_text(found)
    with pytest.raises(SpecError, match="there is no parameter 'stif' in the scene; there are: stiff"):
        calibrate(scene, 60.0, "parameters.stif")
    twice = scene.with_({"parameters.twice": "2*stiff", "materials.eur10.D_cd": "0.75*twice"})
    with pytest.raises(SpecError, match="the parameter twice is a formula; fit what it follows from"):
        calibrate(twice, 60.0, "parameters.twice")
