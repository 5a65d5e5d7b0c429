"""The fast solver: sheets as banded lattices, rollers in minimal coordinates, an implicit midpoint rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mdlgen.backend import Backend, Capabilities, Progress, Shipped

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result
    from mdlgen.runs.checkpoint import Checkpointer

__all__ = ["BACKEND", "check", "solve"]


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that this solver cannot represent."""
    from mdlgen.backends.lattice import scope

    scope.check(model)


def solve(
    model: Model,
    progress: Progress | None = None,
    step: float | None = None,
    without: tuple[str, ...] = (),
    keep: Checkpointer | None = None,
    threads: int = 1,
) -> Result:
    """Run a Model; see `mdlgen.backends.lattice.run.solve`."""
    from mdlgen.backends.lattice import run

    return run.solve(model, progress, step, without, keep, threads)


_SHORT = ("run.duration=0.4 ms", "run.print_step=0.2 ms", "run.step=0.1 ms")
_FEW = ("sheets.note.boxes=[2, 3]",)
BACKEND = Backend(
    check=check,
    solve=solve,
    capabilities=Capabilities(resumes=True, threads=2),
    shipped=Shipped(
        "mdlgen.backends.lattice.kernels.entries",
        (("transport_4x4.yaml", _SHORT), ("pick.yaml", _SHORT), ("cantilever.yaml", _FEW)),
    ),
)
