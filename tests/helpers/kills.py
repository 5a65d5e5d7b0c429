"""Kills runs at random moments, and looks at what is left: the old result whole, or the new one complete.

As a program: python tests/helpers/kills.py 50, with one of SCENES behind the number for another one than
the first.
"""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from same import bits

from mdlgen.paths import NOTE, TEMPORARY, recover, samples

SCENES = {
    "transport_4x4": ["sheets.note.boxes=[3,5]", "run.step=20 us"],
    "stack": [
        "sheets.note_4.velocity=[3000 mm/s, 500 mm/s, 0 mm/s]",
        "run.step=40 us",
        "run.print_step=0.2 ms",
    ],
    "pick": ["run.step=20 us"],
}
NAMES = ("report.html", "report.png", "result.h5", "series.csv", "strain.png", "summary.json")
OLD, NEW = "1 ms", "8 ms"


class Killed(NamedTuple):
    """What kills left: how often the old result and the new one, how often a state to go on from."""

    old: int
    new: int
    kept: int


def start(folder: Path, *args: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "mdlgen", "run", *args, "--page", "--pictures", "-q"]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def finish(process: subprocess.Popen[bytes]) -> None:
    _, err = process.communicate()
    assert process.returncode == 0, err


def contents(folder: Path) -> dict[str, bytes]:
    """The files of a result without what tells of times."""
    held = {n: (folder / n).read_bytes() for n in NAMES if n not in ("summary.json", "report.html")}
    return {n: bits(b) if n == "result.h5" else b for n, b in held.items()}


def kills(count: int, seed: int = 1, scene: str = "transport_4x4") -> Killed:
    """Kills `count` runs over an old result, each at a random moment. Raises AssertionError."""
    words = [str(samples() / f"{scene}.yaml"), *(word for one in SCENES[scene] for word in ("--set", one))]
    rng = random.Random(seed)
    found = {"old": 0, "new": 0, "kept": 0}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        old = [*words, "--set", f"run.duration={OLD}"]
        new = [*words, "--set", f"run.duration={NEW}"]
        finish(start(folder, *old, "-o", "old"))
        before = time.monotonic()
        finish(start(folder, *new, "-o", "new", "--checkpoint", "0"))
        length = time.monotonic() - before
        results = {kind: contents(folder / kind) for kind in ("old", "new")}
        for _ in range(count):
            shutil.copytree(folder / "old", folder / "out")
            process = start(folder, *new, "-o", "out", "--checkpoint", "0")
            time.sleep(rng.uniform(0.3, 1.1) * length)
            process.kill()
            process.communicate()
            for place in ("out", "out/checkpoint"):
                recover(folder / place)
            left = contents(folder / "out")
            kind = next((kind for kind, result in results.items() if result == left), None)
            assert kind is not None, sorted(left)
            summary = (folder / "out" / "summary.json").read_text("utf-8")
            assert (f'"t_end_ms": {float(OLD.split()[0])}' in summary) == (kind == "old")
            assert not (folder / "out" / NOTE).exists()
            found[kind] += 1
            if (folder / "out" / "checkpoint" / "run.json").exists():
                found["kept"] += 1
                finish(start(folder, "--resume", "out"))
                assert contents(folder / "out") == results["new"]
            stray = [p for p in (folder / "out").rglob("*") if p.is_file() and p.name not in NAMES]
            assert all(p.name.startswith(".") and p.name.endswith(TEMPORARY) for p in stray), stray
            shutil.rmtree(folder / "out")
    return Killed(**found)


if __name__ == "__main__":
    print(kills(int(sys.argv[1]) if len(sys.argv) > 1 else 50, 1, *sys.argv[2:3]))
