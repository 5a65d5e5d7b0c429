"""Every sample is run, and the transport scenes give what the paper reports."""

from __future__ import annotations

import numpy as np
import pytest
import ran
from asked import as_asked
from unsaid import UNSAID

import mdlgen
from mdlgen.paths import samples
from mdlgen.results.compare import compare

TRANSPORT = ("transport_4x4", "transport_4x2", "transport_tilted")
FEEDER = ("feeder", "feeder_one")  # 600 ms: tests/solvers/test_feeder.py runs a coarse piece
STUDIED = ("tilt_correction", "feeder_window")  # below, one piece of each
QUICK = sorted(
    path.relative_to(samples()).with_suffix("").as_posix()
    for path in samples().rglob("*.yaml")
    if path.stem not in TRANSPORT + FEEDER + STUDIED
)


def solved(name, solver="auto", *sets):
    result = ran.solved(mdlgen.lower(mdlgen.load(samples() / f"{name}.yaml", sets)), solver)
    return result, result.summary()


PIECES = {
    # Exudyn takes a minute for all of it: to where the second note has left the pick roller, which lands
    # then, with notes that are one box wide
    ("retard_pad", "exudyn"): (
        *("run.duration=160 ms", "run.tolerance=0.01"),
        *("sheets.note_1.boxes=[8,1]", "sheets.note_2.boxes=[8,1]"),
    ),
    # blocks, which tests/solvers/test_exudyn.py runs to what their samples say
    ("verify/drop", "exudyn"): ("run.duration=150 ms",),
    ("verify/incline", "exudyn"): ("run.duration=100 ms",),
    ("verify/slide", "exudyn"): ("run.duration=100 ms",),
    # tests/solvers/test_measured_friction.py looks at such blocks in Exudyn, too
    ("verify/aslant", "exudyn"): ("run.duration=20 ms",),
    ("pile", "exudyn"): ("run.duration=1 ms",),
    # tests/solvers/test_motors.py has both solvers against closed forms
    ("retard", "exudyn"): ("run.duration=2 ms", "run.tolerance=0.01"),
    ("stall", "exudyn"): ("run.duration=10 ms", "run.tolerance=0.01"),
    # what tests/solvers/test_spring_plate.py and tests/solvers/test_roller_plate.py look at in Exudyn, too
    ("spring_plate", "exudyn"): ("run.duration=15 ms",),
    ("peel", "exudyn"): ("run.duration=5 ms",),  # all of it before a release: tests/solvers/test_arms.py
    # while the rod bends the strip; tests/solvers/test_yield.py compares both solvers
    ("crease", "exudyn"): ("sheets.strip.boxes=[10,1]", "run.duration=1 ms", "run.tolerance=0.01"),
    # to where the nips stop; tests/solvers/test_reacting.py looks at both solvers
    ("register", "exudyn"): ("sheets.note.boxes=[5,2]", "run.duration=34 ms", "run.tolerance=0.02"),
    # the first 12 ms of two notes; tests/solvers/test_recycler.py runs all of it, coarser
    ("recycler", "auto"): (
        *("sheets.note.boxes=[8,1]", "piles.cassette.count=2"),
        *("run.duration=12 ms", "run.step=0.05 ms"),
    ),
    # without what Exudyn does not have: speed control, friction that sticks, sheets that leave at rest
    ("recycler", "exudyn"): (
        *("sheets.note.boxes=[4,1]", "piles.cassette.count=2", "sheets.note.out=[]", "run.duration=2 ms"),
        *("shafts.main={rollers: {lower_1: 1, lower_2: 1}, drive: {speed: 200 rad/s}}",),
        "piles.cassette.contact.friction=0.3",
    ),
    # all of it, coarser, in tests/solvers/test_reacting_samples.py
    ("sorter", "auto"): ("run.duration=40 ms",),
    ("sorter", "exudyn"): ("sheets.note.boxes=[4,1]", "run.duration=10 ms", "run.tolerance=0.05"),
    # all of it, coarser, in tests/solvers/test_duplex.py
    ("duplex", "auto"): ("sheets.note.boxes=[10,1]", "run.duration=20 ms"),
    ("duplex", "exudyn"): ("sheets.note.boxes=[4,1]", "run.duration=2 ms", "run.tolerance=0.05"),
    ("pick", "exudyn"): ("run.tolerance=0.01",),
    # until the second note has come in; tests/solvers/test_streams.py compares both solvers
    ("stream", "exudyn"): ("run.duration=62 ms", "sheets.note.boxes=[2,2]", "run.step=0.1 ms"),
    # the Model of transport_4x4 (tests/model/test_nips.py), which it runs as a whole below
    ("transport_nips", "exudyn"): ("run.duration=5 ms",),
}


