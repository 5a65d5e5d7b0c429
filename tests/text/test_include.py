"""*Include: what is read, from where, and what is left alone."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from mdlgen.backends.motionview.reader import Report, include, lint, read

BODY = '*Body( {0}, "{0}", P_Global_Origin, , , ,  )\n*SetBodyInertia( {0}, 1, 1, 1, 1 )\n'


def model(*lines: str) -> str:
    return "\n".join(('*BeginMDL( m, "m" )', *lines, "*StandardInclude(FILE)", "*EndMDL()", ""))


def report_of(folder: Path, text: str) -> Report:
    return read(text, str(folder / "host.mdl"), folder).report


def written(folder: Path, **files: str) -> None:
    for name, text in files.items():
        path = folder / f"{name.replace('__', '/')}.mdl"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def messages(report: Report) -> list[str]:
    return [f.message for f in report.findings if f.code in ("include", "cycle")]


def test_a_file_stands_where_it_is_included(tmp_path: Path) -> None:
    written(tmp_path, part="notes that no statement follows\n" + BODY.format("b"))
    text = model('*Include("part.mdl")', '*Marker( k, "k", b, P_Global_Origin )')
    report = report_of(tmp_path, text)
    assert report.findings == () and report.statements == 6
    assert set(read(text, "host.mdl", tmp_path).values["bodies"]) == {"b"}


def test_inside_a_definition(tmp_path: Path) -> None:
    written(tmp_path, part=BODY.format("b"))
    text = model("*DefineSystem( def_s )", '*Include("part.mdl")', "*EndDefine()", '*System( s, "s", def_s )')
    assert set(read(text, "host.mdl", tmp_path).values["bodies"]) == {"s.b"}


def test_files_in_files_are_sought_beside_the_one_that_names_them(tmp_path: Path) -> None:
    both = '*Include("b.mdl")\n*Include("../c.mdl")\n'
    written(tmp_path, sub__a=both, sub__b=BODY.format("b"), c=BODY.format("c"))
    text = model('*Include("sub/a.mdl")')
    assert report_of(tmp_path, text).findings == ()
    assert set(read(text, "host.mdl", tmp_path).values["bodies"]) == {"b", "c"}


def test_an_error_has_the_place_in_its_own_file(tmp_path: Path) -> None:
    written(tmp_path, sub__part='*Point( p, "p" )\n  *SetPoint( p, q.x, 0, 0 )\n*Point( h, "h" )\n')
    text = model('*Point( h, "h" )', '*Include("sub/part.mdl")', '*Body( c, "c", p )')
    report = report_of(tmp_path, text)
    errors = [(str(f.place), f.code, f.message) for f in report.errors]
    inner = tmp_path / "sub" / "part.mdl"
    assert (f"{inner}:2:17", "dangling", "there is no q") in errors
    duplicate = next(e for e in errors if e[1] == "duplicate")
    assert duplicate[0].startswith(f"{inner}:3:") and f"from {tmp_path / 'host.mdl'}:2:1" in duplicate[2]


def test_without_a_folder_the_disk_is_not_touched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path, part=BODY.format("b"))
    monkeypatch.chdir(tmp_path)
    for name in ("resolve", "open", "stat", "is_file", "exists"):
        monkeypatch.setattr(Path, name, lambda *a, name=name, **k: pytest.fail(f"Path.{name}"))
    found = messages(lint(model('*Include("part.mdl")')))
    assert found == ['"part.mdl" is not read; what it makes is not known here']


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("missing.mdl", ""),
        ("sub", ""),
        ("/etc/hostname", " (only files in the folder of the text or below it are read)"),
        ("../secret.mdl", " (only files in the folder of the text or below it are read)"),
        ("sub/../../secret.mdl", " (only files in the folder of the text or below it are read)"),
        ("link.mdl", " (only files in the folder of the text or below it are read)"),
        ("out/secret.mdl", " (only files in the folder of the text or below it are read)"),
        ("C:/x.mdl", " (only files in the folder of the text or below it are read)"),
        ("pipe.mdl", ""),
    ],
)
def test_what_is_not_read(tmp_path: Path, name: str, reason: str) -> None:
    folder = tmp_path / "model"
    (folder / "sub").mkdir(parents=True)
    written(tmp_path, secret=BODY.format("b"))
    (folder / "link.mdl").symlink_to(tmp_path / "secret.mdl")
    (folder / "out").symlink_to(tmp_path)
    os.mkfifo(folder / "pipe.mdl")
    report = report_of(folder, model(f'*Include("{name}")'))
    assert not report.errors
    assert messages(report) == [f'"{name}" is not read{reason}; what it makes is not known here']


def test_a_name_that_is_none(tmp_path: Path) -> None:
    for argument in ("part.mdl", '{getenv("HOME") + "/a.mdl"}', '"a\\tb.mdl"', f'"{"x" * 5000}"'):
        assert len(messages(report_of(tmp_path, model(f"*Include({argument})")))) == 1


def test_a_link_within_the_folder_is_followed(tmp_path: Path) -> None:
    written(tmp_path, part=BODY.format("b"))
    (tmp_path / "link.mdl").symlink_to("part.mdl")
    (tmp_path / "round.mdl").symlink_to("round.mdl")
    assert report_of(tmp_path, model('*Include("link.mdl")')).findings == ()
    assert len(messages(report_of(tmp_path, model('*Include("round.mdl")')))) == 1


@pytest.mark.parametrize("first", ["host.mdl", "a.mdl"])
def test_files_that_include_each_other_are_named(tmp_path: Path, first: str) -> None:
    text = model('*Include("a.mdl")')
    written(tmp_path, a='*Include("b.mdl")\n', b=f'*Include("{first}")\n', host=text)
    report = report_of(tmp_path, text)
    chain = ["host.mdl", "a.mdl", "b.mdl"]
    reason = " includes ".join((*chain[chain.index(first) :], first))
    assert [(f.code, f.message) for f in report.errors] == [("cycle", reason)]
    assert report.errors[0].place.file == str(tmp_path / "b.mdl")


def test_depth_number_and_size_are_limited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    deep = {f"d{k}": f'*Include("d{k + 1}.mdl")\n' for k in range(include.MOST_DEEP + 5)}
    written(tmp_path, **deep)
    assert "more than 20 deep" in messages(report_of(tmp_path, model('*Include("d0.mdl")')))[0]
    # each file twice in the one before: a million in all
    wide = {f"w{k}": f'*Include("w{k + 1}.mdl")\n' * 2 for k in range(include.MOST_DEEP)}
    written(tmp_path, **wide)
    report = report_of(tmp_path, model('*Include("w0.mdl")'))
    assert any("more than 1000" in m for m in messages(report))
    monkeypatch.setattr(include, "MOST_BYTES", 60)
    written(tmp_path, a=BODY.format("b"))
    assert "is not read" in messages(report_of(tmp_path, model('*Include("a.mdl")')))[0]


def test_a_whole_model_as_a_part_is_doubtful(tmp_path: Path) -> None:
    written(tmp_path, part=model(*BODY.format("b").splitlines()))
    text = model('*Include("part.mdl")', '*Marker( k, "k", b, P_Global_Origin )')
    report = report_of(tmp_path, text)
    assert not report.errors and "*BeginMDL in an included file" in messages(report)[0]
    assert set(read(text, "host.mdl", tmp_path).values["bodies"]) == {"b"}


def test_a_block_that_a_file_leaves_open(tmp_path: Path) -> None:
    written(tmp_path, part="*DefineSystem( def_s )\n")
    report = report_of(tmp_path, model('*Include("part.mdl")'))
    assert any("part.mdl:1:1" in f.message for f in report.errors)
