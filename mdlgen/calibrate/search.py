"""Runs of a scene by the logarithm of one value, and the search among them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np

from mdlgen import registry
from mdlgen.calibrate import value as values
from mdlgen.calibrate.measured import Decay
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import Floats
from mdlgen.results.result import Result
from mdlgen.spec.scene import Scene

MAX_RUNS = 15
# The search for two values with the drop between them gives up after so many runs.
_BRACKET_RUNS = 8
_WIDEST = math.log(8.0)  # of its steps, in the logarithm of the value
_NARROWEST = 0.02
# Where the value is known, relative; a drop is measured to a percent at best.
_PRECISION = 1e-6
_CURVE_PRECISION = 1e-4
# Step of a finite-difference derivative, in the logarithm: far above the noise of a run, and small enough.
_NEAR = 0.02
# A drop that changes by less than this part of itself per unit of the logarithm does not show the value.
_DEAF = 1e-6
# A curve missed by more than this part of its greatest drop is not met: least squares may end off the curve.
_MET = 0.2

Count = Callable[[int, int], None]


class Failed(Exception):
    """A run that failed, or one too many."""


class Runs:
    """Runs of the scene by the logarithm of the value; none is made twice."""

    def __init__(
        self,
        scene: Scene,
        material: str,
        fit: str,
        probe: int,
        solver: str,
        times: Floats | None,
        progress: Count | None,
    ):
        self.scene, self.material, self.fit, self.probe, self.solver = scene, material, fit, probe, solver
        self.times, self.progress = times, progress
        self.known: dict[float, Floats] = {}
        self._numerical: dict[float, float | None] = {}
        self.step: float | None = None
        self.count = 0

    def drop(self, log_value: float) -> Floats:
        """Drop of the probe along gravity [mm]: at rest, (1,), or at the measured times."""
        log_value = float(log_value)
        if log_value not in self.known:
            self.known[log_value], self._numerical[log_value] = self._run(math.exp(log_value), self.step)
        return self.known[log_value]

    def numerical_at(self, log_value: float) -> float | None:
        """Part of what was lost in the run with a value that numerical damping took; None: not known."""
        self.drop(log_value)
        return self._numerical[float(log_value)]

    def at_half_step(self, log_value: float) -> Floats:
        """As `drop`, by one more run."""
        assert self.step is not None, "asked only after a run over time"
        return self._run(math.exp(log_value), self.step / 2)[0]

    def _run(self, value: float, step: float | None) -> tuple[Floats, float | None]:
        if self.count == MAX_RUNS:
            raise Failed(f"no {self.fit} was found in {MAX_RUNS} runs; start nearer to it (--set)")
        self.count += 1
        if self.progress is not None:
            self.progress(self.count, MAX_RUNS)
        model = lower(values.with_value(self.scene, self.material, self.fit, value))
        if step is not None:
            model = replace(model, run=replace(model.run, step=step))
        result = registry.solve(model, self.solver)
        if not result.usable:
            raise Failed(f"with {self.fit} = {value:.6g} the run failed: {result.status}")
        if self.times is not None and self.step is None:
            self.step = result.step
        energy = result.energy
        lost = energy.dissipated + (energy.numerical or 0.0)
        part = None if energy.numerical is None or lost <= 0.0 else energy.numerical / lost
        return self._read(result), part

    def _read(self, result: Result) -> Floats:
        from scipy.interpolate import CubicHermiteSpline

        gravity = result.model.gravity
        down = gravity / np.linalg.norm(gravity)
        anchor = result.model.probes[self.probe]
        sheet = result.model.sheets[anchor.sheet]
        first = sheet.center + sheet.rotation @ np.array([*anchor.at, 0.0])  # in the flat sheet
        place, rate = result.anchor_motion(self.probe)
        drop = (place - first) @ down
        if self.times is None:
            return drop[-1:]
        return CubicHermiteSpline(result.time, drop, rate @ down)(np.minimum(self.times, result.time[-1]))


class Search:
    """From a start to the logarithm of the value with which runs and measurement agree."""

    def __init__(self, runs: Runs, begin: float, greatest: float | None):
        self.runs, self.begin = runs, begin
        self.limit = math.inf if greatest is None else math.log(greatest)

    def number(self, drop: float) -> float:
        from scipy.optimize import root_scalar

        def miss(log_value: float) -> float:
            # near ln(found / drop), and tame for every sign
            found = float(self.runs.drop(log_value)[0])
            return 2.0 * (found - drop) / (abs(found) + drop)

        low, high = self._bracket(miss, drop)
        if low == high:
            return low
        found = root_scalar(miss, method="brentq", bracket=(low, high), xtol=_PRECISION)
        return float(found.root)

    def _bracket(self, miss: Callable[[float], float], drop: float) -> tuple[float, float]:
        """Two values with the drop between them, each step by what the last two say of the next."""
        at, off = self.begin, miss(self.begin)
        if off == 0.0:
            return at, at
        # a stiffer sheet drops less, in proportion while it drops little
        step = math.copysign(min(max(abs(off), _NARROWEST), _WIDEST), off)
        while self.runs.count < _BRACKET_RUNS:
            then, was = at, off
            at, off = at + step, miss(at + step)
            if off * was <= 0.0:
                return min(then, at), max(then, at)
            slope = (off - was) / (at - then)
            self._check_heard(np.array([slope]), 1.0)
            step = -1.5 * off / slope
            step = math.copysign(min(max(abs(step), _NARROWEST), _WIDEST), step)
        found, tried = self.runs.known[at][0], math.exp(at)
        raise SpecError(
            f"--measured: no {self.runs.fit} lets the probe drop by {drop:g} mm; "
            f"from {math.exp(self.begin):.4g} to {tried:.4g} it came to {found:.6g} mm"
        )

    def curve(self, decay: Decay) -> float:
        from scipy.optimize import least_squares

        # counted from 1, so that the relative precision of scipy is one of the value
        offset = self.begin - 1.0

        def miss(unknown: Floats) -> Floats:
            return self.runs.drop(offset + unknown[0]) - decay.drop

        def slopes(unknown: Floats) -> Floats:
            slope = self.slope(offset + unknown[0])
            self._check_heard(slope, float(np.abs(decay.drop).max()))
            return slope[:, None]

        found = least_squares(
            miss,
            [1.0],
            jac=cast(Any, slopes),  # the stubs know its names only
            xtol=_CURVE_PRECISION,
            ftol=1e-10,
        )
        best = offset + float(found.x[0])
        # no bound in the search, which would slow it near there
        if best > self.limit:
            raise Failed(
                f"the curve asks for more {self.runs.fit} than {math.exp(self.limit):g}, the most there is"
            )
        missed = float(np.sqrt(np.mean(found.fun**2)) / decay.drop.max())
        if missed > _MET:
            raise Failed(
                f"the nearest {self.runs.fit}, {math.exp(best):.6g}, misses the curve by {missed:.0%} of its "
                "greatest drop; start nearer to it (--set), or look at the scene"
            )
        return best

    def slope(self, log_value: float) -> Floats:
        """d drop / d ln value [mm], by one more run at a value 2 % away."""
        return (self.runs.drop(log_value + _NEAR) - self.runs.drop(log_value)) / _NEAR

    def step_error(self, log_value: float) -> float:
        """How far the step of the runs moves the value, relative: with one of second order half the step
        leaves a quarter of that, and the least squares follow a change of the drop by their slope."""
        slope = self.slope(log_value)
        change = self.runs.drop(log_value) - self.runs.at_half_step(log_value)
        return -4.0 / 3.0 * float(slope @ change / (slope @ slope))

    def _check_heard(self, slope: Floats, scale: float) -> None:
        if float(np.abs(slope).max()) <= _DEAF * scale:
            raise SpecError(
                f"--fit: the measured motion does not depend on {self.runs.fit}; "
                "k_tx, D_cd and damping.ratio act on bending along y (CD), "
                "k_ty, D_md and damping.ratio_ty on bending along x (MD), "
                "damping.time and damping.loss_factor on both"
            )
