"""Parts of the user's own model in a scene: the spec, the tables, and who refuses them."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from external_scene import FOUR, SMALL, Run, commands, model_of

import mdlgen
import mdlgen.backends.motionview as motionview
from mdlgen import registry
from mdlgen.checks import lints
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.tables import EXTERNAL, ExternalPart


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    return commands(capsys, tmp_path, monkeypatch)


HOSTILE = [
    *('b" )\n*Include("evil.mdl', "b_feed )", "b_feed, b_other", "b feed", "*Body(", "b_feed.", ".b", "a..b"),
    *("b-1", "1b", "\u00e4", "", "a" * 64, ".".join("abcdefghijk"), "b_feed\n", "{x}", "`x`"),
]


@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.parametrize("key", ["body", "graphics"])
def test_nothing_typed_as_a_variable_becomes_a_statement(key: str, name: str) -> None:
    part = {"external": True, "body": "b_feed", "graphics": ["gra_feed"]}
    part[key] = [name] if key == "graphics" else name
    with pytest.raises(SpecError, match="is not a variable of a MotionView model"):
        model_of(f"parts.feed={json.dumps(part)}")


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("parts.feed={body: b_feed, graphics: [g]}", "the key 'external' is missing"),
        ("parts.feed.external=false", "write external: true"),
        ("parts.feed.external=1", "write external: true"),
        ("parts.feed.graphics=[]", "at least one name"),
        ("parts.feed.graphics=g", "at least one name"),
        ("parts.feed.graphics=[g, g]", "stands twice"),
        ("parts.feed.mass=1 g", "unknown key 'mass'"),
        ("parts.MOTOR={external: true, body: b, graphics: [g]}", "the name 'MOTOR' is used twice"),
        ("parts.lead={external: true, body: b, graphics: [g]}", "is used twice"),
        ("contacts.1.between=[note, fed]", "there is no part 'fed'"),
        ("contacts.1.between=[motor, feed]", "contact between motor and feed is not modelled"),
        ("contacts.1.between=[guide, feed]", "both are of the machine"),
        ("contacts.1.between=[note, feed]", "already has contacts.0"),
    ],
)
def test_what_a_part_cannot_be(override: str, words: str) -> None:
    with pytest.raises(SpecError) as error:
        model_of(override)
    assert words in str(error.value) and len(str(error.value).splitlines()) == 1


def test_schema_shows_parts() -> None:
    from mdlgen.spec.schema import json_schema

    part = json_schema()["$defs"]["Part"]
    assert set(part["required"]) == {"external", "body", "graphics"}
    assert part["properties"]["external"]["const"] is True


def test_externals_are_in_tables_of_their_own() -> None:
    model = model_of()
    guide = ExternalPart("guide", "MODEL.sys_guide.b_guide", ("sys_guide.gra_a", "sys_guide.gra_b"))
    assert model.externals == (ExternalPart("feed", "b_feed", ("gra_feed",)), guide)
    assert len(model.bodies.name) == 12 + 1
    rows = np.flatnonzero(model.contacts.kind == EXTERNAL)
    assert [model.contacts.part_b[row] for row in rows] == ["feed", "guide"]
    pairs = model.external_pairs
    assert len(pairs) == 24 and set(pairs.contact.tolist()) == set(rows.tolist())
    assert pairs.box.tolist() == [*range(12), *range(12)] and pairs.part.tolist() == [0] * 12 + [1] * 12


def test_a_sheet_that_meets_an_unknown_part_keeps_all_its_pairs() -> None:
    """What moves it is not known; without the contact most of its pairs are pruned."""
    assert len(model_of().pairs) == 12 and not np.isfinite(model_of().pairs.low[:12]).any()
    pruned = model_of("contacts=[{between: [note, motor], stiffness: 1 N/mm^1.5, friction: 0}]")
    assert 0 < len(pruned.pairs) < 12 and len(pruned.external_pairs) == 0


def test_lints_know_parts() -> None:
    turned = "contacts.1.friction=0.5"  # without it nothing turns the roller (W126)
    assert not lints(model_of(turned))
    idle = lints(model_of("contacts.0.between=[note, feed]", turned))
    assert [(x.code, x.where) for x in idle] == [("W111", "parts.guide")]
    assert not [x for x in lints(model_of("run.analysis=static")) if x.code == "W110"]


@pytest.mark.parametrize("command", [("run", "feed.yaml"), ("mdl", "feed.yaml")])
def test_a_scene_with_externals_is_refused_by_name_and_place(
    cli: Run, tmp_path: Path, command: tuple[str, ...]
) -> None:
    ended = cli(*command)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.startswith("feed.yaml:9:9: parts.feed: ") and "--only sheets" in ended.err
    assert len(ended.err.splitlines()) == 1
    assert [p.name for p in tmp_path.iterdir()] == ["feed.yaml"]


def test_solvers_refuse_it_by_themselves(monkeypatch: pytest.MonkeyPatch) -> None:
    from mdlgen.backends import exudyn_local

    model = model_of()
    with pytest.raises(RefusedError, match="Exudyn: feed is the body b_feed"):
        exudyn_local.solve(model)
    monkeypatch.setattr(registry, "solver", lambda name: pytest.fail("a solver was asked"))
    with pytest.raises(RefusedError, match="local run: feed is the body b_feed"):
        mdlgen.solve(model)
    with pytest.raises(RefusedError, match="whole scene: feed"):
        motionview.check(model)


def test_check_counts_and_shows_parts(cli: Run) -> None:
    record = json.loads(cli("check", "feed.yaml", "--json").out)
    assert record["pairs"]["external"] == 24
    assert record["external_parts"]["feed"] == {"body": "b_feed", "graphics": ["gra_feed"]}
    shown = cli("check", "feed.yaml").out
    assert "external parts: feed (b_feed), guide (MODEL.sys_guide.b_guide); 24 pairs of bodies" in shown
    assert "external parts" not in cli("check", FOUR).out


def test_it_loads_no_solver() -> None:
    code = (
        "import sys, mdlgen, mdlgen.backends.motionview as m\n"
        f"model = mdlgen.lower(mdlgen.load({str(FOUR)!r}, ['{SMALL}']))\n"
        "m.emit(model, only='sheets'), m.companion(model, only='sheets')\n"
        "assert not {'scipy', 'numba', 'exudyn'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
