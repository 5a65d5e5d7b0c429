"""Constructors for rows of the validation."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.bench.case import BenchCase, Finding, Measure, Run

LIMIT = 120.0  # [s]


def row(group: str, name: str, run: Run, measure: Measure, limit: float = LIMIT) -> BenchCase:
    """One row: run once, in a process of its own."""
    return BenchCase("validation", name, run, measure, repeats=False, limit=limit, group=group)


class Basis(NamedTuple):
    """Where an expected number is from, and why it is allowed to be missed by as much as it is."""

    source: str
    because: str


def against(
    quantity: str,
    expected: float,
    found: float,
    allowed: float,
    unit: str,
    basis: Basis,
    over: float | None = None,
) -> Finding:
    """The measured against the expected value; the error is relative to the expected one, or to `over`."""
    error = abs(found - expected) / abs(expected if over is None else over)
    return Finding(
        quantity,
        error,
        allowed,
        expected=float(expected),
        found=float(found),
        unit=unit,
        source=basis.source,
        because=basis.because,
    )
