"""Commands that need a package of an extra say so in one line; all others do without it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mdlgen.extras import EXTRAS
from mdlgen.paths import samples

SHORT = ["--set", "run.duration=1 ms", "--set", "run.step=0.1 ms"]
# Makes the packages of all extras look as if they were not installed.
WITHOUT = f"""
import sys
sys.modules.update(dict.fromkeys({sorted(EXTRAS)!r}))
from mdlgen.cli import main
sys.argv[0] = "mdlgen"
main()
"""


def mdlgen(folder: Path, *args: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", WITHOUT, *map(str, args)],
        cwd=folder,
        env={k: v for k, v in os.environ.items() if k not in ("MDLGEN_NUMBA", "MDLGEN_BITCODE")},
        capture_output=True,
        text=True,
        check=False,
    )


def test_what_a_scene_is_written_for_needs_no_extra(tmp_path: Path) -> None:
    """Text, check, run and page of a sample. A run needs machine code that is shipped for the machine."""
    from mdlgen.program import emit

    scene = samples() / "transport_4x4.yaml"
    commands = [("check", scene), ("mdl", scene, "-o", "t.mdl")]
    if emit.shipped() is not None and not os.environ.get("MDLGEN_NUMBA"):
        commands += [("run", scene, "-o", "out", *SHORT), ("report", "out")]
    for command in commands:
        done = mdlgen(tmp_path, *command)
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    ("command", "package"),
    [
        (("run", "--solver", "exudyn", "-o", "out", *SHORT), "exudyn"),
        (("preview", "-o", "start.png"), "matplotlib"),
        (
            ("run", "--pictures", "-o", "out", *SHORT),
            "matplotlib",
        ),  # before the run, whose result would be lost
    ],
)
def test_a_command_asks_for_the_extra_that_it_needs(
    tmp_path: Path, command: tuple[str, ...], package: str
) -> None:
    done = mdlgen(tmp_path, *command, samples() / "transport_4x4.yaml")
    assert done.returncode in (2, 3)
    last = done.stderr.splitlines()[-1]  # before it stands what check finds
    assert last.endswith(f"needs {package}, which is not installed: pip install 'mdlgen[{EXTRAS[package]}]'")
