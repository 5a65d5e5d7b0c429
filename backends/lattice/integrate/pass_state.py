"""The state that a pass of a run carries from one stored time to the next, as arrays for a checkpoint."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from mdlgen.backends.lattice.integrate.reacting import Reacting
from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.kernels.state import MANY, Control, Workspace
from mdlgen.backends.lattice.search import many_searched
from mdlgen.errors import OutputError
from mdlgen.runs.checkpoint import Checkpointer, State


class Stage(NamedTuple):
    """Progress of a pass: its status and time [ms], number of stored outputs, wall time so far [s]."""

    status: int
    t: float
    outputs: int
    wall: float
    ended: bool


REACTING = "reacting"  # sensors and rules, in a checkpoint
# Arrays that a step computes before it reads them. Their capacity for pairs far exceeds the pairs in use, and
# may exceed the memory.
SCRATCH = {
    *(f"mid.{name}" for name in ("results", "touched", "rows", "faces", "near", "spare")),
    *("mid.does", "mid.lies"),
    *(f"mid.sticks.{name}" for name in ("aside", "head", "following")),
    *(
        "matrix.couplings.room",
        "matrix.couplings.short",
        "matrix.couplings.through",
        "condensed.results",
        "condensed.touched",
    ),
}


class PassState:
    """Writes and reads a pass: the state, its counters and control, and the values that a step takes over
    from the one before, which a pass that has ended does not need."""

    def __init__(
        self,
        work: Workspace,
        control: Control,
        recorder: Recorder,
        sleep: Sleep,
        reacting: Reacting | None = None,
    ):
        beside = work.tables.pairs["beside"][: work.search.first]
        few = (control, work.search.place, beside, work.tables.bristles, work.tables.hinges)
        self._state = dict(_leaves("state", work.state)) | dict(_leaves("few", few))
        carried = {"mid": work.mid, "matrix": work.matrix, "condensed": work.condensed, "free": work.free}
        carried["islands"] = work.islands
        carried["damped"] = work.damped[1:]
        self._recorder, self._sleep, self._search = recorder, sleep, work.search
        self._reacting = reacting
        every = dict(leaf for name, value in carried.items() for leaf in _leaves(name, value))
        self._work = {name: array for name, array in every.items() if name not in SCRATCH}

    def _rows(self) -> dict[str, int]:
        """Number of rows in use, for arrays with unused rows."""
        searched, work = many_searched(self._search), self._work
        coupled = int(work["matrix.couplings.many"][0])
        couplings = dict.fromkeys(("ends", "blocks", "single"), coupled) | {"colouring.own": 2 * coupled}
        slots = np.flatnonzero(work["condensed.owner"] >= 0)
        return {
            **{f"matrix.couplings.{name}": rows for name, rows in couplings.items()},
            **dict.fromkeys(("mid.overlaps", "mid.sticks.pairs"), searched),
            "mid.drift.listed": int(work["mid.drift.list_holds"][MANY]),
            "condensed.cols": int(slots[-1]) + 1 if slots.size else 0,
        }

    def arrays(self, stage: Stage) -> State:
        """Arrays of the present state of the pass."""
        stored = {f"stored.{name}": array for name, array in self._recorder.arrays().items()}
        rows = self._rows()
        work = {name: array[: rows.get(name)] for name, array in self._work.items() if not stage.ended}
        return {
            **self._state,
            **work,
            **stored,
            **self._sleep.carried(),
            **({} if self._reacting is None else {REACTING: self._reacting.carried()}),
            "stage": np.array(stage, dtype=float),
        }

    def back(self, keep: Checkpointer, number: int) -> Stage | None:
        """Restores the pass from its checkpoint; None where there is none. Raises OutputError."""
        stored = {name: array[:0] for name, array in self._recorder.arrays().items()}
        fixed = {name: self._recorder.kept[k] for k, name in enumerate(("rows", "marks"))}
        like = {f"stored.{name}": array for name, array in (stored | fixed).items()}
        asleep = self._sleep.carried()
        like |= asleep | {name: array[:0] for name, array in asleep.items() if array.dtype.names}
        if self._reacting is not None:
            like[REACTING] = np.zeros(0, np.uint8)
        with_room = {name: self._work[name][:0] for name in self._rows()}
        found = keep.load(number, {**self._state, **self._work, **with_room, **like, "stage": np.zeros(5)})
        if found is None:
            return None
        try:
            status, t, outputs, wall, ended = found.pop("stage").tolist()
            self._recorder.restore({name: found.pop(f"stored.{name}") for name in stored})
            self._sleep.restore(found)
            if self._reacting is not None:
                self._reacting.restore(found.pop(REACTING))
            for name, array in (self._state if ended else {**self._state, **self._work}).items():
                rows = len(found[name]) if name in with_room else None
                if array[:rows].shape != found[name].shape:
                    raise ValueError(name)
                array[:rows] = found[name]
        except (KeyError, ValueError) as error:
            raise OutputError(f"{keep.folder}: is not a state of this run ({error})") from None
        return Stage(int(status), t, int(outputs), wall, bool(ended))


def _leaves(name: str, value: Any) -> Iterator[tuple[str, np.ndarray]]:
    if isinstance(value, tuple):
        parts = getattr(value, "_fields", range(len(value)))
        for part, item in zip(parts, value, strict=True):
            yield from _leaves(f"{name}.{part}", item)
    else:
        yield name, value
