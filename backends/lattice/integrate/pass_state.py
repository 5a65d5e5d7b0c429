"""All that a pass of a run carries from one stored time to the next, as arrays that can be kept."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.kernels.state import Control, Workspace
from mdlgen.errors import OutputError
from mdlgen.runs.checkpoint import Checkpointer, State


class Stage(NamedTuple):
    """Where a pass is: its status and time [ms], outputs that are stored, wall time so far [s]."""

    status: int
    t: float
    outputs: int
    wall: float
    ended: bool


class PassState:
    """Writes and reads a pass: the state, what it counts and is steered by, and the work arrays of a step,
    which a pass that has ended does not need."""

    def __init__(self, work: Workspace, control: Control, recorder: Recorder, sleep: Sleep):
        few = (control, work.search.place, work.tables.pairs["beside"][: work.search.first])
        carried = (work.mid, work.matrix, work.condensed, work.free, work.damped[1:])
        self._state = dict(_leaves("state", work.state)) | dict(_leaves("few", few))
        self._work = dict(_leaves("work", carried))
        self._recorder, self._sleep = recorder, sleep

    def arrays(self, stage: Stage) -> State:
        """The pass as it is now."""
        stored = {f"stored.{name}": array for name, array in self._recorder.arrays().items()}
        work = {} if stage.ended else self._work
        return {
            **self._state,
            **work,
            **stored,
            **self._sleep.carried(),
            "stage": np.array(stage, dtype=float),
        }

    def back(self, keep: Checkpointer, number: int) -> Stage | None:
        """Takes the pass back to where it was kept; None where it was not. Raises OutputError."""
        stored = {name: array[:0] for name, array in self._recorder.arrays().items()}
        fixed = {name: self._recorder.kept[k] for k, name in enumerate(("rows", "marks"))}
        like = {f"stored.{name}": array for name, array in (stored | fixed).items()}
        asleep = self._sleep.carried()
        like |= asleep | {name: array[:0] for name, array in asleep.items() if array.dtype.names}
        found = keep.load(number, {**self._state, **self._work, **like, "stage": np.zeros(5)})
        if found is None:
            return None
        try:
            status, t, outputs, wall, ended = found.pop("stage").tolist()
            self._recorder.restore({name: found.pop(f"stored.{name}") for name in stored})
            self._sleep.restore(found)
            for name, array in (self._state if ended else {**self._state, **self._work}).items():
                if array.shape != found[name].shape:
                    raise ValueError(name)
                array[...] = found[name]
        except (KeyError, ValueError) as error:
            raise OutputError(f"{keep.folder}: is not a state of this run ({error})") from None
        return Stage(int(status), t, int(outputs), wall, bool(ended))


def _leaves(name: str, value: Any) -> Iterator[tuple[str, np.ndarray]]:
    if isinstance(value, tuple):
        for k, item in enumerate(value):
            yield from _leaves(f"{name}.{k}", item)
    else:
        yield name, value
