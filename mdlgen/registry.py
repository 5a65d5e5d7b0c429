"""Backends by name. A backend is imported when it is asked for, and not before."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, cast

from mdlgen.errors import RefusedError, SpecError, did_you_mean
from mdlgen.model.external import refuse_externals
from mdlgen.model.tables import Model

if TYPE_CHECKING:
    from mdlgen.results.keep import Keep
    from mdlgen.results.result import Result

Progress = Callable[[float, float, int, int], None]

EMITTERS = {"motionview": "mdlgen.backends.motionview", "motionsolve": "mdlgen.backends.motionsolve"}
READERS = {
    "motionview": "mdlgen.backends.motionview.reader",
    "motionsolve": "mdlgen.backends.motionsolve.reader",
}
SOLVERS = {"exudyn": "mdlgen.backends.exudyn_local", "lattice": "mdlgen.backends.lattice"}
AUTO = ("lattice", "exudyn")  # in this order: the fast one where it can represent the scene


class Emitter(Protocol):
    """What a backend that writes text has."""

    def emit(self, model: Model, **options: Any) -> str: ...

    def check(self, model: Model) -> None: ...

    def companion(self, model: Model, **options: Any) -> str | None: ...

    def companion_reasons(
        self, model: Model, set_contact: bool = False, only: str | None = None
    ) -> list[str]: ...


class Checker(Protocol):
    """What a backend has that says what it cannot represent."""

    def check(self, model: Model) -> None: ...


class Validator(Protocol):
    """What a backend has that checks its own text against a schema."""

    def validate(self, text: str, file: str = ...) -> list[str]: ...


class Reader(Protocol):
    """What a backend that reads its text back has."""

    def read(self, text: str, file: str = ..., folder: Path | None = ...) -> Any: ...


class Solver(Protocol):
    """What a backend that runs a Model has."""

    def solve(
        self, model: Model, progress: Progress | None = None, step: float | None = None, **options: Any
    ) -> Result: ...


def emitter(name: str) -> Emitter:
    """The backend that writes text. Raises SpecError for one that there is not."""
    _known(name, EMITTERS, "text backend")
    return cast(Emitter, import_module(EMITTERS[name]))


def validator(name: str) -> Validator:
    """The backend that checks a text of its kind. Raises SpecError for one that there is not."""
    _known(name, {"motionsolve": ""}, "backend with a schema")
    return cast(Validator, import_module(EMITTERS[name]))


def reader(name: str) -> Reader:
    """The backend that reads a text back. Raises SpecError for one that there is not."""
    _known(name, READERS, "reader")
    return cast(Reader, import_module(READERS[name]))


def solver(name: str) -> Solver:
    """The backend that runs a Model, by its name. Raises SpecError for one that there is not."""
    _known(name, SOLVERS, "solver")
    return cast(Solver, import_module(SOLVERS[name]))


def check_solver(name: str) -> None:
    """Raises SpecError for a solver that there is not, without importing one."""
    if name != "auto":
        _known(name, SOLVERS, "solver")


def chosen(name: str, model: Model) -> tuple[str, str]:
    """The solver that runs a Model, and why it is not the first choice (empty where it is).

    `auto` is the first that can represent the Model. Raises SpecError for a solver that there is not,
    RefusedError for a Model that none can run.
    """
    check_solver(name)
    refuse_externals(model, "local run")
    if name != "auto":
        return name, ""
    first, second = AUTO
    try:
        cast(Checker, import_module(SOLVERS[first])).check(model)
    except RefusedError as error:
        return second, error.message
    return first, ""


def _known(name: str, table: dict[str, str], kind: str) -> None:
    if name not in table:
        names = [*(["auto"] if table is SOLVERS else []), *sorted(table)]
        close = did_you_mean(name[:40], names)
        raise SpecError(f"there is no {kind} {name[:40]!r}{close or ';'} there are: {', '.join(names)}")


def solve(
    model: Model,
    name: str = "auto",
    progress: Progress | None = None,
    check_step: bool = False,
    keep: Keep | None = None,
) -> Result:
    """Run a Model; see `mdlgen.solve`. `keep` is given what the run can go on from, by a solver that can."""
    backend = solver(chosen(name, model)[0])
    options: dict[str, Any] = {"keep": keep} if keep is not None and getattr(backend, "KEEPS", False) else {}
    result = backend.solve(model, progress, **options)
    # a static run has no step, and a failed one nothing to compare
    if not check_step or not result.ok or result.step <= 0.0:
        return result
    from mdlgen.results.estimates import estimated

    finer = backend.solve(model, progress, step=result.step / 2, **options)
    if not finer.ok:
        return finer.failed(f"at half the step ({result.step / 2:.6g} ms): {finer.status}")
    # kernels are compiled once, for the first of the two
    compile_s = result.compile_s + finer.compile_s
    checked = replace(finer, checks=True, compile_s=compile_s)
    return estimated(checked, (result, *result.coarser)[:2])
