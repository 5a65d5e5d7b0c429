"""The feeder sample on coarse grids: one note leaves at a time, and waits until the rubber comes round."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from asked import as_asked

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.registry import solver
from mdlgen.results.compare import compare
from mdlgen.results.events import events
from mdlgen.results.result import Result
from mdlgen.spec.load import load

COARSE = ("sheets.note_1.boxes=[10,8]", "run.step=0.0625 ms")
# note on rejection roller below note on note
SWAPPED = ("contacts.3.friction=0.15", "contacts.6.friction=0.5")
STANDS, RUBBER = 40.0, 200.0  # ms: the notes have come to rest at the rejection roller; the rubber is near
FED = 260.0  # ms: the rubber has gone by for 50 ms


@functools.cache
def run(name: str, *overrides: str, by: str = "lattice") -> Result:
    result = mdlgen.solve(lower(load(samples() / f"{name}.yaml", overrides)), by)
    assert as_asked(result), result.status
    return result


def place(result: Result, sheet: int, time: float) -> float:
    """Of a sheet along x [mm]."""
    at = int(np.argmin(np.abs(result.time - time)))
    return float(result.sheet_motion(sheet)[0][at, 0])


def together(result: Result) -> float:
    """When two sheets were last on their way together [ms]; those that pre-feeding brings together count."""
    found = [event for event in events(result) if event["kind"] == "double_feed"]
    return max((event["time_ms"] + event["duration_ms"] for event in found), default=0.0)


def test_the_note_waits_for_the_rubber() -> None:
    result = run("feeder_one", *COARSE, f"run.duration={FED} ms")
    assert abs(place(result, 0, RUBBER) - place(result, 0, STANDS)) < 0.2
    # and then goes with the roller's surface, 150 mm/s, from about 211 ms
    went = place(result, 0, FED) - place(result, 0, 220.0)
    assert went == pytest.approx(0.15 * (FED - 220.0), rel=0.03)


def test_the_note_is_drawn_out_to_the_end() -> None:
    """The pulling pair has it from about 376 ms on at 400 mm/s, against what holds its rear; a nip that drove
    its boxes would throw them out (docs/theory/contact.md)."""
    result = run("feeder_one", *COARSE, "run.duration=545 ms", "run.print_step=2 ms", "run.tolerance=0.01")
    went = place(result, 0, 540.0) - place(result, 0, 460.0)
    assert went == pytest.approx(0.4 * 80.0, rel=0.01)
    assert abs(result.energy.balance_error) < 2e-3


def test_one_note_leaves_where_the_frictions_have_their_order() -> None:
    result = run("feeder", COARSE[1], f"run.duration={FED} ms")
    assert abs(place(result, 0, RUBBER) - place(result, 0, STANDS)) < 0.2
    assert place(result, 0, FED) - place(result, 0, RUBBER) > 6.0
    assert abs(place(result, 1, FED) - place(result, 1, STANDS)) < 0.2
    assert together(result) < STANDS


def test_where_notes_stop_does_not_depend_on_the_step() -> None:
    """Notes of 200 boxes come to rest at the rejection roller at 28 ms. A step that ended with a note slower
    than its momentum says left it 25 um short."""
    grids = [f"sheets.note_{k}.boxes=[10,20]" for k in (1, 2)]
    model = lower(load(samples() / "feeder.yaml", (*grids, "run.duration=30 ms", "require=[]")))
    found = [solver("lattice").solve(model, step=step) for step in (0.05, 0.0455, 0.025)]
    assert [result.status for result in found] == ["ok"] * 3
    ends = [place(result, 0, 30.0) for result in found]
    assert max(ends) - min(ends) < 5e-3


def test_both_leave_where_notes_rub_more_on_each_other_than_on_the_rejection_roller() -> None:
    result = run("feeder", *SWAPPED, "run.duration=60 ms")
    assert together(result) > 58.0
    assert place(result, 1, 60.0) - place(result, 1, STANDS) > 2.0


def test_lattice_and_exudyn_agree_on_its_first_60_ms() -> None:
    """The note is brought up to the rejection roller and waits there."""
    sets = ("sheets.note_1.boxes=[10,4]", "run.duration=60 ms", "run.print_step=0.5 ms")
    fast, exact = run("feeder_one", *sets), run("feeder_one", *sets, by="exudyn")
    found = compare(fast, exact)
    assert found.relative < 1e-3
    assert abs(place(fast, 0, 60.0) - place(exact, 0, 60.0)) < 1e-3 * (place(exact, 0, 60.0) + 37.5)
    for name in ("feed", "reject", "prefeed", "skimmer_left"):
        assert found.nip_force[f"note_1 / {name}"] < 0.01, name
