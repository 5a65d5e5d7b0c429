"""Schedule of the checks of sheets and parts in a pass. It does not depend on the stored times."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import LOOKS


class Looks:
    """Steps after which a pass checks, and those after which it stops to check or to store a state."""

    def __init__(self, duration: float, outputs: int, each: int):
        """`outputs`: number of stored times; `each`: steps between two of them."""
        self._duration, self._each, self._steps = duration, each, outputs * each
        self._every = max(1, math.ceil(self._steps / LOOKS - 1e-9))

    def stops(self, output: int) -> list[int]:
        """Numbers of the steps after which it stops up to a stored time, which is the last one."""
        before, last = output * self._each, (output + 1) * self._each
        return [*range(before - before % self._every + self._every, last, self._every), last]

    def due(self, step: int) -> bool:
        """True if it checks after this number of steps; always at the end."""
        return step % self._every == 0 or step == self._steps

    def left(self, step: int, t: float, size: float) -> np.ndarray:
        """The steps from a time t to the end of step number `step`; the first is a remainder where t is
        within a step. They are bitwise identical wherever the pass stops before its next check."""
        due = min(step + -step % self._every, self._steps)
        return _steps_to(self.time(due) - t, size)[: None if due == step else step - due]

    def time(self, step: int) -> float:
        """Time after this number of steps [ms]."""
        if self._steps % self._every == 0 == step % self._every:
            return step // self._every * self._duration / (self._steps // self._every)
        return step * self._duration / self._steps


def _steps_to(left: float, step: float) -> np.ndarray:
    """The steps over the time `left` [ms]: the remainder of a step that was begun, then whole ones."""
    whole = math.floor(left / step + 1e-9)
    first = left - whole * step
    return np.array(([first] if first > 1e-9 * step else []) + whole * [step])
