"""Commands run in this process, in a folder: their exit code and what they print."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from mdlgen.cli import app


class Ended(NamedTuple):
    code: int
    out: str
    err: str


Run = Callable[..., Ended]


def runner(capsys: pytest.CaptureFixture[str], folder: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs commands in a folder."""
    monkeypatch.chdir(folder)

    def run(*args: object) -> Ended:
        with pytest.raises(SystemExit) as ended:
            app([str(a) for a in args], prog_name="mdlgen")
        code = ended.value.code
        assert isinstance(code, int)
        return Ended(code, *capsys.readouterr())

    return run


def files(folder: Path) -> list[str]:
    """Paths of all files in a folder, relative to it."""
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())
