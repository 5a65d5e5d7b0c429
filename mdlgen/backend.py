"""The record BACKEND that each folder of `mdlgen/backends` offers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

from mdlgen.errors import RefusedError

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result

# Called with time [ms], end [ms], steps, pairs that touch.
Progress = Callable[[float, float, int, int], None]


@dataclass(frozen=True)
class Capabilities:
    """Further capabilities of a backend."""

    resumes: bool = False  # its runs can be resumed with identical bits: see `mdlgen.runs.checkpoint`
    threads: int = 1  # of which a run of it has use


@dataclass(frozen=True)
class Shipped:
    """The compiled program that comes with a solver, and what it is made from: see `mdlgen.program.build`."""

    module: str  # that has it, as PROGRAM
    scenes: tuple[tuple[str, tuple[str, ...]], ...]  # sample and values; they call every entry with each type


def _lacking(what: str) -> Callable[..., NoReturn]:
    def lacking(*_: Any, **__: Any) -> NoReturn:
        raise RefusedError(f"this backend {what}")

    return lacking


_WRITES_NOTHING, _READS_NOTHING = _lacking("writes no text"), _lacking("reads no text")
_HAS_NO_SCHEMA, _RUNS_NOTHING = _lacking("has no schema"), _lacking("runs nothing")


def _represents_all(_: Model) -> None:
    """Refuses no Model before it is run."""


@dataclass(frozen=True)
class Backend:
    """A backend: each field is a function with the arguments named here, or refuses where there is none.

    `check(model)` raises RefusedError by name for what the backend cannot represent.
    `emit(model, **options)` is the text; `companion(model, **options)` a script to run after it, or None;
    `companion_reasons(model, set_contact, only)` why that is needed, a line each.
    `read(text, file, folder)` reads a text back; `validate(text, file)` names what a schema has against it.
    `solve(model, progress, step, **options)` runs a Model.
    """

    check: Callable[[Model], None] = _represents_all
    emit: Callable[..., str] = _WRITES_NOTHING
    companion: Callable[..., str | None] = _WRITES_NOTHING
    companion_reasons: Callable[..., list[str]] = _WRITES_NOTHING
    read: Callable[..., Any] = _READS_NOTHING
    validate: Callable[..., list[str]] = _HAS_NO_SCHEMA
    solve: Callable[..., Result] = _RUNS_NOTHING
    capabilities: Capabilities = field(default_factory=Capabilities)
    shipped: Shipped | None = None
