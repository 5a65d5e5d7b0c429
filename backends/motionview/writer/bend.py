"""Rows of a bent sheet: its frames, and what they hang on."""

from __future__ import annotations

import math

from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.sheet_rows import BendView, EarView, FrameView
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import SUPPORT, Bend, Model, SheetPart


def bend_view(model: Model, index: int, tables: dict[str, list[Value]]) -> BendView | None:
    """The shape of a sheet; None where it is flat."""
    sheet = model.sheets[index]
    bend = sheet.bend
    if bend is None:
        return None
    rows = (model.bushings.sheet == index) & (model.bushings.kind != SUPPORT)
    pairs = {(one, two) for one, two in model.bushings.frames[rows].tolist() if one != two}
    ears = [
        EarView(c.name, number(c.size[0]), number(c.size[1])) for c in bend.creases if c.corner is not None
    ]
    return BendView(
        given=tables[f"{sheet.name}_shape"],
        flat=bend.start == "flat",
        axis="xy"[bend.axis] if bend.axis >= 0 else "",
        curled=math.isfinite(bend.radius),
        ears=ears,
        frames=[_frame(sheet, bend, k) for k in range(1, len(bend.frames.parent))],
        halves=sorted(pairs),
    )


def _frame(sheet: SheetPart, bend: Bend, index: int) -> FrameView:
    frames = bend.frames
    on = int(frames.crease[index])
    crease = bend.creases[on] if on >= 0 else None
    corner = crease.corner if crease is not None else None
    axis = "xy"[bend.axis] if bend.axis >= 0 else "x"
    return FrameView(
        number=index,
        parent=int(frames.parent[index]),
        line=_line(sheet, axis, int(frames.line[index])),
        part={1.0: "+", -1.0: "-", 0.5: "+0.5*", -0.5: "-0.5*"}.get(float(frames.part[index]), ""),
        lengths=[_length(sheet, axis, cell) for cell in frames.cells[index].tolist() if cell >= 0],
        crease=crease.name if crease is not None else None,
        corner=corner,
        pivot=(
            ("", "")
            if crease is None or corner is None
            else (_line(sheet, "x", crease.line[0]), _line(sheet, "y", crease.line[1]))
        ),
    )


def _line(sheet: SheetPart, axis: str, line: int) -> str:
    if sheet.graded["xy".index(axis)]:
        return f"ds_{sheet.name}_grid_{axis}.real_l_{line}.value"
    return f"({line}-$n_{axis}/2)*$d_{axis}"


def _length(sheet: SheetPart, axis: str, cell: int) -> str:
    graded = sheet.graded["xy".index(axis)]
    return f"ds_{sheet.name}_grid_{axis}.real_d_{cell}.value" if graded else f"$d_{axis}"
