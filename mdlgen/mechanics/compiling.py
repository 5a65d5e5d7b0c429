"""Tells that code is being compiled, which takes a while and happens once on a machine."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager

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
