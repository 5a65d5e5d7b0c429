"""A calibration: the request, a check that the scene can answer it, and the result."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mdlgen import registry
from mdlgen.calibrate import value as values
from mdlgen.calibrate.measured import Decay
from mdlgen.calibrate.search import Count, Failed, Runs, Search
from mdlgen.errors import SpecError
from mdlgen.model.lower import lower
from mdlgen.model.tables import CLAMP, Anchor, Floats, Model
from mdlgen.spec.scene import Scene


@dataclass(frozen=True)
class Calibration:
    """The value found; where `status` is not "ok" it says why there is none."""

    status: str
    fit: str
    material: str
    unit: str
    value: float  # in `unit`, which is internal; nan where there is none
    measured: float | Decay
    drop: Floats  # of the probe with that value, along gravity [mm]; (1,), or at the measured times
    sensitivity: Floats  # d drop / d ln value [mm], of the same shape
    runs: int
    step_error: float | None  # of the value by the time step of the runs, relative; None at rest
    # part of what was lost in the last run that numerical damping of joints took; None at rest, and where the
    # solver does not have it apart
    numerical: float | None
    solver: str
    model: Model  # of the scene as it was given
    probe: Anchor

    @property
    def ok(self) -> bool:
        return self.status == "ok"

    @property
    def residual(self) -> float:
        """Calculated minus measured drop [mm]; the root of the mean square for a curve."""
        wanted = self.measured.drop if isinstance(self.measured, Decay) else self.measured
        gap = self.drop - wanted
        return float(np.sqrt(np.mean(gap**2))) if isinstance(self.measured, Decay) else float(gap[0])


def calibrate(
    scene: Scene,
    measured: float | Decay,
    fit: str,
    probe: str | None = None,
    solver: str = "auto",
    progress: Count | None = None,
) -> Calibration:
    """Find the value `fit` with which the probe moves as measured, of the probed sheet's material (see
    `value.FITS`) or a parameter of the scene (`parameters.NAME`): a static drop along gravity [mm],
    or a Decay.

    The logarithm of the value is sought, by Brent's method for one drop and by least squares for a curve, in
    at most 15 runs. All runs for a curve take the step that the first one was given or chose, so that they
    differ by the value alone. The numerical damping of the solver at that step counts as damping of the
    material. So a last run at half the step shows how far the step moves the value (`step_error`). Its energy
    shows how much of the damping is numerical (`numerical`): a value of damping is too small by that part.
    `progress(runs, most)` is called after each run.

    Raises SpecError for an unknown value or probe, an analysis that does not go with the measurement, and a
    measurement that no value reaches or that does not depend on the value.
    """
    known = values.find(fit, scene)
    model = lower(scene)
    index = _probe(model, probe)
    _check(model, measured, fit)
    if not isinstance(measured, Decay):
        _check_reach(model, index, measured)
    sheet = model.sheets[model.probes[index].sheet]
    material = scene.sheets[sheet.name].material
    values.check(fit, scene.materials[material])
    begin = values.start(fit, scene, scene.materials[material], sheet)
    times = measured.time if isinstance(measured, Decay) else None
    runs = Runs(scene, material, fit, index, solver, times, progress)
    search = Search(runs, math.log(begin), known.greatest)
    best = math.log(begin)
    try:
        best = search.curve(measured) if isinstance(measured, Decay) else search.number(measured)
        status, drop, slope = "ok", runs.drop(best), search.slope(best)
        step_error = None if times is None else search.step_error(best)
        numerical = None if times is None else runs.numerical_at(best)
    except Failed as failure:
        status, drop, slope = str(failure), np.full(1, np.nan), np.full(1, np.nan)
        step_error = numerical = None
    return Calibration(
        status=status,
        fit=fit,
        material=material,
        unit=known.unit,
        value=math.exp(best) if status == "ok" else math.nan,
        measured=measured,
        drop=drop,
        sensitivity=slope,
        runs=runs.count,
        step_error=step_error,
        numerical=numerical,
        solver=registry.chosen(solver, model)[0],
        model=model,
        probe=model.probes[index],
    )


def _probe(model: Model, name: str | None) -> int:
    names = [p.name for p in model.probes]
    if not names:
        raise SpecError("the scene has no probe; name the measured point under probes", ("probes",))
    if name is None and len(names) == 1:
        return 0
    if name not in names:
        what = "give --probe" if name is None else f"there is no probe {name[:80]!r}"
        raise SpecError(f"{what}; there are: {', '.join(names)}", ("probes",))
    return names.index(name)


def _check(model: Model, measured: float | Decay, fit: str) -> None:
    """Raises SpecError where the scene cannot give what was measured."""
    run = model.run
    if not model.gravity.any():
        raise SpecError("a drop is along gravity, and this scene has none", ("gravity",))
    if isinstance(measured, Decay):
        if run.analysis != "transient":
            raise SpecError(
                "a curve over time needs run.analysis: transient (--set run.analysis=transient --set "
                f'run.duration="{measured.time[-1]:g} ms")',
                ("run", "analysis"),
            )
        if measured.time[-1] > run.duration * (1 + 1e-9):
            raise SpecError(
                f"the curve ends at {measured.time[-1]:g} ms, the run at {run.duration:g} ms already",
                ("run", "duration"),
            )
        return
    if run.analysis != "static":
        raise SpecError(
            "one drop is that of a sheet at rest, which needs run.analysis: static; "
            "for a sheet that moves give a curve (--measured FILE.csv)",
            ("run", "analysis"),
        )
    if fit.startswith("damping."):
        raise SpecError(f"a sheet at rest says nothing of {fit}; it needs a curve (--measured FILE.csv)")


def _check_reach(model: Model, index: int, drop: float) -> None:
    """Raises SpecError for a drop that no bending of a clamped sheet allows, since paper does not stretch."""
    anchor = model.probes[index]
    bodies, sheet = model.bodies, model.sheets[anchor.sheet]
    if sheet.clamp is None:
        return
    at = sheet.center + sheet.rotation @ np.array([*anchor.at, 0.0])
    hinges = (model.bushings.kind == CLAMP) & (model.bushings.sheet == anchor.sheet)
    along = sheet.rotation[:, 0 if sheet.clamp.edge[0] == "x" else 1]
    out = float((at - model.bushings.origin[hinges].mean(axis=0)) @ along)
    down = model.gravity / np.linalg.norm(model.gravity)
    # the point stays within its distance from the nearest point of the clamp line
    most = abs(out) - out * float(along @ down)
    if bodies.fixed[anchor.body].all():
        raise SpecError(
            f"the probe {anchor.name} sits in the clamp and does not move", ("probes", anchor.name)
        )
    if drop >= most:
        raise SpecError(
            f"--measured: no value lets the probe {anchor.name} drop by {drop:g} mm: it lies "
            f"{abs(out):.6g} mm from the clamp line and can drop by less than {most:.6g} mm"
        )
