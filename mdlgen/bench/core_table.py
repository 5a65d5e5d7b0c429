"""The table of the suite `core`: what its scenes took."""

from __future__ import annotations

from mdlgen.bench.numerals import number, time
from mdlgen.bench.row import OK, BenchRow

SUITE = "core"
HEAD = (
    *("case", "solver", "status", "step", "steps", "planned", "given up", "iterations per step"),
    *("factors", "solves", "processor time", "of what", "error", "own estimate", "state"),
)


def cells(row: BenchRow) -> tuple[str, ...]:
    """One row. `planned` are steps without a halved one; `state` differs where the last state does."""
    per_step = row.iterations / row.steps if row.iterations and row.steps else None
    counts = (row.details.get(name) for name in ("planned", "given_up", "factors", "solves"))
    planned, given_up, factors, solves = ("" if count is None else f"{count:.0f}" for count in counts)
    state = row.details.get("state")
    return (
        row.case,
        row.solver,
        row.status if row.status == OK else f"**{row.status}**",
        time(row.step_s),
        "" if row.steps is None else str(row.steps),
        planned,
        given_up,
        number(per_step),
        factors,
        solves,
        time(row.cpu_s),
        row.quantity,
        number(row.error),
        number(row.error_estimate),
        "" if state is None else f"{int(state):013x}"[:6],
    )
