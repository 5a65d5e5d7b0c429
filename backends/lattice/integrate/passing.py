"""Sheets that come in and leave during a pass.

A step ends when a sheet comes in, so that it has its given state at its given time. The time at which one
leaves is found by Newton's method over steps: a step ends where the sheet would reach its plane at its
present velocity, until it is near enough. A sheet that leaves at rest does so when it falls asleep.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.integrate.record import Recorder
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.passing import NEAR, SAME, begun_stays, far
from mdlgen.model.tables import Floats, Model


class Passing:
    """Sheets that are present during a pass."""

    def __init__(self, model: Model, sleep: Sleep, recorder: Recorder, dt: float, overlaps: Unheld):
        """`dt`: the step [ms]."""
        self._model, self._sleep, self._recorder, self._slack = model, sleep, recorder, SAME * dt
        self._overlaps = overlaps
        self.enters = np.array([sheet.enters for sheet in model.sheets])
        self.enters[np.isnan(self.enters)] = math.inf
        stays = begun_stays(model)
        self.active, recorder.stays = stays is not None, stays
        self.stays = np.zeros((0, 2)) if stays is None else stays

    @property
    def there(self) -> NDArray[np.bool_] | None:
        """True for sheets that are present, (sheets,); None: all are."""
        return ~self._sleep.gone if self.active else None

    def enter(self, sheet: int, t: float) -> None:
        """Sets the time [ms], not in the past, at which a sheet that has not entered yet comes in."""
        if math.isnan(self.stays[sheet, 0]):
            self.enters[sheet] = t

    def enter_next(self, sheets: Iterable[int], t: float) -> None:
        """Sets the time [ms] at which the first of these sheets that has no such time yet comes in."""
        for sheet in sheets:
            if math.isnan(self.stays[sheet, 0]) and math.isinf(self.enters[sheet]):
                self.enter(sheet, t)
                return

    def exact(self, t: float) -> float:
        """The exact time of a sheet that comes in at t within round-off; else t."""
        near = self.enters[np.abs(self.enters - t) <= self._slack]
        return float(near[0]) if self.active and near.size else t

    def cut(self, t: float, steps: Floats) -> tuple[Floats, bool]:
        """The steps from t on, cut off where the next sheet comes in or leaves; and True if all of these are
        whole. Since the velocity may change, steps cover half of the time until a sheet leaves, repeatedly,
        until that is in the next step."""
        if not self.active:
            return steps, True
        ends, leaves = np.cumsum(steps), self._leaves()
        if leaves > ends[0]:
            leaves = float(ends[max(0, int(np.searchsorted(ends, 0.5 * leaves)) - 1)])
        due = min(self._comes() - t, leaves)
        if not due < ends[-1] - self._slack:
            return steps, True
        whole = int(np.searchsorted(ends, due + self._slack, side="right"))
        # the part of a step follows in a call of its own, from the time that the steps before end at: so its
        # round-off is the same however many steps a call takes, which depends on the clock
        return (steps[:whole], True) if whole else (np.array([due]), False)

    def _comes(self) -> float:
        """Time at which the next sheet comes in [ms]."""
        late = self.enters[self._sleep.gone & np.isnan(self.stays[:, 0])]
        return float(late.min(initial=math.inf))

    def _leaves(self) -> float:
        """Time until the next sheet would leave at its present velocity [ms]."""
        found = math.inf
        for k in np.flatnonzero(~self._sleep.gone).tolist():
            sheet = self._model.sheets[k]
            if not sheet.out:
                continue
            state, own = self._sleep.work.state, self._sleep.system.sheets == k
            if not own.any():
                continue  # it is asleep
            rate = state.v[own].mean(axis=0)
            for (axis, _, side), gap in zip(sheet.out, -self._far(k), strict=True):
                speed = side * float(rate[axis])
                if speed > 0.0:
                    found = min(found, max(float(gap), 0.0) / speed)
        return found

    def _far(self, k: int) -> Floats:
        """model.passing.far for a sheet by its number."""
        x, r = self._sleep.whole.places(self._sleep.work.state)
        return far(self._model, self._model.sheets[k], x, r, self._overlaps.solved)

    def turn(self, t: float) -> bool:
        """Removes and adds the sheets whose time is t. Returns False if one cannot come in, see `taken`."""
        if not self.active:
            return True
        sleep, leaves = self._sleep, self._leaving()
        if leaves.any():
            self._recorder.booked[1] -= sleep.change(sleep.gone | leaves, t)
            self.stays[leaves, 1] = t
        comes = self._coming(t)
        if comes.any():
            if self.taken(t) is not None:
                return False
            self._recorder.booked[0] += sleep.change(sleep.gone & ~comes, t)
            self.stays[comes, 0] = self.enters[comes]
        return True

    def _coming(self, t: float) -> NDArray[np.bool_]:
        return self._sleep.gone & np.isnan(self.stays[:, 0]) & (self.enters <= t + self._slack)

    def _leaving(self) -> NDArray[np.bool_]:
        leaves = self._sleep.asleep & [sheet.out_at_rest for sheet in self._model.sheets]
        for k in np.flatnonzero(~self._sleep.gone).tolist():
            sheet = self._model.sheets[k]
            near = NEAR * self._model.run.tolerance * max(sheet.size) / 10.0
            leaves[k] |= bool(sheet.out) and bool((self._far(k) >= -near).any())
        return leaves

    def taken(self, t: float) -> str | None:
        """Reason why a sheet cannot come in at t: another one is in its place; None: it can."""
        x, r = self._sleep.whole.places(self._sleep.work.state)
        return self._overlaps.taken(self._coming(t), ~self._sleep.gone, x, r, t)
