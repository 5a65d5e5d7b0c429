"""The bound of wall time of a run, `run.limit`: each pass ends soon after it."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from threading import Event, Thread
from typing import Any, NamedTuple

from mdlgen.backends.lattice.kernels.state import Workspace
from mdlgen.backends.lattice.kernels.tuning import CALL, CUT_AGAIN
from mdlgen.model.tables import Model


class Deadline(NamedTuple):
    """Time at which the wall time of a run is over, on the clock `time.perf_counter` [s]; inf: no limit."""

    at: float = math.inf

    @classmethod
    def of(cls, model: Model) -> Deadline:
        """Deadline of a run that begins now."""
        limit = model.run.limit
        return cls() if limit is None else cls(clock.perf_counter() + 1e-3 * limit)

    @property
    def over(self) -> bool:
        return clock.perf_counter() >= self.at

    def allows(self, seconds: float) -> bool:
        """True if work of this duration would end in time."""
        return clock.perf_counter() + seconds <= self.at


class Cut:
    """Ends a call of compiled code soon after a deadline, within one step with its halvings.

    Compiled code cannot be interrupted; but after each step it ends where a body is out of its bounds. So a
    separate thread overwrites the bounds of the workspace of a pass, `work()`, by empty ones. They are in
    arrays of their own, see `work.workspace`.
    """

    def __init__(self, deadline: Deadline, work: Callable[[], Workspace]):
        self._deadline, self._work, self._ended = deadline, work, Event()
        self._thread = Thread(target=self._wait, daemon=True)

    def _wait(self) -> None:
        if self._ended.wait(max(0.0, self._deadline.at - clock.perf_counter())):
            return
        while not self._ended.wait(CUT_AGAIN):
            base = self._work().bounds.low.base
            assert base is not None, "what a pass works on has bounds of its own"
            base[:] = math.inf

    def __enter__(self) -> Cut:
        if self._deadline.at < math.inf:
            self._thread.start()
        return self

    def __exit__(self, *_: Any) -> None:
        self._ended.set()
        if self._thread.is_alive():
            self._thread.join()


class Calls:
    """Number of steps of one call of compiled code, such that it takes about as long as CALL."""

    def __init__(self, most: int):
        self.most = self.many = most

    def took(self, many: int, seconds: float) -> None:
        """Updates the number from a call with this number of steps and this duration."""
        if seconds > 2.0 * CALL:
            self.many = max(1, int(many * CALL / seconds))
        elif seconds < 0.5 * CALL:
            self.many = min(2 * self.many, self.most)
