"""Messages to and from a process that runs scenes."""

from __future__ import annotations

from dataclasses import dataclass

# Limit of the runs at finer steps, relative to that of the scene: they have 8 and 16 times its steps.
FINER = 10.0


@dataclass(frozen=True)
class Task:
    """Asks for one scene. `fine`: compare it with finer steps as well."""

    seed: int
    number: int
    fine: bool
    solver: str = "auto"
    kind: str = ""  # empty: drawn
    limit: float = 60.0  # of processor time of its run [s]; its finer runs have FINER times that
    sticking: bool = False  # friction sticks in half of its contacts
    compile: bool = False  # prepares the solver alone


@dataclass(frozen=True)
class Begun:
    """Answers that a scene is drawn and its run begins; limits count from here."""

    kind: str
    boxes: int
    rejected: tuple[str, ...]
