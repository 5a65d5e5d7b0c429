"""A design in words, as options, and as a piece of a scene file."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from typing import Any

from mdlgen.study.execution.row import CaseRow
from mdlgen.study.optimise.optimisation import Optimisation

DIGITS = 6  # of a measure that is written for people


def options(overrides: Sequence[str]) -> str:
    """`--set PATH=VALUE` of each, quoted for a shell."""
    return " ".join(f"--set {shlex.quote(item)}" for item in overrides)


def design(found: Optimisation, best: CaseRow) -> tuple[str, ...]:
    """`PATH=VALUE` of each value of the scene that the best design sets, with what follows from it."""
    from mdlgen.study.design.case import Case

    own = found.task.overrides(Case(best.index, best.values))
    return own[len(found.task.sets) :]


def report_text(found: Optimisation, rows: Sequence[CaseRow], best: CaseRow) -> str:
    """A few lines for a terminal."""
    failed = sum(not row.measured for row in rows)
    lines = [
        f"best of {len(rows)} runs ({found.how}): case {best.index}, "
        + ", ".join(f"{path} = {text}" for path, text in best.values),
        *(f"{_word(found, name)} = {_number(value)}" for name, value in best.measures.items()),
        *([f"note: {best.status}"] if not best.ok else []),
        *([f"{failed} of the runs failed; the table has the reasons"] if failed else []),
        f"as options: {options(design(found, best))}",
    ]
    return "\n".join(lines)


def fragment(found: Optimisation, rows: Sequence[CaseRow], best: CaseRow) -> str:
    """The piece of a scene file with the best design; items of lists, which it cannot name, as comments."""
    pieces: dict[str, Any] = {}
    items = []
    overrides = design(found, best)
    for override in overrides:
        path, _, text = override.partition("=")
        words = path.split(".")
        if any(word.isdigit() for word in words):
            items.append(f"# {path}: {text}   (items of a list count from 0)")
            continue
        node = pieces
        for word in words[:-1]:
            node = node.setdefault(word, {})
        node[words[-1]] = text
    goal = found.goal
    lines = [
        f"# Found by mdlgen optimize with the scene {found.name}, {len(rows)} runs ({found.how}):",
        f"# least {goal.minimise}"
        + "".join(f", with {condition}" for condition in goal.conditions)
        + f": {_number(best.measures['objective'])}",
        *(f"# {path} = {text}" for path, text in best.values if f"{path}={text}" not in overrides),
        f"# {options(overrides)}",
        *items,
        *_lines(pieces, 0),
    ]
    return "\n".join(lines) + "\n"


def _lines(pieces: dict[str, Any], depth: int) -> list[str]:
    lines = []
    for key, value in pieces.items():
        if isinstance(value, dict):
            lines += [f"{'  ' * depth}{key}:", *_lines(value, depth + 1)]
        else:
            lines.append(f"{'  ' * depth}{key}: {value}")
    return lines


def _word(found: Optimisation, name: str) -> str:
    goal = found.goal
    if name == "objective":
        return f"objective, {goal.minimise}"
    if name in goal.names:
        return f"{name}, {goal.conditions[goal.names.index(name)]}, missed by (below 0: met)"
    return name


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.{DIGITS}g}"
