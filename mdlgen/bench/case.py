"""A case: one scene, how it is run, and what its result is judged by."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result


@dataclass(frozen=True)
class Finding:
    """One number that a result is judged by; above its tolerance the result is wrong."""

    quantity: str  # name of the quantity, and of its scale
    error: float
    tolerance: float | None = None  # None: the step was forced, and nothing was promised
    details: dict[str, float] = field(default_factory=dict)
    expected: float | None = None  # of a row of the validation: the closed form or the published number,
    found: float | None = None  # the solver's value,
    unit: str = ""  # of both,
    source: str = ""  # where the expected number is from,
    because: str = ""  # and the reason for the tolerance


# The result and, for a case that has one, its reference.
Measure = Callable[["Result", "Result | None"], list[Finding]]


@dataclass(frozen=True)
class Run:
    """A sample scene, what is set in it, and the solver and step that run it."""

    sample: str  # as `mdlgen new --list` names it
    overrides: tuple[str, ...] = ()
    step: float | None = None  # [ms]; None: the solver's choice
    without: tuple[str, ...] = ()  # rules that the solver is not to use, of those that it can do without

    @property
    def sets(self) -> tuple[str, ...]:
        """All overrides, the step included."""
        return self.overrides if self.step is None else (*self.overrides, f"run.step={self.step!r} ms")

    def model(self) -> Model:
        """The scene, lowered. Raises SpecError, OutputError."""
        from mdlgen.model.lower import lower
        from mdlgen.paths import samples
        from mdlgen.spec.load import load

        return lower(load(samples() / f"{self.sample}.yaml", self.sets))

    def text(self) -> str:
        """The scene as it stands in its file."""
        from mdlgen.paths import samples

        return (samples() / f"{self.sample}.yaml").read_bytes().decode("utf-8")

    def command(self, solver: str) -> str:
        """The command that repeats it."""
        if self.without:  # which is no choice of a user's
            return f"mdlgen bench skip --solver {solver}"
        sets = [word for item in self.sets for word in ("--set", item)]
        return shlex.join(["mdlgen", "run", f"samples/{self.sample}.yaml", "--solver", solver, *sets])


# A scene of a moment that has every kind of force: compiles a solver before the first clock starts.
WARM = Run("transport_4x4", ("run.duration=0.1 ms",), 0.05)


@dataclass(frozen=True)
class Reference:
    """A finer run that a case is compared with."""

    run: Run
    solver: str


@dataclass(frozen=True)
class BenchCase:
    """One row or more of the bench."""

    suite: str
    name: str
    run: Run
    measure: Measure
    reference: Reference | None = None
    repeats: bool = True  # true if it measures the wall time
    limit: float = 300.0  # [s] for one run; a solver that takes longer is stopped, and that is its result
    group: str = ""  # heading of the suite's page that it stands under
    warm: bool = False  # true if the solver runs something else first, so that loading it does not count

    def at(self, step: float | None) -> BenchCase:
        """The same case at another step [ms]."""
        return replace(self, run=replace(self.run, step=step))
