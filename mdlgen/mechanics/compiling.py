"""Compiling, which takes a while and happens once on a machine."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

LOG = logging.getLogger("mdlgen.compiling")


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
