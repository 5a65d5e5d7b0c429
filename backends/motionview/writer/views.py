"""Model -> the rows that the main template loops over."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mdlgen.altair.statics import static_settings
from mdlgen.backends.motionview.writer.commands import contact_laws
from mdlgen.backends.motionview.writer.contacts import contact_views, pair_rows
from mdlgen.backends.motionview.writer.formula import mdl_formula, rows_of, units_of
from mdlgen.backends.motionview.writer.idle import COMMAND, STATEMENT, idle_values
from mdlgen.backends.motionview.writer.loads import load_views
from mdlgen.backends.motionview.writer.parts.kinds import WRITTEN
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.scene_rows import SceneView, ShaftView
from mdlgen.backends.motionview.writer.sheets import probe_view, sheet_view, support_views
from mdlgen.backends.motionview.writer.units import mdl_value, number, with_unit
from mdlgen.model.parameters.axles import OF_SHAFT
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model, Parameter


def scene_view(model: Model, set_contact: bool) -> SceneView:
    """All rows of a Model."""
    given = given_values(model, STATEMENT if set_contact else COMMAND, model.pairs.contact.tolist())
    machine = [WRITTEN[type(part)].view(model, part, given[part.name]) for part in model.machine]
    contacts, pairs = contact_views(model, given, range(len(model.contacts))), pair_rows(model)
    return SceneView(
        name=model.name,
        parameters=given.get(OF_USER, []),
        static=model.run.analysis == "static",
        static_settings=static_settings(model),
        run=given["run"],
        sheets=[sheet_view(model, k, given) for k in range(len(model.sheets))],
        supports=support_views(model),
        loads=load_views(model, given),
        machine=machine,
        shafts=[
            ShaftView(name, f"Shaft {name.removeprefix(OF_SHAFT)}", rows)
            for name, rows in given.items()
            if name.startswith(OF_SHAFT)
        ],
        contacts=contacts,
        pairs=pairs,
        laws=[] if set_contact else contact_laws(contacts, pairs),
        probes=[probe_view(model, probe) for probe in model.probes],
        set_contact=set_contact,
    )


def given_values(model: Model, numbers_by: str, kept: Sequence[int]) -> dict[str, list[Value]]:
    """Members by data set, in the order of the parameters; `numbers_by` and `kept` as in `idle_values`."""
    idle = idle_values(model, numbers_by, kept)
    units, rows = units_of(model), rows_of(model)
    tables: dict[str, list[Value]] = {}
    for p in model.parameters:
        tables.setdefault(p.data_set, []).append(_value(p, idle.get((p.data_set, p.member)), units, rows))
    return tables


def _value(
    parameter: Parameter, idle: str | None, units: Mapping[str, str], rows: Mapping[str, tuple[str, str]]
) -> Value:
    label = with_unit(parameter.label, parameter.unit)
    text = number(mdl_value(parameter.value, parameter.unit))
    formula = mdl_formula(parameter.formula, parameter.unit, units) if parameter.formula else ""
    if parameter.follows:
        follows = mdl_formula(parameter.follows, parameter.unit, {}, rows)
        return Value(parameter.member, f"{label}; it follows", text, "NO_EDIT", follows, late=True)
    if idle:
        return Value(parameter.member, f"{label}; {idle}", text, "NO_EDIT", formula)
    return Value(parameter.member, label, text, "EDIT", formula)
