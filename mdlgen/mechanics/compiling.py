"""Compiling, which takes a while and happens once on a machine."""

from __future__ import annotations

import importlib
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

LOG = logging.getLogger("mdlgen.compiling")

# Compiled code counts who holds an array, by an atomic operation at each begin and end of a function: in one
# of many arrays that is called for each pair, this was a tenth of a run. What BORROWS leaves the counting to
# its caller, and can make no array; what it calls inherits that, but for what OWNS arrays of its own.
BORROWS: dict[str, Any] = {"_nrt": False}
OWNS: dict[str, Any] = {"_nrt": True}


@contextmanager
def told() -> Iterator[None]:
    """Logs (INFO, how many so far) each function that is compiled inside; what is loaded is not told."""
    from numba.core import event

    class Counter(event.Listener):
        done = 0

        def on_start(self, event: event.Event) -> None:
            """Nothing is done yet."""

        def on_end(self, event: event.Event) -> None:
            self.done += 1
            LOG.info("%d", self.done)

    with event.install_listener("numba:compile", Counter()):
        yield


def without_blas() -> None:
    """Has numba know of no BLAS in this process, which is to be a command of ours.

    It looks for scipy's, to lend it to compiled code; that takes a sixth of a second of each run, and our
    laws and solvers call none.
    """
    lender, asks = "scipy.linalg", "numba.np.arraymath"
    if lender in sys.modules or asks in sys.modules:
        return
    sys.modules.update({lender: None})  # pyright: ignore[reportCallIssue, reportArgumentType]
    try:
        importlib.import_module(asks)
    finally:
        del sys.modules[lender]


@cache
def go_on_unkept() -> None:
    """From here on, code that cannot be kept, as on a full disk, is used all the same.

    numba raises OSError in the middle of a compilation, where it would end a run that needs no room at all.
    """
    from numba.core.caching import FunctionCache

    keep = FunctionCache.save_overload

    def try_to_keep(self: FunctionCache, sig: Any, data: Any) -> None:
        try:
            keep(self, sig, data)
        except OSError as error:
            LOG.debug("compiled code is not kept: %s", error.strerror)

    FunctionCache.save_overload = try_to_keep
