"""The bench: its oracles, its rows and files, and that a wrong, crashed or hung solver is seen."""

from __future__ import annotations

import json
import math
import textwrap
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from mdlgen import registry
from mdlgen.bench import process
from mdlgen.bench.case import BenchCase, Finding, Run
from mdlgen.bench.child import Job
from mdlgen.bench.oracles import chain, elastica, friction, impact
from mdlgen.bench.row import Outcome, rows
from mdlgen.bench.run import bench
from mdlgen.bench.suites.elastica import drop
from mdlgen.cli import app
from mdlgen.errors import SpecError

KEYS = {"suite", "case", "solver", "step_s", "status", "reason", "error", "tolerance", "wall_s"}
STRIP = Run("cantilever", ("sheets.note.boxes=[1,10]",))


@pytest.mark.parametrize(
    ("gamma", "expected"),
    [(0.5, 0.06230577), (3, 0.33964839), (7.026172, 0.602604470), (17.00334, 0.806735962), (20, 0.82988144)],
)
def test_elastica(gamma, expected):
    assert elastica.drop(gamma) == pytest.approx(expected, abs=1e-7)  # Gamma has seven digits


def test_gamma_of_a_scene():
    # D = 2.42e-4 N m, 0.72 g on 67 x 127 mm: whatever the grid
    for boxes in ("[10,20]", "[2,40]"):
        model = Run("cantilever", (f"sheets.note.boxes={boxes}",)).model()
        assert elastica.gamma(model) == pytest.approx(7.026172, rel=1e-6)


def test_chain_is_the_elastica_in_second_order():
    errors = []
    for count in (8, 16, 32):
        model = Run("cantilever", (f"sheets.note.boxes=[2,{count}]",)).model()
        link = chain.chain_of(model)
        down = link.length * np.sin(chain.hang(link)).sum()
        errors.append(down / (0.602604470 * 127) - 1)
    # half-cell hinge at the clamp: 1.20, 0.302, 0.0755 %
    assert errors == pytest.approx([0.0120, 0.00302, 0.000755], rel=5e-3)


def test_chain_swings_at_the_first_mode():
    # 1.855428 Hz for D = 2.42e-4, 10 links 0.46 % below; a strip 1000 times as stiff swings little
    sets = ("materials.eur10.D_cd=242 N*mm", "materials.eur10.damping.ratio=0")
    link = chain.chain_of(replace(STRIP, overrides=(*STRIP.overrides, *sets)).model())
    half_period = 0.5e3 / (1.855428 * math.sqrt(1000) * (1 - 0.0046))
    tip = np.sin(chain.swing(link, np.array([half_period]))).sum()
    # from flat to twice the static drop, but for the higher modes' few percent
    assert tip == pytest.approx(2 * np.sin(chain.hang(link)).sum(), rel=0.05)


@pytest.mark.parametrize(
    ("c", "smoothing", "expected"),
    [
        (0.2, 0.01, 0.200130),
        (0.2, 0.1, 0.212568),
        (0.5, 1, 0.651956),
        (0.8, 1, 0.845249),
        (0.5, 0.01, 0.500021),
    ],
)
def test_restitution(c, smoothing, expected):
    assert impact.restitution(c, smoothing) == pytest.approx(expected, abs=1e-6)
    # the integration in time, which gives the rest, ends with the same energy as the quadrature
    whole = impact.impact(1.0, 1.0, 1.0, c, smoothing)
    assert whole.restitution == impact.restitution(c, smoothing)


def test_undamped_impact():
    found = impact.impact(1e-3, 1e6, 1.0, 1.0, 1e-3)
    assert found.time == pytest.approx(8.083415e-4, rel=1e-6)
    assert found.depth == pytest.approx(0.274640e-3, rel=1e-6)
    assert found.force == pytest.approx(4.551411, rel=1e-6)


def test_an_impact_without_rebound_leaves_below_the_smoothing_speed():
    for smoothing in (1e-3, 0.1):
        assert 0.9 * smoothing < impact.restitution(0.0, smoothing) < smoothing


def test_friction():
    assert friction.slide_acceleration(9.81, math.radians(20), 0.3) == pytest.approx(0.589702, abs=1e-6)
    assert friction.creep(math.radians(20), 0.5, 1.0) == pytest.approx(0.536876, abs=1e-6)
    assert friction.stopping_distance(1.5, 0.3, 9.81, 0.0) == pytest.approx(0.382263, abs=1e-6)
    assert pytest.approx(0.260346, abs=1e-6) == friction.STOP
    assert friction.slid(1.5, 0.3, 9.81, 1e-3, 0.1) == pytest.approx(0.15 - 0.5 * 0.3 * 9.81 * 0.01)
    assert friction.slid(1.5, 0.0, 9.81, 1e-3, 0.1) == pytest.approx(0.15)


