"""Rows of loads: what acts on each box, in the axes of its sheet at the start."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np

from mdlgen.backends.motionview.writer.cells import Differences, differences
from mdlgen.backends.motionview.writer.environment import values
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.sheet_rows import LoadPart, LoadView
from mdlgen.backends.motionview.writer.sheets import frame_of
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import Model, SheetPart

_VALUE = re.compile(r"ds_\w+\.real_\w+\.value")


def load_views(model: Model, given: Mapping[str, list[Value]]) -> list[LoadView]:
    """One row for each entry of the spec's list."""
    table, views = model.loads, []
    for entry in sorted(set(table.entry.tolist())):
        rows = np.flatnonzero(table.entry == entry).tolist()
        sheet = model.sheet_of(int(table.body[rows[0]]))
        assert sheet is not None
        name, edge = f"load_{entry}", table.edge[entry]
        members = [value.member for value in given[name]]
        moment = "m_x" in members
        parts = []
        for row, body in zip(rows, table.body[rows].tolist(), strict=True):
            place, share, forces = _at(len(rows)) if not edge else _on_edge(sheet, edge, body - sheet.first)
            axis = "m" if moment else "f"
            components = [f"ds_{name}.real_{axis}_{a}.value{share}" for a in "xyz"]
            if "stress" in members:
                components = [f.replace("$stress", f"ds_{name}.real_stress.value") for f in forces]
            if entry in table.changing:
                factor = _factor(name, len(table.profiles[entry]))
                components = [f"{_of_solver(f)}*({factor})" for f in components]
            label = f"Load {entry} on {model.bodies.label[body]}"
            body_name = f"b_{model.bodies.name[body]}"
            x, y = (p.replace("$at_", f"ds_{name}.real_") for p in place)
            parts.append(LoadPart(f"frc_{row}", label, body_name, x, y, frame_of(sheet, body), components))
        label, changes = f"Load {entry} on {sheet.name}", entry in table.changing
        views.append(LoadView(name, label, sheet.name, given[name], moment, changes, parts))
    return views


def _factor(name: str, corners: int) -> str:
    """The factor of a load over time, as a solver has it: the sum of what each piece of a profile adds."""
    parts = [f"{{ds_{name}.real_c_0.value}}"]
    for k in range(1, corners):
        times, factors = (
            [f"{{ds_{name}.real_{member}_{j}.value}}" for j in (k - 1, k)] for member in ("t", "c")
        )
        share = f"MAX(0,1-MAX(0,({times[1]}-TIME)/({times[1]}-{times[0]})))"
        parts.append(f"({factors[1]}-({factors[0]}))*{share}")
    return "+".join(parts)


def _of_solver(formula: str) -> str:
    """A formula over values of a text as a solver has it: values are written into it as numbers."""
    return _VALUE.sub(r"({\g<0>})", formula)


def _at(boxes: int) -> tuple[tuple[str, str], str, list[str]]:
    """Place, and share of a box, of a load at a point that lies on some boxes."""
    return ("$at_x.value", "$at_y.value"), "" if boxes == 1 else f"/{boxes}", []


def _on_edge(sheet: SheetPart, edge: str, box: int) -> tuple[tuple[str, str], str, list[str]]:
    """Middle of a box's side on an edge, its share of the edge, and the force of a stress on its section."""
    column, row = box % sheet.n_x, box // sheet.n_x
    across, along = ("x", "y") if edge[0] == "x" else ("y", "x")
    counts, index = {"x": sheet.n_x, "y": sheet.n_y}, {"x": column, "y": row}
    graded = dict(zip("xy", sheet.graded, strict=True))
    last = edge.endswith("max")

    def line(axis: str, count: float) -> str:
        if graded[axis]:
            return f"ds_{sheet.name}_grid_{axis}.real_l_{count:g}.value"
        return f"({number(count)}-ds_{sheet.name}.real_n_{axis}.value/2)*ds_{sheet.name}.real_d_{axis}.value"

    here = {across: line(across, counts[across] if last else 0)}
    k = index[along]
    here[along] = f"({line(along, k)}+{line(along, k + 1)})/2" if graded[along] else line(along, k + 0.5)
    share = f"/ds_{sheet.name}.real_n_{along}.value"
    if graded[along]:
        share = f"*ds_{sheet.name}_grid_{along}.real_d_{k}.value/ds_{sheet.name}.real_L_{along}.value"
    own = _lengths(differences(sheet), box)
    pull = f"{'' if last else '-'}$stress*{own[along]}*{own['s']}"
    forces = [values(pull, sheet.name) if a == across else "0" for a in "xyz"]
    return (
        (here["x"], here["y"]),
        share,
        [f.replace(f"ds_{sheet.name}.real_stress.value", "$stress") for f in forces],
    )


def _lengths(differ: Differences, box: int) -> dict[str, str]:
    own = differ.lengths[box]
    return {"x": own.d_x, "y": own.d_y, "s": own.s}
