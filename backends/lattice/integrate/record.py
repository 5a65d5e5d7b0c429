"""Recorder of a run: stored states, contact statistics, the energy balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.hinges import plastic_rows
from mdlgen.backends.lattice.integrate.islands import groups
from mdlgen.backends.lattice.integrate.states import States
from mdlgen.backends.lattice.integrate.states_there import StatesThere
from mdlgen.backends.lattice.integrate.there import Whole
from mdlgen.backends.lattice.kernels.entries import PROGRAM
from mdlgen.backends.lattice.kernels.state import (
    ACTS,
    DEPTH_NOW,
    DEPTH_TIME,
    DISSIPATED,
    DRIVEN,
    ELASTIC,
    ENDED,
    FORCE_BEGUN,
    FORCE_NOW,
    FORCE_TIME,
    KINETIC,
    MAX_DEPTH,
    MAX_FORCE,
    POTENTIAL,
    PRESSES,
    THROUGH_DRIVES,
    TIME,
    TURNING_BEGUN,
    TURNING_NOW,
    TURNS,
    Kept,
    Workspace,
)
from mdlgen.mechanics.turning import ABOUT_A, ABOUT_B, ALONG, LIMIT, TURNING
from mdlgen.model.passing import at_start, passing
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.passing import CAME, LEFT
from mdlgen.results.result import ContactStatistics, Energy, Result
from mdlgen.version import if_there

# Columns of Kept.rows to store, in the order PRESSES, TURNS: of the last step; of the start of a call.
NOW = [FORCE_NOW, *range(TURNING_NOW, TURNING_NOW + TURNING)]
BEGUN = [FORCE_BEGUN, *range(TURNING_BEGUN, TURNING_BEGUN + TURNING)]


class Snapshot(NamedTuple):
    """Data for a partial result, in addition to the stored states."""

    model: Model
    system: System
    times: int  # number of stored times
    rows: np.ndarray
    marks: np.ndarray
    work: np.ndarray
    # of each group of parts: first and last energies, (groups, 3); greatest kinetic + elastic one, (groups,)
    energies: tuple[np.ndarray, np.ndarray, np.ndarray]
    booked: np.ndarray  # energies of sheets that came in, and that left, (2, groups, 3)
    stays: np.ndarray | None  # see Recorder


class Recorder:
    """Stores states of a run; `kept`: the sums of the compiled code."""

    def __init__(self, model: Model, system: System, work: Workspace, whole: Whole, outputs: int = 0):
        """`whole`: places of all bodies, including those that are not in `work`."""
        self.whole = whole
        self._parts = {p.name: int(work.islands.part[whole.there.number(p.body)]) for p in model.machine}
        self.model, self.system, self.kept, self.work = model, system, work.kept, work
        self._asleep = np.zeros((groups(work), 3))
        # if sheets come in or leave, only the states of those in the machine are stored
        passes = passing(model)
        self._states: States | StatesThere = (
            StatesThere(model, system.mirror) if passes else States(model, system.mirror, outputs + 1)
        )
        self._forces: list[np.ndarray] = []
        self._plastic: list[np.ndarray] = []  # see hinges.plastic_rows; empty for elastic scenes
        self._behind: list[np.ndarray] = []  # see Result.behind
        self._axles = [system.bodies["spin"][r.body] for r in model.rollers if r.axle is not None]
        self._times: list[float] = []
        self._energies = np.zeros((2, groups(work), 3))  # first and last
        self._most = np.zeros(groups(work))
        # energies of sheets that came in, and of those that left, (2, groups, 3)
        self.booked = np.zeros((2, groups(work), 3))
        # times at which each sheet came in and left [ms], nan: not yet, (sheets, 2); None: no sheet ever does
        self.stays: np.ndarray | None = None

    def follow(self, work: Workspace, asleep: np.ndarray) -> None:
        """Replaces the arrays by those of a new awake part of the System; `asleep` (groups, 3): energies of
        the sleeping part."""
        self.work, self._asleep = work, asleep

    def widen(self, model: Model, system: System, kept: Kept) -> None:
        """Replaces the pairs by those of this Model; `system`: the whole System that is solved."""
        self.model, self.system, self.kept = model, system, kept

    def store(self, t: float) -> None:
        """Stores the state at the end of a step."""
        from mdlgen.backends.lattice.kernels.integrate import observe

        energies, rows = np.zeros_like(self._asleep), np.zeros_like(self.kept.rows)
        observe.ledger(self.work, t, energies, rows)
        energies += self._asleep
        if self.system.mirror is not None:
            energies *= 2.0
        if not self._times:
            self._energies[0] = energies
        self._energies[1] = energies
        self._most = np.maximum(self._most, energies[:, KINETIC] + energies[:, ELASTIC])
        self._times.append(t)
        state = self.work.state
        self._states.add(self.whole.motion(state, self.work.mid.motion), self._there())
        if t == 0.0:
            self.kept.rows[:, NOW] = rows[:, NOW]
            # a contact at the start may have opened in the middle of the first step
            self.kept.rows[:, [MAX_FORCE, MAX_DEPTH]] = rows[:, [FORCE_NOW, DEPTH_NOW]]
        # The rule evaluates forces in the middle of a step, so these are half a step old. After the next step
        # `between` interpolates those at the end of this one. At the start these are the forces at the start.
        self._forces.append(self.kept.rows[:, NOW])
        if len(self.model.plastic):
            self._plastic.append(plastic_rows(self.system.yields))
        if self._axles:
            self._behind.append(state.s[self._axles])

    def _there(self) -> NDArray[np.bool_]:
        """True for each sheet that is in the machine, (sheets,)."""
        if self.stays is None:
            return np.array(at_start(self.model))
        return ~np.isnan(self.stays[:, CAME]) & np.isnan(self.stays[:, LEFT])

    @property
    def last(self) -> float:
        """Last stored time [ms]."""
        return self._times[-1]

    def between(self) -> None:
        """Replaces the forces of the last stored state by interpolated ones. Called after the next step: then
        forces are known in the middle of the steps before and after that state."""
        self._forces[-1] = self.kept.rows[:, BEGUN]

    def arrays(self) -> dict[str, np.ndarray]:
        """All stored arrays, and the sums of the compiled code."""
        return {
            **self._states.kept(),
            **({"p": self._rotations(len(self._times))} if len(self.model.plastic) else {}),
            **({"b": self._lags(len(self._times))} if self._axles else {}),
            "f": np.array(self._forces).reshape(len(self._times), len(self.model.contacts), len(NOW)),
            "times": np.array(self._times),
            "energies": np.concatenate([self._energies.ravel(), self._most]),
            **({} if self.stays is None else {"booked": self.booked, "stays": self.stays}),
            "rows": self.kept.rows,
            "marks": self.kept.marks,
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Restores the state that `arrays` returned."""
        self._states.restore(arrays)
        self._forces = list(arrays["f"])
        self._plastic = list(arrays.get("p", ()))
        self._behind = list(arrays.get("b", ()))
        self._times = arrays["times"].tolist()
        energies, self._most = np.split(arrays["energies"], (self._energies.size,))
        self._energies[:] = energies.reshape(self._energies.shape)
        self.kept.rows[:], self.kept.marks[:] = arrays["rows"], arrays["marks"]
        if self.stays is not None:
            self.booked[:], self.stays[:] = arrays["booked"], arrays["stays"]

    def _rotations(self, times: int) -> np.ndarray:
        """Plastic rotations at the first `times` times, and their dissipated energy, (times, rows + 1)."""
        return np.array(self._plastic[:times]).reshape(times, len(self.model.plastic) + 1)

    def _lags(self, times: int) -> np.ndarray:
        """Angles by which rollers lag behind their shafts at the first `times` times, (times, axles)."""
        return np.array(self._behind[:times]).reshape(times, len(self._axles))

    def snapshot(self, work: np.ndarray) -> Snapshot:
        """Snapshot of the present state; it does not change as the run continues."""
        rows, marks = self.kept
        first, last = self._energies.copy()
        energies = (first, last, self._most.copy())
        return Snapshot(
            self.model,
            self.system,
            len(self._times),
            rows.copy(),
            marks.copy(),
            work.copy(),
            energies,
            self.booked.copy(),
            None if self.stays is None else self.stays.copy(),
        )

    def result(self, solver: str, reason: str | None, work: np.ndarray) -> Result:
        """The Result in mm, N, g, ms."""
        return self._result(self.snapshot(work), solver, reason, self._states.all())

    def result_at(self, snapshot: Snapshot, solver: str, reason: str | None) -> Result:
        """The Result up to the snapshot, in its own arrays."""
        return self._result(snapshot, solver, reason, self._states.first(snapshot.times))

    def _result(
        self, snapshot: Snapshot, solver: str, reason: str | None, held: dict[str, np.ndarray]
    ) -> Result:
        rows, marks = snapshot.rows, snapshot.marks
        mirror, touched = snapshot.system.mirror, int(marks.sum())
        if mirror is not None:
            touched = mirror.touched(snapshot.system, marks)
            summed = (MAX_FORCE, FORCE_TIME, FORCE_NOW)  # depths and times hold for both sides
            columns = enumerate(rows.T)
            rows = np.array([(mirror.sums if k in summed else mirror.largest)(c) for k, c in columns]).T
            snapshot = snapshot._replace(work=2.0 * snapshot.work, booked=2.0 * snapshot.booked)
        inside = np.where(rows[:, TIME] > 0, rows[:, TIME], 1.0)
        forces = np.array(self._forces[: snapshot.times])
        forces = forces if mirror is None else mirror.acts(forces)
        energy = _balance(snapshot, self.work, self._parts)
        plastic = None
        if len(snapshot.model.plastic):
            rotations = self._rotations(snapshot.times)
            plastic, energy.plastic = rotations[:, :-1], float(rotations[-1, -1])
        return Result(
            model=snapshot.model,
            solver=solver,
            status=reason or "ok",
            time=np.array(self._times[: snapshot.times]),
            position=held["x"],
            rotation=held["e"],
            velocity=held["u"],
            spin=held["w"],
            contact_force=forces[..., PRESSES],
            contact_torque=forces[..., [TURNS + ABOUT_A, TURNS + ABOUT_B]],
            contact_friction=forces[..., [TURNS + ALONG, TURNS + LIMIT]],
            statistics=ContactStatistics(
                max_depth=rows[:, MAX_DEPTH].copy(),
                mean_depth=rows[:, DEPTH_TIME] / inside,
                max_force=rows[:, MAX_FORCE].copy(),
                mean_force=rows[:, FORCE_TIME] / inside,
                last_force_at=np.where(rows[:, ACTS] != 0, np.nan, rows[:, ENDED]),
            ),
            plastic=plastic,
            behind=self._lags(snapshot.times) if self._axles else None,
            touched=touched,
            energy=energy,
            versions=_versions(),
            halved=mirror is not None,
            stays=snapshot.stays,
        )


