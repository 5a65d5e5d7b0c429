"""The system definition of the sheets in the user's own model: lint, includes, the script."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import pytest
from external_scene import FOUR, SMALL, Run, commands, host_of, model_of, sheets_of

import mdlgen
import mdlgen.backends.motionview as motionview
from mdlgen.backends.motionview.reader import lint, read


@pytest.fixture
def cli(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    return commands(capsys, tmp_path, monkeypatch)


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
    assert numbers["sys_feed.con_note_0_0_motor"] == smooth | {"force_loc": "NODE"}
    moved = run_script(script, "sys_paper.sys_mine")
    assert "sys_paper.sys_mine.con_note_2_3_feed" in moved and len(moved) == len(numbers)
    assert motionview.companion(model, set_contact=True, only="sheets") is None
