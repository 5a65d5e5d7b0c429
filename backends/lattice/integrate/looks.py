"""When a pass checks its sheets and parts: after steps of its own, so that what is stored changes nothing."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.lattice.kernels.tuning import LOOKS


class Looks:
    """At which of its steps a pass looks, and where it stops for that or to store a state."""

    def __init__(self, duration: float, outputs: int, each: int):
        """`outputs` are stored, after so many steps each."""
        self._duration, self._each, self._steps = duration, each, outputs * each
        self._every = max(1, math.ceil(self._steps / LOOKS - 1e-9))

    def stops(self, output: int) -> list[int]:
        """Numbers of the steps after which it stops on its way to a stored time; the last one is that."""
        before, last = output * self._each, (output + 1) * self._each
        return [*range(before - before % self._every + self._every, last, self._every), last]

    def due(self, step: int) -> bool:
        """Whether it looks after so many steps: at the end in any case."""
        return step % self._every == 0 or step == self._steps

    def left(self, step: int, t: float, size: float) -> np.ndarray:
        """The steps from a time t to the end of that one, which begin in the middle of one where t does: the
        same ones, to the bit, wherever it stops before it looks again."""
        due = min(step + -step % self._every, self._steps)
        return _steps_to(self.time(due) - t, size)[: None if due == step else step - due]

    def time(self, step: int) -> float:
        """Time after so many steps [ms]."""
        if self._steps % self._every == 0 == step % self._every:
            return step // self._every * self._duration / (self._steps // self._every)
        return step * self._duration / self._steps


def _steps_to(left: float, step: float) -> np.ndarray:
    """The steps over the time that is `left` [ms]: whole ones, after what is left of one that was begun."""
    whole = math.floor(left / step + 1e-9)
    first = left - whole * step
    return np.array(([first] if first > 1e-9 * step else []) + whole * [step])