def _balance(snapshot: Snapshot, work: Workspace, parts: dict[str, int]) -> Energy:
    """Energies of the whole scene, with the balance of the group that has the largest error; `parts`: group
    of each machine part by name."""
    model, (first, last, most) = snapshot.model, snapshot.energies
    lost, driven, through, numerical = snapshot.work.sum(axis=0).tolist()
    kinetic, elastic, _ = last.sum(axis=0).tolist()
    worst, scale, of = 0.0, 0.0, ()
    came, left = snapshot.booked
    for group in range(len(last)):
        own, moved = snapshot.work[group], float(last[group, POTENTIAL] - first[group, POTENTIAL])
        passed = came[group] - left[group]
        moved -= float(passed[POTENTIAL])
        names = _names(model, work, parts, group)
        size = audit.scale(
            model, float(own[DISSIPATED]), float(own[THROUGH_DRIVES]), float(most[group]), moved, names
        )
        change = float(last[group].sum() - first[group].sum()) - float(passed.sum())
        off = (change + float(own[DISSIPATED]) - float(own[DRIVEN])) / size
        if not of or abs(off) > abs(worst):
            worst, scale, of = off, size, names
    of = of if len(last) > 1 else ()
    energy = Energy(kinetic, elastic, lost - numerical, driven, worst, scale, numerical, of)
    if snapshot.stays is not None:
        energy.entered, energy.left = float(came.sum()), float(left.sum())
    return energy


def _names(model: Model, work: Workspace, parts: dict[str, int], group: int) -> tuple[str, ...]:
    """The parts of a group."""
    found = work.islands.group
    named = {sheet.name: k for k, sheet in enumerate(model.sheets)}
    named |= {name: part for name, part in parts.items() if part >= 0}
    return tuple(name for name, k in named.items() if work.islands.answers[k] and found[k] == group)


def _versions() -> dict[str, str]:
    return if_there("numba", "llvmlite") | {"code": PROGRAM.code()}
