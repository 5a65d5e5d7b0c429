"""Reasons why a run ended early, or is not a valid result."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdlgen.backends.lattice.arrays import System, partner
from mdlgen.backends.lattice.integrate.there import There
from mdlgen.backends.lattice.integrate.work import flexible
from mdlgen.backends.lattice.kernels import tuning
from mdlgen.backends.lattice.kernels.state import (
    STEPS,
    STRAIN,
    THROUGH,
    WORST,
    State,
)
from mdlgen.mechanics.pair import before_an_end
from mdlgen.model.curves import overstretched
from mdlgen.model.overlaps.unheld import Unheld
from mdlgen.model.tables import Floats, Model
from mdlgen.results import audit
from mdlgen.results.result import Result

# Further states in which a pass ends, in addition to those of kernels.integrate.integrate.
PASSED, OVERLAPPED, LIMITED, CRAWLED, RUNAWAY, TAKEN = -1, -2, -3, -4, -5, -6


class Ended(NamedTuple):
    """State of the steps as a run ended."""

    system: System
    bodies: There  # that it has
    state: State
    whole: tuple[Floats, Floats]  # x and r of all bodies
    counters: Floats


def reason_of(
    model: Model,
    ended: Ended,
    status: int,
    t: float,
    dt: float,
    there: NDArray[np.bool_] | None = None,
) -> str:
    """Reason why a run ended early; `there` (sheets,): sheets that were present, None: all."""
    from mdlgen.backends.lattice.kernels.integrate import integrate

    system, state, counters = ended.system, ended.state, ended.counters

    def called(number: float) -> str:
        return model.bodies.name[ended.bodies.body(int(number))]

    if status == LIMITED:
        return limited(model, t)
    if status == CRAWLED:
        return (
            f"{int(counters[STEPS])} steps were needed up to {t:.6g} ms, more than the whole run takes at "
            f"the finest step of a search; the velocity of box {called(counters[WORST])} converges "
            "slowly; larger smoothing of its contacts may help"
        )
    if status == integrate.STOPPED and counters[THROUGH] >= 0:
        one, two = (called(system.pairs[end][int(counters[THROUGH])]) for end in "ab")
        return (
            f"box {one} would pass through box {two} of another sheet at {t:.6g} ms, with steps down to "
            f"{dt / 2**tuning.HALVINGS_MOST:.3g} ms; a stiffer contact between the two would hold it"
        )
    if status == integrate.STOPPED:
        body = called(counters[WORST])
        return (
            f"no convergence at {t:.6g} ms with steps down to {dt / 2**tuning.HALVINGS_MOST:.3g} ms; "
            f"box {body} moved most; larger smoothing of its contacts may help"
        )
    if status == integrate.DEEP:
        pair = int(counters[WORST])
        record = system.pairs[pair].copy()
        record["a"], record["b"] = (ended.bodies.body(int(record[end])) for end in "ab")
        box, plate = int(record["a"]), partner(model, record)
        rates = [
            state.u[np.flatnonzero(system.nodes == int(system.pairs[end][pair])), :3].sum(0) for end in "ab"
        ]
        way = dt * float(np.linalg.norm(rates[0] - rates[1]))
        deep = model.too_deep(box, plate, before_an_end(system.pairs[pair]))
        return f"{deep} at {t:.6g} ms; {model.held_by(box, way)}"
    if status == OVERLAPPED:
        return unheld(model, system).found(*ended.whole, t, there) or "two parts overlap"
    if status == PASSED:
        return (
            f"box {called(counters[WORST])} has passed the plane of the scene's symmetry at "
            f"{t:.6g} ms, where it may meet what is on the other side; run.symmetry: false solves both sides"
        )
    if status == integrate.CROWDED:
        room = len(system.pairs) - system.search.first
        return f"more than {room} pairs of boxes of two sheets are near each other at {t:.6g} ms"
    if status == integrate.STRETCHED:
        row = int(system.joints["row"][int(counters[WORST])])
        return overstretched(model, row, float(counters[STRAIN]), t)
    body = int(ended.bodies.body(int(counters[WORST])))
    at = ", ".join(f"{value:.4g}" for value in ended.whole[0][body])
    bounds, advice = model.bounds_of(body)
    return f"{model.called(body)} left {bounds} at {t:.6g} ms (it is at {at} mm); {advice}"


def limited(model: Model, t: float) -> str:
    """The reason of a pass that ended at a time [ms] because its wall time was over."""
    return f"{limit_of(model)} of wall time was over at {t:.6g} ms"


def limit_of(model: Model) -> str:
    """The limit of wall time of a run, for messages."""
    if model.run.limit is None:
        return f"{tuning.PATIENCE:g} s"
    return f"run.limit of {1e-3 * model.run.limit:g} s"


def unheld(model: Model, system: System) -> Unheld:
    """Detector of overlaps that no contact prevents; in a halved scene, on the side that is solved."""
    return Unheld(model, None if system.mirror is None else ~system.mirror.gone)


def unbalanced(run: Result) -> str | None:
    """Reason why the energy balance of a run invalidates it, or None."""
    loss = audit.LOSS if flexible(run.model) else audit.LOSS_RIGID
    return audit.reason(run.model, run.energy, run.step, loss)


def off_balance(run: Result) -> str | None:
    """Text with the error of a run's energy balance, or None if energies balance."""
    return audit.off_balance(run.energy, audit.LOSS if flexible(run.model) else audit.LOSS_RIGID)


def cut(run: Result) -> bool:
    """True if a run ended because its wall time was over."""
    return run.status.startswith(f"{limit_of(run.model)} of wall time was over")
