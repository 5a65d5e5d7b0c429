"""Displacement and speed of a sheet along its own path, and its angle to the path: also round a bend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.rotations import column
from mdlgen.model.tables import Floats
from mdlgen.results.passing import span
from mdlgen.results.result import Result

LAST = 0.1  # part of the run over which the mean speed and the skew at its end are taken
STANDS = 0.01  # mm/ms: a slower sheet has no direction


@dataclass(frozen=True)
class Way:
    """Motion of one sheet along its path over the stored times: all of it (t,)."""

    length: Floats  # mean way of its boxes in their own planes since the start [mm]
    speed: Floats  # mean speed of its boxes in their own planes [mm/ms]
    skew: Floats  # turn of its nearer side against the way, about its normal [rad]; NaN where it stands


def way_of(result: Result, index: int) -> Way:
    """The way of a sheet. A box's own way is in its plane, so that a sheet that only flutters stands; means
    over boxes are by mass. The skew is within 45 degrees either way: zero where the sheet goes along one of
    its sides."""
    sheet = result.model.sheets[index]
    boxes = slice(sheet.first, sheet.first + sheet.count)
    share = result.model.mass_share(index)
    rate, turned = result.velocity[:, boxes], result.rotation[:, boxes]
    along, across = (np.einsum("tbi,tbi->tb", rate, column(turned, k)) for k in (0, 1))
    speed = np.hypot(along, across) @ share
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(result.time)
    forward, sideways = along @ share, across @ share
    angle = -np.arctan2(sideways, forward)
    skew = (angle + 0.25 * np.pi) % (0.5 * np.pi) - 0.25 * np.pi
    skew = np.where(np.hypot(forward, sideways) > STANDS, skew, np.nan)
    return Way(np.concatenate([[0.0], np.cumsum(steps)]), speed, skew)


def at_the_end(result: Result, index: int) -> tuple[float, float, float]:
    """Way [mm], and mean speed [mm/ms] and mean skew [rad] over the last tenth of the run, or of the time
    that the sheet is there; the skew is NaN where the sheet stands then."""
    way, (first, last) = way_of(result, index), span(result, index)
    own = slice(first, len(result.time) if last < 0 else last + 1)
    time, length, skew = result.time[own], way.length[own], way.skew[own]
    if len(time) < 2:
        return 0.0, float(way.speed[last]), float(way.skew[last])
    begin = min(int(np.searchsorted(time, time[-1] - LAST * (time[-1] - time[0]))), len(time) - 2)
    lasts = float(time[-1] - time[begin])
    fast = float(length[-1] - length[begin]) / lasts
    return float(way.length[-1]), fast, float(np.trapezoid(skew[begin:], time[begin:])) / lasts
