"""Who follows the passes of a run, and the numbers by which the states of each pass are kept."""

from __future__ import annotations

from mdlgen.backends.lattice.integrate.limit import Deadline
from mdlgen.backends.lattice.integrate.passes import Progress, Watch
from mdlgen.backends.lattice.kernels.tuning import MOST_REFINED_RIGID
from mdlgen.runs.checkpoint import Checkpointer

# Numbers by which states of passes are kept: first those of the first step, halved so many times, or of the
# step that is given, doubled so many times; then of twice a step of a search, and of four times that; of a
# check at a step of its own; of a run at finer steps than were given; of one from a start that is moved, at
# the last step, and before it.
DOUBLED, CHECK, FINER, MOVED, MOVED_EARLY, QUADRUPLED = (MOST_REFINED_RIGID + k for k in range(1, 7))


class Watches:
    """Who follows the passes of a run, each by its number; all have until the same time."""

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
