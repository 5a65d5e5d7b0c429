"""An optimisation: designs tried one after another, each a row of the table, and the best of them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path

import numpy as np

from mdlgen.errors import OutputError, RefusedError, SpecError
from mdlgen.study.design.case import Case
from mdlgen.study.design.distribution import Choice, Distribution, parse_distribution
from mdlgen.study.design.link import check_links
from mdlgen.study.design.measure import known
from mdlgen.study.design.task import Task
from mdlgen.study.design.variable import check_paths
from mdlgen.study.execution.journal import Asked, Journal
from mdlgen.study.execution.row import CaseRow
from mdlgen.study.execution.workers import Runner
from mdlgen.study.optimise import search
from mdlgen.study.optimise.goal import OBJECTIVE, Goal, goal
from mdlgen.study.optimise.search import Enough, Outcome
from mdlgen.study.sweep import first_model

WHAT = "search"
MOST_RUNS = 10_000

Variables = tuple[Distribution | Choice, ...]
Count = Callable[[int, int], None]


@dataclass(frozen=True)
class Optimisation:
    """The request of an optimisation. `most` limits the number of runs. `precision` is that of the best
    value, as a part of its range; `together` is the number of designs that run at a time (Optuna alone)."""

    task: Task
    vary: tuple[str, ...]
    variables: Variables
    goal: Goal
    method: str
    most: int
    seed: int
    precision: float
    together: int
    name: str  # of the scene
    model: str  # digest of the design in the middle

    def asked(self) -> Asked:
        """The request in the form of the journal."""
        from mdlgen import registry
        from mdlgen.runs.provenance import provenance

        now = provenance(registry.packages(self.task.solver))
        record = {"what": WHAT, **asdict(self), **now}
        del record["variables"]
        return json.loads(json.dumps(record))

    @property
    def how(self) -> str:
        """In words."""
        names = {"brent": "Brent's method between bounds", "cobyqa": "COBYQA", "optuna": "Optuna, TPE"}
        return names[self.method]


def variables(texts: Sequence[str]) -> Variables:
    """Parses `--vary` texts, `PATH=LO:HI` or `PATH=[a, b, c]`. Raises SpecError."""
    found = tuple(parse_distribution(text, "--vary") for text in texts)
    for text, variable in zip(texts, found, strict=True):
        if isinstance(variable, Distribution) and variable.kind != "uniform":
            raise SpecError(f"--vary {text[:80]!r}: a scatter is for mdlgen sweep; write PATH=LO:HI")
    if not found:
        raise SpecError("name what may differ: --vary PATH=LO:HI, or PATH=[a, b, c]")
    check_paths([variable.path for variable in found])
    return found


def optimisation(
    task: Task,
    vary: Sequence[str],
    goal: Goal,
    measures: Iterable[str] = (),
    method: str = "auto",
    most: int = 25,
    seed: int = 1,
    precision: float = search.PRECISION,
    together: int = 1,
) -> Optimisation:
    """Raises SpecError for what cannot be meant, RefusedError where Optuna is needed and not installed."""
    from mdlgen.runs.provenance import digest

    found = variables(vary)
    check_links(task.lets, [variable.path for variable in found])
    chosen = search.method(method, found, len(goal.margins))
    if not 1 <= most <= MOST_RUNS or not 1e-9 <= precision < 1.0 or seed < 0:
        raise SpecError(
            f"--most {most} --precision {precision:g} --seed {seed}: allowed are 1 to {MOST_RUNS} runs, a "
            "precision of 1e-9 to 1, and a seed from 0"
        )
    middle = Case(0, values(found, (0.5,) * len(found)))
    model = first_model(task, [middle])
    task = replace(task, measures=goal.measures(known(model), measures))
    return Optimisation(
        task,
        tuple(vary),
        found,
        goal,
        chosen,
        most,
        seed,
        precision,
        together if chosen == "optuna" else 1,
        model.name,
        digest(model),
    )


def values(variables: Variables, point: Sequence[float]) -> tuple[tuple[str, str], ...]:
    """Path and text of each value of a design, a point of the unit cube."""
    cube = np.clip(np.asarray(point, dtype=float), 0.0, 1.0)
    return tuple((v.path, v.text(float(v.quantile(cube[k : k + 1])[0]))) for k, v in enumerate(variables))


def opened(folder: Path, wanted: Optimisation | None, resume: bool) -> tuple[Optimisation, Journal]:
    """A search and its journal in `folder`: a new one, or with `resume` the one that is there (`wanted` is
    what is asked for now, None: the same).

    Raises OutputError, and RefusedError by name where something else is there.
    """
    if not resume:
        assert wanted is not None, "a new search has been asked for"
        return wanted, Journal.create(folder, wanted.asked())
    journal = Journal.resume(folder)
    try:
        wanted = wanted or _read(folder, journal.asked)
        _compare(folder, journal.asked, wanted.asked())
        return wanted, journal
    except BaseException:
        journal.close()
        raise


def _read(folder: Path, asked: Asked) -> Optimisation:
    """The request of the journal there. Raises OutputError."""
    try:
        if asked["what"] != WHAT:
            raise ValueError(f"of {asked['what']!s:.40}")
        texts = tuple(str(text) for text in asked["goal"]["conditions"])
        message = Task.of(asked["task"])
        found = optimisation(
            replace(message, measures=()),
            [str(text) for text in asked["vary"]],
            goal(str(asked["goal"]["minimise"]), texts),
            (),
            str(asked["method"]),
            int(asked["most"]),
            int(asked["seed"]),
            float(asked["precision"]),
            int(asked["together"]),
        )
        return replace(found, task=replace(found.task, measures=message.measures))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise OutputError(f"{folder}: the journal there is not of a {WHAT} ({str(error)[:80]})") from None


def _compare(folder: Path, there: Asked, now: Asked) -> None:
    if there.get("what") != WHAT:
        raise OutputError(f"{folder}: the journal there is not of a {WHAT}")
    from mdlgen.runs.provenance import check_same

    # more runs may be allowed now
    asked = {field.name for field in fields(Optimisation)} - {"most", "model"}
    for name, value in now.items():
        if name in asked and there.get(name) != value:
            raise RefusedError(f"{folder}: holds another {WHAT}: its {name} differs; name another folder")
    others = asked | {"what", "most"}
    check_same(folder, there, {name: value for name, value in now.items() if name not in others})


class Runs:
    """Runs of designs, none made twice; those that the journal has are taken from there."""

    def __init__(self, wanted: Optimisation, journal: Journal, runner: Runner, progress: Count | None):
        self.wanted, self.journal, self.runner = wanted, journal, runner
        self.progress = progress or (lambda done, total: None)
        self.rows: dict[tuple[tuple[str, str], ...], CaseRow] = {}
        counts = [len(v.texts) if isinstance(v, Choice) else math.inf for v in wanted.variables]
        self.designs = math.prod(counts)  # that there are

    def __call__(self, points: list[tuple[float, ...]]) -> list[Outcome]:
        """Raises Enough when no more runs are allowed, or all designs are known."""
        asked = [values(self.wanted.variables, point) for point in points]
        new = [each for each in dict.fromkeys(asked) if each not in self.rows]
        allowed = self.wanted.most - len(self.rows)
        cases = [Case(len(self.rows) + k, each) for k, each in enumerate(new[:allowed])]
        for row in self._done(cases):
            self.rows[row.values] = row
        if len(new) > allowed or len(self.rows) == self.designs:
            raise Enough
        return [self._outcome(self.rows[each]) for each in asked]

    def _done(self, cases: list[Case]) -> list[CaseRow]:
        there = self.journal.rows
        for case in cases:
            if case.index in there and there[case.index].values != case.values:
                raise RefusedError(
                    f"{self.journal.folder}: cannot go on: case {case.index} there is another design"
                )
        todo = [case for case in cases if case.index not in there]
        for row in self.runner.rows(self.wanted.task, todo) if todo else ():
            self.journal.append(row)
            self.progress(len(there), self.wanted.most)
        return [there[case.index] for case in cases]

    def _outcome(self, row: CaseRow) -> Outcome:
        """A run that failed is worse than all that did not, as far as they are from the best of them."""
        goal = self.wanted.goal
        if goal.complete(row):
            return Outcome(*self._numbers(row))
        known = [self._numbers(other) for other in self.rows.values() if goal.complete(other)]
        objectives = [objective for objective, _ in known] or [0.0]
        worst = max(objectives)
        margins = tuple(max((m[k] for _, m in known), default=1.0) for k in range(len(goal.margins)))
        return Outcome(worst + max(worst - min(objectives), 1e-3 * abs(worst), 1e-9), margins)

    def _numbers(self, row: CaseRow) -> tuple[float, tuple[float, ...]]:
        measures = row.measures
        margins = tuple(float(measures[name] or 0.0) for name in self.wanted.goal.names)
        return float(measures[OBJECTIVE] or 0.0), margins


def run(
    wanted: Optimisation, journal: Journal, runner: Runner, progress: Count | None = None
) -> tuple[list[CaseRow], CaseRow | None]:
    """Searches until the best value is known to `precision`, or the runs are used up: all rows in the order
    of their runs, and the best one; None where none met the conditions. Raises OutputError."""
    runs = Runs(wanted, journal, runner, progress)
    conditions = len(wanted.goal.margins)
    try:
        if wanted.method == "brent":
            search.brent(runs, wanted.precision)
        elif wanted.method == "cobyqa":
            search.cobyqa(runs, len(wanted.variables), conditions, wanted.precision)
        else:
            search.optuna(runs, wanted.variables, wanted.seed, wanted.most, wanted.together)
    except Enough:
        pass
    rows = sorted(runs.rows.values(), key=lambda row: row.index)
    return rows, wanted.goal.best(rows)
