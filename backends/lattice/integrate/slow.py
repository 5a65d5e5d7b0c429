"""Reports of a slow pass: its progress, and the step and the body that slow it down."""

from __future__ import annotations

import logging
from collections.abc import Callable

from mdlgen.backends.lattice.kernels.state import LEVEL, STEPS, TOUCHING, WORST, Control
from mdlgen.backends.lattice.kernels.tuning import HELD_UP, REPORTED
from mdlgen.model.tables import Model

# Callback for those who show the progress of a run, such as `mdlgen run`.
LOG = logging.getLogger("mdlgen.slow")


class Slow:
    """Follows the calls of compiled code in one pass."""

    def __init__(
        self, model: Model, control: Control, progress: Callable[[float, float, int, int], None] | None
    ):
        self._model, self._progress = model, progress
        self._counters, self._pace = control.counters, control.pace
        self._since = 0.0

    def tell(self, t: float, step: float, took: float) -> None:
        """Reports after a call with steps of that length [ms] that ended at t [ms] and took `took` [s]."""
        self._since += took
        if self._since < REPORTED:
            return
        self._since = 0.0
        if self._progress is None:
            return
        self._progress(t, self._model.run.duration, int(self._counters[STEPS]), int(self._counters[TOUCHING]))
        halved = int(self._pace[LEVEL])
        if halved >= HELD_UP:
            body = self._model.bodies.name[int(self._counters[WORST])]
            LOG.info(
                "steps of %.3g ms at %.4g ms: the velocity of %s converges slowly", step / 2**halved, t, body
            )
