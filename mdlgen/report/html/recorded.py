"""A run against what another program recorded: in words, and as figures."""

from __future__ import annotations

from mdlgen.report.html.curves import POINTS, Line, Panel
from mdlgen.results.recorded.against import Against, Apart
from mdlgen.results.wording import number

_DIGITS = 4
_MOST_NAMES = 4
_AXES = ("x", "y", "z")


def sentences(found: Against) -> list[str]:
    """Sentences on the comparison, on a shift in time that would fit better, and on unused content."""
    said = [
        f"{len(found.quantities)} quantities of {found.file}, at {found.states} times from "
        f"{number(found.begin_ms, _DIGITS)} to {number(found.end_ms, _DIGITS)} ms"
    ]
    if found.shift is not None:
        shift = found.shift
        way = "later" if shift.later_ms > 0.0 else "earlier"
        said.append(
            f"the file would fit better {number(abs(shift.later_ms), _DIGITS)} ms {way}: then the mean "
            f"relative difference is {_percent(shift.after)}, not {_percent(shift.before)}"
        )
    if found.unknown:
        shown = ", ".join(found.unknown[:_MOST_NAMES]) + (", ..." if len(found.unknown) > _MOST_NAMES else "")
        said.append(f"{len(found.unknown)} of the file are not of this scene: {shown}")
    return said


def lines(found: Against) -> list[str]:
    """For the console: a table of the quantities, then the sentences."""
    rows = [("quantity", "RMS", "greatest", "at ms", "mean", "relative"), *map(row, found.quantities)]
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    shown = [
        "  ".join(cell.ljust(width) if k == 0 else cell.rjust(width) for k, (cell, width) in enumerate(cells))
        for cells in (list(zip(row, widths, strict=True)) for row in rows)
    ]
    return [*(line.rstrip() for line in shown), *sentences(found)]


def row(apart: Apart) -> tuple[str, ...]:
    """Name, RMS, greatest difference, its time, mean difference by component, relative."""
    mean = " ".join(number(v, 3) for v in apart.offset)
    return (
        apart.name,
        f"{number(apart.rms, _DIGITS)} {apart.unit}",
        number(apart.greatest, _DIGITS),
        number(apart.at_ms, _DIGITS),
        mean,
        _percent(apart.relative),
    )


def _percent(value: float) -> str:
    return f"{100.0 * value:.3g} %"


def panels(found: Against) -> list[Panel]:
    """A figure of each quantity over time, the run and the file in one."""
    return [_panel(apart) for apart in found.quantities if len(apart.time) > 1]


def _panel(apart: Apart) -> Panel:
    panel = Panel(f"recorded {apart.name}", apart.name, apart.unit or "-")
    panel.note = (
        f"the run and the file; RMS of the difference {_percent(apart.relative)} of {apart.scale:.4g}"
    )
    every = max(1, -(-len(apart.time) // POINTS))
    for who, values in (("run", apart.here), ("file", apart.there)):
        for k in range(values.shape[1]):
            name = f"{who} {_AXES[k]}" if values.shape[1] > 1 else who
            panel.lines.append(Line(name, apart.time[::every], values[::every, k]))
    return panel
