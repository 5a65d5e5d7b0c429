"""A run against what another program recorded: files of our own in its form, whole, moved and damaged."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from decks import run
from ran import ran as result_of
from recordings import comment, label, plt, requests, split_in_parts, table

from mdlgen.errors import OutputError
from mdlgen.results.io.series import csv
from mdlgen.results.recorded.against import Against, against
from mdlgen.results.recorded.files import read
from mdlgen.results.recorded.own import quantities
from mdlgen.results.result import Result

SCENE = ("transport_4x4", "sheets.note.boxes=[4,8]", "run.duration=20 ms")
DIGITS = 5e-6  # half of the last of six digits
EXACT = 1e-14


@pytest.fixture(scope="module")
def ran() -> Result:
    return result_of(*SCENE)


def compared(result: Result, text: str, folder: Path, name: str = "note.plt") -> Against:
    file = folder / name
    file.write_bytes(text.encode())
    return against(result, read(file))


@pytest.mark.parametrize("called", [comment, label])
def test_our_own_run_in_a_plot_file_differs_by_its_digits(ran: Result, called, tmp_path: Path) -> None:
    found = compared(ran, plt(ran, called), tmp_path)
    assert [apart.name for apart in found.quantities] == [quantity.name for quantity in quantities(ran)]
    assert found.states == len(ran.time) and (found.begin_ms, found.end_ms) == (0.0, 20.0)
    assert found.shift is None and found.unknown == ()
    for apart, quantity in zip(found.quantities, quantities(ran), strict=True):
        # each of its components is known to six digits
        most = np.sqrt(3.0) * DIGITS * np.abs(quantity.values).max()
        assert apart.greatest <= most + 1e-12, apart.name
    names = {apart.name for apart in found.quantities}
    assert {"probes.lead.position", "probes.lead.velocity", "rollers.motor_1_left.omega"} <= names
    assert {"contacts.note.motor_1_left.resultant", "contacts.note.counter_1_left.torque"} <= names


def test_our_own_run_in_a_table_does_not_differ(ran: Result, tmp_path: Path) -> None:
    found = compared(ran, table(ran), tmp_path, "note_requests.csv")
    assert len(found.quantities) == len(quantities(ran)) and found.shift is None
    assert all(apart.relative <= EXACT for apart in found.quantities)
    same = compared(ran, table(ran, comment), tmp_path, "comments.csv")
    assert [a.relative for a in same.quantities] == [a.relative for a in found.quantities]


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_what_is_round_off_in_the_run_is_relative_to_the_file(ran: Result, tmp_path: Path) -> None:
    """The note does not turn here, and does in the file."""
    head, *lines = csv(ran).splitlines()
    at, time = head.split(",").index("note.yaw_deg"), ran.time.tolist()
    cells = [line.split(",") for line in lines]
    for k, row in enumerate(cells):
        row[at] = repr(0.1 * time[k])
    text = "\n".join([head, *map(",".join, cells)]) + "\n"
    found = {apart.name: apart for apart in compared(ran, text, tmp_path, "series.csv").quantities}
    yaw = found.pop("note.yaw_deg")
    assert yaw.scale == pytest.approx(2.0) and yaw.relative == pytest.approx(np.sqrt(1 / 3), rel=0.02)
    assert all(apart.relative <= EXACT for apart in found.values())


def test_series_of_our_own_do_not_differ(ran: Result, tmp_path: Path) -> None:
    found = compared(ran, csv(ran), tmp_path, "series.csv")
    assert {"note.x_mm", "lead.vx_mm_per_s", "motor_1_left.omega_rad_per_s"} <= {
        a.name for a in found.quantities
    }
    assert all(apart.greatest == 0.0 for apart in found.quantities) and found.unknown == ()
    units = {apart.name: apart.unit for apart in found.quantities}
    assert units["lead.vx_mm_per_s"] == "mm/s" and units["motor_1_left.torque_n_mm"] == "N mm"
    assert units["note.yaw_deg"] == "deg" and units["motor_1_left.force_n"] == "N"


@pytest.mark.parametrize("later", [1.0, -0.5])
def test_a_file_that_is_moved_in_time_is_shown_with_its_shift(
    ran: Result, later: float, tmp_path: Path
) -> None:
    """Times are on another clock, so that it is interpolated; the shift is found."""
    found = compared(ran, plt(ran, later=later), tmp_path)
    assert found.shift is not None
    assert found.shift.later_ms == pytest.approx(-later, abs=0.02)  # a fifth of what is stored apart
    assert found.shift.after < 0.2 * found.shift.before
    lead = next(a for a in found.quantities if a.name == "probes.lead.position")
    # 1400 mm/s once the ramp is over
    assert lead.greatest == pytest.approx(abs(later) * 1.4, rel=0.05)


def test_a_file_that_is_moved_in_space_is_shown_with_its_offset(ran: Result, tmp_path: Path) -> None:
    moved = replace(ran, position=ran.position + np.array([0.0, 0.25, -0.5]))
    found = compared(ran, table(moved), tmp_path, "moved.csv")
    for apart in found.quantities:
        if apart.name.endswith(".position"):
            assert apart.offset == pytest.approx((0.0, 0.25, -0.5), abs=1e-12)
            assert [apart.rms, apart.greatest] == pytest.approx([np.hypot(0.25, 0.5)] * 2, rel=1e-12)
        else:
            assert apart.rms == 0.0
    assert found.shift is None


def test_other_times_are_interpolated(ran: Result, tmp_path: Path) -> None:
    """Of every third state the cubic through places and velocities is far closer than straight lines."""
    third = slice(None, None, 3)
    names = (
        "time",
        "position",
        "rotation",
        "velocity",
        "spin",
        "contact_force",
        "contact_torque",
        "contact_friction",
    )
    coarse = replace(ran, **{name: getattr(ran, name)[third] for name in names})
    found = {a.name: a for a in compared(ran, table(coarse), tmp_path, "coarse.csv").quantities}
    lead = found["probes.lead.position"]
    assert lead.relative < 1e-5, "states 0.3 ms apart, where friction sets in within some"
    straight = table(coarse).replace("o_lead.f6", "o_lead.f5", 1)  # without a velocity
    other = {a.name: a for a in compared(ran, straight, tmp_path, "straight.csv").quantities}
    assert other["probes.lead.position"].rms > 10 * lead.rms
    assert "probes.lead.velocity" not in other


def test_a_part_of_the_run_is_compared_where_both_are(ran: Result, tmp_path: Path) -> None:
    late = replace(ran, time=ran.time + 5.0)
    found = compared(ran, table(late), tmp_path, "late.csv")
    assert found.begin_ms == 5.0 and found.end_ms == 20.0 and 0 < found.states < len(ran.time)
    with pytest.raises(
        OutputError, match="it is from 50 to 70 ms, the run from 0 to 20 ms: no time is in both"
    ):
        compared(ran, table(replace(ran, time=ran.time + 50.0)), tmp_path, "never.csv")


def test_of_several_states_at_one_time_the_last_counts(ran: Result, tmp_path: Path) -> None:
    """MotionSolve writes all results at a time where it is asked for; decks ask for the last."""
    head, first, *rest = table(ran).splitlines()
    wrong = first.split(",")
    doubled = [head, ",".join([wrong[0], *("7.0" for _ in wrong[1:])]), first, *rest]
    found = compared(ran, "\n".join(doubled), tmp_path, "doubled.csv")
    assert all(apart.relative <= EXACT for apart in found.quantities)


def test_a_state_of_rest_is_compared_as_one(tmp_path: Path) -> None:
    """Whatever time the solver gives it."""
    result = result_of("cantilever", "sheets.note.boxes=[2,4]")
    for time in (0.0, 1000.0):
        still = replace(result, time=np.array([time]))
        found = compared(result, table(still), tmp_path, "still.csv")
        assert [(a.name, a.greatest) for a in found.quantities] == [
            ("probes.tip.position", 0.0),
            ("probes.tip.velocity", 0.0),
        ]


def test_what_is_recorded_is_what_texts_ask_for(ran: Result) -> None:
    """The names of the writer of these files are those of deck and script."""
    from mdlgen.registry import emitter

    names = {name for name, _ in requests(ran)}
    script = emitter("msolve").read(emitter("msolve").emit(ran.model)).values
    assert names == {*script["outputs"], *script["contact outputs"]}
    deck = emitter("motionsolve").read(emitter("motionsolve").emit(ran.model)).values
    assert names == {*deck["outputs"], *deck["contact outputs"]}
    comments = {comment for _, comment in requests(ran)}
    assert {record["label"] for record in deck["outputs"].values()} <= comments


def test_parts_of_a_sum_are_added_up(ran: Result, tmp_path: Path) -> None:
    """A text records long sums in parts; where one is missing none of them counts."""
    text = plt(ran)
    own = next(line for line in text.splitlines() if line.startswith("Contact of note on motor_1_left"))
    first, second = (f"{' '.join(own.split())} ({k} of 2)" for k in (1, 2))
    whole = compared(ran, text, tmp_path)
    halves = compared(ran, split_in_parts(text, own, (first, second)), tmp_path, "parts.plt")
    assert {one.name: one.relative for one in halves.quantities} == pytest.approx(
        {one.name: one.relative for one in whole.quantities}, rel=1e-3, abs=1e-5
    )
    one = compared(ran, text.replace(own, first), tmp_path, "one.plt")
    assert one.unknown == (first,)


def test_what_is_not_of_the_scene_is_named(ran: Result, tmp_path: Path) -> None:
    text = table(ran).replace("o_lead.", "o_other.")
    found = compared(ran, text, tmp_path, "other.csv")
    assert found.unknown == ("o_other",)
    assert not any(a.name.startswith("probes.lead") for a in found.quantities)


def test_of_several_requests_with_one_label_the_first_counts(ran: Result, tmp_path: Path) -> None:
    text = plt(ran)
    first, second = (text.splitlines()[k] for k in (4, 6))
    found = compared(ran, text.replace(second, first, 1), tmp_path, "note.plt")
    assert found.unknown == (f"{' '.join(first.split())} (request 2)",)
    assert max(one.relative for one in found.quantities) < 1e-5


def damage(text: str, line: int, new: str | None) -> str:
    lines = text.split("\r\n")
    lines[line - 1 : line] = [] if new is None else [new]
    return "\r\n".join(lines)


PLOTS = {
    "ends in the head": (lambda t: "\r\n".join(t.split("\r\n")[:2]), r":2: the number of requests"),
    "no count": (lambda t: damage(t, 3, "   many     MMKGS_N_RACA  1.0"), r":3: the number of requests"),
    "other units": (lambda t: damage(t, 3, "   15     MKS_N_RACA  1.0"), r":3: its units are MKS_N_RACA"),
    "ends in the list": (
        lambda t: "\r\n".join(t.split("\r\n")[:9]),
        r":9: the file ends among its \d+ requests",
    ),
    "no id": (lambda t: damage(t, 6, "Probe"), r":6: an id is due here"),
    "cut": (lambda t: t[: -len(t) // 3].rsplit("\r\n", 2)[0], r"lines of numbers, not \d+ for each time"),
    "a line too few": (lambda t: damage(t, 60, None), r"lines of numbers, not \d+ for each time"),
    "no number": (
        lambda t: damage(t, 70, "  what  1.0  1.0  1.0  1.0  1.0"),
        r":70: 'what.*' holds what is no",
    ),
    "five numbers": (lambda t: damage(t, 70, " 1.0 1.0 1.0 1.0 1.0"), r":70: 5 numbers, not 6"),
    "stars": (lambda t: damage(t, 70, " ************ 1.0 1.0 1.0 1.0 1.0"), r":70: '\*+"),
    "infinite": (lambda t: damage(t, 70, " inf 1.0 1.0 1.0 1.0 1.0"), "a number that is not finite"),
    "backwards": (
        lambda t: t.replace("  2.00000E-02\r", " -1.00000E-04\r"),
        "a time before the one above it",
    ),
}


@pytest.mark.parametrize("name", PLOTS)
def test_a_damaged_plot_file_is_reported_in_one_line(ran: Result, name: str, tmp_path: Path) -> None:
    make, match = PLOTS[name]
    text = make(plt(ran))
    assert text != plt(ran)
    with pytest.raises(OutputError, match=match) as error:
        compared(ran, text, tmp_path)
    assert "\n" not in str(error.value) and len(str(error.value)) < 400


TABLES = {
    "only names": ("time,o_lead.f2\n", ":1: there is no row"),
    "a column more": ("time,o_lead.f2\n0,1\n1,2,3\n", ":3: 3 columns, not 2"),
    "no number": ("time,o_lead.f2\n0,one\n", ":2: a cell is no number"),
    "backwards": ("time,o_lead.f2\n0,1\n2,1\n1,1\n", ":4: a time before"),
    "no time": ("time,o_lead.f2\nnan,1\n", "a time is not finite"),
    "foreign": (
        "time,speed,force\n0,1,2\n1,1,2\n",
        "none of its 2 requests is of transport_4x4; there are: o_",
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_damaged_or_foreign_table_is_reported_in_one_line(ran: Result, name: str, tmp_path: Path) -> None:
    text, match = TABLES[name]
    with pytest.raises(OutputError, match=match) as error:
        compared(ran, text, tmp_path, "bad.csv")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("note.mrf", b"\x00\x01", "multibody results, whose layout is not public; MotionSolve writes"),
        ("note.abf", b"text", "an Altair binary file, whose layout is not public"),
        ("note.h3d", b"", "an animation, whose layout is not public"),
        ("note.plt", b"\x00" * 40, "a binary file, whose layout is not public"),
        ("note.plt", b"", "the file is empty"),
        ("note.plt", b" \r\n", "the file is empty"),
        ("note.plt", b"hello", "neither a plot file of MotionSolve"),
        ("note.csv", "x,zeit\n".encode("utf-16"), "a binary file"),
        ("note.csv", b"x;y\n1;2\n", "neither a plot file"),
    ],
)
def test_other_files_are_refused_by_name(name: str, content: bytes, match: str, tmp_path: Path) -> None:
    file = tmp_path / name
    file.write_bytes(content)
    with pytest.raises(OutputError, match=match) as error:
        read(file)
    assert str(error.value).startswith(str(file)) and "\n" not in str(error.value)
    with pytest.raises(OutputError, match="cannot read"):
        read(tmp_path / "missing.plt")


@pytest.mark.parametrize("head", ["time", "Time (s)", "TIME", '"time [s]"', "time_s"])
@pytest.mark.parametrize("sign", [",", ";", "\t"])
def test_tables_of_other_makers(ran: Result, head: str, sign: str, tmp_path: Path) -> None:
    """Names as HyperGraph shows requests, other delimiters, a time with its unit."""
    rows = [(0.0, 33.5), (0.01, 40.0), (0.02, 50.0)]
    names = [head, *(f"o_lead F{k}" for k in (2, 3, 4))]
    text = "\n".join([sign.join(names), *(sign.join(map(str, (t, x, 0.0, 0.0))) for t, x in rows)])
    found = compared(ran, text, tmp_path, "other.csv")
    (lead,) = found.quantities
    assert lead.name == "probes.lead.position" and (found.begin_ms, found.end_ms) == (0.0, 20.0)
    in_ms = text.replace(head, head.replace("s]", "ms]").replace("(s)", "(ms)").replace("_s", "_ms"))
    if in_ms != text:
        assert read(tmp_path / "other.csv").time[-1] == 20.0
        (tmp_path / "ms.csv").write_text(in_ms)
        assert read(tmp_path / "ms.csv").time[-1] == 0.02


def test_the_command(ran: Result, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, file = tmp_path / "out", tmp_path / "note.plt"
    ran.save(folder)
    file.write_text(plt(ran, later=1.0), newline="")
    assert run("compare", folder, "--with", file) == 0
    out, err = capsys.readouterr()
    assert err == f"wrote {folder / 'compare.html'}\n"
    first, *rows = out.splitlines()
    assert first.split() == ["quantity", "RMS", "greatest", "at", "ms", "mean", "relative"]
    assert rows[0].startswith("probes.grip.position ")
    assert re.search(r"the file would fit better (0\.99\d*|1(\.0\d*)?) ms earlier", out)
    page = (folder / "compare.html").read_text()
    assert '<section id="recorded">' in page and "probes.lead.position" in page and "ms earlier" in page
    assert "recorded probes.lead.position" in page, "a figure of both"
    assert run("compare", folder, "--with", file, "--json", "-q", "-o", tmp_path / "page.html") == 0
    out, err = capsys.readouterr()
    record = json.loads(out)
    assert err == "" and (tmp_path / "page.html").exists()
    assert record["shift"]["later_ms"] == pytest.approx(-1.0, abs=0.02)
    assert {q["name"] for q in record["quantities"]} == {q.name for q in quantities(ran)}
    assert set(record["quantities"][0]) == {
        *("name", "unit", "rms", "greatest", "at_ms", "offset", "scale", "relative")
    }
    assert run("compare", folder, "--with", file, "-q", "--within", 0.5) == 0
    assert capsys.readouterr() == ("", "")
    assert run("compare", folder, "--with", file, "-q", "--within", 1e-3) == 5
    out, err = capsys.readouterr()
    worst = max(record["quantities"], key=lambda q: q["relative"])
    assert out == "" and f"furthest {worst['name']}: {worst['relative']:.3g}\n" in err
    for args in ((folder, "--with", tmp_path / "no.plt"), (tmp_path, "--with", file)):
        assert run("compare", *args) == 3
        assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_page_without_a_file_has_no_such_section(ran: Result) -> None:
    from mdlgen.report.html.page import page

    assert "recorded" not in page([ran]).partition("<main>")[2].partition("<script")[0]
