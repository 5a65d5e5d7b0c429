"""Observers of the passes of a run, and the numbers under which the states of each pass are stored."""

from __future__ import annotations

from mdlgen.backends.lattice.integrate.limit import Deadline
from mdlgen.backends.lattice.integrate.passes import Progress, Watch
from mdlgen.backends.lattice.kernels.tuning import MOST_REFINED_RIGID
from mdlgen.runs.checkpoint import Checkpointer

# Numbers under which states of passes are stored. The first ones are numbers of halvings of the first step,
# or of doublings of a given step. Then: twice a step of a search; a check at a step of its own; a run at
# finer steps than the given one; one from a slightly moved start at the last step, and before it; four times
# a step.
DOUBLED, CHECK, FINER, MOVED, MOVED_EARLY, QUADRUPLED = (MOST_REFINED_RIGID + k for k in range(1, 7))


class Watches:
    """Observers of the passes of a run, one per number; all have the same deadline."""

    def __init__(self, progress: Progress | None, keep: Checkpointer | None, sleeps: bool):
        self._keep = keep
        self._of_all = Watch(progress, keep, sleeps=sleeps)
        self.deadline = Deadline()

    def until(self, deadline: Deadline) -> Watches:
        """The same, with a time at which all passes end."""
        self.deadline = deadline
        self._of_all = self._of_all._replace(deadline=deadline)
        return self

    def __call__(self, number: int) -> Watch:
        if self._keep is not None:
            self._keep.begin(number)
        return self._of_all._replace(number=number)
