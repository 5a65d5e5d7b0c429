"""A step that is given is taken as it is; whether it will do is judged by a run at twice that step."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.backends.lattice import compared
from mdlgen.backends.lattice.compared import UNKNOWN
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.spec.load import load

MU, THROWN, TIME = 0.3, 0.3, 20.0  # -, [mm/ms], [ms]
LENGTH = 127.0  # of a note [mm]
LAW = f"stiffness: 2000 N/mm^1.5, restitution: 0.5, friction: {MU}, smoothing: 1 mm/s"


def thrown(step: float, seed: int) -> Result:
    """The uppermost of five notes is thrown along the others. Contacts swing within 0.5 ms."""
    sets = [
        "piles.cassette.count=5",
        f"piles.cassette.contact={{{LAW}}}",
        f"piles.cassette.seed={seed}",
        "piles.cassette.turn=1 deg",
        "sheets.note.boxes=[2,2]",
        "sheets.cassette_5.velocity=[0.3 m/s, 0 m/s, 0 m/s]",
        "rollers={}",
        "probes={}",
        "require=[]",
        f'contacts={{floor: {{between: ["cassette_*", floor], {LAW}}}}}',
        "run.margin=30 mm",
        f"run.duration={TIME} ms",
        f"run.step={step} ms",
    ]
    return mdlgen.solve(lower(load(samples() / "pile.yaml", sets)), "lattice")


def way_of(result: Result) -> float:
    names = [sheet.name for sheet in result.model.sheets]
    place = result.sheet_motion(names.index("cassette_5"))[0]
    return float(place[-1, 0] - place[0, 0])


def test_a_step_that_does_not_resolve_its_contacts_says_that_its_error_is_not_known() -> None:
    """Whether such a run keeps its energy is a matter of chance: of forty piles at a step of 1 ms sixteen
    did, one with a way that is wrong by 70 %. A run at twice the step fails for most of them, or differs by
    so much that a third one has to show that differences fall."""
    exact = THROWN * TIME - 0.5 * MU * 9.81e-3 * TIME**2
    unknown = 0
    for seed in range(1, 21):
        result = thrown(1.0, seed)
        known = result.error_estimate
        assert (known is None) == (not result.usable or bool(result.error_unknown)), seed
        if known is not None:
            # from three runs: of sixty such piles three have one, and are off by less; where iterations go on
            # in another way one of four was off by 1.3 times that
            assert abs(way_of(result) - exact) <= 1.5 * known * max(exact, LENGTH / 10.0), seed
        if result.error_unknown:
            unknown += 1
            assert result.error_unknown.startswith(UNKNOWN) and result.error_estimate is None
            assert result.status == "inaccurate"
            assert result.summary()["error_unknown"] == result.error_unknown
    assert unknown > 0


def test_a_step_that_does_is_taken_as_it_is() -> None:
    exact = THROWN * TIME - 0.5 * MU * 9.81e-3 * TIME**2
    result = thrown(0.02, 1)
    assert as_asked(result) and result.step == pytest.approx(0.02)
    assert result.error_estimate is not None and result.error_estimate < 0.01
    assert way_of(result) == pytest.approx(exact, rel=5e-3)


def test_a_run_that_is_only_compared_stores_no_more_than_it_must(monkeypatch: pytest.MonkeyPatch) -> None:
    """Times that both have, by which estimates are much the same; a prime number of them is not divided."""
    whole = thrown(0.02, 1)
    monkeypatch.setattr(compared, "COMPARED", 210)
    thin = thrown(0.02, 1)
    assert len(whole.coarser[0].time) == len(whole.time) == len(thin.time) == 41
    assert thin.coarser[0].time == pytest.approx(thin.time[::4], abs=1e-9)
    assert np.array_equal(thin.position, whole.position)
    known = whole.error_estimate, thin.error_estimate
    assert None not in known and 0.3 < known[0] / known[1] < 3.0
    model = whole.model
    odd = replace(model, run=replace(model.run, duration=18.5))
    assert compared.thinned(odd) is odd