@pytest.mark.parametrize("solver", ["auto", "exudyn"])
@pytest.mark.parametrize("name", QUICK)
def test_sample_runs(name, solver):
    result, summary = solved(name, solver, *PIECES.get((name, solver), ()))
    # the reference solver runs long ones once, and says why nothing was compared
    assert as_asked(result) if solver == "exudyn" else summary["status"] == "ok"
    assert np.isfinite(result.position).all()
    static = result.model.run.analysis == "static"
    assert result.time[-1] == pytest.approx(0.0 if static else result.model.run.duration, rel=1e-9)
    if solver == "auto":
        # no energy comes from nowhere; what a search for a step allows is 1 % of where sheets are
        assert abs(summary["energy"]["balance_error"]) < 5e-3


@pytest.mark.parametrize("name", [*QUICK, *TRANSPORT, *FEEDER, *STUDIED])
def test_sample_has_a_text_and_a_header(name):
    path = samples() / f"{name}.yaml"
    assert path.read_text().startswith("# ")
    # a text with loads is refused, or with air
    text = mdlgen.emit(mdlgen.lower(mdlgen.load(path, ["loads=[]", *UNSAID.get(name, ())])), "motionview")
    assert text.rstrip().endswith("*EndMDL()")


def test_four_pairs_of_rollers():
    """Paper section 4.1: 66.5 mm in 50 ms, 1400 mm/s, nips, penetrations."""
    _, summary = solved("transport_4x4", "lattice")
    _paper_says(summary)
    assert summary["error_estimate"] < 1e-3


def test_four_pairs_of_rollers_by_the_reference_solver():
    """The same, and both solvers agree."""
    slow, summary = solved("transport_4x4", "exudyn")
    _paper_says(summary)
    fast, _ = solved("transport_4x4", "lattice")
    away = compare(slow, fast)
    assert away.relative < 1e-3
    gripped = (
        slow.statistics.mean_force > 2.5
    )  # the nips; rollers that graze each other between whiles are not
    assert slow.statistics.mean_force[gripped] == pytest.approx(fast.statistics.mean_force[gripped], rel=0.01)


def _paper_says(summary):
    note = summary["sheets"]["note"]
    assert note["travel_mm"][0] == pytest.approx(66.5, rel=0.015)
    assert note["speed_mm_per_s"][0] == pytest.approx(1400, rel=0.02)
    assert summary["pairs"]["kept"] < 0.3 * summary["pairs"]["possible"]
    for side in ("left", "right"):
        for row in (1, 2):
            for kind in ("motor", "counter"):
                roller = summary["rollers"][f"{kind}_{row}_{side}"]
                assert 0.03 < roller["mean_penetration_mm"] < 0.06
                assert 0.03 < roller["max_penetration_mm"] < 0.06
        nip = summary["rollers"][f"counter_2_{side}"]
        assert 26 <= nip["free_of_counterpart_at_ms"] <= 32
        assert nip["contacts"][f"motor_2_{side}"]["max_penetration_mm"] == pytest.approx(0.22, abs=0.01)
    assert abs(summary["energy"]["balance_error"]) < 5e-3  # of an energy without drag in the nips
    # symmetric scene, symmetric answer
    assert abs(note["yaw_deg"]) < 1e-3
    assert abs(note["travel_mm"][1]) < 1e-3


