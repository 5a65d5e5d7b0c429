"""Reads .mdl text back: statements, expressions, entities and what a lint has to say of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mdlgen.backends.motionview.reader.reading import Reading
from mdlgen.backends.motionview.reader.report import Finding, Report

__all__ = ["Finding", "Reading", "Report", "lint", "read", "values"]


def read(text: str, file: str = "<text>", folder: Path | None = None) -> Reading:
    """One reading, for both the report and the values.

    `folder` is where the text lies: files that it includes are read there and below. Without it the disk is
    not touched. Raises SpecError with file:line:column where the text is no model at all.
    """
    return Reading(text, file, folder)


def lint(text: str, file: str = "<text>") -> Report:
    """Errors and doubtful places in an MDL file, each with its place."""
    return Reading(text, file).report


def values(text: str, file: str = "<text>") -> dict[str, Any]:
    """Every evaluated entity, in mm, kg, s, N and rad, by kind and full name (`sys_a.p_top`, `b_wheel.l`)."""
    return Reading(text, file).values
