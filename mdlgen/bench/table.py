"""The bench as text: bench.md, which is also what the command prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.bench import core_table
from mdlgen.bench.fits import fits
from mdlgen.bench.numerals import number, time
from mdlgen.bench.row import OK, BenchRow
from mdlgen.errors import printable

if TYPE_CHECKING:
    from mdlgen.bench.run import Bench

HEAD = (
    *("case", "solver", "step", "status", "of what", "error", "allowed", "own estimate"),
    *("wall", "for the estimate", "wall per step", "solves per step"),
)


def markdown(found: Bench) -> str:
    """Machine, versions, one table per suite, and what the rows say together."""
    machine, versions = found.machine, found.versions
    parts = [
        "# Run time against error",
        f"{machine['cpu']}, {machine['cores']} cores, one thread used; Python {machine['python']}; "
        + ", ".join(f"{name} {number}" for name, number in versions.items())
        + ". Wall time is the median of the repeats, solving only; the runs at other steps from which a "
        "solver estimates its error are listed separately. A solve is one of the linear equations of a step.",
    ]
    for suite in dict.fromkeys(row.suite for row in found.rows):
        rows = [row for row in found.rows if row.suite == suite]
        parts += [f"## {suite}", _table(suite, rows), _reasons(rows), f"To repeat one: `{rows[0].command}`"]
    return "\n\n".join(part for part in [*parts, *_together(found)] if part) + "\n"


def _table(suite: str, rows: list[BenchRow]) -> str:
    head, cells = (core_table.HEAD, core_table.cells) if suite == core_table.SUITE else (HEAD, _cells)
    lines = [head, ("---",) * len(head), *map(cells, rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _cells(row: BenchRow) -> tuple[str, ...]:
    per_step = row.wall_s / row.steps if row.wall_s and row.steps else None
    solves = row.iterations / row.steps if row.iterations and row.steps else None
    return (
        row.case,
        row.solver,
        time(row.step_s),
        row.status if row.status == OK else f"**{row.status}**",
        row.quantity,
        number(row.error),
        number(row.tolerance),
        number(row.error_estimate),
        time(row.wall_s),
        time(row.estimate_s or None),
        time(per_step),
        number(solves),
    )


def _reasons(rows: list[BenchRow]) -> str:
    message = [f"- {row.case}, {row.solver}: {row.status}: {row.reason}" for row in rows if row.status != OK]
    return "\n".join(printable(line).replace("|", "/") for line in message)


def _together(found: Bench) -> list[str]:
    record = fits(found.rows)
    lines = [
        *(f"- {label}: order {order:.2f}" for label, order in record["order"].items()),
        *(
            f"- {label}: {time(at['wall_s'])} at an error of {at['error']:g}"
            + ("" if at["fastest"] == label else f", {at['times_fastest']:.3g} times {at['fastest']}")
            for label, at in record["wall_at_equal_error"].items()
        ),
        *(
            f"- {label}: does not come to that; the least is {at['error']:.3g}, in {time(at['wall_s'])}"
            for label, at in record["least_error"].items()
        ),
        *(
            f"- {solver}: wall time grows with the boxes at a fixed aspect to the power {power:.2f}"
            for solver, power in record["growth"].items()
        ),
        *(
            f"- {label}: a step takes {growth['times']:.3g} times as long"
            for label, growth in record["piles"].items()
        ),
        *(f"- {rule}: saves {100 * part:.0f} % of the wall time" for rule, part in record["saves"].items()),
        *(f"- not honest: {line}" for line in record["estimates_off"]),
    ]
    counts = {status: sum(row.status == status for row in found.rows) for status in ("ok", "failed", "wrong")}
    summed = ", ".join(f"{count} {status}" for status, count in counts.items())
    return ["## Together", "\n".join(lines), f"{len(found.rows)} rows: {summed}."]
