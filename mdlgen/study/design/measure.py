"""Measures of a run: numbers of its summary by dotted name, and expressions of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.results.begun import begun_of
from mdlgen.results.events import KINDS
from mdlgen.results.quantities import all_names
from mdlgen.study.design.expression import Expression, Value, read

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result

AXES = "xyz"
# They differ from run to run of the same case; a study keeps them apart from its table.
TIMES = ("wall_s", "estimate_s", "compile_s", "build_s")
BEARING = ("strain", "curvature", "twist", "tension")
LEFT_OUT = ("error_estimate_of", "estimate_scales", "estimates_below")
MOST = 200  # measures
_NAMED = re.compile(r"\s*([A-Za-z]\w{0,62})\s*=(?!=)(.*)", re.ASCII | re.DOTALL)
_PIECE = re.compile(r"[A-Za-z_]\w*(?:\.\w+)*", re.ASCII)
_TAKEN = ("case", "status", "error_estimate")  # columns of the table


def flat(record: Mapping[str, Any], within: str = "") -> dict[str, Value]:
    """Numbers and vectors of a summary by dotted name; the parts of a vector as NAME.x, .y, .z too.

    `events.jam` is how many there were, `events.jam.NAME` of them with a sheet, a roller or a plate. Texts
    and times are left out. `verdict.margin_1` is the margin of the first requirement.
    """
    found: dict[str, Value] = {}
    for key, value in record.items():
        name = f"{within}{key}"
        if name in LEFT_OUT:
            continue
        if isinstance(value, Mapping):
            found |= flat(value, f"{name}.")
        elif name == "events":
            found |= _counts(value)
        elif name == "verdict.requirements":
            found |= {f"verdict.margin_{k}": _margin(row) for k, row in enumerate(value, 1)}
        elif name in TIMES or isinstance(value, str):
            continue
        elif isinstance(value, (list, tuple)):
            if all(v is None or isinstance(v, (int, float)) for v in value):
                found[name] = None if any(v is None for v in value) else tuple(float(v) for v in value)
                if len(value) == len(AXES):
                    found |= {f"{name}.{axis}": v for axis, v in zip(AXES, value, strict=True)}
        else:
            found[name] = None if value is None else float(value)
    return found


def _margin(row: Mapping[str, Any]) -> float | None:
    """Margin of a requirement in its unit, below zero where it is missed; for an event, minus its count."""
    if row["value"] is None:
        return None
    return float(row["margin"]) if row["margin"] is not None else -float(row["value"])


def _counts(events: Sequence[Mapping[str, Any]]) -> dict[str, Value]:
    found: dict[str, Value] = {f"events.{kind}": 0.0 for kind in KINDS}
    for event in events:
        who = {str(event[part]) for part in ("sheet", "roller", "other", "part") if part in event}
        who |= {*event.get("held_by", ())}
        for name in (f"events.{event['kind']}", *(f"events.{event['kind']}.{part}" for part in who)):
            found[name] = float(found.get(name) or 0.0) + 1.0  # pyright: ignore[reportArgumentType]
    return found


def known(model: Model) -> dict[str, Value]:
    """Every name that a run of this Model has; of the values only which are vectors means anything."""
    from mdlgen.results.summary import summary

    parts = [p.name for p in (*model.sheets, *model.machine)]
    begun = begun_of(model)
    found = flat(summary(begun)) | {f"estimates.{name}": 0.0 for name in all_names(begun)}
    return found | {f"events.{kind}.{part}": 0.0 for kind in KINDS for part in parts}


def defaults(model: Model) -> list[str]:
    """The measures without a choice of the user: travel, speed and yaw of each sheet."""
    names = ("travel_mm", "speed_mm_per_s", "yaw_deg")
    return [f"sheets.{sheet.name}.{name}" for sheet in model.sheets for name in names]


def measures(asked: Iterable[str], names: Mapping[str, Value], option: str) -> tuple[tuple[str, str], ...]:
    """Name and expression of each measure of texts `EXPR` or `NAME=EXPR`; a vector alone becomes three.

    `names` are those that there are (see `known`). Raises SpecError for a name that there is not, a name that
    stands twice, and a vector in the place of a number.
    """
    found: dict[str, str] = {}
    for text in asked:
        given = _NAMED.fullmatch(text)
        expression = read(given[2] if given else text, option)
        name = given[1] if given else expression.text
        check(expression, names, option)
        vector = expression.plain and isinstance(names[expression.names[0]], tuple)
        ends = [f".{axis}" for axis in AXES] if vector else [""]
        for end in ends:
            if name + end in found or name + end in _TAKEN:
                raise SpecError(f"{option}: the name {(name + end)[:80]!r} stands twice in the table")
            found[name + end] = expression.text + end
    if len(found) > MOST:
        raise SpecError(f"{option}: {len(found)} measures; allowed are {MOST}")
    return tuple(found.items())


def check_apart(names: Sequence[str]) -> None:
    """Raises SpecError for a name that stands twice among those of several options."""
    for name in names:
        if names.count(name) > 1:
            raise SpecError(f"the name {name[:80]!r} stands twice in the table; write OTHER={name[:80]}")


def check(expression: Expression, names: Mapping[str, Value], option: str) -> None:
    """Raises SpecError for a name that there is not, and for a vector where a number is due."""
    for name in expression.names:
        if name not in names:
            if name in TIMES:
                raise SpecError(f"{option}: {name} differs from run to run; times.csv has it")
            close = did_you_mean(name[:80], names)
            raise SpecError(
                f"{option}: there is no number {name[:80]!r} in summary.json{close or _near(name, names)}"
            )
    if expression.plain:
        return
    try:
        # any numbers will do: what is wrong with these alone is not wrong with the expression
        expression.value(
            {name: (1.0, 1.0, 1.0) if isinstance(v, tuple) else 1.0 for name, v in names.items()}.get
        )
    except ValueError as error:
        if "vector" in str(error):
            raise SpecError(f"{option}: {error}") from None


def _near(name: str, names: Mapping[str, Value]) -> str:
    """The known names at the level where the name is not known."""
    words = name.split(".")
    for end in range(len(words) - 1, -1, -1):
        head = "".join(f"{word}." for word in words[:end])
        there = list(dict.fromkeys(n[len(head) :].partition(".")[0] for n in names if n.startswith(head)))
        if there:
            shown = ", ".join(there[:20]) + (", ..." if len(there) > 20 else "")
            return f"; {head.rstrip('.') or 'it'} has {shown}"
    return ""


def numbers(result: Result, expressions: Iterable[Expression]) -> dict[str, Value]:
    """The summary of a run by dotted name, as far as the expressions need it."""
    from mdlgen.results.summary import summary

    words = [name.split(".") for expression in expressions for name in expression.names]
    without = []
    judged = any(word[0] == "verdict" for word in words)  # of events, and of what joints bore, too
    if not judged:
        without.append("verdict")
    if not judged and not any(word[0] == "events" for word in words):
        without.append("events")
    if not judged and not any(word[0] == "sheets" and word[2:3] and word[2] in BEARING for word in words):
        without.append("bearing")
    if not any(word[0] == "estimates" for word in words):
        without.append("estimates")
    return flat(summary(result, without))


def measured(result: Result, expressions: Sequence[tuple[str, Expression]]) -> dict[str, float | None]:
    """Each measure of a run by name; None where this run has no such number.

    Raises ValueError with what is wrong: see `Expression.value`, and a name that this run has not.
    """
    there = numbers(result, (expression for _, expression in expressions))

    def lookup(name: str) -> Value:
        if name not in there and name.startswith("estimates."):
            return None  # of a contact that was not touched, or a run at rest
        if name not in there and not name.startswith("events."):
            raise ValueError(f"this case has no {name}")
        return there.get(name, 0.0)

    return {name: expression.value(lookup) for name, expression in expressions}