def test_two_pairs_and_two_single_rollers():
    """Paper section 4.2: the note creeps, reaches row 2 after more than twice the time, then 1400 mm/s."""
    result, summary = solved("transport_4x2")
    row = [i for i, b in enumerate(result.model.contacts.part_b) if b == "counter_2_left"]
    note = next(i for i in row if result.model.contacts.part_a[i] == "note")
    arrived = result.time[np.flatnonzero(result.contact_force[:, note] > 0)[0]]
    assert 90 <= arrived <= 130
    assert summary["sheets"]["note"]["speed_mm_per_s"][0] == pytest.approx(1400, rel=0.03)
    # friction cannot accelerate it faster than mu g, with mu = 1 at the rollers
    before = result.time < arrived
    speed = result.sheet_motion(0)[1][before, 0]
    assert (speed <= 9.81e-3 * result.time[before] + 0.02).all()


def test_a_tilted_note_is_turned_over_to_the_other_side():
    """Paper section 4.3: the slow side near 0.9 mm/ms, the fast side near 1.6, the tilt over-corrected."""
    result, summary = solved("transport_tilted")
    rows = [i for i, b in enumerate(result.model.contacts.part_b) if b.endswith(("1_left", "1_right"))]
    notes = [i for i in rows if result.model.contacts.part_a[i] == "note"]
    held = np.flatnonzero((result.contact_force[:, notes] > 0).any(axis=1))[-1]
    alone = slice(held + 1, None)
    box_speed = result.velocity[alone, :200, 0]
    # the boxes in the nips of row 2, where each roller's force acts
    names = [p.name for p in result.model.probes]
    slow = result.anchor_motion(names.index("slow"))[1][alone, 0]
    fast = result.anchor_motion(names.index("fast"))[1][alone, 0]
    assert 0.9 <= slow.mean() <= 1.1
    assert 1.5 <= fast.mean() <= 1.85
    assert box_speed.min() < 1.1 and box_speed.max() > 1.5
    assert summary["sheets"]["note"]["yaw_deg"] < 0 < np.degrees(result.model.sheets[0].angles[2])


def test_a_tilted_note_leaves_straight():
    """What mdlgen optimize found for row 2: 0 deg to 0.1 deg, where the paper's speeds turn it to -29 deg.

    At 50 us, which is within 0.005 deg of 20 us; the header of the sample has the command of the search.
    """
    scene = mdlgen.load(samples() / "tilt_correction.yaml", ["run.step=0.05 ms", "run.tolerance=0.01"])
    result = mdlgen.solve(mdlgen.lower(scene))
    assert as_asked(result), result.status
    assert abs(result.summary()["sheets"]["note"]["yaw_deg"]) <= 0.1
    left, right = (scene.rollers[f"motor_2_{side}"].drive.speed for side in ("left", "right"))
    assert left + right == pytest.approx(2 * 0.186)


@pytest.mark.parametrize(
    ("reach", "friction", "outcome"),
    [(0.02, 0.3, "jam"), (0.06, 0.3, "one note"), (0.08, 0.55, "double feed")],
)
def test_the_window_of_a_feeder(reach, friction, outcome):
    """Far from the border of each part of the map, where forces at rest decide."""
    sets = [f"rollers.feed.center.2={10.2 - reach} mm", f"contacts.2.friction={friction}", "run.step=0.05 ms"]
    model = mdlgen.lower(mdlgen.load(samples() / "feeder_window.yaml", sets))
    result = mdlgen.solve(model)
    assert as_asked(result), result.status
    kinds = {event["kind"] for event in result.summary()["events"]}
    found = "double feed" if "double_feed" in kinds else "jam" if "jam" in kinds else "one note"
    # the force of three contacts in series, and that of the pad with its spring
    nip, pile = (reach / (2 * 300 ** (-2 / 3) + 1000 ** (-2 / 3))) ** 1.5, 0.345
    both = friction * (nip + pile) > 0.35 * nip + 0.8 * pile
    none = 0.9 * nip < friction * (nip + pile) + 0.3 * pile
    assert found == outcome == ("double feed" if both else "jam" if none else "one note")
