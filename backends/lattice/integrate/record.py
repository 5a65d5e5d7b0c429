"""What a run passes through: stored states, contact statistics, the energy balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System
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
)
from mdlgen.mechanics.turning import ABOUT_A, ABOUT_B, ALONG, LIMIT, TURNING
from mdlgen.model.meshes import carried
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.result import ContactStatistics, Energy, Result
from mdlgen.version import of

STORED = {"x": 3, "r": 9, "u": 3, "w": 3}
NOW = [FORCE_NOW, *range(TURNING_NOW, TURNING_NOW + TURNING)]  # of the rows of contacts: PRESSES, TURNS
BEGUN = [FORCE_BEGUN, *range(TURNING_BEGUN, TURNING_BEGUN + TURNING)]
TOGETHER = 20_000  # bodies, times states, whose rotations are looked at together


class Snapshot(NamedTuple):
    """How far a recorder is: what a result up to there is made from, besides the stored states."""

    times: int  # how many are stored
    rows: np.ndarray
    marks: np.ndarray
    work: np.ndarray
    energies: tuple[tuple[float, float, float], tuple[float, float, float], float]  # first, last, most


class Recorder:
    """Stores states of a run; `kept` is what the compiled code adds up."""

    def __init__(self, model: Model, system: System, state: State, mid: Midpoint, kept: Kept):
        self.model, self.system, self.tables = model, system, system.tables
        self.state, self.mid, self.kept = state, mid, kept
        self._stored: dict[str, list[np.ndarray]] = {name: [] for name in (*STORED, "f")}
        self._times: list[float] = []
        self._first: tuple[float, float, float] | None = None
        self._last = (0.0, 0.0, 0.0)
        self._most = 0.0

    def store(self, t: float) -> None:
        """The state at the end of a step."""
        from mdlgen.backends.lattice.kernels.integrate import observe

        count = len(self.model.bodies.name)
        energies, rows = np.zeros(3), np.zeros_like(self.kept.rows)
        observe.ledger(self.tables, self.state, self.mid, t, self.system.search.first, energies, rows)
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
        for name, array in (("x", self.state.x), ("r", self.state.r), ("u", motion.u), ("w", motion.w)):
            self._stored[name].append(array[:count].copy())
        if t == 0.0:
            self.kept.rows[:, NOW] = rows[:, NOW]
            # what presses as a run begins may be gone in the middle of its first step
            self.kept.rows[:, [MAX_FORCE, MAX_DEPTH]] = rows[:, [FORCE_NOW, DEPTH_NOW]]
        # forces in the middle of the last step, where the rule has them, until the next one shows what they
        # are at its end; at the start as it begins
        self._stored["f"].append(self.kept.rows[:, NOW])

    def between(self) -> None:
        """The step after the last state that is stored has been taken: forces there lie between both."""
        self._stored["f"][-1] = self.kept.rows[:, BEGUN]

    def arrays(self) -> dict[str, np.ndarray]:
        """All that it has stored, and what the compiled code added up."""
        times, bodies = len(self._times), len(self.model.bodies.name)
        found = {
            name: np.array(self._stored[name]).reshape(times, bodies, width) for name, width in STORED.items()
        }
        first = self._first or (0.0, 0.0, 0.0)
        return {
            **found,
            "f": np.array(self._stored["f"]).reshape(times, len(self.model.contacts), len(NOW)),
            "times": np.array(self._times),
            "energies": np.array([*first, *self._last, self._most]),
            "rows": self.kept.rows,
            "marks": self.kept.marks,
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Goes back to what `arrays` gave."""
        for name in (*STORED, "f"):
            self._stored[name] = list(arrays[name])
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
        return self.result_at(self.snapshot(work), solver, reason)

    def result_at(self, snapshot: Snapshot, solver: str, reason: str | None) -> Result:
        """The Result up to the snapshot."""
        rows, marks = snapshot.rows, snapshot.marks
        mirror, touched = self.system.mirror, int(marks.sum())
        if mirror is not None:
            touched = mirror.touched(self.system, marks)
            summed = (MAX_FORCE, FORCE_TIME, FORCE_NOW)  # depths and times hold for both sides
            columns = enumerate(rows.T)
            rows = np.array([(mirror.sums if k in summed else mirror.largest)(c) for k, c in columns]).T
            snapshot = snapshot._replace(work=2.0 * snapshot.work)
        inside = np.where(rows[:, TIME] > 0, rows[:, TIME], 1.0)
        held = self._whole(snapshot.times)
        return Result(
            model=self.model,
            solver=solver,
            status=reason or "ok",
            time=np.array(self._times[: snapshot.times]),
            position=held["x"],
            rotation=held["e"],
            velocity=held["u"],
            spin=held["w"],
            contact_force=held["f"][..., PRESSES],
            contact_torque=held["f"][..., [TURNS + ABOUT_A, TURNS + ABOUT_B]],
            contact_friction=held["f"][..., [TURNS + ALONG, TURNS + LIMIT]],
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

    def _whole(self, times: int) -> dict[str, np.ndarray]:
        """The first states that it has stored, with the bodies that are not solved for; Euler parameters."""
        held = {name: np.array(values[:times]) for name, values in self._stored.items()}
        mirror = self.system.mirror
        moving, finite = [held[name] for name in STORED], np.isfinite(held["r"]).all()
        held["e"] = np.full((*held["x"].shape[:2], 4), np.nan)
        few = max(1, TOGETHER // held["x"].shape[1])
        for at in range(0, times, few):
            some = [array[at : at + few] for array in moving]
            if mirror is not None:
                mirror.fill(*some)
            carried(self.model, *some)
            if finite:
                held["e"][at : at + few] = euler_parameters(some[1].reshape(*some[1].shape[:2], 3, 3))
        if mirror is not None:
            held["f"] = mirror.acts(held["f"])
        return held | {"e": _without_jumps(held["e"]) if finite else held["e"]}


def _balance(model: Model, snapshot: Snapshot) -> Energy:
    lost, driven, through, numerical = (float(v) for v in snapshot.work)
    first, last, most = snapshot.energies
    kinetic, elastic, potential = last
    change = sum(last) - sum(first)
    scale = audit.scale(model, lost, through, most, potential - first[POTENTIAL])
    balance = float((change + lost - driven) / scale)
    return Energy(kinetic, elastic, lost - numerical, driven, balance, scale, numerical)


def _without_jumps(parameters: np.ndarray) -> np.ndarray:
    """Euler parameters (t, bodies, 4) with the signs that let them go on from one state to the next."""
    signs = np.sign(np.einsum("tbi,tbi->tb", parameters[1:], parameters[:-1]))
    signs[signs == 0] = 1.0
    parameters[1:] *= np.cumprod(signs, axis=0)[:, :, None]
    return parameters


def _versions() -> dict[str, str]:
    return {name: of(name) for name in ("numba", "llvmlite")}
