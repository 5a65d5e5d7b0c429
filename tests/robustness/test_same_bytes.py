"""The same bytes whatever the hash seed, locale, folder or threads; nothing from a network."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from itertools import product
from pathlib import Path

import pytest
from same import bits

import mdlgen
from mdlgen.paths import samples

SAMPLE = samples() / "transport_4x4.yaml"
SETS = ["--set", "sheets.note.boxes=[3,5]", "--set", "run.duration=0.5 ms", "--set", "run.step=0.1 ms"]

SCRIPT = """
import contextlib, io, sys
from mdlgen.cli import app
for args in {commands!r}:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        try:
            app(args, prog_name="mdlgen")
        except SystemExit as ended:
            assert not ended.code, ended.code
"""

FOLDERS = ("here", "der Süden", "a/b/c/d")
LOCALES = ("C", "C.UTF-8", "POSIX", "tr_TR.UTF-8", "de_DE.UTF-8")
SEEDS = ("0", "1", "4294967295", "random")
# 20 of them: each folder, locale, seed and number of threads stands in several
ENVIRONMENTS = [
    (FOLDERS[k % 3], locale, seed, str(1 + k % 2)) for k, (locale, seed) in enumerate(product(LOCALES, SEEDS))
]


def written(folder: Path, environment: dict[str, str]) -> dict[str, str]:
    """Digests of text, scripts, deck and a run's series, written by a process of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    commands = [
        ["mdl", str(SAMPLE), *SETS, "--script", "-o", "t.mdl", "-q"],
        ["deck", str(SAMPLE), *SETS, "-o", "t.xml", "-q"],
        ["script", str(SAMPLE), *SETS, "-o", "t.py", "-q"],
    ]
    run = [["run", str(SAMPLE), *SETS, "-o", "d", "-q"]] if environment.get("RUN") else []
    script = SCRIPT.format(commands=commands + run)
    done = subprocess.run(
        [sys.executable, "-c", script],
        cwd=folder,
        env={**os.environ, **environment},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    files = ["t.mdl", "t_mview.py", "t.xml", "t.py", *(["d/series.csv", "d/result.h5"] if run else [])]
    held = {name: (folder / name).read_bytes() for name in files}
    return {n: hashlib.sha256(bits(b) if n.endswith("h5") else b).hexdigest() for n, b in held.items()}


@pytest.mark.parametrize("count", [4, 20])
def test_environments(count: int, tmp_path: Path) -> None:
    """Four have each folder, each seed, each number of threads, and four of five locales."""
    assert len(ENVIRONMENTS) == 20
    found = []
    for k, (folder, locale, seed, threads) in enumerate(ENVIRONMENTS[:: 20 // count]):
        environment = {"PYTHONHASHSEED": seed, "LC_ALL": locale, "LANG": locale}
        environment |= dict.fromkeys(
            ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), threads
        )
        # a run takes longer to start; four of all see each seed
        environment |= {"RUN": "1"} if k < min(4, count // 2) else {}
        found.append(written(tmp_path / str(k) / folder, environment))
    for other in found[1:]:
        assert other.items() <= found[0].items()


# A connection, a name that is looked up, a server: none of them happens in a run.
NO_NETWORK = """
import sys
def hook(event, args):
    if event.startswith(("socket.", "urllib.", "http.", "ftplib.", "smtplib.")):
        sys.stderr.write(event)
        raise SystemExit("network: " + event)
sys.addaudithook(hook)
"""


@pytest.mark.parametrize("module", ["socket", "urllib.request"])
def test_the_watch_on_networks_sees_one(module: str) -> None:
    """A check that cannot fail would be none."""
    ask = f"import {module}; socket = __import__('socket'); socket.getaddrinfo('localhost', 80)"
    done = subprocess.run([sys.executable, "-c", NO_NETWORK + ask], capture_output=True, check=False)
    assert done.returncode != 0 and b"network" in done.stderr


def test_nothing_is_fetched(tmp_path: Path) -> None:
    commands = [
        ["new", "mine"],
        ["check", str(SAMPLE), *SETS],
        ["mdl", str(SAMPLE), *SETS, "-o", "t.mdl"],
        ["lint", "t.mdl"],
        ["deck", str(SAMPLE), *SETS],
        ["script", str(SAMPLE), *SETS],
        ["verify", str(SAMPLE), *SETS, "--no-turn"],
        ["run", str(SAMPLE), *SETS, "-o", "d"],
        ["run", str(SAMPLE), *SETS[:-2], "-o", "e", "--solver", "exudyn", "-q"],
        ["compare", "d", "--with", "d/series.csv"],
        ["schema"],
    ]
    script = NO_NETWORK + SCRIPT.format(commands=commands)
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    for path in tmp_path.rglob("*.html"):
        assert not any(
            mark in path.read_text() for mark in ('src="http', 'href="http', "@import", "url(http")
        )


def test_floats_come_back() -> None:
    """What stands in a text is the float itself, not a rounded one."""
    size = 67.00000000000001
    scene = mdlgen.load(SAMPLE, [f"sheets.note.size=[{size!r} mm, 127 mm]"])
    assert repr(size) in mdlgen.emit(mdlgen.lower(scene))
