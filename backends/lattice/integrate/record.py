"""What a run passes through: stored states, contact statistics, the energy balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.backends.lattice.integrate.states import WIDTHS, States
from mdlgen.backends.lattice.kernels.state import (
    ACTS,
    DEPTH_NOW,
    DEPTH_TIME,
    ENDED,
    FORCE_BEGUN,
    FORCE_NOW,
    FORCE_TIME,
    MAX_DEPTH,
    MAX_FORCE,
    POTENTIAL,
    PRESSES,
    TIME,
    TURNING_BEGUN,
    TURNING_NOW,
    TURNS,
    Kept,
    Midpoint,
    State,
    Workspace,
)
from mdlgen.mechanics.frame import Motion
from mdlgen.mechanics.turning import ABOUT_A, ABOUT_B, ALONG, LIMIT, TURNING
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.result import ContactStatistics, Energy, Result
from mdlgen.version import of

NOW = [FORCE_NOW, *range(TURNING_NOW, TURNING_NOW + TURNING)]  # of the rows of contacts: PRESSES, TURNS
BEGUN = [FORCE_BEGUN, *range(TURNING_BEGUN, TURNING_BEGUN + TURNING)]


class Snapshot(NamedTuple):
    """How far a recorder is: what a result up to there is made from, besides the stored states."""

    times: int  # how many are stored
    rows: np.ndarray
    marks: np.ndarray
    work: np.ndarray
    energies: tuple[tuple[float, float, float], tuple[float, float, float], float]  # first, last, most


class Recorder:
    """Stores states of a run; `kept` is what the compiled code adds up."""

    def __init__(
        self, model: Model, system: System, state: State, mid: Midpoint, kept: Kept, outputs: int = 0
    ):
        self.model, self.system, self.kept = model, system, kept
        self.tables, self.first, self.state, self.mid = system.tables, system.search.first, state, mid
        self._asleep = np.zeros(3)
        self._states = States(model, system.mirror, outputs + 1)
        self._forces: list[np.ndarray] = []
        self._times: list[float] = []
        self._first: tuple[float, float, float] | None = None
        self._last = (0.0, 0.0, 0.0)
        self._most = 0.0

    def follow(self, work: Workspace, awake: System, asleep: np.ndarray) -> None:
        """From now on steps work on these arrays, of what is awake of the System; `asleep` (3,): energies of
        what is not."""
        self.tables, self.first, self.state, self.mid = work.tables, awake.search.first, work.state, work.mid
        self._asleep = asleep

    def store(self, t: float) -> None:
        """The state at the end of a step."""
        from mdlgen.backends.lattice.kernels.integrate import observe

        energies, rows = np.zeros(3), np.zeros_like(self.kept.rows)
        observe.ledger(self.tables, self.state, self.mid, t, self.first, energies, rows)
        energies += self._asleep
        if self.system.mirror is not None:
            energies *= 2.0
        kinetic, elastic, potential = energies.tolist()
        now = (kinetic, elastic, potential)
        if self._first is None:
            self._first = now
        self._last = now
        self._most = max(self._most, kinetic + elastic)
        self._times.append(t)
        motion = self.mid.motion
        self._states.add(Motion(self.state.x, self.state.r, motion.u, motion.w))
        if t == 0.0:
            self.kept.rows[:, NOW] = rows[:, NOW]
            # what presses as a run begins may be gone in the middle of its first step
            self.kept.rows[:, [MAX_FORCE, MAX_DEPTH]] = rows[:, [FORCE_NOW, DEPTH_NOW]]
        # forces in the middle of the last step, where the rule has them, until the next one shows what they
        # are at its end; at the start as it begins
        self._forces.append(self.kept.rows[:, NOW])

    def between(self) -> None:
        """The step after the last state that is stored has been taken: forces there lie between both."""
        self._forces[-1] = self.kept.rows[:, BEGUN]

    def arrays(self) -> dict[str, np.ndarray]:
        """All that it has stored, and what the compiled code added up."""
        first = self._first or (0.0, 0.0, 0.0)
        return {
            **self._states.all(),
            "f": np.array(self._forces).reshape(len(self._times), len(self.model.contacts), len(NOW)),
            "times": np.array(self._times),
            "energies": np.array([*first, *self._last, self._most]),
            "rows": self.kept.rows,
            "marks": self.kept.marks,
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Goes back to what `arrays` gave."""
        self._states.restore({name: arrays[name] for name in WIDTHS})
        self._forces = list(arrays["f"])
        self._times = arrays["times"].tolist()
        first, last, (self._most,) = np.split(arrays["energies"], (3, 6))
        self._first, self._last = tuple(first.tolist()), tuple(last.tolist())
        self.kept.rows[:], self.kept.marks[:] = arrays["rows"], arrays["marks"]

    def snapshot(self, work: np.ndarray) -> Snapshot:
        """How far it is now; it stays as it is while the run goes on."""
        assert self._first is not None
        rows, marks = self.kept
        energies = (self._first, self._last, self._most)
        return Snapshot(len(self._times), rows.copy(), marks.copy(), work.copy(), energies)

    def result(self, solver: str, reason: str | None, work: np.ndarray) -> Result:
        """The Result in mm, N, g, ms."""
        return self._result(self.snapshot(work), solver, reason, self._states.all())

    def result_at(self, snapshot: Snapshot, solver: str, reason: str | None) -> Result:
        """The Result up to the snapshot, in arrays of its own."""
        return self._result(snapshot, solver, reason, self._states.first(snapshot.times))

    def _result(
        self, snapshot: Snapshot, solver: str, reason: str | None, held: dict[str, np.ndarray]
    ) -> Result:
        rows, marks = snapshot.rows, snapshot.marks
        mirror, touched = self.system.mirror, int(marks.sum())
        if mirror is not None:
            touched = mirror.touched(self.system, marks)
            summed = (MAX_FORCE, FORCE_TIME, FORCE_NOW)  # depths and times hold for both sides
            columns = enumerate(rows.T)
            rows = np.array([(mirror.sums if k in summed else mirror.largest)(c) for k, c in columns]).T
            snapshot = snapshot._replace(work=2.0 * snapshot.work)
        inside = np.where(rows[:, TIME] > 0, rows[:, TIME], 1.0)
        forces = np.array(self._forces[: snapshot.times])
        forces = forces if mirror is None else mirror.acts(forces)
        return Result(
            model=self.model,
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
            touched=touched,
            energy=_balance(self.model, snapshot),
            versions=_versions(),
            halved=mirror is not None,
        )


def _balance(model: Model, snapshot: Snapshot) -> Energy:
    lost, driven, through, numerical = (float(v) for v in snapshot.work)
    first, last, most = snapshot.energies
    kinetic, elastic, potential = last
    change = sum(last) - sum(first)
    scale = audit.scale(model, lost, through, most, potential - first[POTENTIAL])
    balance = float((change + lost - driven) / scale)
    return Energy(kinetic, elastic, lost - numerical, driven, balance, scale, numerical)


def _versions() -> dict[str, str]:
    return {name: of(name) for name in ("numba", "llvmlite")}
