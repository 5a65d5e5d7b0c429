"""Threads that take parts of the jobs of one pass, for as long as it lasts (see kernels.parallel)."""

from __future__ import annotations

import ctypes
import functools
import sys
from threading import Event, Thread
from time import perf_counter, thread_time
from typing import Any

from mdlgen.backends.lattice.kernels.parallel import CLOSED, HELPERS, LEAVE
from mdlgen.backends.lattice.kernels.state import Workspace

# How often a helper looks for a part before it sleeps (some tens of microseconds), and how long it sleeps
# [s]: twice as long each time that it found none. One that sleeps holds nobody up: others take its parts.
LOOKS, SHORTEST, LONGEST = 10_000, 2e-5, 2e-4
# A helper that waited this long for a processor [s] held up the thread of the run, where it had begun a part.
# On a busy machine it then stays away: from the one time on, twice as long each time, to the other at most.
LATE, AWAY, FAR_AWAY = 1e-3, 5e-3, 1.0


class Helpers:
    """`threads` - 1 of them, at most one for each sheet but one, for the body of a `with` statement, however
    that ends."""

    def __init__(self, work: Workspace, threads: int):
        self._many = threads
        self._take(work)

    def _take(self, work: Workspace) -> None:
        self._work, self._words = work, work.pool.words
        self._closed = Event()
        self._threads = [
            Thread(target=self._help, name=f"helper {k}", daemon=True)
            for k in range(1, min(self._many, work.pool.failed.size))
        ]

    def follow(self, work: Workspace) -> None:
        """From now on they take parts of the jobs of other arrays."""
        self.__exit__()
        self._take(work)
        self.__enter__()

    def _help(self) -> None:
        from mdlgen.backends.lattice.kernels import entries

        idle, away = SHORTEST, AWAY
        while not self._closed.is_set():
            begun, ran = perf_counter(), thread_time()
            taken = entries.help(self._work, LOOKS)
            if perf_counter() - begun - (thread_time() - ran) > LATE:
                self._closed.wait(away)
                away = min(2.0 * away, FAR_AWAY)
                continue
            if taken:
                idle, away = SHORTEST, max(0.9 * away, AWAY)
            else:
                self._closed.wait(idle)
                idle = min(2.0 * idle, LONGEST)

    def __enter__(self) -> Helpers:
        self._words[HELPERS] = len(self._threads)
        self._words[LEAVE] = _leaving()
        try:
            for thread in self._threads:
                thread.start()
        except RuntimeError:  # the system gives no more: those that there are do
            pass
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: Any) -> None:
        # a job that an error cut short goes no further; a part that is begun ends
        self._closed.set()
        self._words[CLOSED] = 1
        for thread in self._threads:
            if thread.is_alive():
                thread.join()
        self._words[HELPERS] = 0


@functools.cache
def _leaving() -> int:
    """Address of the system's function by which a thread leaves its processor to another one, without
    arguments, which returns an int on each system; 0 where there is none."""
    try:
        if sys.platform == "win32":
            found = ctypes.WinDLL("kernel32").SwitchToThread
        else:
            found = ctypes.CDLL(None).sched_yield
    except (OSError, AttributeError):
        return 0
    return ctypes.cast(found, ctypes.c_void_p).value or 0
