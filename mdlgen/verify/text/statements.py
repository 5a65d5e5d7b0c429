"""Statements of which no value speaks: those of the text that mdlgen writes must be there, and no others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any

from mdlgen.verify.inputs.scope import Scope
from mdlgen.verify.outcome import Verification
from mdlgen.verify.tables import Difference

_SHOWN = 120  # characters of a statement in a message
# Findings of lint about statements that `unaccounted` reports itself.
_REPORTED_HERE = ("unknown", "include", "unread", "standard")
# Findings that change nothing of what the text says.
_HARMLESS = ("ascii", "unused", "comment", "attachment")
_MOST_NOTES = 5


def unaccounted(mine: Any, given: Any, scope: Scope) -> Iterator[Difference]:
    """Statements that a given MDL file has more, or less, than the text `mine` that mdlgen writes."""
    due = Counter(rest.key for rest in mine.remainder())
    for rest in given.remainder():
        if due[rest.key]:
            due[rest.key] -= 1
        elif scope.has(rest):
            message = f"{rest.statement.place()}: {_short(rest.statement)}"
            yield Difference(
                "statement", "", f"{message} is not in the text that mdlgen writes; its effect is not known"
            )
    for rest in mine.remainder():
        if due[rest.key]:
            due[rest.key] -= 1
            yield Difference("statement", "", f"{_short(rest.statement)} is missing")


def remarks(given: Any, scope: Scope, found: Verification) -> None:
    """Findings of lint in a given MDL file: those in the sheets count, of a host only errors do."""
    notes = []
    for finding in given.report.findings:
        mine = scope.holds(finding.place)
        sheets_only = scope.definitions is not None
        if mine and (finding.code in _REPORTED_HERE or (sheets_only and finding.code == "external")):
            continue
        if finding.severity == "error" or (mine and finding.code not in _HARMLESS):
            found.differs("lint", "", str(finding))
        elif mine or finding.code != "unused":
            notes.append(str(finding))
    found.notes += notes[:_MOST_NOTES]
    if len(notes) > _MOST_NOTES:
        found.notes.append(f"and {len(notes) - _MOST_NOTES} more remarks, which mdlgen lint prints")


def _short(statement: Any) -> str:
    text = str(statement)
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 4]} ..."
