"""Shows the log messages of solvers as they work: compilation, and causes of delay."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import logging


@contextlib.contextmanager
def compiling(report: Callable[[int], None]) -> Iterator[None]:
    """Calls `report` with how many parts of a solver have been compiled, as they are; with 0 where its
    program is being prepared."""
    with _logged("mdlgen.compiling", lambda record: report(getattr(record, "parts", 0))):
        yield


@contextlib.contextmanager
def _logged(name: str, report: Callable[[logging.LogRecord], None]) -> Iterator[None]:
    """Calls `report` with each record of a logger."""
    import logging

    class Handler(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            report(record)

    log, handler = logging.getLogger(name), Handler()
    before = log.level, log.propagate
    log.setLevel(logging.INFO)
    log.propagate = False
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.level, log.propagate = before


@contextlib.contextmanager
def slow(report: Callable[[str], None]) -> Iterator[None]:
    """Calls `report` with the step and the body that hold a run up, where it is slow."""
    with _logged("mdlgen.slow", lambda record: report(record.getMessage())):
        yield
