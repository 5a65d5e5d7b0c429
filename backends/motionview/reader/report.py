"""Findings in an MDL file, each with its place, and the errors that stop an evaluation."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mdlgen.errors import Place, printable

Severity = Literal["error", "warning"]


class Finding(NamedTuple):
    """One line of a report."""

    severity: Severity
    code: str
    place: Place
    message: str

    def __str__(self) -> str:
        return printable(f"{self.place}: {self.severity}: {self.message} [{self.code}]")


class Report(NamedTuple):
    """All findings of a text and its files, in the order of their places."""

    findings: tuple[Finding, ...]
    statements: int

    @property
    def errors(self) -> list[Finding]:
        return [f for f in self.findings if f.severity == "error"]

    @property
    def warnings(self) -> list[Finding]:
        return [f for f in self.findings if f.severity == "warning"]


class Trouble(Exception):
    """Reason why an entity or an expression has no value. All values that depend on it share the same object,
    which is reported once.

    `shift` is where in the expression, until `place` is known.
    """

    def __init__(self, code: str, message: str, shift: int = 0, severity: Severity = "error"):
        super().__init__(message)
        self.code = code
        self.message = message
        self.shift = shift
        self.severity: Severity = severity
        self.place: Place | None = None


class Notes:
    """Findings while they are collected; the same one twice counts once."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, Place, str], Finding] = {}

    def add(self, severity: Severity, code: str, place: Place, message: str) -> None:
        """One finding more."""
        finding = Finding(severity, code, place, " ".join(message.split()))
        self._found.setdefault((code, place, finding.message), finding)

    def add_trouble(self, trouble: Trouble, place: Place) -> None:
        """A trouble as a finding; `place` where it does not know its own."""
        self.add(trouble.severity, trouble.code, trouble.place or place, trouble.message)

    def findings(self) -> tuple[Finding, ...]:
        """By place."""
        return tuple(sorted(self._found.values(), key=lambda f: (*f.place, f.code)))
