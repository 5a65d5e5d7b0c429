"""What tests of commands share."""

from __future__ import annotations

from pathlib import Path

import pytest
from called import Run, runner


@pytest.fixture
def mdl(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command in an empty folder."""
    return runner(capsys, tmp_path, monkeypatch)
