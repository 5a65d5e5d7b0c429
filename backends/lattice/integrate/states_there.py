"""Places and velocities at stored times, of sheets while they are in the machine and of parts.

A sheet that has not entered yet, or has left, has no rows: it stays at its place, without a velocity. So
memory grows with the sheets in the machine, not with all sheets of the scene.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.integrate.states import WIDTHS, without_jumps
from mdlgen.mechanics.frame import Motion
from mdlgen.model.meshes import carried
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Floats, Ints, Model
from mdlgen.results.stored import Block, Stored

# Names in a checkpoint: first stored time and number of times of each block; places before and after them.
SPANS, ENDS = "spans", ("before_x", "before_e", "after_x", "after_e")


@dataclass
class _Rows:
    """Stored values of one sheet, or of all parts."""

    columns: Ints
    first: int = 0
    states: dict[str, list[Floats]] = field(default_factory=lambda: {name: [] for name in WIDTHS})

    @property
    def times(self) -> int:
        return len(self.states["e"])


class StatesThere:
    """Like `states.States`, for a Model in which sheets come in or leave."""

    def __init__(self, model: Model, mirror: Any):
        """`mirror`: places the bodies that symmetry eliminates, None: none are."""
        self._model, self._mirror = model, mirror
        bodies = len(model.bodies.name)
        parts, self._blocks = np.ones(bodies, bool), []
        for sheet in model.sheets:
            self._blocks.append(_Rows(np.arange(sheet.first, sheet.first + sheet.count)))
            parts[self._blocks[-1].columns] = False
        self._blocks.append(_Rows(np.flatnonzero(parts)))
        self._ends = {name: np.zeros((bodies, WIDTHS[name[-1]])) for name in ENDS}
        self.count = 0

    def add(self, motion: Motion, there: NDArray[np.bool_]) -> None:
        """Stores a state, in which the sheets `there` (sheets,) are in the machine."""
        state = motion
        if self._mirror is not None or len(self._model.meshes):
            bodies = len(self._model.bodies.name)
            x, r, u, w = (array[None, :bodies].copy() for array in motion)
            if self._mirror is not None:
                self._mirror.fill(x, r, u, w)
            carried(self._model, x, r, u, w)
            state = Motion(x[0], r[0], u[0], w[0])
        present = np.append(there, True)
        own = [block for block, here in zip(self._blocks, present, strict=True) if here]
        for end, blocks in (("before", [] if self.count else self._blocks), ("after", self._blocks)):
            for block, here in zip(blocks, present, strict=bool(blocks)):
                ended = block.times > 0 and block.first + block.times == self.count
                if not here and (ended or end == "before"):
                    self._ends[f"{end}_x"][block.columns] = state.x[block.columns]
                    self._ends[f"{end}_e"][block.columns] = _parameters(state.r[block.columns])
        columns = np.concatenate([block.columns for block in own])
        arrays = {"x": state.x[columns], "u": state.u[columns], "w": state.w[columns]}
        arrays["e"] = _parameters(state.r[columns])
        at = 0
        for block in own:
            if not block.times:
                block.first = self.count
            end = at + len(block.columns)
            for name, array in arrays.items():
                block.states[name].append(array[at:end])
            at = end
        self.count += 1

    def all(self) -> dict[str, Any]:
        """All states, by name, as Stored."""
        return self.first(self.count)

    def first(self, times: int) -> dict[str, Any]:
        """The first states; the run may continue meanwhile."""
        found: dict[str, Any] = {
            name: Stored(times, [self._block(name, b, times) for b in self._blocks]) for name in WIDTHS
        }
        if not found["e"].finite:
            found["e"] = np.full(found["e"].shape, np.nan)
        return found

    def _block(self, name: str, rows: _Rows, times: int) -> Block:
        own, width = rows.columns, WIDTHS[name]
        many = max(0, min(rows.times, times - rows.first))
        states = np.array(rows.states[name][:many]).reshape(many, len(own), width)
        if name in "uw":
            before = after = np.zeros((len(own), width))
        else:
            before, after = self._ends[f"before_{name}"][own], self._ends[f"after_{name}"][own]
        if name == "e":
            chain = without_jumps(np.concatenate([before[None], states, after[None]][not rows.first :]))
            chain = chain[1:] if rows.first else chain
            states, after = chain[:many], chain[many]
        return Block(own, rows.first if rows.times else times, states, before, after)

    def kept(self) -> dict[str, np.ndarray]:
        """All arrays, for a checkpoint."""
        flat = {
            name: np.concatenate([np.reshape(b.states[name], (-1, width)) for b in self._blocks])
            for name, width in WIDTHS.items()
        }
        spans = np.array([[block.first, block.times] for block in self._blocks])
        return {**flat, SPANS: spans, **self._ends}

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Restores the state that `kept` returned."""
        at = 0
        for block, (first, times) in zip(self._blocks, arrays[SPANS].tolist(), strict=True):
            block.first, end = first, at + times * len(block.columns)
            for name, width in WIDTHS.items():
                rows = arrays[name][at:end].reshape(times, len(block.columns), width)
                block.states[name] = list(rows)
            at = end
        for name in ENDS:
            self._ends[name][:] = arrays[name]
        self.count = self._blocks[-1].times


def _parameters(rotations: Floats) -> Floats:
    """Euler parameters (n, 4) of rotations (n, 9); nan where one is not finite."""
    if not np.isfinite(rotations).all():
        return np.full((len(rotations), 4), np.nan)
    return euler_parameters(rotations.reshape(-1, 3, 3))
