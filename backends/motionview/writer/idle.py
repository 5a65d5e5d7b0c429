"""Values of a data set that an MDL file shows but does not use: they are written NO_EDIT, with the reason.

A value that a user can edit and that changes nothing would be worse than one that cannot be edited.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from mdlgen.formulas import names
from mdlgen.model.parameters.axles import home_of
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model

# Sources of the numbers of contacts.
COMMAND, STATEMENT, SCRIPT = "solver commands", "SetContact", "the companion script"
_FRICTION = ("mu_s", "mu_d", "v_s", "v_d")
_DAMPING = ("zeta", "zeta_ty", "tau", "tau_md", "tau_cd", "eta", "eta_md", "eta_cd", "f")
_STIFFNESS = ("E_md", "E_cd", "k_tx", "k_ty", "k_tz", "D_md", "D_cd", "D_twist", "G", *_DAMPING)


def idle_values(model: Model, numbers_by: str, kept: Sequence[int]) -> dict[tuple[str, str], str]:
    """Reason by (data set, member).

    `numbers_by`: the source of the numbers of contacts; `kept`: contacts (rows) that are in the text.
    """
    found = _contacts(model, numbers_by, kept) | _unused(model)
    for p in model.parameters:
        if p.member in ("E_md", "E_cd") and p.path is None:
            found[p.data_set, p.member] = "the first slope of its curve"
    for index, sheet in enumerate(model.sheets):
        if not np.any(model.bushings.sheet == index):
            found |= {(sheet.name, member): "there are no joints" for member in _STIFFNESS}
            found |= {
                (f"{sheet.name}_zone_{z.name}", "stiffness"): "there are no joints" for z in sheet.zones
            }
        rubs = model.contacts.mu_static + model.contacts.mu_dynamic > 0
        mine = np.array([part == sheet.name for part in model.contacts.part_a], dtype=bool)
        if not set(np.flatnonzero(rubs & mine).tolist()) & set(kept):
            why = "nothing that it may touch has friction"
        elif numbers_by == SCRIPT:
            why = "the companion script sets it"
        else:
            continue
        found |= {(f"{sheet.name}_zone_{zone.name}", "friction"): why for zone in sheet.zones}
    for roller in model.rollers:
        if roller.speed is not None and roller.profile is None and roller.ramp <= 0.0:
            found[home_of(model, roller), "ramp"] = "the text has no ramp"
    found |= _rims(model, numbers_by, kept)
    if model.run.analysis == "static":
        found |= {("run", member): "the run is static" for member in ("end", "print", "h_max", "tol")}
    return found


def _unused(model: Model) -> dict[tuple[str, str], str]:
    """The user's parameters that no value of the text follows from."""
    rows = [p for p in model.parameters if p.data_set == OF_USER]
    used = used_by(model, (p.formula for p in model.parameters if p.data_set != OF_USER and p.formula))
    return {
        (OF_USER, p.member): "no value of this text follows from it" for p in rows if p.member not in used
    }


def used_by(model: Model, texts: Iterable[str]) -> set[str]:
    """The user's parameters that formulas, and places of probes and supports, follow from."""
    own = {p.member: p.formula for p in model.parameters if p.data_set == OF_USER}
    places = (text for anchor in (*model.probes, *model.supports) for text in anchor.formulas if text)
    waiting, used = [*texts, *places], set()
    while waiting:
        for name in names(waiting.pop()):
            if name not in used:
                used.add(name)
                waiting += [own[name]] if own[name] else []
    return used


def _rims(model: Model, numbers_by: str, kept: Sequence[int]) -> dict[tuple[str, str], str]:
    """Values of sectors of rims that no statement uses, with the reason."""
    table, found = model.contacts, {}
    for roller in model.rollers:
        if roller.rim is None:
            continue
        mine = {row for row in kept if roller.name in (table.part_a[row], table.part_b[row])}
        rubs = any(table.mu_static[row] > 0 or table.mu_dynamic[row] > 0 for row in mine)
        for name in roller.rim.name:
            for member in ("friction", "stiffness", "restitution"):
                reason = "the companion script sets it" if numbers_by == SCRIPT else ""
                if not mine:
                    reason = "no pair can meet"
                elif member == "friction" and not rubs:
                    reason = "friction is off"
                if reason:
                    found[roller.name, f"{name}_{member}"] = reason
    return found


def _contacts(model: Model, numbers_by: str, rows: Sequence[int]) -> dict[tuple[str, str], str]:
    table, found = model.contacts, {}
    kept = {int(table.entry[row]) for row in set(rows)}
    rubs = {int(e) for e in table.entry[(table.mu_static > 0) | (table.mu_dynamic > 0)]}
    for entry in sorted(set(table.entry.tolist())):
        for member in ("k", "c_R", *_FRICTION, "v_n"):
            if entry not in kept:
                reason = "no pair can meet"
            elif member in _FRICTION and entry not in rubs:
                reason = "friction is off"
            elif numbers_by == SCRIPT or (numbers_by == STATEMENT and member == "v_n"):
                reason = "the companion script sets it"
            else:
                continue
            found[f"contact_{entry}", member] = reason
    return found
