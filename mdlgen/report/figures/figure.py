"""One figure of a run: how the sheets move and how the nips press, or how a static sheet lies."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from mdlgen.model.tables import CYLINDER_CYLINDER, Floats
from mdlgen.results.compare import travel
from mdlgen.results.result import Result

# Okabe and Ito: distinct for all readers and in grey
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
# Curves often coincide (left and right): a later one is thinner, so that the one below shows.
WIDEST, THINNEST = 3.8, 1.2
# A component that moves less than this part of the largest is not drawn.
STILL = 0.03
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e4e4e4",
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.5,
}


def figure(result: Result) -> bytes:
    """PNG of a result; the same result gives the same bytes."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    # the user's own matplotlibrc must not change the picture
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        static = result.model.run.analysis == "static" or len(result.time) < 2
        page = Figure(figsize=(8.5, 4.2 if static else 7.5), dpi=120)
        canvas = FigureCanvasAgg(page)
        page.suptitle(f"{result.model.name} ({result.solver})", x=0.01, ha="left", fontsize=11, weight="bold")
        # margins by hand: to have them found takes as long as to draw
        if static:
            _shape(result, page)
            page.subplots_adjust(left=0.09, right=0.97, top=0.84, bottom=0.14, wspace=0.25)
        else:
            _motion(result, page)
            page.subplots_adjust(left=0.085, right=0.72, top=0.915, bottom=0.07, hspace=0.22)
        stream = io.BytesIO()
        canvas.print_png(stream, metadata={"Software": None})
    return stream.getvalue()


def _motion(result: Result, page: Any) -> None:
    rows = _pressed(result)
    panels = page.subplots(3 if rows else 2, 1, sharex=True)
    moves = [result.sheet_motion(k) for k in range(len(result.model.sheets))]
    travels = [move[0] - move[0][0] + travel(result, k, at=0) for k, move in enumerate(moves)]
    _components(result, panels[0], travels)
    panels[0].set(title="travel of the sheet's centre of mass", ylabel="mm")
    _components(result, panels[1], [move[1] * 1e3 for move in moves])
    panels[1].set(title="speed of the sheet's centre of mass", ylabel="mm/s")
    if rows:
        for k, row in enumerate(rows):
            contacts = result.model.contacts
            panels[2].plot(
                result.time,
                result.contact_force[:, row],
                color=COLOURS[k % len(COLOURS)],
                linewidth=WIDEST + (THINNEST - WIDEST) * k / max(1, len(rows) - 1),
                label=f"{contacts.part_a[row]} / {contacts.part_b[row]}",
            )
        panels[2].set(title="normal force in the nips", ylabel="N")
        panels[2].set_ylim(bottom=0)
        panels[2].legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    panels[-1].set_xlabel("time [ms]")
    panels[-1].set_xlim(result.time[0], result.time[-1])


def _pressed(result: Result) -> list[int]:
    """Rows of contacts to draw: the pairs of rollers; where there are none, what touches the sheets."""
    kinds = result.model.contacts.kind
    rollers = [int(k) for k in np.flatnonzero(kinds == CYLINDER_CYLINDER)]
    return rollers or [int(k) for k in range(len(kinds)) if result.statistics.max_force[k] > 0.0]


def _components(result: Result, panel: Any, curves: list[Floats]) -> None:
    """The components of each curve (t, 3) that count."""
    largest = max(float(np.abs(curve).max()) for curve in curves)
    count = 0
    for sheet, curve in zip(result.model.sheets, curves, strict=True):
        for k, axis in enumerate("xyz"):
            if float(np.abs(curve[:, k]).max()) <= STILL * largest:
                continue
            colour = COLOURS[count % len(COLOURS)]
            panel.plot(result.time, curve[:, k], color=colour, label=f"{sheet.name} {axis}")
            count += 1
    if count:
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _shape(result: Result, page: Any) -> None:
    """Box centres of each sheet seen from the side, along its longer side, before and after."""
    panels = page.subplots(1, len(result.model.sheets), squeeze=False)[0]
    for sheet, panel in zip(result.model.sheets, panels, strict=True):
        boxes = slice(sheet.first, sheet.first + sheet.count)
        axis = 0 if sheet.outline[0] > sheet.outline[1] else 1
        for k, (places, label) in enumerate(
            ((result.model.bodies.position[boxes], "before"), (result.position[-1, boxes], "after"))
        ):
            local = (places - sheet.center) @ sheet.rotation
            grid = local.reshape(sheet.n_y, sheet.n_x, 3)
            strips = grid if axis == 0 else grid.swapaxes(0, 1)
            for number, strip in enumerate(strips):
                panel.plot(
                    strip[:, axis],
                    strip[:, 2],
                    color=("#888888", COLOURS[0])[k],
                    linewidth=0.8,
                    marker="o",
                    markersize=2.5,
                    label=label if number == 0 else None,
                )
        name = ("x (MD)", "y (CD)")[axis]
        panel.set(title=f"{sheet.name}: box centres from the side", xlabel=f"along the sheet's {name} [mm]")
        panel.set_ylabel("normal to the sheet [mm]")
        panel.set_aspect("equal", adjustable="datalim")
        panel.legend(loc="best")
