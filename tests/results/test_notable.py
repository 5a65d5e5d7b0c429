"""Which events a terminal prints where there are many."""

from __future__ import annotations

from mdlgen.results.notable import foremost, notable

KINDS = ("double_feed", "double_feed", "double_feed", "creep", "stub", "double_feed", "creep")
EVENTS = [{"kind": kind, "time_ms": float(k), "sheet": "note"} for k, kind in enumerate(KINDS)]


def test_a_stub_is_printed_before_a_double_feed_that_repeats_itself() -> None:
    shown, more = foremost(notable(EVENTS), 4)
    assert [event["time_ms"] for event in shown] == [0.0, 1.0, 4.0, 3.0]  # creep stands last
    assert more == "double feed (2), creep (1)"


def test_few_events_are_all_printed() -> None:
    assert foremost(EVENTS, len(EVENTS)) == (EVENTS, "")
