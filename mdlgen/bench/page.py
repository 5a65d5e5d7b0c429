"""The pages of samples/ that show a suite, with one column per solver."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from mdlgen.bench.numerals import number, time
from mdlgen.bench.row import FAILED, OK, BenchRow
from mdlgen.errors import SpecError, printable

if TYPE_CHECKING:
    from mdlgen.bench.run import Bench

LADDER = """# The stability ladder

Every rung of `mdlgen bench stability`, as it was last run. A rung is right within what is allowed, or ends
with its reason (exit code 4 of `mdlgen run`); `bench` marks a wrong number with status ok as wrong, and ends
with exit code 5 itself. Errors are relative; what they are of stands in `bench.json`, with the command that
repeats a rung. This page is written by `mdlgen bench stability --repeat 1 --page FILE`.
"""

VALIDATION = """# Validation

Results of the solvers against closed forms and published tables, from the last `mdlgen bench validation`. The
expected numbers share no code with the solvers: they are from the literature or from scipy. "error" is
relative to the expected number (of places, to the length that they are parts of). "estimate" is the solver's
own `error_estimate`, which is of positions; a static run has none, and Exudyn has none where two runs would
take long. The allowed error, which a grid or a smoothing causes, stands under each table. A row that
is off by more is **wrong**, and stays in the table. This page is written by
`mdlgen bench validation --page FILE`.
"""


def page(suite: str, found: Bench) -> str:
    """The page of a suite. Raises SpecError for a suite that has none."""
    return _page_of(suite)([row for row in found.rows if row.suite == suite])


def check_page(suites: Iterable[str]) -> str:
    """The suite that a page is asked of. Raises SpecError where it is not one, or has no page."""
    names = list(suites)
    if len(names) != 1:
        raise SpecError(f"--page shows one suite; give one of: {', '.join(PAGES)}")
    _page_of(names[0])
    return names[0]


def _page_of(suite: str) -> Callable[[list[BenchRow]], str]:
    if suite not in PAGES:
        raise SpecError(f"the suite {suite[:40]!r} has no page; there is one of: {', '.join(PAGES)}")
    return PAGES[suite]


def _ladder(rows: list[BenchRow]) -> str:
    solvers = list(dict.fromkeys(row.solver for row in rows))
    parts = [LADDER, *(f"- {name}: {_counts(rows, name)}" for name in solvers), ""]
    columns = [f"{name}, {what}" for name in solvers for what in ("error", "wall")]
    head = ["rung", "of what", "allowed", *columns]
    parts += [_line(head), _line(["---"] * len(head))]
    for case in dict.fromkeys(row.case for row in rows):
        mine = [row for row in rows if row.case == case]
        # a rung that failed has no quantity: it stands in each line of those that did not
        for quantity in dict.fromkeys(row.quantity for row in mine if row.quantity) or [""]:
            allowed = next((row.tolerance for row in mine if row.quantity == quantity), None)
            cells = [case, quantity, number(allowed)]
            for name in solvers:
                own = [r for r in mine if r.solver == name and r.quantity in (quantity, "")]
                cells += _outcome(own[0]) if own else ["", ""]
            parts.append(_line(cells))
    return "\n".join([*parts, "", "## Reasons", "", *_reasons(rows, "None failed."), ""])


def _validation(rows: list[BenchRow]) -> str:
    solvers = list(dict.fromkeys(row.solver for row in rows))
    parts = [VALIDATION, *(f"- {name}: {_counts(rows, name, 'row')}" for name in solvers), ""]
    columns = [f"{name}{what}" for name in solvers for what in ("", ", error", ", estimate")]
    head = ["case", "quantity", "expected", *columns, "allowed"]
    for group in dict.fromkeys(row.group for row in rows):
        mine = [row for row in rows if row.group == group]
        parts += [f"## {group}", "", _line(head), _line(["---"] * len(head))]
        for case in dict.fromkeys(row.case for row in mine):
            own = [row for row in mine if row.case == case]
            for quantity in dict.fromkeys(row.quantity for row in own if row.quantity) or [""]:
                parts.append(_line(_compared(own, quantity, solvers)))
        parts += ["", *_bases(mine), "", f"To repeat one: `{mine[0].command}`", ""]
    return "\n".join([*parts, "## What is not right", "", *_reasons(rows, "All rows are right."), ""])


def _compared(rows: list[BenchRow], quantity: str, solvers: list[str]) -> list[str]:
    """The cells of one quantity of a case."""
    shown = next((row for row in rows if row.quantity == quantity), rows[0])
    cells = [shown.case, quantity, _with_unit(shown.expected, shown.unit)]
    for name in solvers:
        own = [row for row in rows if row.solver == name and row.quantity in (quantity, "")]
        if not own:
            cells += ["", "", ""]
            continue
        found = "failed" if own[0].status == FAILED else _with_unit(own[0].found, own[0].unit)
        error = number(own[0].error) if own[0].status == OK else f"**{own[0].status}** {number(own[0].error)}"
        cells += [found, error.strip(), number(own[0].error_estimate)]
    return [*cells, number(shown.tolerance)]


def _with_unit(value: float | None, unit: str) -> str:
    return "" if value is None else f"{value:.6g} {unit}".strip()


def _bases(rows: list[BenchRow]) -> list[str]:
    """Where the numbers are from, and why they may be missed: once for all quantities that share it."""
    record: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        names = record.setdefault((row.source, row.because), []) if row.source else []
        if row.quantity not in names:
            names.append(row.quantity)
    return [
        f"- {', '.join(names)}: {source}. Allowed: {because}." for (source, because), names in record.items()
    ]


def _outcome(row: BenchRow) -> list[str]:
    error = number(row.error) if row.status == OK else f"**{row.status}** {number(row.error)}".strip()
    return [error, time(row.wall_s)]


def _counts(rows: list[BenchRow], solver: str, noun: str = "rung") -> str:
    """How many cases of a solver came to what; one of several numbers counts once, as its worst."""
    status: dict[str, str] = {}
    for row in rows:
        if row.solver == solver and status.get(row.case, OK) == OK:
            status[row.case] = row.status
    values = list(status.values())
    record = ", ".join(f"{values.count(k)} {text}" for k, text in COUNTED.items())
    return f"{len(values)} {noun if len(values) == 1 else noun + 's'}: {record}."


COUNTED = {OK: "right", "failed": "failed with a reason", "wrong": "wrong"}


def _reasons(rows: list[BenchRow], none: str) -> list[str]:
    message = dict.fromkeys(
        f"- {row.case}, {row.solver}: {row.status}: {row.reason}" for row in rows if row.status != OK
    )
    return [printable(line).replace("|", "/") for line in message] or [none]


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


PAGES: dict[str, Callable[[list[BenchRow]], str]] = {"stability": _ladder, "validation": _validation}
