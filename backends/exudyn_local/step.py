"""The time step that a tolerance asks for."""

from __future__ import annotations

import math

from backends.exudyn_local.system import MS
from mdlgen.model.impact import impact_time
from mdlgen.model.tables import CYLINDER_CYLINDER, Model

# A flexible sheet in nips: travel is right to 1e-4 at this step (see the bench), and second order below.
FLEXIBLE_STEP = 0.05  # ms at tolerance 1e-3
# A rigid block that bounces: steps in one contact; 50 give 0.1 % of the rebound.
STEPS_IN_CONTACT = 50.0  # at tolerance 1e-3
# Below this restitution the force drops sharply at the greatest depth and wants finer steps.
SOFT_RESTITUTION = 0.4


def choose_steps(model: Model, step: float | None = None) -> tuple[int, float]:
    """(number of steps, step [s]); from `step` or the Model's [ms], or from its tolerance."""
    run = model.run
    wanted = step or run.step
    if wanted is None:
        wanted = _from_tolerance(model)
        # so that outputs fall on steps
        outputs = max(1, round(run.duration / run.print_step))
        count = outputs * max(1, math.ceil(run.duration / outputs / wanted - 1e-9))
    else:
        count = max(1, math.ceil(run.duration / wanted - 1e-9))
    return count, run.duration / count * MS


def _from_tolerance(model: Model) -> float:
    finer = math.sqrt(model.run.tolerance / 1e-3)
    wanted = FLEXIBLE_STEP * finer
    for row in range(len(model.contacts)):
        if model.contacts.kind[row] == CYLINDER_CYLINDER:
            continue
        sheet = next(s for s in model.sheets if s.name == model.contacts.part_a[row])
        if sheet.count == 1:
            time = impact_time(model, row, sheet.derived["m"])
            soft = SOFT_RESTITUTION / max(float(model.contacts.restitution[row]), 0.25 * SOFT_RESTITUTION)
            wanted = min(wanted, time / (STEPS_IN_CONTACT * max(1.0, soft)) * finer)
    return wanted