def test_a_quick_suite_end_to_end(tmp_path):
    ended = CliRunner().invoke(
        app, ["bench", "impact", "--quick", "--repeat", "1", "--solver", "exudyn", "-o", str(tmp_path)]
    )
    assert ended.exit_code == 0, ended.output
    assert "c_R = 0.5 at 1 m/s" in ended.stdout
    found = json.loads((tmp_path / "bench.json").read_text())
    assert {"machine", "versions", "rows"} <= set(found)
    assert {"cpu", "cores", "python"} <= set(found["machine"])
    assert {"mdlgen", "numpy", "numba", "exudyn"} <= set(found["versions"])
    assert len(found["rows"]) == 8
    for row in found["rows"]:
        assert set(row) >= KEYS
        assert row["status"] == "ok" and row["error"] <= row["tolerance"]
        assert row["wall_s"] > 0 and row["step_s"] > 0
    assert (tmp_path / "bench.md").read_text().startswith("# ")
    assert (tmp_path / "bench.png").read_bytes().startswith(b"\x89PNG")


FAKES = {
    "shifted": """
        from dataclasses import replace
        from mdlgen.backends.exudyn_local import solve as honest

        def solve(model, progress=None, step=None):
            result = honest(model, progress, step)
            return replace(result, position=result.position - [0.0, 0.0, 5.0])
        """,
    "crashing": "import os\nos.kill(os.getpid(), 11)\n",
    "hanging": "import time\n\ndef solve(model, progress=None, step=None):\n    time.sleep(60)\n",
    "raising": "def solve(model, progress=None, step=None):\n    raise RuntimeError('no luck today')\n",
    "refusing": """
        from mdlgen.errors import RefusedError

        def solve(model, progress=None, step=None):
            raise RefusedError("no sheets here")
        """,
    "talking": """
        from mdlgen.backends.exudyn_local import solve as honest

        def solve(model, progress=None, step=None):
            print("noise on standard output")
            return honest(model, progress, step)
        """,
}
RECORD = "\nfrom mdlgen.backend import Backend\n\nBACKEND = Backend(solve=solve)\n"


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Registers a solver of FAKES by its name."""

    def register(name: str) -> str:
        (tmp_path / f"bench_{name}.py").write_text(textwrap.dedent(FAKES[name]) + RECORD)
        monkeypatch.syspath_prepend(str(tmp_path))
        monkeypatch.setitem(registry.SOLVERS, name, f"bench_{name}")
        return name

    return register


def outcome(solver: str, limit: float = 60.0) -> Outcome:
    case = BenchCase("stability", "strip", STRIP, drop, limit=limit)
    return process.run(Job(case, solver, registry.SOLVERS[solver], 1, None))


def test_a_wrong_number_with_status_ok_is_seen(fake, tmp_path, monkeypatch):
    monkeypatch.setattr(
        "mdlgen.bench.suites.elastica.cases", lambda *_: [BenchCase("elastica", "s", STRIP, drop)]
    )
    ended = CliRunner().invoke(
        app, ["bench", "elastica", "--repeat", "1", "--solver", fake("shifted"), "-o", str(tmp_path / "out")]
    )
    assert ended.exit_code == 5, ended.output
    (row,) = json.loads((tmp_path / "out" / "bench.json").read_text())["rows"]
    assert row["status"] == "wrong" and row["error"] > row["tolerance"]
    assert "the solver said ok" in row["reason"]


def test_a_crash_a_hang_and_a_refusal_are_rows_with_a_reason(fake, monkeypatch):
    monkeypatch.setattr(process, "STARTING", 3.0)
    for name, reason in (
        ("crashing", "crashed: SIGSEGV"),
        ("hanging", "no end within"),
        ("raising", "no luck today"),
        ("refusing", "refused: no sheets here"),
    ):
        found = outcome(fake(name), limit=0.0)
        (row,) = rows(BenchCase("stability", "strip", STRIP, drop), name, found)
        assert row.status == "failed" and row.error is None
        assert reason in (row.reason or ""), (name, row.reason)


def test_a_solver_may_talk(fake):
    found = outcome(fake("talking"))
    assert found.status == "ok" and len(found.findings) == 1
    assert found.findings[0].error == pytest.approx(0.00772, rel=0.01)  # of the lattice at 10 rows
    assert found.boxes == 10 and found.repeats == 1


def test_a_failed_solver_has_its_reason_and_no_error():
    case = BenchCase("stability", "x", STRIP, drop)
    (row,) = rows(case, "exudyn", Outcome("did not converge at 3 ms"))
    assert (row.status, row.reason, row.error) == ("failed", "did not converge at 3 ms", None)
    bad = replace(Outcome("ok"), findings=[Finding("q", math.inf, 1.0)])
    assert rows(case, "exudyn", bad)[0].status == "wrong"


def test_an_unknown_suite_or_solver_is_named(tmp_path):
    with pytest.raises(SpecError, match="there is no suite 'speed'"):
        bench(["speed"], tmp_path)
    with pytest.raises(SpecError, match="there is no solver 'nastran'"):
        bench(["impact"], tmp_path, ["nastran"])


def test_an_interrupt_leaves_the_rows_so_far(tmp_path, monkeypatch):
    monkeypatch.setattr(
        process, "run", lambda task, checkout=None: Outcome("ok", [Finding("q", 0.0, 1.0)], 0.1, 1, 1.0)
    )

    def say(text: str) -> None:
        if text.startswith("2/"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        bench(["impact"], tmp_path, ["exudyn"], quick=True, say=say)
    assert len(json.loads((tmp_path / "bench.json").read_text())["rows"]) == 1
