"""What an import costs, and which room may import which."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.cli import COMMANDS
from mdlgen.paths import samples
from mdlgen.program.build import programs
from mdlgen.program.kernel import Intrinsic, Kernel, kernel_sources, room_of
from mdlgen.program.ship import Program

HEAVY = ("exudyn", "numba", "scipy", "matplotlib", "h5py", "rich")


def modules(code: str) -> set[str]:
    """Modules that are there after `code` ran in a new process."""
    script = f"import sys\n{code}\nprint('\\n'.join(list(sys.modules)), file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split())


def loaded(code: str) -> set[str]:
    """As `modules`, top-level ones."""
    return {name.split(".")[0] for name in modules(code)}


def test_importing_the_package_is_cheap() -> None:
    found = loaded("import mdlgen; mdlgen.load; mdlgen.solve; mdlgen.__all__")
    assert not found & {*HEAVY, "numpy", "pydantic", "ruamel", "typer", "jinja2"}


@pytest.mark.parametrize("command", ["mdl", "check", "preview"])
def test_what_does_not_run_imports_no_solver(command: str, tmp_path: Path) -> None:
    args = ["mdlgen", command, str(samples() / "transport_4x4.yaml")]
    page = ["-o", str(tmp_path / "start.html"), "-q"]
    args += {"mdl": ["-o", "-", "-q"], "check": ["--json"], "preview": page}[command]
    found = loaded(
        f"import contextlib, io\nfrom mdlgen.cli import main\nsys.argv = {args!r}\n"
        "with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):\n    main()"
    )
    assert "numpy" in found
    assert not found & set(HEAVY)
    assert ("jinja2" in found) == (command != "check")


# No process is started, but for the one that importing h5py asks for the name of the processor.
WATCH = """
def imported(event, args):
    started = event in ("subprocess.Popen", "os.system", "os.fork", "os.posix_spawn")
    assert not started or list(args[1]) == ["uname", "-p"], (event, args)
sys.addaudithook(imported)
"""


def test_a_plain_run_imports_what_it_uses_and_starts_no_process(tmp_path: Path) -> None:
    if PROGRAM.why_not() is not None:
        pytest.skip("numba compiles, since the program does not fit")
    args = ["mdlgen", "run", str(samples() / "transport_4x4.yaml"), "-o", str(tmp_path / "out"), "-q"]
    args += ["--set", "run.duration=1 ms", "--set", "run.step=0.1 ms"]
    found = modules(
        f"import contextlib\nfrom mdlgen.cli import main\nsys.argv = {args!r}\n{WATCH}"
        "with contextlib.suppress(SystemExit):\n    main()"
    )
    assert (tmp_path / "out" / "result.h5").exists() and "h5py" in found
    # what writes texts and pages, draws, compiles, or searches meshes
    not_used = {"jinja2", "markupsafe", "mdlgen.report.html", "exudyn", "numba", "llvmlite", "scipy"}
    not_used |= {"matplotlib", "rich", "lxml"}
    not_used |= {"asyncio", "multiprocessing", "concurrent.futures", "numpy.testing", "unittest"}
    not_used |= {"numpy.random", "numpy.fft", "numpy.polynomial"}
    # what is another command's
    rooms = {"bench", "calibrate", "study", "verify", "spec.schema"}
    rooms |= {"backends.exudyn_local", "backends.motionview", "backends.motionsolve", "backends.msolve"}
    rooms |= {f"cli.{name}" for name in set(COMMANDS.values()) - {"run"}}
    assert found & (not_used | {f"mdlgen.{room}" for room in rooms}) == set()


@pytest.mark.parametrize("first", ["mdlgen.mechanics.contact", "mdlgen.backends.lattice.kernels.linear.band"])
def test_compiled_code_is_kept_in_one_place_whoever_imports_it_first(first: str) -> None:
    code = (
        f"import {first}\n"
        "from mdlgen.backends.lattice.kernels.integrate import integrate\n"
        "from mdlgen.backends.lattice.kernels.linear import band\n"
        "from mdlgen.mechanics import plate\n"
        "for one in (band.factor, integrate.run, plate.box_plane):\n"
        "    print(one.dispatcher._cache.cache_path.replace('\\\\', '/').split('/')[-2].rsplit('_', 1)[0])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == [
        "mdlgen.backends.lattice.kernels.linear.band.factor",
        "mdlgen.backends.lattice.kernels.integrate.integrate.run",
        "mdlgen.mechanics.plate.box_plane",
    ]


@pytest.mark.parametrize("program", programs(), ids=lambda program: program.name)
def test_a_program_and_what_numba_keeps_know_all_sources_of_a_kernel(program: Program) -> None:
    """A kernel and all that it calls lie in the rooms that its program has the digest of."""
    known = {module for room in program.rooms for module in kernel_sources(room)}
    for room in program.rooms:
        for module in kernel_sources(room):
            assert room_of(module.rpartition(".")[0]) == room
            source = vars(importlib.import_module(module))
            called = [value for value in source.values() if isinstance(value, (Kernel, Intrinsic))]
            assert {value.__module__ for value in called} <= known, module


def test_rooms_import_only_lower_rooms() -> None:
    done = linted(ROOT / "pyproject.toml")
    assert done.returncode == 0, done.stdout


# what a Scene names for a type alone, besides what pyproject.toml allows it
FOR_A_TYPE = '    "mdlgen.spec.scene -> mdlgen.lints.lint",\n'


def strict(text: str) -> str:
    """The contracts of pyproject.toml but that of siblings, with names for types counted."""
    head, *contracts = text[text.index("[tool.importlinter]") :].split("[[tool.importlinter.contracts]]")
    kept = [contract for contract in contracts if 'type = "acyclic_siblings"' not in contract]
    assert len(kept) == len(contracts) - 1 and "exclude_type_checking_imports = true" in head
    layers = kept[0].replace("ignore_imports = [\n", f"ignore_imports = [\n{FOR_A_TYPE}")
    head = head.replace("exclude_type_checking_imports = true", "exclude_type_checking_imports = false")
    return "[[tool.importlinter.contracts]]".join([head, layers, *kept[1:]])


def test_names_for_types_follow_the_layers_too(tmp_path: Path) -> None:
    file = tmp_path / "strict.toml"
    text = strict((ROOT / "pyproject.toml").read_text("utf-8"))
    file.write_text(text, "utf-8")
    done = linted(file)
    assert done.returncode == 0 and "5 kept, 0 broken" in done.stdout, done.stdout
    file.write_text(text.replace(FOR_A_TYPE, ""), "utf-8")
    assert linted(file).returncode != 0


def linted(config: Path) -> subprocess.CompletedProcess[str]:
    tool = Path(sys.executable).with_name("lint-imports")
    if not tool.exists():
        pytest.skip("import-linter is not installed")
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(
        [tool, "--no-cache", "--config", config],
        cwd=ROOT,
        capture_output=True,
        encoding="utf-8",
        env=environment,
        check=False,
    )
