"""A run whose machine reacts: it is made in parts, which end at events of sensors and rules."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.system import MM, MS, System
from mdlgen.model.tables import Model
from mdlgen.reactions.commands import JUMP, Commands, Units
from mdlgen.reactions.machine import SOON, Machine, RunawayError
from mdlgen.reactions.sensing import Poses

# End of a jump of a speed, relative to its duration (convention).
AFTER = 2.0


class Reacting:
    """The machine of a Model along one run; it writes into the records of the System, and back at its end."""

    def __init__(self, model: Model, system: System, recorder: Recorder, h: float):
        """`h`: the step [s]."""
        self._h, self._system, self._recorder = h, system, recorder
        self.machine = Machine(model, 0.0)
        self._commands = Commands(model, Units(length=MM, time=MS))
        self._bodies = system.bodies.copy()
        self.enter: Callable[[tuple[int, ...], float], None] = lambda sheets, t: None

    def until(self, t: float) -> float:
        """Latest end of the next step from t on [s]."""
        return self.machine.ahead(t / MS, self._h / MS, self._poses()) * MS

    def look(self, t: float) -> bool:
        """Executes the orders at a time [s]; returns True if there were any. Raises RunawayError."""
        orders = self.machine.look(t / MS, self._h / MS, self._poses())
        for order in orders:
            if order.kind == "enter":
                self.enter(order.sheets, t)
        ordered = [order for order in orders if order.kind not in ("end", "enter")]
        for order in ordered:
            grown = self._commands.order(order, t / MS, self._system.bodies)
            if grown:
                self._recorder.book(
                    -grown, int(self._system.bodies["slide"][self._commands.body(order.name)])
                )
        if ordered:
            self._recorder.renew(t + AFTER * JUMP * MS)
        return bool(orders)

    def follow(self, system: System, there: NDArray[np.bool_]) -> None:
        """Uses the records of this System, which has only the sheets that are `there`, from now on."""
        self._system, self.machine.there = system, there
        self._commands.write(system.bodies)

    def undo(self) -> None:
        """Restores the System for another run."""
        if len(self._bodies) == len(self._system.bodies):
            self._system.bodies[:] = self._bodies

    def _poses(self) -> Poses:
        x, r, u, w = self._recorder.motion
        return Poses(x[:-1] / MM, r[:-1], u[:-1] * MS / MM, w[:-1] * MS)


def in_parts(run: Any, mbs: Any, settings: Any, exu: Any, reacting: Reacting, recorder: Recorder) -> bool:
    """Runs Exudyn's dynamic solver from one event to the next, `settings` being those of the whole run;
    returns True if it reached its end. A part begins with the accelerations at the end of the one before."""
    times = settings.timeIntegration
    count, end = times.numberOfSteps, times.endTime
    h, t = end / count, 0.0
    data, initial = mbs.systemData, exu.ConfigurationType.Initial
    try:
        reacting.look(0.0)
        while t < end * (1.0 - 1e-12) and not recorder.finished:
            until = reacting.until(t)
            grid = (np.floor(t / h + SOON) + 1.0) * h
            if until < grid - SOON * h:
                times.startTime, times.endTime, times.numberOfSteps = t, until, 1
            elif grid < t + h * (1.0 - SOON):
                times.startTime, times.endTime, times.numberOfSteps = t, min(grid, end), 1
            else:
                left = max(1, round((end - t) / h))
                times.startTime, times.endTime, times.numberOfSteps = t, end, left
            times.minimumStepSize = min(
                times.minimumStepSize, 1e-3 * (times.endTime - t) / times.numberOfSteps
            )
            recorder.watch(reacting, times.numberOfSteps > 1)
            done = run(settings)
            if recorder.reason is not None or not (done or recorder.parted or recorder.finished):
                return False
            t = recorder.time
            data.SetSystemState(data.GetSystemState(), initial)
            # which the state above leaves at zero: half a step of acceleration would be lost
            data.SetODE2Coordinates_tt(data.GetODE2Coordinates_tt(), initial)
            data.SetTime(t, initial)
            times.generalizedAlpha.computeInitialAccelerations = False
            times.generalizedAlpha.resetAccelerations = False
    except RunawayError as error:
        recorder.reason = str(error)
        return False
    return True
