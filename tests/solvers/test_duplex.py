"""samples/duplex.yaml turns a note over, as its head says; with half of its boxes, at one step."""

from __future__ import annotations

import numpy as np
import pytest

import mdlgen
from mdlgen.backends.lattice.run import solve
from mdlgen.checks import lints
from mdlgen.results.result import Result

LONG, THROAT, GATE = 67.0, 22.0, 19.0  # of the note; heights of the sensor, and of what the gate reaches [mm]


def ran(*sets: str) -> Result:
    model = mdlgen.lower(mdlgen.load("samples/duplex.yaml", ["sheets.note.boxes=[10,1]", *sets]))
    assert sets or not lints(model)
    return solve(model, step=0.125)


def test_a_note_stops_turns_back_and_comes_out_with_its_back_up() -> None:
    result = ran()
    assert result.ok and all(outcome.passed for outcome in result.verdict)
    rows = {row["rule"]: row for row in result.reactions if row["kind"] == "rule"}
    cleared = next(row["time_ms"] for row in result.reactions if row["kind"] == "cleared")
    # the drive stops as the edge passes, the gate moves 6 ms later, the drive turns back after 8 ms more
    delays = [rows[k]["time_ms"] - cleared for k in range(3)]
    assert delays == pytest.approx([0.0, 6.0, 14.0], abs=1e-3)
    tail, _ = result.anchor_motion(1)
    standing = (result.time > cleared + 6.5) & (result.time < cleared + 13.5)
    # a ramp of 6 ms from 1.5 m/s is 4.5 mm; it waits there, above the gate
    assert tail[standing, 2] == pytest.approx(THROAT + 4.5, abs=0.3)
    assert np.ptp(tail[standing, 2]) < 0.05 and tail[standing, 2].min() > GATE
    # out of the machine: flat on the table, the other edge ahead, normals down
    head, _ = result.anchor_motion(0)
    assert tail[-1, 0] - head[-1, 0] == pytest.approx(LONG, abs=0.1)
    boxes = slice(0, result.model.sheets[0].count)
    _, x, y, _ = result.rotation[-1, boxes].T
    assert 1.0 - 2.0 * (x * x + y * y) == pytest.approx(-1.0, abs=0.01)
    assert abs(result.position[-1, boxes, 2]).max() < 0.5
    assert result.reactions[-1]["does"] == "end"


def test_a_gate_that_is_late_leads_it_back_where_it_jams() -> None:
    result = ran("rules.1.after=60 ms")
    assert result.ok
    missed = {outcome.requirement for outcome in result.verdict if not outcome.passed}
    assert "no jam" in missed and "sensors.out.count from 1 to 1" in missed
    assert result.anchor_motion(1)[0][-1, 0] < 19.2  # on the side it came from
