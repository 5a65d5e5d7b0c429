"""Notes that are taken from others: the order of frictions decides which go, and the events tell."""

from __future__ import annotations

from typing import Any

from asked import as_asked
from papers import HINGED_PAPER

import mdlgen
from mdlgen.model.lower import lower
from mdlgen.results.events import events
from mdlgen.results.result import Result
from mdlgen.spec.load import loads

SPEED, RAMP = 0.3, 5.0  # of the feeding roller's surface along x [mm/ms], and when it is reached [ms]
SMOOTHING = 1e-3  # of friction [mm/ms]
SHEET = "material: paper, size: [40 mm, 30 mm], thickness: 0.1 mm, mass: 0.1 g, boxes: [4, 3]"
LAW = "restitution: 0.2, smoothing: 1 mm/s"
# the upper of two notes lies under the feeding roller
HEAD = f"""
name: feeding
materials:
  paper: {HINGED_PAPER}
sheets:
  low: {{{SHEET}, center: [0 mm, 0 mm, 0.05 mm]}}
  top: {{{SHEET}, center: [0 mm, 0 mm, 0.15 mm]}}
rollers:
  feed: {{center: [0 mm, 0 mm, 10.2 mm], axis: y, radius: 10 mm, width: 20 mm, mass: 10 g,
    drive: {{speed: -30 rad/s, ramp: 5 ms}}, press: {{direction: -z, stiffness: 0.3 N/mm, preload: 1 N}}}}
"""
TABLE = """planes:
  table: {center: [0 mm, 0 mm, -5 mm], normal: z, size: [200 mm, 100 mm, 10 mm], mass: 500 g}
"""
# a roller that stands, in the place of the paper's rejection rollers
REJECT = """  reject: {center: [0 mm, 0 mm, -5 mm], axis: y, radius: 5 mm, width: 20 mm, mass: 5 g,
    drive: {speed: 0 rad/s}}
"""


def fed(
    under: str, part: str, frictions: tuple[float, float, float], stiffness: float, time: float
) -> Result:
    """Two notes between the feeding roller and what is `under` them, with the friction of a note on the
    roller, on what is under it, and on the other note; `stiffness` is of the notes' contact [N/mm^1.5]."""
    feed, held, notes = frictions
    # notes that clap on each other shake the roller, which sinks by 0.05 mm, each run by another 0.0005 mm
    # what a note creeps by is far below the tolerance of the way that the other one goes
    step = ", step: 0.02 ms" if under == "reject" else ", step: 0.05 ms"
    text = f"""{HEAD}{part}
contacts:
  - {{between: ["???", feed], stiffness: 100 N/mm^1.5, {LAW}, friction: {feed}}}
  - {{between: ["???", {under}], stiffness: 100 N/mm^1.5, {LAW}, friction: {held}}}
  - {{between: [low, top], stiffness: {stiffness} N/mm^1.5, {LAW}, friction: {notes}}}
run: {{duration: {time} ms, print_step: 0.5 ms{step}}}
"""
    result = mdlgen.solve(lower(loads(text, "feeding")), "lattice")
    assert as_asked(result), result.status
    return result


def travel(result: Result) -> dict[str, float]:
    """How far each sheet went along x [mm]."""
    ways = {}
    for k, sheet in enumerate(result.model.sheets):
        place = result.sheet_motion(k)[0][:, 0]
        ways[sheet.name] = float(place[-1] - place[0])
    return ways


def doubles(result: Result) -> list[dict[str, Any]]:
    return [event for event in events(result) if event["kind"] == "double_feed"]


def test_the_upper_note_leaves_alone_where_notes_rub_less_on_each_other_than_on_the_table() -> None:
    time = 40.0
    way = SPEED * (time - 0.5 * RAMP)
    right = fed("table", TABLE, (1.0, 0.6, 0.3), 100.0, time)
    went = travel(right)
    assert abs(went["top"] - way) < 5e-3 * way
    # smoothed friction creeps: 0.3 of a friction of 0.6 needs some 0.35 of the smoothing speed
    assert 0.0 < went["low"] < 0.5 * SMOOTHING * time
    assert doubles(right) == []
    wrong = fed("table", TABLE, (1.0, 0.3, 0.6), 100.0, time)
    went = travel(wrong)
    assert abs(went["top"] - way) < 5e-3 * way and abs(went["low"] - went["top"]) < 5e-3 * way
    (double,) = doubles(wrong)
    assert (double["sheet"], double["other"], double["roller"]) == ("top", "low", "feed")
    assert double["time_ms"] < 2.0 and double["duration_ms"] > time - 2.0


def test_a_rejection_roller_lets_one_note_through_where_the_frictions_have_their_order() -> None:
    """The paper's: note on feeding roller > note on rejection roller > note on note."""
    time = 12.0
    way = SPEED * (time - 0.5 * RAMP)
    right = fed("reject", REJECT, (1.0, 0.6, 0.3), 1000.0, time)
    went = travel(right)
    assert abs(went["top"] - way) < 2e-2 * way and abs(went["low"]) < 1e-2 * way
    assert doubles(right) == []
    wrong = fed("reject", REJECT, (1.0, 0.3, 0.6), 1000.0, time)
    went = travel(wrong)
    assert abs(went["top"] - way) < 2e-2 * way and abs(went["low"] - went["top"]) < 2e-2 * way
    (double,) = doubles(wrong)
    assert {double["sheet"], double["other"]} == {"low", "top"} and double["duration_ms"] > time - 3.0
