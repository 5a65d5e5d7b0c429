"""What an import costs, and which room may import which."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mdlgen.paths import samples

HEAVY = ("exudyn", "numba", "scipy", "matplotlib", "h5py", "rich")
ROOT = Path(__file__).parent.parent


def loaded(code: str) -> set[str]:
    """Top-level modules that are there after `code` ran in a new process."""
    script = (
        f"import sys\n{code}\nprint('\\n'.join({{m.split('.')[0] for m in sys.modules}}), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(done.stderr.split())


def test_importing_the_package_is_cheap() -> None:
    found = loaded("import mdlgen; mdlgen.load; mdlgen.solve; mdlgen.__all__")
    assert not found & {*HEAVY, "numpy", "pydantic", "ruamel", "typer", "jinja2"}


@pytest.mark.parametrize("command", ["mdl", "check"])
def test_what_does_not_run_imports_no_solver(command: str) -> None:
    args = ["mdlgen", command, str(samples() / "transport_4x4.yaml")]
    args += ["-o", "-", "-q"] if command == "mdl" else ["--json"]
    found = loaded(
        f"import contextlib, io\nfrom mdlgen.cli import main\nsys.argv = {args!r}\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n    main()"
    )
    assert "numpy" in found
    assert not found & set(HEAVY)
    assert ("jinja2" in found) == (command == "mdl")


@pytest.mark.parametrize("first", ["mdlgen.mechanics.contact", "mdlgen.backends.lattice.kernels.band"])
def test_compiled_code_is_kept_in_one_place_whoever_imports_it_first(first: str) -> None:
    code = (
        f"import {first}\n"
        "from mdlgen.backends.lattice.kernels import band, march\n"
        "from mdlgen.mechanics import plate\n"
        "for one in (band.factor, march.run, plate.box_plane):\n"
        "    print(one.dispatcher._cache.cache_path.replace('\\\\', '/').split('/')[-2].rsplit('_', 1)[0])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [
        "mdlgen.backends.lattice.kernels",
        "mdlgen.backends.lattice.kernels",
        "mdlgen.mechanics",
    ]


def test_rooms_import_only_lower_rooms() -> None:
    tool = Path(sys.executable).with_name("lint-imports")
    if not tool.exists():
        pytest.skip("import-linter is not installed")
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
    done = subprocess.run(
        [tool, "--no-cache"],
        cwd=ROOT,
        capture_output=True,
        encoding="utf-8",
        env=environment,
        check=False,
    )
    assert done.returncode == 0, done.stdout
