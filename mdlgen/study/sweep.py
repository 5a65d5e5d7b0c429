"""A sweep: the requested cases, run and stored, and the table of their outcomes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from mdlgen.errors import MdlgenError, OutputError, RefusedError, SpecError
from mdlgen.model.tables import Model
from mdlgen.paths import check_folder, write_together
from mdlgen.study.design.case import Case
from mdlgen.study.design.measure import check_apart, defaults, known, measures
from mdlgen.study.design.task import Task
from mdlgen.study.design.variable import check_count, check_paths, grid, variable
from mdlgen.study.execution.journal import Asked, Journal
from mdlgen.study.execution.row import INACCURATE, CaseRow
from mdlgen.study.execution.workers import Runner

WHAT = "sweep"
# How many cases are tried for one that can be read, from which the names of its numbers are known.
LOOKED_AT = 100
PASSES = "pass=verdict.passed > 0"  # of a scene that requires something: the share of cases that do it

Count = Callable[[int, int], None]


@dataclass(frozen=True)
class Sweep:
    """The request of a sweep: a task and its cases; `how` says how they were chosen."""

    task: Task
    cases: tuple[Case, ...]
    how: str
    name: str  # of the scene
    model: str  # digest of the first case that can be read

    def asked(self) -> Asked:
        """The request in the form of the journal."""
        from mdlgen import registry
        from mdlgen.runs.provenance import provenance

        now = provenance(registry.packages(self.task.solver))
        cases = [[list(value) for value in case.values] for case in self.cases]
        task = asdict(self.task)
        record = {"what": WHAT, "name": self.name, "task": task, "how": self.how, "cases": cases}
        record |= {"model": self.model, **now}
        return json.loads(json.dumps(record))


def over(texts: Sequence[str], draw: tuple[str, int] | None, seed: int) -> tuple[tuple[Case, ...], str]:
    """The cases of `--over` texts, and how they were chosen: every combination, or with `draw` (kind, count)
    a sample of ranges and distributions. Raises SpecError."""
    if not texts:
        raise SpecError("name what is to differ: --over PATH=START:STOP:N, or PATH=[a, b, c]")
    if draw is None:
        return grid([variable(text) for text in texts]), "grid"
    from mdlgen.study.design.distribution import parse_distribution
    from mdlgen.study.design.sampling import sample

    kind, count = draw
    drawn = [parse_distribution(text) for text in texts]
    check_paths([one.path for one in drawn])
    check_count(count)
    points = sample(kind, count, drawn, seed)
    check_count(len(points))
    cases = tuple(
        Case(index, tuple((one.path, one.text(value)) for one, value in zip(drawn, point, strict=True)))
        for index, point in enumerate(points)
    )
    return cases, f"{kind} {count}, seed {seed}"


def sweep(
    task: Task, cases: Sequence[Case], how: str, asked: Iterable[str] = (), events: Iterable[str] = ()
) -> Sweep:
    """A Sweep whose measures are the texts `asked` for, travel, speed and yaw of the sheets where there are
    none, and the `events`, conditions that hold where something happened. Where the scene requires something,
    and none of them is about verdicts, whether a case does all of it is one of the events.

    Raises SpecError for a measure that there is not, and where not one of the cases can be read.
    """
    from mdlgen.runs.provenance import digest
    from mdlgen.study.design.link import check_links

    check_links(task.lets, [path for path, _ in cases[0].values])
    model = first_model(task, cases)
    names = known(model)
    asked = list(asked)
    wanted = measures(asked or defaults(model), names, "--measure")
    events = list(events)
    if model.require and not any("verdict." in text for text in (*asked, *events)):
        events.append(PASSES)
    happened = measures(events, names, "--event")
    check_apart([name for name, _ in (*wanted, *happened, *cases[0].values)])
    task = replace(task, measures=wanted + happened, events=tuple(name for name, _ in happened))
    return Sweep(task, tuple(cases), how, model.name, digest(model))


def first_model(task: Task, cases: Sequence[Case]) -> Model:
    """The Model of the first case that can be read. Raises the first error where none of a hundred can."""
    first: MdlgenError | None = None
    stride = max(1, len(cases) // LOOKED_AT)
    for case in cases[::stride][:LOOKED_AT]:
        try:
            return task.model(case)
        except MdlgenError as error:
            first = first or error
    assert first is not None, "a sweep has a case"
    raise first


def opened(folder: Path, wanted: Sweep | None, resume: bool) -> tuple[Sweep, Journal]:
    """A sweep and its journal in `folder`: a new one, or with `resume` the one that is there, as it was asked
    for (`wanted` is what is asked for now, None: the same).

    Raises OutputError, and RefusedError by name where another sweep is there, or where it would not resume
    with bitwise identical results.
    """
    from mdlgen.runs.provenance import digest

    if not resume:
        assert wanted is not None, "a new sweep has been asked for"
        return wanted, Journal.create(folder, wanted.asked())
    journal = Journal.resume(folder)
    try:
        there = _read(folder, journal.asked)
        if wanted is None:
            wanted = replace(there, model=digest(first_model(there.task, there.cases)))
        _compare(folder, journal.asked, wanted.asked())
        return there, journal
    except BaseException:
        journal.close()
        raise


def _read(folder: Path, asked: Asked) -> Sweep:
    try:
        if asked["what"] != WHAT:
            raise ValueError(f"of {asked['what']!s:.40}")
        values = [tuple((str(path), str(text)) for path, text in case) for case in asked["cases"]]
        cases = tuple(Case(index, value) for index, value in enumerate(values))
        if not cases:
            raise ValueError("it has no cases")
        return Sweep(
            Task.of(asked["task"]), cases, str(asked["how"]), str(asked["name"]), str(asked["model"])
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise OutputError(f"{folder}: the journal there is not of a sweep ({str(error)[:80]})") from None


_WORDS = {
    "text": "the scene",
    "sets": "--set",
    "limits": "--limit",
    "solver": "--solver",
    "check_step": "--check-step",
    "measures": "--measure or --event",
    "lets": "--let",
    "keep": "--keep",
    "cases": "--over, --sample or --seed",
}


def _compare(folder: Path, there: Asked, now: Asked) -> None:
    """Raises RefusedError by name where the sweep in `folder` is another one, or would give other bits."""
    from mdlgen.runs.provenance import check_same

    mine, theirs = {**now["task"], "cases": now["cases"]}, {**there["task"], "cases": there["cases"]}
    for name, word in _WORDS.items():
        if mine[name] != theirs.get(name):
            raise RefusedError(f"{folder}: holds another sweep: {word} differs; name another folder")
    others = ("what", "name", "task", "how", "cases")
    check_same(folder, there, {name: value for name, value in now.items() if name not in others})


def run(wanted: Sweep, journal: Journal, runner: Runner, progress: Count | None = None) -> list[CaseRow]:
    """Runs the cases that the journal has not, and gives all rows by index. Raises OutputError."""
    todo = [case for case in wanted.cases if case.index not in journal.rows]
    report = progress or (lambda done, total: None)
    report(len(journal.rows), len(wanted.cases))
    for row in runner.rows(wanted.task, todo) if todo else ():
        keep(journal.folder, row)
        journal.append(row)
        report(len(journal.rows), len(wanted.cases))
    return [journal.rows[case.index] for case in wanted.cases]


def keep(folder: Path, row: CaseRow) -> None:
    """Writes the files of a run that came with its row into `folder/case_N`. Raises OutputError."""
    if not row.files:
        return
    place = folder / Case(row.index, row.values).name
    check_folder(place)
    try:
        place.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{place}: cannot make this folder: {error.strerror or error}") from None
    write_together({place / name: content for name, content in row.files.items()})


def summary(rows: Sequence[CaseRow]) -> str:
    """One line: how many cases failed, and of what, the most frequent reasons first."""
    failed = [row for row in rows if not row.measured]
    loose = [row for row in rows if row.kind == INACCURATE]
    line = f"{len(rows)} cases, none failed"
    if failed:
        reasons: dict[str, list[CaseRow]] = {}
        for row in failed:
            reasons.setdefault(row.status, []).append(row)
        most = sorted(reasons.items(), key=lambda item: -len(item[1]))
        shown = "; ".join(f"{len(those)} x {why[:120]} (case {those[0].index})" for why, those in most[:3])
        more = f"; {len(most) - 3} other reasons" if len(most) > 3 else ""
        line = f"{len(failed)} of {len(rows)} cases failed: {shown}{more}"
    if loose:
        line += f"; {len(loose)} have an error estimate above run.tolerance"
    return line
