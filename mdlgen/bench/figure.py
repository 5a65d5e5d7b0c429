"""bench.png: wall time against error, growth with the boxes, the ladder; what there is of them."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

from mdlgen.bench.fits import EQUAL_ERROR, fits, lines
from mdlgen.bench.row import OK, BenchRow
from mdlgen.report.figures.figure import COLOURS, STYLE

if TYPE_CHECKING:
    from mdlgen.bench.run import Bench

MARKERS = "osD^v"
# Lower end of the error axis of the ladder, relative to the tolerance.
FLOOR = 1e-6
# Suites of many small cases against closed forms.
CLOSED = ("impact", "friction", "flight")


def figure(found: Bench) -> bytes:
    """PNG; the same rows give the same bytes."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    panels = [
        (draw, rows)
        for suites, draw in (
            (("transport",), _transport),
            (("elastica",), _elastica),
            (CLOSED, _closed),
            (("scaling",), _scaling),
            (("stability",), _ladder),
        )
        if (rows := [row for row in found.rows if row.suite in suites])
    ]
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        page = Figure(figsize=(5.2 * max(1, len(panels)), 4.4), dpi=120, layout="constrained")
        canvas = FigureCanvasAgg(page)
        page.suptitle(
            f"mdlgen bench: {found.machine['cpu']}, one thread", x=0.01, ha="left", fontsize=11, weight="bold"
        )
        for number, (draw, rows) in enumerate(panels):
            draw(page.add_subplot(1, len(panels), number + 1), rows)
        stream = io.BytesIO()
        canvas.print_png(stream, metadata={"Software": None})
    return stream.getvalue()


def _transport(axes: Any, rows: list[BenchRow]) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for number, (label, errors, walls) in enumerate(lines(rows)):
        style = {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)]}
        axes.loglog(errors, walls, label=label, **style)
    axes.axvline(EQUAL_ERROR, color="#888888", linewidth=0.8, linestyle=":")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda error, _: f"{100.0 * error:.3g} %"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set(title="transport", xlabel="RMS position error / travel", ylabel="wall time [s]")
    _legend(axes)


def _elastica(axes: Any, rows: list[BenchRow]) -> None:
    groups: dict[str, list[BenchRow]] = {}
    for row in rows:
        if row.status == OK and row.error and row.wall_s:
            columns = row.case.partition(" columns, ")[0]
            groups.setdefault(f"{row.solver}, {columns} columns", []).append(row)
    for number, (label, group) in enumerate(groups.items()):
        style = {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)]}
        axes.loglog([row.error for row in group], [row.wall_s for row in group], label=label, ls="", **style)
    axes.set(title="static cantilever", xlabel="error of the drop (elastica)", ylabel="wall time [s]")
    _legend(axes)


def _closed(axes: Any, rows: list[BenchRow]) -> None:
    groups: dict[str, list[BenchRow]] = {}
    for row in rows:
        if row.error and row.wall_s:
            groups.setdefault(f"{row.solver}, {row.suite}", []).append(row)
    for number, (label, group) in enumerate(groups.items()):
        style = {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)]}
        axes.loglog([row.error for row in group], [row.wall_s for row in group], label=label, ls="", **style)
    axes.set(title="closed forms", xlabel="error of each quantity", ylabel="wall time [s]")
    _legend(axes)


def _scaling(axes: Any, rows: list[BenchRow]) -> None:
    growth = fits(rows)["growth"]
    for number, solver in enumerate(dict.fromkeys(row.solver for row in rows)):
        ended = [row for row in rows if row.solver == solver and row.status == OK]
        group = [row for row in ended if row.wall_s and row.steps]
        power = growth.get(solver)
        label = solver if power is None else f"{solver}, power {power:.2f}"
        style = {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)]}
        # solvers run other durations here
        per_step = [1e3 * (row.wall_s or 0.0) / (row.steps or 1) for row in group]
        axes.loglog([row.boxes for row in group], per_step, label=label, **style)
    boxes = sorted({row.boxes for row in rows if row.boxes})
    axes.set_xticks(boxes, [str(count) for count in boxes])
    axes.set_xticks([], minor=True)
    axes.set(title="growth with the boxes", xlabel="boxes", ylabel="wall time per step [ms]")
    _legend(axes)


def _ladder(axes: Any, rows: list[BenchRow]) -> None:
    """Error over tolerance of every rung; a rung that failed with its reason stands at the bottom, hollow."""
    for number, solver in enumerate(dict.fromkeys(row.solver for row in rows)):
        group = [row for row in rows if row.solver == solver]
        ends = [max((row.error or 0.0) / (row.tolerance or 1.0), FLOOR) for row in group]
        colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
        for kept, face in ((True, colour), (False, "none")):
            chosen = [k for k, row in enumerate(group) if (row.error is not None) == kept]
            label = f"{solver}, {'with an error' if kept else 'failed with its reason'}"
            places, values = [k + 1 for k in chosen], [ends[k] for k in chosen]
            axes.semilogy(places, values, ls="", marker=marker, mec=colour, mfc=face, label=label)
    axes.axhline(1.0, color="#888888", linewidth=0.8, linestyle=":")
    axes.set(title="stability: above 1 is wrong", xlabel="rung", ylabel="error / tolerance")
    _legend(axes)


def _legend(axes: Any) -> None:
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="best")
