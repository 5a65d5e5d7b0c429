"""Lints of the damping time of sheets."""

from __future__ import annotations

import math
from collections.abc import Iterator

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Model, SheetPart

# Damping times of paper [ms]: loss factors of 0.01 to 0.1 at 10 to 100 Hz, and ten times less and more.
PAPER_TIME = (0.01, 1.0)
# (beta L)^2 of the lowest bending mode of a beam, held at one end and free (Blevins, Formulas for Natural
# Frequency and Mode Shape, table 8-1)
CLAMPED, FREE = 1.875104**2, 4.730041**2


def damping(model: Model) -> Iterator[Lint]:
    """Damping times far from those of paper, longer than the run, or so long that a sheet cannot swing."""
    transient = model.run.analysis != "static"
    for sheet in model.sheets:
        if sheet.damping_times is None or sheet.count == 1:
            continue
        where = _where(model, sheet)
        ways = list(zip(("MD", "CD"), sheet.damping_times, (0, 1), strict=True))
        same = sheet.damping_times[0] == sheet.damping_times[1]
        for name, tau, _ in ways[:1] if same else ways:
            of = "" if same else f" of {name}"
            low, high = PAPER_TIME
            if tau > 0.0 and not low <= tau <= high:
                yield Lint(
                    "W130",
                    where,
                    f"a damping time of {tau:.3g} ms{of} is unusual for paper ({low:g} to {high:g} ms)",
                    "check the unit; tau = loss factor / (2 pi frequency), 0.2 ms for 0.05 at 40 Hz",
                )
            if transient and tau > model.run.duration:
                yield Lint(
                    "W131",
                    where,
                    f"the damping time of {tau:.3g} ms{of} is longer than the run of "
                    f"{model.run.duration:g} ms: the sheet creeps towards its shape and does not get there",
                    "give a shorter damping time, or run longer",
                )
        for _, tau, axis in ways:
            omega = _lowest(sheet, axis)
            if transient and omega * tau / 2.0 >= 1.0:
                yield Lint(
                    "W132",
                    where,
                    f"a damping time of {tau:.3g} ms overdamps the lowest bending mode of {sheet.name} along "
                    f"{'xy'[axis]} ({1e3 * omega / (2 * math.pi):.3g} Hz, ratio {omega * tau / 2:.3g})",
                    f"below {2.0 / omega:.3g} ms it swings",
                )


def _where(model: Model, sheet: SheetPart) -> str:
    paths = [p.path for p in model.parameters if p.data_set == sheet.name and p.path and "damping" in p.path]
    return ".".join(map(str, paths[0][:4])) if paths else f"sheets.{sheet.name}.material"


def _lowest(sheet: SheetPart, axis: int) -> float:
    """Angular frequency of the lowest bending mode along x or y as a beam, clamped where the sheet is
    [rad/ms]; 0 with one box that way."""
    if (sheet.n_x, sheet.n_y)[axis] == 1:
        return 0.0
    parts = 2 if sheet.layout == "edge_to_edge" else 1
    shape = (sheet.d_x / sheet.d_y, sheet.d_y / sheet.d_x)[axis]
    stiff = parts * sheet.derived[("k_ty", "k_tx")[axis]] * shape  # per width [N mm]
    area = sheet.derived["m"] / (sheet.d_x * sheet.d_y)  # [g/mm^2]
    lines, mode = (sheet.lines_x, sheet.lines_y)[axis], FREE
    length = float(lines[-1] - lines[0])
    if sheet.clamp is not None and sheet.clamp.edge[0] == "xy"[axis]:
        rows = sheet.clamp.rows
        held = lines[rows] - lines[0] if sheet.clamp.edge.endswith("min") else lines[-1] - lines[-1 - rows]
        length, mode = length - float(held), CLAMPED
    return mode / length**2 * math.sqrt(stiff / area)
