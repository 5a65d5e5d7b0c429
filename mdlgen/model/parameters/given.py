"""The named values that a user gave, in the order in which a text shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from mdlgen.formulas import is_formula
from mdlgen.model.parameters.axles import shaft_rows
from mdlgen.model.parameters.loads import load_rows
from mdlgen.model.parameters.names import FRICTION, OF_USER, in_text, unit
from mdlgen.model.parameters.run import run_rows, step_source
from mdlgen.model.parameters.sheets import grading_rows, shape_rows, sheet_rows, zones_rows
from mdlgen.model.parameters.starts import followed, held
from mdlgen.model.tables import Contacts, Parameter, RunSettings, SheetPart
from mdlgen.spec.scene import Scene
from mdlgen.spec.smoothing import formulas as smoothing_formulas
from mdlgen.spec.smoothing import speeds


def parameters(
    scene: Scene,
    starts: dict[str, tuple[float, float]],
    run: RunSettings,
    sheets: tuple[SheetPart, ...],
    contacts: Contacts,
    machine: Sequence[Parameter],
) -> tuple[Parameter, ...]:
    """All parameters of a scene; `starts` gives (touch, start) of each pressed roller and plate [mm];
    `machine` has those of its parts."""
    rows = _given(scene, machine, run)
    if not scene.formulas and not scene.parameters:
        return tuple(rows)
    for name in sorted(set(starts) & set(scene.rollers)):
        what = held(scene, name, sheets, contacts, starts[name])
        rows = rows if what is None else followed(scene, what, rows)
    formulas = {**scene.formulas, **smoothing_formulas(scene)}
    return (*_own(scene), *(_with_formula(scene, formulas, row) for row in rows))


def unfollowed(scene: Scene, rows: tuple[Parameter, ...]) -> tuple[tuple[str, str], ...]:
    """Formulas of values that have no row, and so are numbers in an MDL file: their places, and their texts.

    For nips the rollers are listed.
    """
    had = {row.path for row in rows} | {_source(scene, row)[0] for row in rows if row.formula}
    return tuple(
        (".".join(map(str, path)), formula)
        for path, formula in sorted(scene.formulas.items(), key=lambda item: str(item[0]))
        if path not in had and path[0] != "nips" and path[2:3] != ("at",)
    )


def _own(scene: Scene) -> list[Parameter]:
    """The parameters that the user named."""
    rows = []
    for name, amount in scene.amounts.items():
        given = scene.parameters[name]
        formula = given if isinstance(given, str) and is_formula(given, scene.parameters) else ""
        shown = in_text(amount.dimension)
        label = f"Parameter {name}" + (f" ({shown})" if shown else "")
        rows.append(
            Parameter(OF_USER, name, label, amount.value, unit(amount.dimension), (OF_USER, name), formula)
        )
    return rows


def _with_formula(scene: Scene, formulas: Mapping[tuple[str | int, ...], str], row: Parameter) -> Parameter:
    """A row with its formula: that of its value, or of the one that it follows from where it is left out."""
    formula = formulas.get(row.path or (), "")
    if not formula:
        source, template = _source(scene, row)
        followed = formulas.get(source, "")
        formula = template.format(followed) if followed else ""
    return replace(row, formula=formula)


def _source(scene: Scene, row: Parameter) -> tuple[tuple[str | int, ...], str]:
    """Where the value stands that a row follows from, and how."""
    path = row.path or ()
    if row.data_set.startswith("contact_") and row.member in FRICTION:
        index = int(row.data_set.removeprefix("contact_"))
        base, friction = ("contacts", index), scene.contacts[index].friction
        own, smooth = ((*base, "friction", FRICTION[member]) for member in (row.member, "v_s"))
        if row.member in ("mu_s", "mu_d") or getattr(friction, FRICTION[row.member]) is not None:
            return own, "{}"
        slow = smooth if friction.stiction_velocity is not None else (*base, "smoothing")
        if scene.contacts[index].smoothing is None and friction.friction_velocity is not None:
            return slow, f"min({{}}, {1e3 * friction.friction_velocity!r} mm/s)"
        return slow, "{}" if row.member == "v_s" or friction.static == friction.dynamic else "1.5*({})"
    if path[-2:] == ("press", "carrier_mass") and path[:1] == ("rollers",):
        return (*path[:2], "mass"), "({})/1000"
    if path[-2:] == ("damping", "ratio_ty"):
        return (*path[:-1], "ratio"), "{}"
    if path == ("run", "step"):
        return step_source(scene)
    if path == ("run", "print_step"):
        return ("run", "duration"), "({})/200"
    return (), "{}"


def _given(scene: Scene, machine: Sequence[Parameter], run: RunSettings) -> list[Parameter]:
    """All parameters but those that the user named, as numbers."""
    rows: list[Parameter] = []
    for name in sorted(scene.sheets):
        rows += sheet_rows(scene, name)
        rows += grading_rows(scene, name)
        rows += zones_rows(scene, name)
        rows += shape_rows(scene, name)
    rows += shaft_rows(scene)
    rows += machine
    for index, (contact, (smooth, slow, fast)) in enumerate(zip(scene.contacts, speeds(scene), strict=True)):
        base, group, friction = ("contacts", index), f"contact_{index}", contact.friction
        for member, label, value, shown, path in (
            ("k", "Stiffness k (N/mm to the 1.5)", contact.stiffness, "N/mm^1.5", "stiffness"),
            ("c_R", "Restitution c_R", contact.restitution, "1", "restitution"),
            ("mu_s", "Static friction", friction.static, "1", None),
            ("mu_d", "Dynamic friction", friction.dynamic, "1", None),
            ("v_s", "Stiction velocity", slow, "mm/ms", None),
            ("v_d", "Friction velocity", fast, "mm/ms", None),
            ("v_n", "Smoothing velocity of the damping", smooth, "mm/ms", "smoothing"),
        ):
            rows.append(Parameter(group, member, label, value, shown, (*base, path) if path else None))
    return [*rows, *load_rows(scene), *run_rows(scene, run)]
