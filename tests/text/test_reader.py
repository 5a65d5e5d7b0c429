"""The reader of MDL: what our own texts and samples hold, long texts, hostile ones."""

from __future__ import annotations

import json
import re
import time
from pathlib import Path

import pytest
from places import GOLDEN
from readings import model
from unsaid import UNSAID

import mdlgen
from mdlgen.backends.motionview.reader import Report, lint, read, values
from mdlgen.errors import SpecError
from mdlgen.paths import samples


@pytest.mark.parametrize("file", sorted(GOLDEN.glob("*.mdl")), ids=lambda f: f.name)
def test_golden_texts_read_clean(file: Path) -> None:
    report: Report = lint(file.read_text(), file.name)
    assert not report.findings, [str(f) for f in report.findings[:5]]


@pytest.mark.parametrize(
    "sample", sorted(p.relative_to(samples()) for p in samples().rglob("*.yaml")), ids=str
)
def test_sample_texts_read_clean(sample: Path) -> None:
    overrides = (
        ["sheets.note.boxes=[2,3]"] if str(sample).startswith("transport") else UNSAID.get(sample.stem, ())
    )
    lowered = mdlgen.lower(mdlgen.load(samples() / sample, overrides=overrides))
    reading = read(mdlgen.emit(lowered, "motionview"), sample.name)
    found = reading.values
    assert not reading.report.errors
    arms = sum(roller.arm is not None for roller in lowered.rollers)  # whose springs are bushings, too
    assert len(found["bushings"]) == len(lowered.bushings) + arms
    assert json.loads(json.dumps(found, allow_nan=False))
    places = dict(zip((f"b_{n}" for n in lowered.bodies.name), lowered.bodies.position, strict=True))
    for name, body in found["bodies"].items():
        if name in places:
            assert body["cm"] == pytest.approx(places[name], rel=1e-12, abs=1e-12)


def chain(count: int, back: bool) -> str:
    """Points, each one from its neighbour."""
    points = (
        f'*Point( p{k}, "p" )\n*SetPoint( p{k}, '
        + (f"p{k + (1 if back else -1)}.x+1" if k != (count - 1 if back else 0) else "0")
        + ", 0, 0 )"
        for k in range(count)
    )
    return model(*points)


@pytest.mark.parametrize("back", [False, True])
def test_a_chain_may_be_as_long_as_the_file(back: bool) -> None:
    found = values(chain(5000, back))["points"]
    assert max(p[0] for p in found.values()) == 4999


def test_a_circle_is_reported_once_however_long() -> None:
    ring = (f'*Point( p{k}, "p" )\n*SetPoint( p{k}, p{(k + 1) % 3000}.x, 0, 0 )' for k in range(3000))
    (error,) = lint(model(*ring)).errors
    assert error.code == "cycle"


