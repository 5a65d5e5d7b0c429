"""Streams: which sheets they make, that chance is that of the seed, what is said of mistakes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from papers import on_paper

import mdlgen
from mdlgen.errors import RefusedError, SpecError
from mdlgen.spec.load import loads
from mdlgen.spec.scene import Scene

STREAM = on_paper("""
name: stream
parameters: {pitch: 70 ms, far: 200 mm}
materials: {paper: HINGED_PAPER}
sheets:
  note: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [2, 2], turn: 5 deg,
    velocity: [1 m/s, 0 m/s, 0 m/s]}
  other: {material: paper, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [2, 2],
    center: [0 mm, 0 mm, 9 mm]}
streams: {infeed: {of: note, every: pitch, count: 12, from: 5 ms, out: beyond x = far + 1 mm}}
planes: {floor: {center: [0 mm, 0 mm, -9 mm], normal: z, size: [200 mm, 200 mm, 1 mm], mass: 1 g}}
contacts: [{between: [infeed, floor], stiffness: 100 N/mm^1.5, friction: 0.1, smoothing: 10 mm/s}]
run: {duration: 900 ms}
""")


def stream(*sets: str) -> Scene:
    return loads(STREAM, "stream", list(sets))


def test_sheets_are_named_so_that_they_sort_and_come_in_at_their_times() -> None:
    model = mdlgen.lower(stream())
    assert [s.name for s in model.sheets] == [*(f"infeed_{k:02d}" for k in range(1, 13)), "other"]
    assert [s.enters for s in model.sheets[:12]] == pytest.approx([5.0 + 70.0 * k for k in range(12)])
    assert {s.out for s in model.sheets[:12]} == {((0, 201.0, 1.0),)}
    assert not model.sheets[12].passes
    given = stream("streams={infeed: {of: note, times: [0 ms, 3 ms, 2 ms], at: [1 mm, 2 mm, 3 mm]}}")
    assert [given.sheets[f"infeed_{k}"].enters for k in (1, 2, 3)] == [0.0, 3.0, 2.0]
    assert given.sheets["infeed_2"].center == (1.0, 2.0, 3.0)
    assert stream("parameters.pitch=10 ms").sheets["infeed_12"].enters == pytest.approx(115.0)


@pytest.mark.parametrize("name", ["infeed", "note", "infeed_*"])
def test_a_contact_means_all_of_a_stream(name: str) -> None:
    pairs = stream(f"contacts.0.between=['{name}', floor]").contact_pairs()
    assert [a for _, a, _ in pairs] == [f"infeed_{k:02d}" for k in range(1, 13)]


def test_sheets_of_a_stream_touch_where_they_are_asked_to() -> None:
    assert len(stream("contacts.0.between=[infeed, infeed]").contact_pairs()) == 66
    assert len(stream("contacts.0.between=[infeed_03, note]").contact_pairs()) == 11


CHANCE = ("streams.infeed.jitter=2 ms", "streams.infeed.skew=1 deg")


def test_chance_is_that_of_the_seed() -> None:
    def drawn(*sets: str) -> np.ndarray:
        sheets = list(stream(*CHANCE, *sets).sheets.values())[:-1]
        return np.array([[s.enters, math.degrees(s.turn or 0.0)] for s in sheets])

    plain, other = drawn(), drawn("streams.infeed.seed=2")
    assert np.array_equal(plain, drawn()) and (plain != other)[1:].all()
    late = plain[:, 0] - 5.0 - 70.0 * np.arange(12)
    # for one of 22 draws to be within 90 % in each case has the odds of 0.9^11
    assert late[0] == 0.0 and np.abs(late).max() <= 2.0 and np.ptp(late) > 1.0
    assert np.abs(plain[:, 1] - 5.0).max() <= 1.0 and np.ptp(plain[:, 1]) > 0.5
    # a longer stream has the same sheets first, and one is not drawn with the other
    assert np.array_equal(drawn("streams.infeed.count=30")[:12], plain)
    assert np.array_equal(drawn("streams.infeed.skew=0 deg")[:, 0], plain[:, 0])


def test_one_sheet_may_differ() -> None:
    scene = stream("sheets.infeed_03.mass=0.9 g", "sheets.infeed_07.enters=1 ms")
    assert [scene.sheets[f"infeed_0{k}"].mass for k in (2, 3)] == [0.72, 0.9]
    assert scene.sheets["infeed_07"].enters == 1.0


def test_a_dump_reads_as_the_same_scene() -> None:
    scene = stream(*CHANCE)
    again = Scene(**scene.model_dump(mode="json"))
    assert again.sheets == scene.sheets and again.contact_pairs() == scene.contact_pairs()
    assert loads(scene.to_yaml(), "again").sheets == scene.sheets


@pytest.mark.parametrize(
    "sets, said",
    [
        ("streams.infeed.times=[0 ms]", "every and times are given; give one of them"),
        ("streams={infeed: {of: note}}", "when do they come in? give every and count, times, or by_rule"),
        ("streams={infeed: {of: note, every: 3 ms}}", "how many are there? give count"),
        ("streams={infeed: {of: note, times: [0 ms], count: 2}}", "count is 2, and there are 1 times"),
        ("streams={infeed: {of: note, times: [0 ms], from: 2 ms}}", "from goes with every; leave it out"),
        ("streams.infeed.of=paper", "there is no sheet 'paper'"),
        ("streams.infeed.out=past x = 3 mm", "allowed: beyond x = 400 mm (or y, z), at rest"),
        ("streams.infeed.out=beyond x = 3 g", "g"),
        ("streams.infeed.out=beyond x = 0 mm", "so that no side is beyond it"),
        ("sheets.note.clamp={edge: x_min}", "leave clamp out, or all sheets of the stream would be"),
        ("run.analysis=static", "a static one has no time"),
        ("streams={infeed: {of: note, times: [3 ms], by_rule: true}}", "times and by_rule are given"),
    ],
)
def test_mistakes(sets: str, said: str) -> None:
    with pytest.raises(SpecError) as raised:
        stream(sets)
    assert said in str(raised.value) and "\n" not in str(raised.value)


@pytest.mark.parametrize("output", ["motionview", "motionsolve", "msolve"])
def test_texts_refuse_them_by_name(output: str) -> None:
    with pytest.raises(RefusedError, match="infeed_01 comes in at 5 ms, and MotionSolve makes no body"):
        mdlgen.emit(mdlgen.lower(stream()), output)
    # all there from the start, and none leaves: sheets as all others
    there = "streams={infeed: {of: note, times: [0 ms]}}"
    assert "infeed_1" in mdlgen.emit(mdlgen.lower(stream(there)), output)


def test_lints() -> None:
    near = ("streams.infeed.every=50 ms", "streams.infeed.count=30", "streams.infeed.out=beyond z = 500 mm")
    found = {lint.code: lint for lint in stream(*near).check() if lint.code in ("W178", "W179", "W180")}
    assert found["W178"].where == "sheets.infeed_02.enters"
    # 67 mm and the width of a turned sheet, at 1 mm/ms
    assert "50 ms after infeed_01, which is 50 mm on" in found["W178"].message
    assert "let it come in 78 ms after that" in found["W178"].remedy
    assert found["W179"].where == "sheets.infeed_19.enters"
    assert found["W180"].where == "sheets.infeed_01.out"
    # each is told once, of the first one
    plain = [lint for lint in stream("streams.infeed.every=90 ms").check() if "infeed" in str(lint)]
    assert not [lint for lint in plain if lint.code in ("W120", "W178", "W180")]
    waits = stream("streams={infeed: {of: note, by_rule: true, count: 3}}").check()
    assert [lint.where for lint in waits if lint.code == "W179"] == ["sheets.infeed_1.by_rule"]
