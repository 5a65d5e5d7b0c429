"""Backends by name. A backend is imported when it is asked for, and not before."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from importlib import import_module
from typing import TYPE_CHECKING, Any

from mdlgen.backend import Backend, Progress
from mdlgen.errors import RefusedError, SpecError, did_you_mean
from mdlgen.model.external import refuse_externals
from mdlgen.model.tables import Model
from mdlgen.program.kernel import LAWS

if TYPE_CHECKING:
    from mdlgen.results.result import Result
    from mdlgen.runs.checkpoint import Checkpointer

# Name of a backend -> its package.
EMITTERS = {name: f"mdlgen.backends.{name}" for name in ("motionview", "motionsolve", "msolve")}
SOLVERS = {"exudyn": "mdlgen.backends.exudyn_local", "lattice": "mdlgen.backends.lattice"}
TEXT, DECK, SCRIPT = "motionview", "motionsolve", "msolve"
FAST, REFERENCE = "lattice", "exudyn"
AUTO = (FAST, REFERENCE)  # in this order: the fast one where it can represent the scene


def emitter(name: str) -> Backend:
    """The backend that writes a text, and reads it back. Raises SpecError for one that there is not."""
    _known(name, EMITTERS, "text backend")
    return _backend(EMITTERS[name])


def solver(name: str) -> Backend:
    """The backend that runs a Model, by its name. Raises SpecError for one that there is not."""
    _known(name, SOLVERS, "solver")
    return _backend(SOLVERS[name])


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


def _backend(package: str) -> Backend:
    return import_module(package).BACKEND


def check_solver(name: str) -> None:
    """Raises SpecError for a solver that there is not, without importing one."""
    if name != "auto":
        _known(name, SOLVERS, "solver")


def packages(name: str) -> tuple[str, ...]:
    """The packages from whose code the bits of a solver's runs follow; `auto`: of all it may choose from."""
    return (*(SOLVERS[each] for each in (AUTO if name == "auto" else (name,))), LAWS)


def check_resumes(name: str, reason: str, wish: str) -> None:
    """Raises RefusedError by name where a solver, chosen for a reason, writes no checkpoints for a wish."""
    if not solver(name).capabilities.resumes:
        why = f" ({reason})" if reason else ""
        others = [other for other in SOLVERS if solver(other).capabilities.resumes]
        raise RefusedError(
            f"{wish}: {name} runs this scene{why}, and cannot store all of its state, so its runs cannot be "
            f"resumed; {', '.join(others)} can: give --solver {others[0]}"
        )


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
        solver(first).check(model)
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
    checkpointer: Checkpointer | None = None,
    threads: int = 1,
) -> Result:
    """Run a Model; see `mdlgen.solve`. `checkpointer` writes states, of a solver that can; `threads` are how
    many it may use, where it has use for them."""
    from mdlgen.results.estimates import marked
    from mdlgen.results.required import check

    check(model)
    backend = solver(chosen(name, model)[0])
    options: dict[str, Any] = {}
    if checkpointer is not None and backend.capabilities.resumes:
        options["keep"] = checkpointer
    if backend.capabilities.threads > 1:
        options["threads"] = threads
    result = backend.solve(model, progress, **options)
    if result.error_estimate is not None or result.error_unknown:
        result = marked(result)
    result.ran_at = _now()
    # a static run has no step, and a failed one nothing to compare
    if not check_step or not result.usable or result.step <= 0.0:
        return result
    from mdlgen.results.estimates import NOT_KNOWN, estimated

    finer = backend.solve(model, progress, step=result.step / 2, **options)
    if not finer.usable:
        half = f"a run at half the step ({result.step / 2:.6g} ms) ended early: {finer.status}"
        return marked(replace(result, error_estimate=None, error_unknown=f"{NOT_KNOWN}: {half}"))
    # kernels are compiled once, for the first of the two
    compile_s = result.compile_s + finer.compile_s
    checked = replace(finer, checks=True, compile_s=compile_s, ran_at=_now())
    return marked(estimated(checked, (result, *result.coarser)[:2]))
