"""The time step that a tolerance requires, and the cost of a run at it."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.backends.exudyn_local.shipped import ledger
from mdlgen.backends.exudyn_local.state import SEEN, TOTALS, Coordinates, Work
from mdlgen.backends.exudyn_local.system import MS, System
from mdlgen.mechanics.point import DEPTH, FORCE_A, FORCE_B, PRESSING, STORED
from mdlgen.model.impact import approach_time, impact_time, lasting
from mdlgen.model.tables import OF_MACHINE, Model

# A flexible sheet in nips: the error of its travel is 1e-4 at this step (see the bench), of second order
# below.
FLEXIBLE_STEP = 0.05  # ms at tolerance 1e-3
# A rigid block that bounces: steps in one contact; 50 give 0.1 % of the rebound.
STEPS_IN_CONTACT = 50.0  # at tolerance 1e-3
# The boxes of a flexible sheet that start in a part, or that fly at one: 20 steps give 1 %.
STEPS_OF_BOXES = 20.0
# Contacts at the start balance each other where their resultant is below this part of the sum of their
# forces.
UNBALANCED = 0.1
# Below this restitution the force drops sharply at the greatest depth, which requires smaller steps.
SOFT_RESTITUTION = 0.4


# Wall time of a step: of Python between the kernels, and per unknown, as measured in 2026 [s].
STEP_COST, UNKNOWN_COST = 5e-5, 6e-6


def choose_steps(model: Model, system: System, work: Work) -> tuple[int, float]:
    """(number of steps, step [s]) that the Model's tolerance requires, so that outputs fall on steps."""
    run = model.run
    wanted = min(_from_tolerance(model), overlap_step(model, system, work))
    outputs = max(1, round(run.duration / run.print_step))
    count = outputs * max(1, math.ceil(run.duration / outputs / wanted - 1e-9))
    return count, run.duration / count * MS


def given_steps(model: Model, step: float) -> tuple[int, float]:
    """(number of steps, step [s]) for a step of at most `step` [ms]."""
    count = max(1, math.ceil(model.run.duration / step - 1e-9))
    return count, model.run.duration / count * MS


def cost(system: System, steps: float) -> float:
    """Estimated time of a run [s], from its counts. It is the same on every machine, so that the choice of
    runs does not depend on the speed of the machine."""
    return steps * (STEP_COST + UNKNOWN_COST * system.free)


def overlap_step(model: Model, system: System, work: Work) -> float:
    """Step [ms] for boxes that contacts push away as the run begins; inf where there are none, or where
    contacts balance each other.

    The energy that a contact has stored at the start is that of an impact whose second half follows. Boxes
    under a pressed roller or on a pressed plate are in balance, and do not count.
    """
    pairs, bodies = system.pairs, system.bodies
    if not len(pairs):
        return math.inf
    q = np.zeros(max(1, system.free))
    out = np.zeros((len(pairs), SEEN))
    ledger(system.tables, Coordinates(q, q.copy(), 0.0), work, out, np.zeros(TOTALS))
    stored, force = np.zeros(len(bodies)), np.zeros(len(bodies))
    left, stiffest = np.zeros((len(bodies), 3)), np.zeros(len(bodies))
    pressed = np.zeros(len(bodies), bool)
    for k in np.flatnonzero(out[:, STORED] > 0.0):
        for end, at in (("a", FORCE_A), ("b", FORCE_B)):
            body = int(pairs[end][k])
            stored[body] += out[k, STORED]
            force[body] += out[k, PRESSING]
            left[body] += out[k, at : at + 3]
            stiffest[body] = max(stiffest[body], out[k, STORED] / (0.4 * out[k, DEPTH] ** 2.5))
            pressed[body] |= bodies["slide"][pairs["b" if end == "a" else "a"][k]] >= 0
    finer = math.sqrt(model.run.tolerance / 1e-3)
    shortest = math.inf
    for body in np.flatnonzero((stored > 0.0) & ~pressed & (bodies["first"] >= 0)):
        mass = float(bodies["mass"][body])
        if np.linalg.norm(left[body] + mass * system.gravity) > UNBALANCED * force[body]:
            speed = math.sqrt(2.0 * stored[body] / mass)
            shortest = min(shortest, lasting(mass, float(stiffest[body]), speed) / MS)
    rigid = all(sheet.count == 1 for sheet in model.sheets)
    return shortest / (STEPS_IN_CONTACT if rigid else STEPS_OF_BOXES) * finer


def _from_tolerance(model: Model) -> float:
    finer = math.sqrt(model.run.tolerance / 1e-3)
    wanted = FLEXIBLE_STEP * finer
    for row in range(len(model.contacts)):
        restitution = max(float(model.contacts.restitution[row]), 0.25 * SOFT_RESTITUTION)
        sharper = max(1.0, SOFT_RESTITUTION / restitution)
        wanted = min(wanted, approach_time(model, row) / (STEPS_OF_BOXES * sharper) * finer)
        if model.contacts.kind[row] in OF_MACHINE:
            continue
        sheet = next(s for s in model.sheets if s.name == model.contacts.part_a[row])
        if sheet.count == 1:
            time = impact_time(model, row, sheet.derived["m"])
            wanted = min(wanted, time / (STEPS_IN_CONTACT * sharper) * finer)
    return wanted
