"""Runs suites: every case in its process, one after the other, and the files that they leave."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from mdlgen import paths, registry
from mdlgen.bench import process
from mdlgen.bench.case import WARM, BenchCase, Reference
from mdlgen.bench.child import Job
from mdlgen.bench.machine import machine, versions
from mdlgen.bench.peers import MISSING, PEERS, installed
from mdlgen.bench.peers import versions as peer_versions
from mdlgen.bench.reference import file_of
from mdlgen.bench.row import FAILED, OK, WRONG, BenchRow, Outcome, rows
from mdlgen.bench.suites import SUITES, cases
from mdlgen.errors import OutputError, SpecError

Say = Callable[[str], None]
# Suffix of a solver's name for another state of mdlgen.
BESIDE = ", beside"
# A reference is finer than the measured run; it may take this long [s].
REFERENCE_LIMIT = 1800.0


@dataclass
class Bench:
    """The results of a run of the bench."""

    machine: dict[str, Any]
    versions: dict[str, str]
    compile_s: dict[str, float | None]  # per solver, in a new process; small where the cache holds the code
    rows: list[BenchRow] = field(default_factory=list)

    @property
    def wrong(self) -> list[BenchRow]:
        """Rows whose solver said ok, but whose error is above its tolerance."""
        return [row for row in self.rows if row.status == WRONG and not row.solver.endswith(BESIDE)]

    @property
    def failed(self) -> list[BenchRow]:
        """Rows that failed where a failure is no answer: the ladder's rungs may end in one, and a peer."""
        others = (*PEERS, *(f"{name}{BESIDE}" for name in registry.SOLVERS))
        ours = [row for row in self.rows if row.suite != "stability" and row.solver not in others]
        return [row for row in ours if row.status == FAILED]

    def json(self) -> dict[str, Any]:
        """The content of bench.json."""
        from mdlgen.bench.fits import fits

        return {
            "machine": self.machine,
            "versions": self.versions,
            "compile_s": self.compile_s,
            "fits": fits(self.rows),
            "rows": [row.json() for row in self.rows],
        }


def bench(
    suites: Sequence[str],
    folder: Path,
    solvers: Sequence[str] = (),
    quick: bool = False,
    repeats: int = 3,
    say: Say = lambda text: None,
    peers: bool | None = None,
    beside: Path | None = None,
) -> Bench:
    """Run `suites` (all where empty) with `solvers` (all that there are); `say` is called with what is run.

    `peers` says whether other tools run `transport` too; None: where they are installed and no solver is
    chosen. `beside` is a folder with another state of mdlgen: it runs each case of our solvers, too, right
    after this one, with its own samples and measures; its rows fail nothing.

    Writes bench.json, bench.md and bench.png into `folder`. Raises SpecError for a suite or solver that
    there is not, OutputError for files that cannot be written.
    """
    known = tuple(sorted(registry.SOLVERS))
    for name in solvers:
        if name not in PEERS:
            registry.solver(name)
    asked = list(suites) or list(SUITES)
    names = list(solvers) or list(known)
    if "transport" in asked:
        names += [name for name in _peers(peers, bool(solvers), say) if name not in names]
    plan = [
        (name, case)
        for suite in asked
        for name in names
        if suite == "transport" or name not in PEERS
        for case in cases(suite, name, known, quick)
    ]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    if beside is not None and not (beside / "mdlgen" / "__init__.py").is_file():
        raise SpecError(
            f"{beside}: is not a folder with another state of mdlgen: it has no mdlgen/__init__.py"
        )
    compiled = {name: _warm(name, say).compiled for name in names if name not in PEERS}
    for name in compiled if beside is not None else ():
        why = _warm(name, say, beside).status
        if why != OK:
            raise SpecError(
                f"{beside}: that state of mdlgen does not run a case of this one with {name}: {why}"
            )
    found = Bench(machine(), versions() | peer_versions(), compiled)
    references = References(folder, say)
    try:
        for count, (name, case) in enumerate(plan, 1):
            step = "" if case.run.step is None else f" at {case.run.step:g} ms"
            say(f"{count}/{len(plan)} {case.suite}, {name}: {case.name}{step}")
            made = rows(case, name, _outcome(case, name, references, repeats))
            if beside is not None and name not in PEERS:
                other = _outcome(case, name, references, repeats, beside)
                made += [replace(row, solver=f"{name}{BESIDE}") for row in rows(case, name, other)]
            found.rows += made
            for row in made:
                if row.status != OK:
                    say(f"  {row.status}: {row.reason}")
    finally:  # an hour's rows are worth keeping when someone interrupts it
        write(found, folder)
    return found


def _peers(asked: bool | None, chosen: bool, say: Say) -> list[str]:
    """The peers to run. Raises SpecError where they are asked for, but not installed."""
    if asked and not installed():
        raise SpecError(MISSING)
    if asked is None and not chosen and not installed():
        say(MISSING)
    return list(PEERS) if asked or (asked is None and not chosen and installed()) else []


def write(found: Bench, folder: Path) -> None:
    """The files of the bench; all or none. Raises OutputError."""
    from mdlgen.bench.figure import figure
    from mdlgen.bench.table import markdown

    files: dict[Path, str | bytes] = {
        folder / "bench.json": json.dumps(found.json(), indent=1, allow_nan=False) + "\n",
        folder / "bench.md": markdown(found),
        folder / "bench.png": figure(found),
    }
    paths.write_together(files)


def _warm(solver: str, say: Say, checkout: Path | None = None) -> Outcome:
    """Has a solver compiled in a new process, before anything is measured."""
    say(f"{solver}{BESIDE if checkout else ''}: compiling, or loading what is compiled")
    case = BenchCase("warm", "compile", WARM, _nothing)
    return process.run(Job(case, solver, registry.SOLVERS[solver], 1, None), checkout)


def _nothing(result: Any, reference: Any) -> list:
    return []


def _outcome(
    case: BenchCase, solver: str, references: References, repeats: int, checkout: Path | None = None
) -> Outcome:
    kept = None
    if case.reference is not None:
        kept, reason = references.file(case, case.reference)
        if reason is not None:
            return Outcome(f"no reference: {reason}")
    module = {**registry.SOLVERS, **PEERS}[solver]
    task = Job(case, solver, module, repeats if case.repeats else 1, kept)
    return process.run(task, checkout)


@dataclass
class References:
    """The finer runs that cases are compared with, each run once and stored in `folder`."""

    folder: Path
    say: Say
    failed: dict[Path, str] = field(default_factory=dict)

    def file(self, case: BenchCase, reference: Reference) -> tuple[str, str | None]:
        """Where the states are, and the reason where there are none."""
        file = file_of(reference, registry.SOLVERS[reference.solver], self.folder)
        if not file.exists() and file not in self.failed:
            self.say(f"  reference: {reference.solver} at {reference.run.step:g} ms")
            finer = replace(case, run=reference.run, measure=_nothing, reference=None, limit=REFERENCE_LIMIT)
            module = registry.SOLVERS[reference.solver]
            outcome = process.run(Job(finer, reference.solver, module, 1, None, str(file)))
            if outcome.status != OK:
                self.failed[file] = outcome.status
        return str(file), self.failed.get(file)
