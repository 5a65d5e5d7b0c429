"""Model -> the rows that the main template loops over."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mdlgen.backends.motionview.writer.contacts import contact_views, pair_rows
from mdlgen.backends.motionview.writer.formula import mdl_formula, rows_of, units_of
from mdlgen.backends.motionview.writer.guides import guide_view
from mdlgen.backends.motionview.writer.idle import idle_values
from mdlgen.backends.motionview.writer.meshes import mesh_view
from mdlgen.backends.motionview.writer.planes import plane_view
from mdlgen.backends.motionview.writer.rollers import roller_view
from mdlgen.backends.motionview.writer.rows import SceneView, Value
from mdlgen.backends.motionview.writer.sheets import probe_view, sheet_view, support_views
from mdlgen.backends.motionview.writer.units import mdl_value, number, with_unit
from mdlgen.model.parameters.names import OF_USER
from mdlgen.model.tables import Model, Parameter


def scene_view(model: Model, set_contact: bool) -> SceneView:
    """All rows of a Model."""
    given = given_values(model, set_contact, model.pairs.contact.tolist())
    return SceneView(
        name=model.name,
        parameters=given.get(OF_USER, []),
        static=model.run.analysis == "static",
        run=given["run"],
        sheets=[sheet_view(model, k, given) for k in range(len(model.sheets))],
        supports=support_views(model),
        rollers=[roller_view(model, r, given[r.name]) for r in model.rollers],
        planes=[plane_view(model, p, given[p.name]) for p in model.planes],
        guides=[guide_view(g, given[g.name]) for g in model.guides],
        meshes=[mesh_view(model, m, given[m.name]) for m in model.meshes],
        contacts=contact_views(model, given, range(len(model.contacts))),
        pairs=pair_rows(model),
        probes=[probe_view(model, probe) for probe in model.probes],
        set_contact=set_contact,
    )


def given_values(model: Model, set_contact: bool, kept: Sequence[int]) -> dict[str, list[Value]]:
    """Members by data set, in the order of the parameters; `kept` as in `idle_values`."""
    idle = idle_values(model, set_contact, kept)
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
