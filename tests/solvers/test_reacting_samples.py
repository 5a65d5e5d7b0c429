"""Samples of machines that react do what their heads promise."""

from __future__ import annotations

import numpy as np
import pytest
from ran import solved

import mdlgen
from mdlgen.backends.lattice.run import solve
from mdlgen.checks import lints

COARSE = ("sheets.note.boxes=[10,4]", "run.duration=45 ms", "run.tolerance=0.01")


def test_a_note_stops_where_the_sensor_says() -> None:
    places, seen = [], []
    for start in ("0 mm", "-6 mm"):
        sets = (*COARSE, f"sheets.note.center=[{start}, 0 mm, 0 mm]")
        result = solved(mdlgen.lower(mdlgen.load("samples/register.yaml", list(sets))), "lattice")
        edge = result.reactions[0]["time_ms"]
        place, rate, _ = result.sheet_motion(0)
        at = edge + 12.0  # 2 ms of delay, 4 ms of ramp
        seen.append(edge)
        places.append(float(np.interp(at, result.time, place[:, 0])))
        assert abs(float(np.interp(at, result.time, rate[:, 0]))) < 0.005
    # 6 mm at 1400 mm/s later
    assert seen[1] - seen[0] == pytest.approx(6.0 / 1.4, abs=0.02)
    assert places[1] == pytest.approx(places[0], abs=0.01)


def test_every_second_note_goes_up() -> None:
    model = mdlgen.lower(mdlgen.load("samples/sorter.yaml", ["sheets.note.boxes=[5,1]"]))
    assert not lints(model)
    result = solve(model, step=0.125)
    assert result.ok
    assert all(outcome.passed for outcome in result.verdict)
    went = {row["sensor"]: row["sheet"] for row in result.reactions if row.get("sensor") == "high"}
    assert went == {"high": "infeed_2"}
    # the next one comes 23 ms after the one before has cleared the fork
    clear = [r["time_ms"] for r in result.reactions if r["kind"] == "cleared" and r["sensor"] == "fork"]
    assert result.stays is not None
    assert result.stays[1:, 0] == pytest.approx([time + 23.0 for time in clear[:2]], abs=1e-3)
