"""A pass whose machine reacts: its steps end at events of its sensors and rules, where orders are
executed."""

from __future__ import annotations

import json

import numpy as np

from mdlgen.backends.lattice.integrate.ends import RUNAWAY
from mdlgen.backends.lattice.integrate.passing import Passing
from mdlgen.backends.lattice.integrate.sleep import Sleep
from mdlgen.backends.lattice.kernels.integrate.integrate import DONE
from mdlgen.backends.lattice.kernels.state import DRIVEN, THROUGH_DRIVES
from mdlgen.model.tables import Floats, Model
from mdlgen.reactions.commands import Commands, Units
from mdlgen.reactions.machine import SOON, Machine, RunawayError
from mdlgen.reactions.sensing import Poses


class Reacting:
    """The machine of a Model along one pass."""

    def __init__(self, model: Model, sleep: Sleep, passing: Passing, slowest: float):
        """`slowest`: see Machine."""
        self.machine = Machine(model, slowest)
        self._sleep, self._passing, self._commands = sleep, passing, Commands(model, Units())
        self._boxes = np.zeros(1 + len(model.bodies.name), bool)
        for sheet in model.sheets:
            self._boxes[sheet.first : sheet.first + sheet.count] = True
        self.runaway = ""  # reason why a pass ended
        sleep.ordered = self._commands.write
        self._commands.number = self._number
        self._ordered: np.ndarray | None = None  # the records that have all orders

    def steps(self, t: float, left: Floats, step: float) -> Floats:
        """The steps, of those that are `left` [ms] from the time t on, up to the next check of the machine:
        whole ones, or a part of the first; `step`: a whole one."""
        self._write()
        self.machine.there = self._passing.there
        until = self.machine.ahead(t, step, self._poses()) - t
        whole = int(np.searchsorted(np.cumsum(left), until + SOON * step, side="right"))
        return left[:whole] if whole else np.array([until])

    def look(self, t: float, step: float) -> int:
        """Evaluates sensors and rules at the time t, and executes their orders: integrate.DONE, or
        RUNAWAY."""
        self.machine.there = self._passing.there
        try:
            orders = self.machine.look(t, step, self._poses())
        except RunawayError as error:
            self.runaway = str(error)
            return RUNAWAY
        for order in orders:
            if order.kind == "end":
                continue
            if order.kind == "enter":
                self._passing.enter_next(order.sheets, t)
                continue
            bodies = self._sleep.work.tables.bodies
            grown = self._commands.order(order, t, bodies)
            if grown:
                self._book(self._number(self._commands.body(order.name)), grown)
        return DONE

    def _book(self, body: int, grown: float) -> None:
        """Adds the work of an order that changes the force of a spring by `grown` [N]: its potential energy
        jumps."""
        work = self._sleep.work
        gained = -grown * float(work.state.s[work.tables.bodies["slide"][body]])
        energies = self._sleep.steering.energies[work.islands.group[work.islands.part[body]]]
        energies[DRIVEN] += gained
        energies[THROUGH_DRIVES] += abs(gained)

    def _number(self, body: int) -> int:
        return self._sleep.there.number(body)

    def _write(self) -> None:
        """Writes all orders into new records of bodies, after sheets slept or woke, or the margin widened."""
        bodies = self._sleep.work.tables.bodies
        if bodies is not self._ordered:
            self._commands.write(bodies)
            self._ordered = bodies

    def _poses(self) -> Poses:
        """Poses of all bodies, with the velocities in the middle of the last step."""
        work, sleep = self._sleep.work, self._sleep
        x, r, rates, spins = sleep.whole.motion(work.state, work.mid.motion)
        u, w, nodes = rates.copy(), spins.copy(), sleep.there.whole(sleep.system.nodes)
        u[self._boxes] = w[self._boxes] = 0.0  # awake boxes are set next
        u[nodes], w[nodes] = work.state.u[:, :3], work.state.u[:, 3:]
        return Poses(x, r, u, w)

    # -- checkpoints

    def carried(self) -> np.ndarray:
        """The state of the machine for a checkpoint, as bytes."""
        state = {"machine": self.machine.kept(), "commands": self._commands.kept()}
        text = json.dumps({**state, "enters": self._passing.enters.tolist()})
        return np.frombuffer(text.encode("ascii"), dtype=np.uint8)

    def restore(self, kept: np.ndarray) -> None:
        """Restores the state that `carried` returned."""
        found = json.loads(kept.tobytes())
        self.machine.restore(found["machine"])
        self._commands.restore(found["commands"])
        self._passing.enters[:] = found["enters"]
        self._ordered = None
