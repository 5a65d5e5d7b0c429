"""One quantity over time, for a notebook or a file of one's own."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.model.tables import Floats
from mdlgen.paths import write_atomic
from mdlgen.report.figures.figure import COLOURS, STILL, STYLE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mdlgen.results.result import Result

Lines = dict[str, Floats]  # label: values over time, (t,)


def _components(curves: dict[str, Floats]) -> Lines:
    """Components of each curve (t, 3) that are not small compared with the largest."""
    largest = max((float(np.abs(curve).max()) for curve in curves.values()), default=0.0)
    return {
        f"{name} {axis}": curve[:, k]
        for name, curve in curves.items()
        for k, axis in enumerate("xyz")
        if float(np.abs(curve[:, k]).max()) > STILL * largest
    }


def _since_start(places: dict[str, Floats]) -> Lines:
    return _components({name: place - place[0] for name, place in places.items()})


def _sheets(what: str) -> Callable[[Result], Lines]:
    def lines(result: Result) -> Lines:
        found = {name: getattr(sheet, what) for name, sheet in result.sheets.items()}
        if what == "turn":
            return found
        return _since_start(found) if what == "position" else _components(found)

    return lines


def _rollers(what: str) -> Callable[[Result], Lines]:
    return lambda result: {name: getattr(roller, what) for name, roller in result.rollers.items()}


def _driven(what: str) -> Callable[[Result], Lines]:
    def lines(result: Result) -> Lines:
        driven = [roller.name for roller in result.model.rollers if roller.driven]
        found = result.rollers
        return {name: getattr(found[name], what) for name in driven if name in found}

    return lines


def _tensions(result: Result) -> Lines:
    found = {name: sheet.tension for name, sheet in result.sheets.items() if sheet.tension is not None}
    lines = {}
    for name, tension in found.items():
        lines |= {f"{name} greatest": tension.greatest, f"{name} least": tension.least}
    return lines


def _probes(result: Result) -> Lines:
    return _since_start({name: probe.position for name, probe in result.probes.items()})


# Name: title, unit, lines.
QUANTITIES: dict[str, tuple[str, str, Callable[[Result], Lines]]] = {
    "travel": ("travel of the sheet's centre of mass", "mm", _sheets("position")),
    "speed": ("speed of the sheet's centre of mass", "mm/s", _sheets("velocity")),
    "yaw": ("turn of the sheet about its normal", "deg", _sheets("turn")),
    "tension": ("tension of the sheet along its way, of its sections", "N", _tensions),
    "roller_speed": ("speed of rollers about their axes", "rad/s", _rollers("rate")),
    "nip_force": ("normal force on rollers", "N", _rollers("force")),
    "torque": ("torque of drives", "N mm", _driven("drive_torque")),
    "power": ("power of drives", "W", _driven("drive_power")),
    "contact_torque": ("torque of contacts on rollers", "N mm", _rollers("contact_torque")),
    "probes": ("displacement of probes", "mm", _probes),
}


@dataclass(frozen=True)
class Plot:
    """A figure that shows itself in a notebook."""

    figure: Figure

    def _repr_png_(self) -> bytes:
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        stream = io.BytesIO()
        FigureCanvasAgg(self.figure).print_png(stream, metadata={"Software": None})
        return stream.getvalue()

    def save(self, path: str | Path) -> Path:
        """Write it to a file as PNG; its path. Raises OutputError."""
        write_atomic(Path(path), self._repr_png_())
        return Path(path)


def plot(result: Result, what: str = "travel") -> Plot:
    """See `Result.plot`. Raises SpecError for a quantity that there is not, or that this run has not."""
    if what not in QUANTITIES:
        close = did_you_mean(what[:80], QUANTITIES)
        raise SpecError(f"there is no plot {what[:80]!r}{close or ';'} there are: {', '.join(QUANTITIES)}")
    title, unit, found = QUANTITIES[what]
    lines = found(result)
    if not lines or len(result.time) < 2:
        raise SpecError(f"this run has nothing to plot of {what}")
    import matplotlib
    from matplotlib.figure import Figure

    # the user's own matplotlibrc must not change the picture
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        page = Figure(figsize=(7.0, 3.2), dpi=110, layout="constrained")
        panel = page.subplots()
        for k, (label, values) in enumerate(lines.items()):
            panel.plot(result.time, values, color=COLOURS[k % len(COLOURS)], label=label)
        panel.set(title=f"{result.model.name}: {title}", xlabel="time [ms]", ylabel=unit)
        panel.set_xlim(float(result.time[0]), float(result.time[-1]))
        panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return Plot(page)
