"""The cash recycler of samples/recycler.yaml, coarser and with three notes: what its head says of each."""

from __future__ import annotations

import functools

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice.run import solve
from mdlgen.checks import lints
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.result import Result

FEW = (
    *("piles.cassette.count=3", "sheets.note.boxes=[8,1]", "parameters.fed=2", "parameters.reject=2"),
    *("run.duration=250 ms", "require.5=sensors.low.count from 1 to 1"),
)


def model(*sets: str) -> Model:
    return mdlgen.lower(mdlgen.load(samples() / "recycler.yaml", list(sets)))


@functools.cache
def ran(*sets: str) -> Result:
    return solve(model(*FEW, *sets), step=0.2)


def missed(result: Result) -> list[str]:
    return [outcome.requirement for outcome in result.verdict if not outcome.passed]


def test_the_scene_has_the_lint_that_its_head_names() -> None:
    made = model()
    assert {lint.code for lint in lints(made)} == {"W102"}
    assert len(made.sheets) == 6 and all(sheet.count == 40 for sheet in made.sheets)
    assert len((samples() / "recycler.yaml").read_text().splitlines()) < 150


def test_notes_go_where_they_should() -> None:
    result = ran()
    assert result.ok, result.status
    assert not missed(result), missed(result)
    went = {row["sensor"]: row["sheet"] for row in result.reactions if row["kind"] == "covered"}
    assert (went["low"], went["high"]) == ("cassette_1", "cassette_2")
    # the third one stays on the stack, below the pick roller
    place, _, _ = result.sheet_motion(2)
    assert np.ptp(place[:, 0]) < 5.0


@pytest.mark.parametrize(
    ("change", "duration", "fails"),
    [
        ("parameters.skew=2 deg", "155 ms", "skew at reader within 1 deg"),
        ("sheets.cassette_2.zones.worn.friction=0.3", "160 ms", "no jam"),
        ("shafts.main.drive.motor.torque=8 N*mm", "85 ms", "rollers.lower_1.omega above 190 rad/s"),
    ],
)
def test_the_wrong_cases_fail_by_name(change: str, duration: str, fails: str) -> None:
    result = ran(change, f"run.duration={duration}")
    assert result.usable, result.status
    assert fails in missed(result), missed(result)
    if fails == "no jam":
        assert any(e["kind"] == "jam" and e["sheet"] == "cassette_2" for e in result.summary()["events"])
