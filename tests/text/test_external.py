"""Sheets for a machine that stands in the user's own model: parts, the system definition, the way back."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from golden import compare
from places import GOLDEN

import mdlgen
import mdlgen.backends.motionview as motionview
from mdlgen import registry
from mdlgen.backends.motionview.reader import lint, read
from mdlgen.checks import lints
from mdlgen.cli import app
from mdlgen.errors import RefusedError, SpecError
from mdlgen.model.tables import EXTERNAL, ExternalPart, Model
from mdlgen.paths import samples

SYSTEMS = GOLDEN / "systems"
FOUR = samples() / "transport_4x4.yaml"
SMALL = "sheets.note.boxes=[2,3]"
SCENE = """\
name: feed
materials:
  eur10: {E_md: 3530 MPa, E_cd: 1113 MPa, k_tx: 0.15 N*mm/rad, k_ty: 0.185 N*mm/rad}
sheets:
  note: {material: eur10, size: [67 mm, 127 mm], thickness: 0.1 mm, mass: 0.72 g, boxes: [3, 4]}
rollers:
  motor: {center: [0 mm, 0 mm, 15.05 mm], axis: y, radius: 15 mm, width: 5 mm, mass: 0.88 g}
parts:
  feed: {external: true, body: b_feed, graphics: [gra_feed]}
  guide: {external: true, body: MODEL.sys_guide.b_guide, graphics: [sys_guide.gra_a, sys_guide.gra_b]}
contacts:
  - {between: [note, "*e*"], stiffness: 300 N/mm^1.5, friction: 1.0}
  - {between: [note, motor], stiffness: 100 N/mm^1.5, friction: 0}
probes:
  lead: {sheet: note, at: [33.5 mm, 0 mm]}
