"""The command for scripts, what verify says of one, and a whole script to look at."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from decks import FOUR, SHORT_SPRING, SMALL, model_of, run
from golden import compare
from mutations import mutations
from places import GOLDEN, RICH
from scripts import small_script

from mdlgen.backends import msolve
from mdlgen.errors import MdlgenError
from mdlgen.model.lower import lower
from mdlgen.paths import samples
from mdlgen.spec.load import load
from mdlgen.verify import verification
from mdlgen.verify.inputs.subject import Subject
from mdlgen.verify.verification import verify


def test_the_command(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = samples() / FOUR
    expected = msolve.emit(model_of(FOUR, SMALL))
    assert run("script", spec, "--set", SMALL) == 0
    assert capsys.readouterr() == ("", "wrote transport_4x4.py\n")
    assert Path("transport_4x4.py").read_text() == expected
    assert run("script", spec, "--set", SMALL, "-q", "-o", "a.py") == 0
    assert capsys.readouterr() == ("", "")
    assert run("script", spec, "--set", SMALL, "-o", "-") == 0
    assert capsys.readouterr() == (expected, "")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.py", "transport_4x4.py"]


def test_the_command_fails_in_one_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for code, args in (
        (2, (samples() / FOUR, "--set", SMALL, "--set", SHORT_SPRING)),
        (3, ("nothing.yaml",)),
        (3, (samples() / FOUR, "--set", SMALL, "-o", "no/such/folder/a.py")),
    ):
        assert run("script", *args) == code, args
        out, err = capsys.readouterr()
        assert out == "" and len(err.splitlines()) == 1 and "Traceback" not in err
    assert not list(tmp_path.iterdir())


def test_the_command_imports_no_solver() -> None:
    script = (
        "import contextlib, io, sys\nfrom mdlgen.cli import main\n"
        f"sys.argv = ['mdlgen', 'script', {str(samples() / FOUR)!r}, '-o', '-', '-q']\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n    main()\n"
        "print('\\n'.join({m.split('.')[0] for m in sys.modules}), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    found = set(done.stderr.split())
    assert "jinja2" in found
    assert not found & {"exudyn", "numba", "scipy", "matplotlib", "h5py", "rich", "lxml"}


def test_verify_takes_a_file(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    file = tmp_path / "note.py"
    text = msolve.emit(model_of(FOUR, SMALL))
    spec = samples() / FOUR
    file.write_text(text)
    assert run("verify", spec, "--set", SMALL, "--msolve", file, "--no-perturb") == 0
    assert "msolve" in capsys.readouterr().out.splitlines()[1]
    file.write_text(text.replace('"penalty": 300.0', '"penalty": 301.0'))
    assert run("verify", spec, "--set", SMALL, "--msolve", file, "--no-perturb") == 5
    assert "penalty is 301" in capsys.readouterr().out
    file.write_text(text.replace("kmax=5", "kmax=4"))
    assert run("verify", spec, "--set", SMALL, "--msolve", file, "--no-perturb") == 5
    assert "only its values may differ" in capsys.readouterr().err
    file.write_text(re.sub(r'"boxes": \[.*\]', '"boxes": [10, 9000000000]', text))
    assert run("verify", spec, "--set", SMALL, "--msolve", file, "--no-perturb") == 2
    assert re.search(r"its values make no model: more than \d{3,4} objects", capsys.readouterr().err)
    assert run("verify", spec, "--set", SMALL, "--msolve", tmp_path / "none.py") == 3


@pytest.fixture
def script_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Text and deck, which are not changed, are not looked at: what is caught is caught in the script."""
    read: dict[int, object] = {}
    own = Subject.own

    def once(self: Subject, set_contact: bool, like: object = None) -> object:
        return read.setdefault(0, own(self, set_contact))

    monkeypatch.setattr(Subject, "own", once)
    for name in ("_deck", "_text", "_lint"):
        monkeypatch.setattr(verification, name, lambda *_: None)


@pytest.mark.usefixtures("script_alone")
@pytest.mark.parametrize("seed", range(8))
def test_a_change_of_any_number_name_or_sign_is_caught(seed: int, tmp_path: Path) -> None:
    """45 random changes for each seed, 360 in all: each that makes another model, or no script."""
    scene = load(RICH)
    model = lower(scene)
    text = msolve.emit(model)
    before = msolve.read(text)
    file = tmp_path / "rich.py"
    altered = 0
    for change in mutations(text, seed, 45, "NAME = "):
        try:
            after = msolve.read(change.text)
            same = (
                after.same_program and after.values == before.values and after.objects() == before.objects()
            )
        except MdlgenError:
            same = False
        if same:  # a note, or a number that is written otherwise
            continue
        altered += 1
        file.write_text(change.text)
        try:
            caught = not verify(scene, model, msolve=file, perturb=False).ok
        except MdlgenError:
            caught = True
        assert caught, f"{change.old} -> {change.new} in {change.where}"
    assert altered >= 38, "more than 300 in all"


@pytest.mark.usefixtures("script_alone")
@pytest.mark.parametrize(
    "less",
    [
        "probes={}",
        "loads=[]",
        "supports=[]",
        "contacts.0.friction=0",
        "rollers.low.drive={speed: 100 rad/s}",
        "sheets.one.spin=[0 rad/s, 0 rad/s, 0 rad/s]",
        "sheets.two.clamp=null",
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        "run.duration=4 ms",
    ],
)
def test_the_script_of_another_scene_is_not_that_of_this_one(less: str, tmp_path: Path) -> None:
    scene = load(RICH)
    file = tmp_path / "rich.py"
    file.write_text(msolve.emit(lower(load(RICH, [less]))))
    assert not verify(scene, lower(scene), msolve=file, perturb=False).ok


def test_golden() -> None:
    compare(small_script(), GOLDEN / "script_small.py.txt")
