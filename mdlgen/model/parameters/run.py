"""Rows of the run: its times, the steps and tolerance of a solver that reads a text, and gravity."""

from __future__ import annotations

from mdlgen.model.parameters.names import NAMED_AXES
from mdlgen.model.tables import Parameter, RunSettings
from mdlgen.spec.scene import Scene

RUN = "run"  # data set
PAPER_STEP = 0.01
"""The longest step of MotionSolve where the scene gives none: the paper's [ms]."""
TOLERANCE = 1e-3
"""Error that MotionSolve's integrator may make, as MotionView writes it."""


def longest_step(run: RunSettings) -> float:
    """The longest step that MotionSolve may take [ms]."""
    return run.step if run.step is not None else min(PAPER_STEP, run.print_step)


def run_rows(scene: Scene, run: RunSettings) -> list[Parameter]:
    """All rows."""
    rows = [
        Parameter(RUN, "end", "End time", run.duration, "ms", (RUN, "duration")),
        Parameter(RUN, "print", "Print interval", run.print_step, "ms", (RUN, "print_step")),
        Parameter(RUN, "h_max", "Longest step", longest_step(run), "ms", (RUN, "step")),
        Parameter(RUN, "tol", "Error that the integrator may make", TOLERANCE, "1", None),
    ]
    for k, axis in enumerate(NAMED_AXES):
        label = f"Gravity along {axis}"
        rows.append(Parameter(RUN, f"g_{axis}", label, scene.gravity[k], "mm/ms^2", ("gravity", k)))
    return rows


def step_source(scene: Scene) -> tuple[tuple[str | int, ...], str]:
    """Where the value stands that the longest step follows from where none is given, and how."""
    if scene.run.step is not None:
        return (), "{}"
    if scene.run.print_step is not None:
        return (RUN, "print_step"), f"min({{}}, {PAPER_STEP!r} ms)"
    return (RUN, "duration"), f"min(({{}})/200, {PAPER_STEP!r} ms)"