HOSTILE = {
    "nothing": "",
    "no model": '*Point( p, "p" )',
    "zero bytes": "\0" * 100,
    "deep parentheses": model('*Point( p, "p" )', f"*SetPoint( p, {'(' * 9999}1{')' * 9999}, 0, 0 )"),
    "open parentheses": model(f"*SetPoint( p, {'(' * 9999}"),
    "dots": model('*Point( p, "p" )', f"*SetPoint( p, p{'.x' * 9999}, 0, 0 )"),
    "signs": model('*Point( p, "p" )', f"*SetPoint( p, {'-' * 9999}1, 0, 0 )"),
    "powers": model('*Point( p, "p" )', "*SetPoint( p, 9^9^9^9, 0, 0 )"),
    "open text": model('*Point( p, "p )', '*Point( q, "q" )'),
    "open definitions": model(*["*DefineSystem( d )"] * 999),
    "a system in itself": model(
        "*DefineSystem( d )", '*System( s, "s", d )', "*EndDefine()", '*System( t, "", d )'
    ),
    "attachments in a circle": model(
        "*DefineSystem( d, a )",
        '*Attachment( a, "a", Point, "", ,  )',
        '*Point( q, "q" )',
        "*SetPoint( q, a.x, 0, 0 )",
        "*EndDefine()",
        '*System( s1, "s", d, s2.a )',
        '*System( s2, "s", d, s1.a )',
    ),
    "empty arguments": model(
        "*Point( )", '*Body( b )', '*Graphic( g, "g", BOX )', '*Bush( b2, "b", , , )', '*Motion( m1, "x" )',
        '*RevJoint( j, "j", , , , POINT, )', '*Table( t, "" )', "*Set( )", '*PolyBeam( pb, "" )',
    ),
    "wrong kinds": model(
        '*Point( p, "p" )', '*Body( b, "b", b )', '*Marker( k, "k", p, b )',
        '*Graphic( g, "g", CYLINDER, p, b, VECTOR, k, "x", g.r2, {1,2}, 0, CAPBOTH, 3 )',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_texts_give_lines_not_tracebacks(name: str) -> None:
    report = lint(HOSTILE[name], "h.mdl")
    assert report.errors
    for finding in report.findings:
        assert re.match(r"h\.mdl:\d+:\d+: (error|warning): .+ \[[a-z-]+\]\Z", str(finding))


def test_definitions_that_multiply_are_refused() -> None:
    lines = []
    for k in range(9):
        inner = [f'*System( s{j}, "s", d{k + 1} )' for j in range(10)]
        lines += [f"*DefineSystem( d{k} )", *inner, "*EndDefine()"]
    with pytest.raises(SpecError, match=r"h\.mdl:\d+:\d+: the definitions"):
        read(model(*lines, '*System( s, "s", d0 )'), "h.mdl")


def big(boxes: int) -> str:
    """Boxes in a row with a bushing between neighbours, ten lines each."""
    head = (
        "*DefineDataSet( def_d )",
        '*Real( d, "d", EDIT )',
        '*Real( k, "k", EDIT )',
        "*EndDefine()",
        '*DataSet( ds, "ds", def_d )',
        "*SetReal( ds.d, 0.5 )",
        "*SetReal( ds.k, 100 )",
    )
    law = ", ".join(["LIN, ds.k.value"] * 12)
    rows = (
        f'*Point( p_{k}, "Box {k}" )\n'
        f"*SetPoint( p_{k}, loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[0]\n"
        f"         , loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[1]\n"
        f"         , loc_rel_to( {{{k}*ds.d.value, 0, 0}}, Global_Frame )[2] )\n"
        f'*Body( b_{k}, "Box {k}", p_{k}, , , ,  )\n'
        f"*SetBodyInertia( b_{k}, ds.d.value^3, ds.d.value, ds.d.value, ds.d.value, 0, 0, 0 )\n"
        f'*Graphic( g_{k}, "Box {k}", BOX, b_{k}, CENTER, p_{k}, ZX, VECTOR, Global_Frame.zaxis\n'
        "        , VECTOR, Global_Frame.xaxis, ds.d.value, ds.d.value, ds.d.value, 3 )\n"
        f'*Bush( bsh_{k}, "Bush {k}", b_{k}, {f"b_{k - 1}" if k else "B_Ground"}, p_{k} )\n'
        f"*SetBush( bsh_{k}, {law}, 0, 0, 0, 0, 0, 0 )"
        for k in range(boxes)
    )
    return model(*head, *rows)


def time_to_read(boxes: int) -> float:
    text = big(boxes)
    begun = time.process_time()
    reading = read(text)
    found, report = reading.values, reading.report
    taken = time.process_time() - begun
    assert not report.findings
    assert len(found["bushings"]) == boxes
    assert found["points"][f"p_{boxes - 1}"] == ((boxes - 1) * 0.5, 0, 0)
    return taken


def test_large_texts_in_linear_time() -> None:
    time_to_read(200)
    small, large = time_to_read(1500), time_to_read(12_000)
    # 8 times the boxes in 8 times the time; what is not linear would take 64 times
    assert large / small < 16
