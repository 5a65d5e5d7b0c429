"""What lint says: one small text for each finding, and silence where there is nothing to say."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mdlgen.backends.motionview.reader import lint
from mdlgen.cli import app

STANDARD = "*StandardInclude(FILE)"
HEAD = (
    '*Point( p, "p" )',
    "*SetPoint( p, 0, 0, 0 )",
    '*Body( b, "b", p, , , ,  )',
    "*SetBodyInertia( b, 1, 1, 1, 1, 0, 0, 0 )",
)
ROLLER = (
    *HEAD,
    '*RevJoint( j, "j", b, B_Ground, p, VECTOR, V_Global_Y )',
)
CYLINDER = '*Graphic( g, "g", CYLINDER, b, p, VECTOR, V_Global_Y, 5, g.r1, 10, {}, CAPBOTH, 3 )'
MARKER = '*Marker( k, "k", b, p )'
BUSH = '*Bush( bsh, "bsh", b, B_Ground, p )'
LAW = "*SetBush( bsh, {}, 0, 0, 0, 0, 0, 0 )"


def law(*numbers: float) -> str:
    return LAW.format(", ".join(f"LIN, {n}" for n in numbers))


def text_of(*statements: str) -> str:
    return "\n".join(('*BeginMDL( m, "m" )', *statements, STANDARD, "*EndMDL()", ""))


def test_nothing_to_say() -> None:
    text = text_of(*ROLLER, CYLINDER.format("-10/2"), BUSH, law(*range(1, 13)))
    assert lint(text).findings == ()


@pytest.mark.parametrize(
    ("statements", "code", "severity", "line", "words"),
    [
        # how many arguments
        (('*Point( p, "p", 1 )',), "arity", "error", 2, "takes 2 arguments, not 3"),
        ((*HEAD, BUSH, law(*range(11))), "arity", "error", 7, "number 12 of 12"),
        ((*HEAD, BUSH, law(*range(13))), "arity", "error", 7, "takes 31 arguments, not 33"),
        ((*HEAD, '*Graphic( g, "g", SPHERE, b, p, 5 )'), "arity", "error", 6, "SPHERE takes 7"),
        ((*HEAD, '*Graphic( g, "g", BOX, b, MIDDLE, p, 1 )'), "arity", "error", 6, "CENTER, CORNER or FACE"),
        ((*HEAD, '*Output( o, "o", EXPR, `0` )'), "arity", "error", 6, "takes 9 arguments"),
        ((*HEAD, "*SetOrientation( b.cm, ONEAXIS, Z, POINT, p, p )"),
         "arity", "error", 6, "takes 5 arguments"),
        (('*Option( o, "o", 3, "a", "b" )',), "arity", "error", 2, "3 choices"),
        # names
        (('*Bushing( a, "a" )',), "unknown", "warning", 2, "meant is *Bush"),
        (("*SetPoint( q, 0, 0, 0 )",), "dangling", "error", 2, "there is no q to set"),
        (('*Body( c, "c", q )',), "dangling", "error", 2, "there is no q"),
        (('*Body( c, "c", p_global_origin )',), "dangling", "error", 2, "there is no p_global_origin"),
        ((*HEAD, '*Marker( k, "k", B, p )'), "dangling", "error", 6, "case sensitive: b?"),
        ((*HEAD, '*Point( p, "again" )'), "duplicate", "error", 6, "from line 2"),
        (("*DefineDataSet( d )", "*EndDefine()", "*DefineDataSet( d )", "*EndDefine()"),
         "duplicate", "error", 4,
         "first in line 2"),
        ((*HEAD, '*Output( o, "o", EXPR, `DX({x.idstring})`, `0`, `0`, `0`, `0`, `0` )'),
         "dangling", "error", 6,
         "there is no x"),
        ((*HEAD, '*Marker( k, "k", p, p )'), "kind", "error", 6, "a Body is due"),
        ((*HEAD, '*Point( q, "q" )', "*SetPoint( q, p.w, 0, 0 )"), "property", "error", 7, "no property w"),
        (('*Point( q, "q" )', "*SetPoint( q, 0, 0, 0 )"), "unused", "warning", 2, "q is used by nothing"),
        (("*DefineDataSet( d )", "*EndDefine()"), "unused", "warning", 2, "definition d"),
        # blocks and bytes
        (("*endif()",), "block", "error", 2, "closes no *if"),
        (("*if( 1 )",), "block", "error", 2, "*if is not closed"),
        (("// note",), "comment", "warning", 2, "before *BeginMDL it is safe"),
        (("here",), "syntax", "error", 2, "a statement"),
        (('*Point( q, "q"',), "syntax", "error", 2, "no closing parenthesis"),
        ((*HEAD, '*Marker( k, "\u00e9", b, p )'), "ascii", "warning", 6, "plain ASCII"),
        (('*SetNote( b, "a\r\n" )',), "ascii", "warning", 2, "LF"),
        (('*SetNote( b, "a\0" )',), "control", "warning", 2, "control character (0)"),
        (("// note", "here"), "syntax", "error", 3, "a statement"),
        # what no value acts on
        ((*HEAD, "*Set( b.mass, 5 )"), "unread", "warning", 6, "what *Set of b.mass does is not known"),
        ((*HEAD, "*Set( b.usecm, false )"), "unread", "warning", 6, "b.usecm"),
        ((*HEAD, "*SetReal( b.mass, 5 )"), "unread", "warning", 6, "b.mass"),
        ((*HEAD, "*SetPoint( b, 1, 2, 3 )"), "unread", "warning", 6, "*SetPoint of b"),
        ((*HEAD, BUSH, law(*range(1, 13)), "*Set( bsh.kx, 5 )"), "unread", "warning", 8, "bsh.kx"),
        ((*HEAD, "*SetOrientation( b.im, ONEAXIS, Z, VECTOR, V_Global_X )"), "unread", "warning", 6, "b.im"),
        # values
        (('*Body( c, "c", P_Global_Origin )',), "mass", "warning", 2, "has no mass"),
        ((*HEAD, "*Set( b.inertia_props_from_graphic, true )", CYLINDER.format(-5)), "mass", "warning", 4,
         "are not used"),
        ((*HEAD[:3], "*SetBodyInertia( b, 1, 1, 1, 3 )"), "inertia", "warning", 4, "no body can have"),
        ((*HEAD[:3], "*SetBodyInertia( b, -1, 1, 1, 1 )"), "mass", "error", 4, "negative"),
        ((*HEAD, '*Point( q, "q" )', '*Marker( k, "k", b, q )'), "unset", "warning", 6, "never set"),
        ((*HEAD, MARKER, "*SetOrientation( k, TWOAXES, ZX, DXDYDZ, 0, 0, 1, DXDYDZ, 0, 0, 2 )"),
         "direction", "error", 7, "parallel"),
        ((*HEAD, '*Marker( k, "k", b, p )', "*SetOrientation( k, ONEAXIS, Z, POINT, p )"),
         "direction", "error", 7,
         "no length"),
        # traps
        ((*HEAD[:3], "*SetBodyInertia( b, 2+sin(90), 1, 1, 1 )"),
         "angle", "warning", 5, "degrees need *PI/180"),
        ((*HEAD, MARKER, "*SetOrientation( k, ANGLES, Global_Frame, PI/2, 0, 0 )"), "angle", "warning",
         7, "look like radians"),
        ((*HEAD, BUSH, law(1, 1, 1, 1, 1, 1, 0, 0, 0, 9, 9, 9)), "bushing", "warning", 7, "the order is"),
        ((*HEAD, BUSH, law(0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0)),
         "bushing", "warning", 7, "no stiffness at all"),
        ((*HEAD, BUSH, law(-1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1)), "bushing", "error", 7, "negative"),
        ((*HEAD, BUSH), "unset", "warning", 6, "has no *SetBush"),
        ((*ROLLER, CYLINDER.format(0)), "offset", "warning", 7, "-length/2"),
        ((*HEAD, CYLINDER.format(-5).replace("CAPBOTH", "BOTH")), "keyword", "error", 6, "CAPBOTH"),
        ((*HEAD, CYLINDER.format(-5).replace("10", "0")), "size", "warning", 6, "no length"),
        ((*HEAD, CYLINDER.format(-5), '*Contact( c, "c", POISSON, ON, BODY, B_Ground, 1, g, false'
         ", BODY, b, 1, g, false )"), "contact", "error", 7, "is not on"),
        ((*HEAD, CYLINDER.format(-5), '*Contact( c, "c", POISSON, DYNAMICS_ONLY, BODY, b, 1, g, false'
         ", BODY, b, 1, g, false )"), "keyword", "error", 7, "DYNAMIC_ONLY"),
    ],
)  # fmt: skip
def test_findings(statements: tuple[str, ...], code: str, severity: str, line: int, words: str) -> None:
    found = [f for f in lint(text_of(*statements), "t.mdl").findings if f.code == code]
    assert found, [str(f) for f in lint(text_of(*statements), "t.mdl").findings]
    assert (found[0].severity, found[0].place.line) == (severity, line)
    assert words in found[0].message
    assert str(found[0]).startswith(f"t.mdl:{line}:")


def test_idle_parts_of_a_conditional_are_no_findings() -> None:
    """Both branches may name the same thing; what stands under a false condition may be set."""
    text = text_of(
        *HEAD,
        "*if( 1 == 2 )",
        '*Marker( k, "k", nowhere, p )',
        '*Motion( mot, "mot", JOINT, j_none, ROT )',
        "*else()",
        '*Marker( k, "k", b, p )',
        "*endif()",
        "*SetMotion( mot, DISP, LIN, 0 )",
    )
    assert lint(text).findings == ()


def test_properties_that_change_no_value_are_no_findings() -> None:
    text = text_of(
        *ROLLER,
        CYLINDER.format(-5),
        "*Set( b.usecm, true )",
        "*Set( g.hide_in_post, true )",
        '*Set( g.mesh_coarsening_level, "AGGRESSIVE" )',
    )
    assert lint(text).findings == ()
    (waits,) = lint(text_of(*HEAD, "*if( 0 )", "*Set( b.mass, 5 )", "*endif()", "*Set( b.mass, 5 )")).findings
    assert waits.place.line == 9


def test_a_model_without_the_standard_include() -> None:
    text = text_of(*HEAD)
    assert lint(text).findings == ()
    (warning,) = lint(text.replace(STANDARD, "")).findings
    assert (warning.code, warning.severity, warning.place.line) == ("standard", "warning", 1)
    assert lint("*DefineSystem( d )\n*EndDefine()\n").findings == ()  # a part of a model has it there


def test_line_ends_and_marks_of_a_file_are_reported() -> None:
    text = text_of(*HEAD)
    for changed, words in (
        (text.replace("\n", "\r\n"), "LF, not CR LF"),
        (text.replace("\n", "\r"), "LF, not CR LF"),
        ("\ufeff" + text, "byte order mark"),
    ):
        report = lint(changed)
        assert [(f.code, f.place.line) for f in report.findings] == [("ascii", 1)]
        assert words in report.findings[0].message


@pytest.mark.parametrize(
    ("raw", "words"),
    [
        (b"", "it is empty"),
        (text_of(*HEAD).encode("utf-16"), "UTF-16"),
        (text_of(*HEAD).encode("utf-16-le"), "UTF-16"),
        (bytes(range(256)) * 20, "no text at all"),
    ],
)
def test_what_is_no_text_is_said_so(raw: bytes, words: str) -> None:
    (error,) = lint(raw.decode("utf-8", errors="replace")).errors
    assert error.code == "no-model" and words in error.message


def test_too_few_attachments() -> None:
    text = text_of("*DefineSystem( d, a, z )", '*Attachment( a, "a", Body, "", B_Ground,  )',
                   '*Attachment( z, "z", Body, "", B_Ground,  )', "*EndDefine()",
                   '*System( s, "s", d, B_Ground )')  # fmt: skip
    (warning,) = lint(text).findings
    assert (warning.code, warning.place.line) == ("attachment", 6) and "s is given no z" in warning.message


def test_too_many_attachments() -> None:
    text = text_of("*DefineSystem( d, a )", '*Attachment( a, "a", Body, "", B_Ground,  )', "*EndDefine()",
                   '*System( s, "s", d, B_Ground, B_Ground )')  # fmt: skip
    (error,) = lint(text).errors
    assert (error.code, "takes 1 attachments, not 2" in error.message) == ("arity", True)


def test_what_an_unread_definition_makes_is_only_a_warning() -> None:
    text = text_of(
        '*Include( "lib.mdl" )',
        '*System( sys_a, "A", def_a )',
        *HEAD,
        '*Marker( k, "k", sys_a.b_x, p )',
        "*BeginContext( sys_a )",
        "*SetReal( ds.x, 1 )",
        "*EndContext()",
        "*SetReal( sys_a.ds.y, 2 )",
    )
    report = lint(text)
    assert not report.errors
    assert {f.code for f in report.warnings} == {"include", "external"}


def linted(capsys: pytest.CaptureFixture[str], *args: object) -> tuple[str, str]:
    """Standard output and standard error of the command."""
    with pytest.raises(SystemExit) as ended:
        app(["lint", *map(str, args)], prog_name="mdlgen")
    assert ended.value.code == 0
    return capsys.readouterr()


def test_values_go_to_standard_output(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "t.mdl"
    file.write_text(text_of(*HEAD[:3], "*SetBodyInertia( b, 1, 11, 12, 13, 1, 2, 3 )", "*Set( b.mass, 5 )"))
    out, err = linted(capsys, file, "--values", "-")
    assert json.loads(out)["bodies"]["b"]["inertia"] == [11, 12, 13, 1, 3, 2]  # xx, yy, zz, xy, yz, xz
    assert "[unread]" in err and "1 warnings" in err
    assert [p.name for p in tmp_path.iterdir()] == ["t.mdl"]


def test_line_ends_of_a_file_reach_lint(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "t.mdl"
    file.write_bytes(b"\xef\xbb\xbf" + text_of(*HEAD).replace("\n", "\r\n").encode())
    out, _ = linted(capsys, file)
    assert "LF, not CR LF" in out and "byte order mark" in out and "2 warnings" in out
