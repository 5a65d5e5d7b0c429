"""The bench of the numbers as text: the output of the command, and the page of the manual."""

from __future__ import annotations

from collections.abc import Iterable

from mdlgen.bench.tuning.numbers import Number
from mdlgen.bench.tuning.row import CUT, Outcome, Tuning, TuningRow
from mdlgen.errors import printable

HEAD = """# Numbers of the solver

The solver lattice has numbers that are not physics: limits of iterations, tolerances, parts of a step. All of
them stand in `backends/lattice/kernels/tuning.py`. `mdlgen bench tuning` halves and doubles each number and
runs twelve short scenes. The solver is compiled once, with its numbers as variables. It needs the extra
`compile` and takes minutes.

- A number that changes nothing in any scene may be removed, if no other scene needs it.
- A number that decides whether a run ends is a fault, since no choice of the user decides it.

`mdlgen bench tuning --page docs/validation/tuning.md` writes this page. `tuning.json` in the folder of the
output holds the outcome of each run.
"""

COLUMNS = """The columns:

- results: largest change of a final position. It is relative to the greatest displacement of a body in the
  unchanged run. In scenes with collisions small changes grow.
- iterations, steps: of a run, relative to the unchanged run. The column shows the ratio that is farthest
  from 1.
- same: runs that are bitwise identical to the unchanged one, of all.
- ends: a scene that ends unchanged, but not with this factor, or the other way round. `cut`: the run took
  more than ten times the processor time of the unchanged run (1 s at least) and was stopped.

A count stays a whole number. Doubling may move a part above 1, where it has no meaning any more.
"""

UNSEEN = """Some of these numbers act only in longer runs or on larger scenes. A number in s or bytes limits
wall time or memory. Others limit steps, states or iterations that no short run reaches. So a number of this
list is not yet shown to be useless."""


def table(found: Tuning) -> str:
    """The output of the command."""
    return "\n".join([*_head(found), "", *_body(found), ""])


def page(found: Tuning) -> str:
    """The page of the manual."""
    return "\n".join([HEAD, *_head(found), "", *_body(found), ""])


def said(row: TuningRow) -> str:
    """A row in one line, as it is reported while the bench runs."""
    decided = [outcome.scene for outcome in row.outcomes if outcome.decided]
    changed = sum(not outcome.same for outcome in row.outcomes)
    ends = f", decides whether a run ends: {', '.join(decided)}" if decided else ""
    return f"{row.name} x {row.factor:g}: changes {changed} of {len(row.outcomes)} scenes{ends}"


def unused(found: Tuning) -> list[Number]:
    """Numbers that change nothing in any scene."""
    rows = {number.name: found.of(number.name) for number in found.numbers}
    return [n for n in found.numbers if rows[n.name] and all(o.same for o in _outcomes(rows[n.name]))]


def deciding(found: Tuning) -> list[Number]:
    """Numbers that decide whether a run ends."""
    return [n for n in found.numbers if any(o.decided for o in _outcomes(found.of(n.name)))]


def _outcomes(rows: list[TuningRow]) -> list[Outcome]:
    return [outcome for row in rows for outcome in row.outcomes]


def _head(found: Tuning) -> list[str]:
    versions = ", ".join(f"{name} {number}" for name, number in found.versions.items())
    varied = {row.name for row in found.rows}
    frozen = [number for number in found.numbers if number.frozen]
    left = len(found.numbers) - len(varied) - len(frozen)
    lines = [
        f"{len(found.numbers)} numbers, {len(varied)} varied, on {len(found.references)} scenes; "
        f"{found.machine.get('cpu', '')}, one core; {versions}."
    ]
    if left:
        lines += ["", f"The run was interrupted: {left} numbers have no result yet."]
    return lines


def _body(found: Tuning) -> list[str]:
    lines = ["## Scenes", "", _line(("scene", "what", "status", "steps", "iterations", "time"))]
    lines.append(_line(("---",) * 6))
    for each in found.references:
        counts = str(each.steps), str(each.iterations), f"{1e3 * each.cpu_s:.3g} ms"
        lines.append(_line((each.scene, each.meaning, _printed(each.status), *counts)))
    lines += ["", "## Decides whether a run ends", "", *_deciding(found)]
    lines += ["", "## Changes nothing", "", *_unused(found)]
    lines += ["", "## All numbers", "", COLUMNS, *_all(found)]
    frozen = [number for number in found.numbers if number.frozen]
    return [*lines, "", "## Not varied", "", *([f"- `{n.name}`: {n.frozen}" for n in frozen] or ["None."])]


def _deciding(found: Tuning) -> list[str]:
    lines = []
    for number in deciding(found):
        for row in found.of(number.name):
            ends = [f"{o.scene} ({_printed(o.status)})" for o in row.outcomes if o.decided]
            if ends:
                lines.append(f"- `{row.name}` = {row.value:g} (x {row.factor:g}): {', '.join(ends)}")
    return lines or ["None."]


def _unused(found: Tuning) -> list[str]:
    names = [f"`{n.name}`{f' {n.unit}' if n.unit else ''}" for n in unused(found)]
    return [", ".join(names) + ".", "", UNSEEN] if names else ["None."]


def _all(found: Tuning) -> list[str]:
    head = ("number", "value", "origin", "same", "results", "iterations", "steps", "ends")
    lines = [_line(head), _line(("---",) * len(head))]
    for number in found.numbers:
        outcomes = _outcomes(found.of(number.name))
        if not outcomes:
            continue
        same = sum(outcome.same for outcome in outcomes)
        cut = any(outcome.status == CUT for outcome in outcomes)
        ends = ", ".join(dict.fromkeys(o.scene for o in outcomes if o.decided)) + (" (cut)" if cut else "")
        cells = (
            f"{same}/{len(outcomes)}",
            _most((o.moved, o) for o in outcomes),
            _farthest((o.iterations, o) for o in outcomes),
            _farthest((o.steps, o) for o in outcomes),
            ends,
        )
        value = f"{number.value:.6g}{' ' + number.unit.split(',')[0] if number.unit else ''}"
        lines.append(_line((f"`{number.name}`", value, number.origin, *cells)))
    return lines


def _most(values: Iterable[tuple[float | None, Outcome]]) -> str:
    """The largest value with its scene; empty where it is 0."""
    known = [(value, outcome.scene) for value, outcome in values if value is not None]
    value, scene = max(known, default=(0.0, ""))
    return f"{value:.1e} {scene}" if value > 0.0 else ""


def _farthest(values: Iterable[tuple[float | None, Outcome]]) -> str:
    """The ratio that is farthest from 1, with its scene, of complete runs; empty where all are 1."""
    known = [(value, o.scene) for value, o in values if value is not None and value > 0.0 and o.ended]
    value, scene = max(known, key=lambda pair: max(pair[0], 1.0 / pair[0]), default=(1.0, ""))
    return f"{value:.2f} {scene}" if value != 1.0 else ""


def _printed(text: str) -> str:
    return printable(text).replace("|", "/").replace("\n", " ")


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"
