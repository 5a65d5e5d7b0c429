"""The companion: a Python script for MotionView that sets what MDL has no known form for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mdlgen.backends.motionview.writer.environment import environment
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.system import kept_contacts, system_view
from mdlgen.backends.motionview.writer.units import mdl_value, number
from mdlgen.backends.motionview.writer.views import scene_view
from mdlgen.model.tables import Ints, Model

OPTIONAL = (
    "the numbers of its contacts, which the solver commands of the text give at the start of a run anyway"
)
# Default of MotionView where a file does not set it [mm/s].
DEFAULT_SMOOTHING = 1.0


class Numbers(NamedTuple):
    """The numbers of one entry of the contacts, and the contact statements that get them."""

    label: str
    numbers: list[tuple[str, str]]  # (property of mview.Contact, number, or how it follows: see `_said`)
    names: list[str]


def reasons(model: Model, set_contact: bool = False, only: str | None = None) -> list[str]:
    """Reasons why the script is needed, one line each: the solver commands of a whole text have its
    numbers."""
    found, rows = [], _written(model, only)
    if len(rows) and only is not None and not set_contact:
        found.append("the contact numbers: the argument order of SetContact is not certain")
    elif len(rows) and set_contact and _smoothing_differs(model, rows):
        found.append("normal_trans_vel of the contacts: SetContact has no documented place for it")
    return found


def companion(model: Model, *, set_contact: bool = False, only: str | None = None) -> str | None:
    """The script, needed or not; None where there is nothing that it could set."""
    contacts = _numbers(model, set_contact, only)
    if not contacts:
        return None
    template = environment().get_template("companion.py.j2")
    return template.render(
        name=model.name,
        reasons=reasons(model, set_contact, only) or [OPTIONAL],
        system=None if only is None else system_view(model, set_contact).variable,
        contacts=contacts,
        follows=follows(contacts),
    )


def _written(model: Model, only: str | None) -> Ints:
    """Row of the contacts of each pair that has a statement in the text."""
    return model.pairs.contact if only is None else kept_contacts(model)


def _smoothing_differs(model: Model, rows: Ints) -> bool:
    used = np.unique(rows)
    return any(mdl_value(float(v), "mm/ms") != DEFAULT_SMOOTHING for v in model.contacts.smoothing[used])


def _numbers(model: Model, set_contact: bool, only: str | None) -> list[Numbers]:
    rows = _written(model, only)
    if not len(rows) or (set_contact and not _smoothing_differs(model, rows)):
        return []
    scene = scene_view(model, set_contact) if only is None else system_view(model, set_contact).scene
    names: dict[str, dict[tuple[bool, float, float, float | None], list[str]]] = {}
    for pair in scene.pairs:
        alike = names.setdefault(pair.data_set, {})
        key = (pair.friction == "ON", pair.rougher, pair.stiffer, pair.restitution)
        alike.setdefault(key, []).append(pair.name)
    found = []
    for contact in scene.contacts:
        given = {value.member: value for value in contact.given}

        def said(member: str, times: float = 1.0, given=given, holder=f"ds_{contact.data_set}") -> str:
            return _said(given[member], holder, times)

        for (rubs, rougher, stiffer, restitution), pairs in names.get(contact.data_set, {}).items():
            label = contact.label if rougher == 1.0 else f"{contact.label}, friction times {number(rougher)}"
            label += "" if stiffer == 1.0 else f", stiffness times {number(stiffer)}"
            table = [("normal_trans_vel", said("v_n"))]
            if not set_contact:
                bounce = said("c_R") if restitution is None else number(restitution)
                table = [("penalty", said("k", stiffer)), ("rest_coeff", bounce), *table]
                if rubs:
                    table += [
                        ("mu_static", said("mu_s", rougher)),
                        ("mu_dynamic", said("mu_d", rougher)),
                        ("stiction_trans_vel", said("v_s")),
                        ("friction_trans_vel", said("v_d")),
                    ]
            found.append(Numbers(label, table, pairs))
    return found


def _said(value: Value, holder: str, times: float) -> str:
    """A number of a contact in the script: as it is written; with the value of the model that it is so many
    times, where that follows the parameters of the scene."""
    written = value.number if times == 1.0 else number(float(value.number) * times)
    return f'({written}, "{holder}.real_{value.member}", {number(times)})' if value.formula else written


def follows(contacts: list[Numbers]) -> bool:
    """True if some number follows a value of the model."""
    return any(text.startswith("(") for contact in contacts for _, text in contact.numbers)
