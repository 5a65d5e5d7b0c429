"""The command for decks, its time, and a whole deck to look at."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest
from decks import FOUR, SHORT_SPRING, SMALL, model_of, run, small_deck
from golden import compare
from places import GOLDEN

from mdlgen.backends import motionsolve
from mdlgen.paths import samples


def test_the_command(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = samples() / FOUR
    expected = motionsolve.emit(model_of(FOUR, SMALL))
    assert run("deck", spec, "--set", SMALL) == 0
    assert capsys.readouterr() == ("", "wrote transport_4x4.xml\n")
    assert Path("transport_4x4.xml").read_text() == expected
    assert run("deck", spec, "--set", SMALL, "-q", "-o", "a.xml") == 0
    assert capsys.readouterr() == ("", "")
    assert run("deck", spec, "--set", SMALL, "-o", "-") == 0
    assert capsys.readouterr() == (expected, "")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.xml", "transport_4x4.xml"]


def test_the_command_fails_in_one_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = samples() / FOUR
    (tmp_path / "folder").mkdir()
    for code, args in (
        (2, (spec, "--set", "sheets.note.mass=1")),
        (2, (spec, "--set", SMALL, "--set", SHORT_SPRING)),
        (3, ("nothing.yaml",)),
        (3, (spec, "--set", SMALL, "-o", "folder")),
        (3, (spec, "--set", SMALL, "-o", "no/such/folder/a.xml")),
    ):
        assert run("deck", *args) == code, args
        out, err = capsys.readouterr()
        assert out == "" and len(err.splitlines()) == 1 and "Traceback" not in err
    assert [p.name for p in tmp_path.rglob("*")] == ["folder"]


def test_the_command_imports_no_solver() -> None:
    script = (
        "import contextlib, io, sys\nfrom mdlgen.cli import main\n"
        f"sys.argv = ['mdlgen', 'deck', {str(samples() / FOUR)!r}, '-o', '-', '-q']\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n    main()\n"
        "print('\\n'.join({m.split('.')[0] for m in sys.modules}), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    found = set(done.stderr.split())
    assert "jinja2" in found
    assert not found & {"exudyn", "numba", "scipy", "matplotlib", "h5py", "rich", "lxml"}


def test_the_time_grows_no_faster_than_the_deck() -> None:
    """Nine times the boxes must not cost 25 times: linear is 9, quadratic 81."""
    from time import process_time

    def seconds(boxes: str) -> float:
        model = model_of("cantilever.yaml", f"sheets.note.boxes={boxes}")
        best = math.inf
        for _ in range(2):
            start = process_time()
            motionsolve.emit(model)
            best = min(best, process_time() - start)
        return best

    assert seconds("[60,60]") < 25 * seconds("[20,20]")


def test_golden() -> None:
    text, path = small_deck(), GOLDEN / "deck_small.xml"
    assert motionsolve.validate(text) == []
    compare(text, path)
