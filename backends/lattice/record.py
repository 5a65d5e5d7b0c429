"""What a run passes through: stored states, contact statistics, the energy balance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.lattice.arrays import System
from mdlgen.model.meshes import carried
from mdlgen.model.rotations import euler_parameters
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.result import ContactStatistics, Energy, Result
from mdlgen.version import of

STORED = {"x": 3, "r": 9, "u": 3, "w": 3}
TOGETHER = 20_000  # bodies, times states, whose rotations are looked at together


class Stand(NamedTuple):
    """How far a recorder is: what a result up to there is made from, apart from the stored states."""

    times: int  # how many are stored
    rows: np.ndarray
    marks: np.ndarray
    work: np.ndarray
    energies: tuple[tuple[float, float, float], tuple[float, float, float], float]  # first, last, most


class Recorder:
    """Stores states of a run; `kept` is what the compiled code adds up."""

    def __init__(self, model: Model, system: System, tables: tuple, state: tuple, mid: tuple, kept: tuple):
        self.model, self.system, self.tables = model, system, tables
        self.state, self.mid, self.kept = state, mid, kept
        self._stored: dict[str, list[np.ndarray]] = {name: [] for name in (*STORED, "f")}
        self._times: list[float] = []
        self._first: tuple[float, float, float] | None = None
        self._last = (0.0, 0.0, 0.0)
        self._most = 0.0

    def store(self, t: float) -> None:
        """The state at the end of a step."""
        from mdlgen.backends.lattice.kernels import observe

        bodies, joints, pairs, _, gravity, nodes, points, _, meshes = self.tables
        x, r, v, l, s, vb, _, _ = self.state
        _, _, u, w, f, touched, outs, _, near = self.mid
        count = len(self.model.bodies.name)
        energies = np.zeros(3)
        force = np.zeros(len(self.model.contacts))
        places, rates = (x, r), (v, l, s, vb)
        work = (u, w, f, touched, outs, near)
        sheets = (bodies, joints, points)
        observe.ledger(*sheets, pairs, meshes, gravity, nodes, t, *places, *rates, *work, energies, force)
        if self.system.mirror is not None:
            energies *= 2.0
        now = (float(energies[0]), float(energies[1]), float(energies[2]))
        if self._first is None:
            self._first = now
        self._last = now
        self._most = max(self._most, now[0] + now[1])
        self._times.append(t)
        for name, array in (("x", x), ("r", r), ("u", u), ("w", w)):
            self._stored[name].append(array[:count].copy())
        if t == 0.0:
            self.kept[0][:, 5] = force
        # forces in the middle of the last step, where the rule has them, until the next one tells what they
        # are at its end; at the start as it begins
        self._stored["f"].append(self.kept[0][:, 5].copy())

    def between(self) -> None:
        """The step after the last state that is stored has been taken: forces there lie between both."""
        self._stored["f"][-1] = self.kept[0][:, 9].copy()

    def arrays(self) -> dict[str, np.ndarray]:
        """All that it has stored, and what the compiled code added up."""
        times, bodies = len(self._times), len(self.model.bodies.name)
        found = {
            name: np.array(self._stored[name]).reshape(times, bodies, width) for name, width in STORED.items()
        }
        first = self._first or (0.0, 0.0, 0.0)
        return {
            **found,
            "f": np.array(self._stored["f"]).reshape(times, len(self.model.contacts)),
            "times": np.array(self._times),
            "energies": np.array([*first, *self._last, self._most]),
            "rows": self.kept[0],
            "marks": self.kept[1],
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Goes back to what `arrays` gave."""
        for name in (*STORED, "f"):
            self._stored[name] = list(arrays[name])
        self._times = arrays["times"].tolist()
        first, last, (self._most,) = np.split(arrays["energies"], (3, 6))
        self._first, self._last = tuple(first.tolist()), tuple(last.tolist())
        self.kept[0][:], self.kept[1][:] = arrays["rows"], arrays["marks"]

    def stand(self, work: np.ndarray) -> Stand:
        """How far it is now; it stays as it is while the run goes on."""
        assert self._first is not None
        rows, marks = self.kept
        energies = (self._first, self._last, self._most)
        return Stand(len(self._times), rows.copy(), marks.copy(), work.copy(), energies)

    def result(self, solver: str, reason: str | None, work: np.ndarray) -> Result:
        """The Result in mm, N, g, ms."""
        return self.result_at(self.stand(work), solver, reason)

    def result_at(self, stand: Stand, solver: str, reason: str | None) -> Result:
        """The Result up to where the recorder stood."""
        rows, marks = stand.rows, stand.marks
        mirror, touched = self.system.mirror, int(marks.sum())
        if mirror is not None:
            touched = mirror.touched(self.system, marks)
            summed = (1, 3, 5)  # forces; depths and times hold for both sides
            columns = enumerate(rows.T)
            rows = np.array([(mirror.sums if k in summed else mirror.largest)(c) for k, c in columns]).T
            stand = stand._replace(work=2.0 * stand.work)
        inside = np.where(rows[:, 4] > 0, rows[:, 4], 1.0)
        held = self._whole(stand.times)
        return Result(
            model=self.model,
            solver=solver,
            status=reason or "ok",
            time=np.array(self._times[: stand.times]),
            position=held["x"],
            rotation=held["e"],
            velocity=held["u"],
            spin=held["w"],
            contact_force=held["f"],
            statistics=ContactStatistics(
                max_depth=rows[:, 0].copy(),
                mean_depth=rows[:, 2] / inside,
                max_force=rows[:, 1].copy(),
                mean_force=rows[:, 3] / inside,
                last_force_at=np.where(rows[:, 7] != 0, np.nan, rows[:, 8]),
            ),
            touched=touched,
            energy=_balance(self.model, stand),
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
            held["f"] = mirror.sums(held["f"])
        return held | {"e": _without_jumps(held["e"]) if finite else held["e"]}


def _balance(model: Model, stand: Stand) -> Energy:
    lost, driven, through, numerical = (float(v) for v in stand.work)
    first, last, most = stand.energies
    kinetic, elastic, potential = last
    change = sum(last) - sum(first)
    scale = audit.scale(model, lost, through, most, potential - first[2])
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
