"""The fast solver: sheets as banded lattices, rollers in minimal coordinates, an implicit midpoint rule."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.keep import Keep
    from mdlgen.results.result import Result

__all__ = ["check", "solve"]

# Its runs can be gone on with: see `mdlgen.results.keep`.
KEEPS = True

Progress = Callable[[float, float, int, int], None]


def check(model: Model) -> None:
    """Raises RefusedError by name for what this solver cannot represent."""
    from mdlgen.backends.lattice import scope

    scope.check(model)


def solve(
    model: Model,
    progress: Progress | None = None,
    step: float | None = None,
    without: tuple[str, ...] = (),
    keep: Keep | None = None,
) -> Result:
    """Run a Model; see `mdlgen.backends.lattice.run.solve`."""
    from mdlgen.backends.lattice import run

    return run.solve(model, progress, step, without, keep)
