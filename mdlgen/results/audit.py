"""The energy audit of a run: no energy may come out that no force put in.

All solvers share it. The imbalance is compared with an energy that matters in the run: the energy that passed
through it, and at least the work of the weight over a lift that `run.tolerance` permits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Collection

    from mdlgen.model.tables import Model
    from mdlgen.results.result import Energy

# Energy that the integration makes or loses, relative to the scale, above which a run fails. Contacts that
# open and close within a step, as where an edge comes into a nip, lose more than they make.
GAIN, LOSS, LOSS_RIGID = 0.02, 0.05, 0.01
# How much finer a step is advised where none was given.
FINER = 4.0
LEAST = 1e-12  # [N mm]
# An error of more than this part of its scale is none that a result may have, be it estimated or known.
MOST = 0.25
ADVICE = "leave out run.step"  # where one was given


def scale(
    model: Model,
    dissipated: float,
    driven: float,
    most: float,
    moved: float,
    of: Collection[str] | None = None,
) -> float:
    """Energy that an imbalance of the parts `of` is relative to [N mm]; None: of all parts.

    It is the greatest of these: dissipated energy, work of drives and loads in either direction, kinetic plus
    elastic energy at any time, and the work of gravity. It is at least the work that is `unseen` over the
    part that may be gained.
    """
    return max(abs(dissipated), driven, most, abs(moved), unseen(model, of) / GAIN, LEAST)


def unseen(model: Model, of: Collection[str] | None = None) -> float:
    """Work [N mm] that lifts the sheets `of`, None: all, by `run.tolerance` times a tenth of their length.

    Positions that are so far off are within the tolerance, and boxes that come to rest make or lose less.
    """
    free = ~model.bodies.fixed
    weight = 0.0
    for sheet in model.sheets:
        if of is not None and sheet.name not in of:
            continue
        boxes = slice(sheet.first, sheet.first + sheet.count)
        weight += float(model.bodies.mass[boxes] @ free[boxes]) * max(sheet.size) / 10.0
    return model.run.tolerance * weight * float(np.linalg.norm(model.most_gravity))


def made_by_nips(energy: Energy) -> str | None:
    """A message about the energy that the law of nips created at any step; None: no more than a run may gain.

    The law is not the gradient of an energy where a hard and a soft roller press deep. Such a run is complete
    and its steps are fine enough, but its error is not known. Where the nips create more than MOST of the
    scale, the run has no result.
    """
    if -energy.dissipated <= GAIN * energy.scale:
        return None
    made = -energy.dissipated / energy.scale
    return (
        f"nips made {made * energy.scale:.3g} N mm of energy, {100 * made:.3g} % of "
        f"{energy.scale:.3g} N mm, at any step; allowed are {100 * GAIN:g} %; a hard and a soft roller press "
        "deep: raise the stiffness of the soft one's contact, or lower the preload (see W105)"
    )


def reason(model: Model, energy: Energy, step: float, loss: float | None = None) -> str | None:
    """Why a run at a step [ms] has no result; None where its energies balance.

    The gain may be GAIN of the scale, the loss `loss` of it (None: any, for an integrator that damps).
    """
    nips = made_by_nips(energy)
    if nips is not None and -energy.dissipated > MOST * energy.scale:
        return nips
    message = off_balance(energy, loss)
    if message is None:
        return None
    if model.run.step is not None:
        return f"{message}; {ADVICE}, so that a step is found that keeps the energy"
    return f"{message}; give a run.step of {step / FINER:.2g} ms"


def off_balance(energy: Energy, loss: float | None = None) -> str | None:
    """By how much the energies of a run do not balance, None where they do; `loss` as of `reason`."""
    off = energy.balance_error
    if off <= GAIN and (loss is None or off >= -loss):
        return None
    whence, most = ("came from nowhere", GAIN) if off > 0.0 else ("got lost", loss or 0.0)
    where = f" in {', '.join(energy.of[:3])}" if energy.of else ""
    message = f"{abs(off) * energy.scale:.3g} N mm of energy {whence}{where}, {100 * abs(off):.3g} % of "
    return message + f"{energy.scale:.3g} N mm; allowed are {100 * most:g} %"


def shown(energy: Energy) -> bool:
    """Whether a complete run whose energies do not balance is worth showing, marked as inaccurate: what is
    missing or too much is no more than MOST of the scale."""
    return max(abs(energy.balance_error), -energy.dissipated / max(energy.scale, LEAST)) <= MOST
