"""What the process that runs scenes is asked, and its first answer."""

from __future__ import annotations

from dataclasses import dataclass

# Limit of the runs at finer steps, relative to that of the scene: they have 8 and 16 times its steps.
FINER = 10.0


@dataclass(frozen=True)
class Task:
    """One scene; `fine`: to be compared with finer steps as well."""

    seed: int
    number: int
    fine: bool
    solver: str = "auto"
    kind: str = ""  # empty: drawn
    limit: float = 60.0  # of processor time of its run [s]; its finer runs have FINER times that
    compile: bool = False  # prepares the solver alone


@dataclass(frozen=True)
class Begun:
    """What is sent before a scene is run: the limit of time counts from here."""

    kind: str
    boxes: int
    rejected: tuple[str, ...]
