"""Checks that a run is valid: by its energy over time, or by its forces at rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mdlgen.backends.exudyn_local.recorder import Recorder
from mdlgen.backends.exudyn_local.shipped import forces
from mdlgen.backends.exudyn_local.state import Coordinates, Work
from mdlgen.backends.exudyn_local.system import MM, MS, System
from mdlgen.model.tables import Model
from mdlgen.results import audit
from mdlgen.results.result import Result


def unbalanced_energy(model: Model, result: Result, recorder: Recorder, h: float) -> str | None:
    """Reason why the energy does not balance, at the time of the largest error of either sign.

    A sheet vibrates too fast for the step, and the rule damps that; a rigid block loses the error of its
    impacts.
    """
    if any(sheet.count > 1 for sheet in model.sheets):
        # the energy that an edge stores as it enters a nip returns some steps later: the end counts
        return audit.reason(model, result.energy, h / MS, audit.LOSS)
    for off in (recorder.gained, recorder.vanished):
        worst = replace(result.energy, balance_error=off / MM / result.energy.scale)
        reason = audit.reason(model, worst, h / MS, audit.LOSS_RIGID)
        if reason is not None:
            return reason
    return None


def unbalanced(model: Model, system: System, q: np.ndarray, work: Work) -> str | None:
    """Static equilibrium by our own account: the residual against weight, loads and stress at the start."""
    worst = float(np.abs(_residual(system, q, work)).max())
    allowed = allowed_residual(model, system, q, work)
    return None if worst <= allowed else f"static residual {worst:.3g} N above {allowed:.3g} N"


def allowed_residual(model: Model, system: System, q: np.ndarray, work: Work) -> float:
    """Residual [N] at which a static run is in balance: a part of its loads, or what rounding leaves."""
    weight = float(system.bodies["mass"].sum() * np.linalg.norm(system.gravity))
    rest = model.bushings.rest[system.bushings["row"]]
    bent = float(np.abs(system.bushings["k"][:, 3:] * rest).max(initial=0.0))
    loads = float(np.abs(system.loads["force"]).sum() + (np.abs(system.loads["moment"]).sum() + bent) / 0.1)
    return max(1e-4 * max(weight, loads, 1e-9), _rounding(system, q, work))


def _rounding(system: System, q: np.ndarray, work: Work) -> float:
    """Norm of the change of the residual [N] where each coordinate is moved to a neighbouring number.

    No solver finds a smaller one; Exudyn's Newton iteration ends by that norm. The signs are drawn with a
    fixed seed.
    """
    reference = np.zeros_like(q)
    for row in system.bodies:
        n = row["first"]
        if n >= 0:
            reference[n : n + 7] = row["reference"]
    moved = q + np.random.default_rng(0).choice((-1.0, 1.0), len(q)) * np.spacing(np.abs(reference + q))
    return float(np.linalg.norm(_residual(system, moved, work) - _residual(system, q, work)))


def _residual(system: System, q: np.ndarray, work: Work) -> np.ndarray:
    """Forces of each coordinate at rest, [N] of places and [N m] of Euler parameters."""
    forces(system.tables, Coordinates(q, np.zeros_like(q), 1.0), 1.0, work)
    residual = work.forces.copy()
    for row in system.bodies:
        n = row["first"]
        if n >= 0:  # along the Euler parameters themselves a force does no work
            e = row["reference"][3:] + q[n + 3 : n + 7]
            residual[n + 3 : n + 7] -= e * (e @ residual[n + 3 : n + 7]) / (e @ e)
    return residual