run: {duration: 5 ms}
"""


def model_of(*overrides: str) -> Model:
    return mdlgen.lower(mdlgen.loads(SCENE, overrides))


def sheets_of(model: Model) -> str:
    return motionview.emit(model, only="sheets")


def counts(text: str) -> Counter[str]:
    return Counter(s.name for s in read(text).program.statements)


# ---------------------------------------------------------------- spec


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


# ---------------------------------------------------------------- model


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


# ---------------------------------------------------------------- who refuses


class Ended(NamedTuple):
    code: int
    out: str
    err: str


Run = Callable[..., Ended]


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command in a folder that holds the scene alone."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "feed.yaml").write_text(SCENE)

    def run(*args: object) -> Ended:
        with pytest.raises(SystemExit) as ended:
            app([str(a) for a in args], prog_name="mdlgen")
        code = ended.value.code
        assert isinstance(code, int)
        return Ended(code, *capsys.readouterr())

    return run


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


# ---------------------------------------------------------------- the system definition


def test_statements_of_the_definition() -> None:
    text = sheets_of(model_of())
    found = counts(text)
    assert found["DefineSystem"] == 1 and found["Attachment"] == 2 + 2 + 3
    assert found["Body"] == found["Graphic"] == 12
    # two bushings for each of 2 x 4 joints along x and 3 x 3 along y
    assert found["Bush"] == found["SetBush"] == 2 * (2 * 4 + 3 * 3)
    assert found["Contact"] == 12 * 3 and found["Output"] == 1
    assert found["DataSet"] == found["DefineDataSet"] == 1 + 2 + 1
    assert not set(found) & {"BeginMDL", "System", "Template", "StandardInclude", "RevJoint", "Motion"}
    order = [s.name for s in read(text).program.statements]
    # the context of a data set's definition is the model, not a system
    assert order.index("EndDefine") < order.index("DefineDataSet")


def test_attachments_are_the_parts_that_sheets_meet() -> None:
    text = sheets_of(model_of())
    begin = text[text.index("\n*DefineSystem") :]
    assert begin.startswith(
        "\n*DefineSystem( def_sys_feed\n"
        "             , b_motor_att\n"
        "             , gra_motor_att\n"
        "             , b_feed_att\n"
        "             , gra_feed_att\n"
        "             , b_guide_att\n"
        "             , gra_guide_att_0\n"
        "             , gra_guide_att_1 )\n"
    )
    words = 'b_guide_att, "Body of guide", Body, "Select attachment.", MODEL.sys_guide.b_guide, '
    assert f"\n  *Attachment( {words} )\n" in begin
    assert "BODY, b_guide_att, 2, gra_guide_att_0, false, gra_guide_att_1, false )" in begin
    pasted = next(x for x in text.splitlines() if "*System(" in x)
    assert pasted == (
        '//   *System( sys_feed, "feed", def_sys_feed, b_motor, gcyl_motor, b_feed, gra_feed, '
        "MODEL.sys_guide.b_guide, sys_guide.gra_a, sys_guide.gra_b )"
    )


def test_contacts_of_the_machine_itself_are_left_out() -> None:
    model = mdlgen.lower(mdlgen.load(FOUR, [SMALL]))
    text = sheets_of(model)
    found = counts(text)
    assert found["Attachment"] == 2 * (8 + 1) and found["Body"] == 6
    assert found["Contact"] == len(model.pairs) - 4
    head = text[: text.index("\n*DefineSystem")]
    assert "//   motor_1_left / counter_1_left\n" in head
    assert all(line.startswith("//") for line in head.splitlines())
    assert text.isascii() and text.endswith("\n") and "\n\n\n" not in text


def test_a_sheet_that_meets_nothing_has_no_attachments() -> None:
    text = sheets_of(mdlgen.lower(mdlgen.load(samples() / "cantilever.yaml", [SMALL])))
    assert "*DefineSystem( def_sys_cantilever )\n" in text
    assert lint(text).findings == ()


def test_loads_and_taken_names_are_refused() -> None:
    load = "loads=[{sheet: note, edge: x_max, force: [1 N, 0 N, 0 N]}]"
    with pytest.raises(RefusedError, match="loads are not written"):
        sheets_of(model_of(load))
    with pytest.raises(SpecError, match="sys_misc"):
        sheets_of(model_of("name=misc"))
    with pytest.raises(SpecError, match="cannot be written alone"):
        motionview.emit(model_of(), only="rollers")


# ---------------------------------------------------------------- what the text means


TURNED = ('sheets.note.turn="10 deg"', 'sheets.note.velocity=["1 m/s", "0.2 m/s", "0 m/s"]',
          'sheets.note.spin=["0 rad/s", "0 rad/s", "3 rad/s"]')  # fmt: skip
ROTATED = ('sheets.note.rotation=["5 deg", "-3 deg", "20 deg"]', "sheets.note.surface=true", *TURNED[1:])
HELD = ("sheets.note.clamp={edge: y_min}", "supports=[{sheet: note, at: [33.5 mm, 63.5 mm], fix: [z]}]")


def host_of(model: Model, include: str) -> str:
    """A model of the user's with the machine's bodies, each with its graphics."""
    lines = ['*BeginMDL( host, "Host" )', "  *StandardInclude(FILE)", f"  {include}"]
    given = []
    for part in [*model.rollers, *model.planes]:
        body, graphic = f"b_{part.name}", f"{'gcyl' if part in model.rollers else 'gbox'}_{part.name}"
        given += [body, graphic]
        lines += [
            f'  *Body( {body}, "{part.name}", P_Global_Origin, , , ,  )',
            f"  *SetBodyInertia( {body}, 1, 1, 1, 1 )",
            f'  *Graphic( {graphic}, "{part.name}", SPHERE, {body}, P_Global_Origin, 5, 3 )',
        ]
    name = model.name
    lines += [f'  *System( sys_{name}, "Mine", def_sys_{name}, {", ".join(given)} )', "*EndMDL()", ""]
    return "\n".join(lines)


def inside(values: dict[str, dict[str, Any]], system: str) -> dict[str, dict[str, Any]]:
    """What lies in a system, by kind, under the names that it has there."""

    def plain(value: Any) -> Any:
        if isinstance(value, str):
            return value.replace(f"{system}.", "") if system else value
        if isinstance(value, (tuple, list)):
            return [plain(v) for v in value]
        if isinstance(value, dict):  # what is an argument of a system is a name of its own only there
            return {k: plain(v) for k, v in value.items() if k != "attachments"}
        return value

    return {
        kind: {plain(n): plain(v) for n, v in found.items() if n.startswith(system)}
        for kind, found in values.items()
    }


@pytest.mark.parametrize("changes", [(), TURNED, ROTATED, HELD], ids=["plain", "turned", "rotated", "held"])
@pytest.mark.parametrize("set_contact", [False, True])
def test_the_definition_means_what_the_whole_text_means(changes: tuple[str, ...], set_contact: bool) -> None:
    model = mdlgen.lower(mdlgen.load(FOUR, [SMALL, *changes]))
    whole = inside(read(motionview.emit(model, set_contact=set_contact)).values, "")
    text = motionview.emit(model, set_contact=set_contact, only="sheets")
    host = host_of(model, text[text.index("*DefineSystem") :])
    assert lint(host).findings == ()
    for found in (read(text).values, read(host).values):
        system = inside(found, f"sys_{model.name}")
        for kind, records in system.items():
            for name, record in records.items():
                assert record == whole[kind][name.lstrip(".")], (kind, name)
        assert len(system["bushings"]) == len(model.bushings)
        assert len(system["bodies"]) == 6 and len(system["contacts"]) == len(model.pairs) - 4
        sheet_points = {n for n in whole["points"] if n.startswith(("p_note", "p_probe", "p_support_"))}
        assert set(system["points"]) == sheet_points


def test_two_notes_in_one_machine_do_not_meet() -> None:
    texts = [sheets_of(model_of(f"name={name}")) for name in ("one", "two")]
    bare = "\n".join(t[t.index("*DefineSystem") :] for t in texts)
    host = f'*BeginMDL( host, "Host" )\n*StandardInclude(FILE)\n{bare}*EndMDL()\n'
    assert {f.code for f in lint(host).findings} == {"external"}
    assert len(read(host).values["bushings"]) == 2 * 34


# ---------------------------------------------------------------- lint


def test_lint_of_the_definition_names_what_is_external(cli: Run, tmp_path: Path) -> None:
    assert cli("mdl", "feed.yaml", "--only", "sheets").code == 0
    assert {p.name for p in tmp_path.iterdir()} == {"feed.yaml", "feed_sheets.mdl", "feed_sheets_mview.py"}
    ended = cli("lint", "feed_sheets.mdl", "--values", "v.json")
    assert ended.code == 0 and "0 errors, 7 warnings" in ended.out
    findings = lint((tmp_path / "feed_sheets.mdl").read_text()).findings
    declared = ["b_motor", "gcyl_motor", *GIVEN.split(", ")]
    assert [f.code for f in findings] == ["external"] * 7
    assert [f.message.split(" is external")[0].split()[-1] for f in findings] == declared
    contact = json.loads((tmp_path / "v.json").read_text())["contacts"]["sys_feed.con_note_0_0_feed"]
    assert contact["bodies"] == ["sys_feed.b_note_0_0", "b_feed"] and contact["graphics"][1] == ["gra_feed"]


def test_lint_in_a_model_without_an_instance() -> None:
    text = sheets_of(model_of())
    model = f'*BeginMDL( m, "m" )\n*StandardInclude(FILE)\n{text[text.index("*DefineSystem") :]}*EndMDL()\n'
    assert [f.code for f in lint(model).findings] == ["external"] * 7


def part_of(instance: str, begin: str = "", end: str = "") -> str:
    text = sheets_of(model_of("contacts.0.between=[note, feed]", "contacts.1.between=[note, guide]"))
    return f"{begin}{text[text.index('*DefineSystem') :]}{instance}\n{end}"


GIVEN = "b_feed, gra_feed, MODEL.sys_guide.b_guide, sys_guide.gra_a, sys_guide.gra_b"


def test_an_instance_may_name_what_the_text_declares() -> None:
    text = part_of(f'*System( sys_note, "Note", def_sys_feed, {GIVEN} )')
    assert [f.code for f in lint(text).findings] == ["external"] * 5
    found = read(text).values["contacts"]["sys_note.con_note_0_0_feed"]
    assert found["bodies"] == ("sys_note.b_note_0_0", "b_feed")


@pytest.mark.parametrize(("begin", "end"), [("", ""), ('*BeginMDL( m, "m" )\n', "*EndMDL()\n")])
def test_a_mistyped_name_stays_an_error(begin: str, end: str) -> None:
    mistyped = GIVEN.replace("b_feed", "b_fed")
    report = lint(part_of(f'*System( sys_note, "Note", def_sys_feed, {mistyped} )', begin, end))
    assert any(f.code == "dangling" and "b_fed" in f.message for f in report.errors)


def test_a_name_that_a_whole_model_lacks_stays_an_error() -> None:
    """Also where the attachment has the same default: a saved model has its own names there."""
    instance = f'*System( sys_note, "Note", def_sys_feed, {GIVEN} )'
    report = lint(part_of(instance, '*BeginMDL( m, "m" )\n', "*EndMDL()\n"))
    assert any("there is no b_feed" in f.message for f in report.errors)


def test_what_is_asked_of_an_external_thing_is_one_warning() -> None:
    text = """\
