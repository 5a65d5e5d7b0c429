"""Rows of a sheet whose boxes are not all alike: lengths, zones, and classes of boxes and joints."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.altair.classes import BoxClass, box_classes, joint_classes
from mdlgen.backends.motionview.writer.rows import Value
from mdlgen.backends.motionview.writer.sheet_rows import CellView, GridView, HingeView, Lengths, ZoneView
from mdlgen.backends.motionview.writer.units import number
from mdlgen.model.tables import SheetPart


@dataclass(frozen=True)
class Differences:
    """Classes of the boxes and joints of a sheet; none where all are alike."""

    cells: list[CellView]
    hinges: list[HingeView]
    lengths: list[Lengths]  # of each box
    owners: list[str]  # of each bushing: how a reference to its values is made; empty: the sheet's own


def differences(sheet: SheetPart) -> Differences:
    """The classes of a sheet."""
    if sheet.uniform:
        alike = Lengths("$d_x", "$d_y", "$s", "$m", ("$I_x", "$I_y", "$I_z"))
        return Differences([], [], [alike] * sheet.count, [])
    classes, of = box_classes(sheet)
    cells = [_cell(sheet, c) for c in classes]
    lengths = [_lengths(sheet, cells[k]) for k in range(len(cells))]
    hinges, owners = [], []
    for _, kinds, members in joint_classes(sheet):
        made = [
            HingeView(c.name, c.along_x, cells[c.one], cells[c.two], *_crease(sheet, c.crease)) for c in kinds
        ]
        hinges += made
        own = [f"ds_{sheet.name}_joints.real_%s_{c.name}.value" for c in made]
        owners += [own[k] for k in members.tolist()]
    return Differences(cells, hinges, [lengths[k] for k in of.tolist()], owners)


def _crease(sheet: SheetPart, index: int) -> tuple[str | None, str | None]:
    """Name of the crease by a factor, and of that by a stiffness per length."""
    if sheet.bend is None or index < 0:
        return None, None
    crease = sheet.bend.creases[index]
    return (crease.name, None) if crease.per_length is None else (None, crease.name)


def _cell(sheet: SheetPart, boxes: BoxClass) -> CellView:
    shares = [(z.name, number(z.share[boxes.first])) for z in sheet.zones if z.share[boxes.first] > 0.0]
    return CellView(
        boxes.name, _length(sheet, "x", boxes.column), _length(sheet, "y", boxes.row), boxes.many, shares
    )


def _length(sheet: SheetPart, axis: str, index: int) -> str:
    graded = sheet.graded["xy".index(axis)]
    return f"ds_{sheet.name}_grid_{axis}.real_d_{index}.value" if graded else f"$d_{axis}"


def _lengths(sheet: SheetPart, cell: CellView) -> Lengths:
    def own(symbol: str) -> str:
        return f"ds_{sheet.name}_cells.real_{symbol}_{cell.name}.value"

    return Lengths(cell.d_x, cell.d_y, own("s"), own("m"), (own("I_x"), own("I_y"), own("I_z")))


def rough_boxes(sheet: SheetPart) -> list[str]:
    """Reference to the friction of each box relative to that of the contact; none where there are no
    zones."""
    if not sheet.zones:
        return []
    classes, of = box_classes(sheet)
    return [f"ds_{sheet.name}_cells.real_f_{classes[k].name}.value" for k in of.tolist()]


def grid_views(sheet: SheetPart, tables: dict[str, list[Value]]) -> list[GridView]:
    """The sides along which lengths are given one by one."""
    names = [(axis, f"{sheet.name}_grid_{axis}") for axis, on in zip("xy", sheet.graded, strict=True) if on]
    return [GridView(axis, name, tables[name]) for axis, name in names]


def zone_views(sheet: SheetPart, tables: dict[str, list[Value]]) -> list[ZoneView]:
    """The zones of a sheet."""
    return [
        ZoneView(zone.name, tables[f"{sheet.name}_zone_{zone.name}"], zone.thickness is not None)
        for zone in sheet.zones
    ]
