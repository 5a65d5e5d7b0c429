"""Sweeps in the test process."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mdlgen.paths import samples
from mdlgen.study import sweep
from mdlgen.study.design.task import task

INCLINE = samples() / "verify" / "incline.yaml"
FOUR = samples() / "transport_4x4.yaml"
SHORT = ["run.duration=2 ms"]
FRICTION = "contacts.0.friction"


def wanted(
    *over: str, measures: Sequence[str] = (), sets: Sequence[str] = SHORT, **asked: Any
) -> sweep.Sweep:
    cases, how = sweep.over(over, None, 1)
    return sweep.sweep(task(INCLINE, list(sets), **asked), cases, how, measures)