*DefineSystem( def_a, p_att, m_att, b_att, ground, pair, any )
  *Attachment( p_att, "P", Point, "Select attachment.", ,  )
  *Attachment( m_att, "M", Marker, "Select attachment.", ,  )
  *Attachment( b_att, "B", Body, "Select attachment.", ,  )
  *Attachment( ground, "G", Body, "Select attachment.", B_Ground,  )
  *Attachment( pair, "Q", bodypair, "Select attachment.", ,  )
  *Point( p, "p" )
  *SetPoint( p, p_att.x+1, p_att.y, 0 )
  *Marker( k, "k", b_att, p_att )
  *SetOrientation( b_att.cm, ONEAXIS, Z, VECTOR, V_Global_X )
  *Bush( s, "s", b_att, ground, P_Global_Origin )
  *SetBush( s, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1, LIN, 1
          , 0, 0, 0, 0, 0, 0 )
  *Bush( u, "u", pair.l, ground, p )
  *Marker( n, "n", any, p )
  *Output( o, "o", EXPR, `DX({b_att.cm.idstring},{m_att.idstring})`, `0`, `0`, `0`, `0`, `0` )
*EndDefine()
"""
    report = lint(text)
    assert not report.errors
    external = [f for f in report.findings if "is external" in f.message]
    assert [f.place.line for f in external] == [1, 2, 3, 4, 6]
    assert read(text).values["bushings"]["a.s"]["bodies"] == ("b_att", "B_Ground")


# ---------------------------------------------------------------- the user's model and the script


def test_a_host_model_includes_the_definition(cli: Run, tmp_path: Path) -> None:
    model = mdlgen.lower(mdlgen.load(FOUR, [SMALL]))
    assert cli("mdl", FOUR, "--set", SMALL, "--only", "sheets", "-o", "note_sheets.mdl").code == 0
    (tmp_path / "host.mdl").write_text(host_of(model, '*Include("note_sheets.mdl")'))
    ended = cli("lint", "host.mdl", "--values", "host.json")
    assert (ended.code, ended.out.count("0 errors, 0 warnings")) == (0, 1)
    found = json.loads((tmp_path / "host.json").read_text())
    assert "sys_transport_4x4.b_note_0_0" in found["bodies"] and len(found["bushings"]) == 14


def test_only_takes_sheets(cli: Run, tmp_path: Path) -> None:
    ended = cli("mdl", "feed.yaml", "--only", "rollers")
    assert (ended.code, ended.err) == (2, "'rollers' cannot be written alone; there is: sheets\n")
    assert [p.name for p in tmp_path.iterdir()] == ["feed.yaml"]
    assert "NAME_sheets.mdl" in " ".join(cli("mdl", "--help").out.split())


def run_script(script: str, system: str | None = None) -> dict[str, dict[str, float]]:
    """Runs a companion with a stand-in for MotionView; numbers by path."""
    tree = ast.parse(script)
    if system is not None:
        constants = (n for n in tree.body if isinstance(n, ast.Assign))
        constant = next(n for n in constants if ast.unparse(n.targets) == "SYSTEM")
        constant.value = ast.Constant(system)
    tree.body = [n for n in tree.body if not (isinstance(n, ast.ImportFrom) and n.module == "hw")]
    found: dict[str, dict[str, float]] = {}

    class Entity:
        def __init__(self, path: str):
            self._path = path

        def __getattr__(self, name: str) -> Entity:
            return Entity(f"{self._path}.{name}".lstrip("."))

        def setValues(self, **numbers: float) -> None:
            found[self._path] = numbers

    mview = type("mview", (), {"getModel": staticmethod(lambda: Entity(""))})
    space = {"mview": mview, "print": lambda *a: None}
    exec(compile(ast.fix_missing_locations(tree), "companion", "exec"), space)
    return found


def test_the_script_reaches_into_the_system() -> None:
    model = model_of('gravity=["0 m/s^2", "0 m/s^2", "0 m/s^2"]')
    assert len(motionview.companion_reasons(model, only="sheets")) == 1
    script = motionview.companion(model, only="sheets") or ""
    assert 'SYSTEM = "sys_feed"  #' in script and "gravity.x" not in script
    numbers = run_script(script)
    contacts = read(sheets_of(model)).values["contacts"]
    assert set(numbers) == set(contacts)
    assert numbers["sys_feed.con_note_0_0_guide"]["penalty"] == 300.0
    smooth = {"penalty": 100.0, "rest_coeff": 0.5, "normal_trans_vel": 1.0}
    assert numbers["sys_feed.con_note_0_0_motor"] == smooth
    moved = run_script(script, "sys_paper.sys_mine")
    assert "sys_paper.sys_mine.con_note_2_3_feed" in moved and len(moved) == len(numbers)
    assert motionview.companion(model, set_contact=True, only="sheets") is None


def test_it_loads_no_solver() -> None:
    code = (
        "import sys, mdlgen, mdlgen.backends.motionview as m\n"
        f"model = mdlgen.lower(mdlgen.load({str(FOUR)!r}, ['{SMALL}']))\n"
        "m.emit(model, only='sheets'), m.companion(model, only='sheets')\n"
        "assert not {'scipy', 'numba', 'exudyn'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


GOLDENS = {
    "feed_sheets.mdl": model_of,
    "transport_4x4_2x3_sheets.mdl": lambda: mdlgen.lower(mdlgen.load(FOUR, [SMALL])),
}


@pytest.mark.parametrize("name", sorted(GOLDENS))
def test_golden(name: str) -> None:
    compare(sheets_of(GOLDENS[name]()), SYSTEMS / name)
