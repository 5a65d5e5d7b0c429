"""Difference of a run from a recording of the same scene by another program, on one clock.

Compared are the stored times of the run that the recording covers. Where it has no state at one of them, it
is interpolated: by the cubic through places and velocities where it has both, elsewhere by straight lines.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from mdlgen.altair.recorded import whole
from mdlgen.errors import OutputError
from mdlgen.model.tables import Floats
from mdlgen.results.io.series import series
from mdlgen.results.quantities import LEAST
from mdlgen.results.recorded.own import Quantity, quantities
from mdlgen.results.recorded.recording import Recording
from mdlgen.results.result import Result
from mdlgen.results.wording import ROUND_OFF

ROUNDED = 1e-5  # relative to the end of the run: precision of times with six digits
_LAG = 0.1  # of the common time: the largest shift that is looked for
_LAGS = 101  # shifts tried, before the best is found more closely
_HALVINGS = 40
_BETTER = 0.5  # of the difference: a shift that leaves less is reported


@dataclass(frozen=True)
class Apart:
    """One quantity: the recording less the run, over the common times."""

    name: str
    unit: str
    rms: float
    greatest: float
    at_ms: float  # of the greatest
    offset: tuple[float, ...]  # mean difference, by component
    scale: float  # what `relative` is relative to: the greatest value, of a position the greatest motion, at
    # least what `Quantity.least` has; of round-off that of the recording
    relative: float  # rms over scale
    time: Floats = field(repr=False, compare=False)  # common times [ms]
    here: Floats = field(repr=False, compare=False)
    there: Floats = field(repr=False, compare=False)


@dataclass(frozen=True)
class Shift:
    """A shift in time by which the recording fits better: its mean relative difference before and after."""

    later_ms: float
    before: float
    after: float


@dataclass(frozen=True)
class Against:
    """A run against a recording."""

    file: str
    begin_ms: float
    end_ms: float
    states: int  # common times
    quantities: tuple[Apart, ...]
    shift: Shift | None
    unknown: tuple[str, ...]  # requests and columns of the file that are not of this scene

    def record(self) -> dict[str, Any]:
        """The comparison as plain values; no series."""
        found = asdict(self)
        for one in found["quantities"]:
            for name in ("time", "here", "there"):
                del one[name]
        return found


def against(result: Result, recording: Recording) -> Against:
    """Raises OutputError, in one line, for a recording of another scene, or of other times."""
    pairs, unknown = _matched(result, recording)
    if not pairs:
        count = len(recording.requests) + len(recording.series)
        due = [quantity.labels[0] for quantity in quantities(result)] or ["none, without a probe or a roller"]
        raise OutputError(
            f"{recording.file}: none of its {count} requests is of {result.model.name}; there are: "
            f"{', '.join(dict.fromkeys(due))[:200]}"
        )
    common = _common(result, recording)
    time = result.time[common]
    found = [_apart(quantity, time, common, there) for quantity, there in pairs]
    return Against(
        file=recording.file,
        begin_ms=float(time[0]),
        end_ms=float(time[-1]),
        states=len(time),
        quantities=tuple(found),
        shift=_shift(found, pairs, recording),
        unknown=tuple(unknown),
    )


class _Recorded:
    """One quantity as it was recorded, at any time."""

    def __init__(self, time: Floats, values: Floats, rate: Floats | None, slack: float):
        self.time, self.values, self.rate, self.slack = time, values, rate, slack

    def at(self, time: Floats) -> Floats:
        """Values at times [ms]; as recorded where there is a state at one of them."""
        known, x = self.time, self.values
        if len(known) == 1:
            return np.repeat(x, len(time), axis=0)
        near = np.clip(np.searchsorted(known, time), 1, len(known) - 1)
        near = np.where(time - known[near - 1] < known[near] - time, near - 1, near)
        left = np.clip(np.searchsorted(known, time, side="right") - 1, 0, len(known) - 2)
        span = (known[left + 1] - known[left])[:, None]
        u = np.clip((time - known[left])[:, None] / span, 0.0, 1.0)
        between = (1.0 - u) * x[left] + u * x[left + 1]
        if self.rate is not None:
            v = self.rate / 1000.0  # for a ms
            between = (
                (1 + 2 * u) * (1 - u) ** 2 * x[left]
                + u * (1 - u) ** 2 * span * v[left]
                + u**2 * (3 - 2 * u) * x[left + 1]
                - u**2 * (1 - u) * span * v[left + 1]
            )
        return np.where((np.abs(known[near] - time) <= self.slack)[:, None], x[near], between)


Pair = tuple[Quantity, _Recorded]


def _matched(result: Result, recording: Recording) -> tuple[list[Pair], list[str]]:
    """Quantities of the run with what was recorded of them; and names that are not of the run."""
    slack = ROUNDED * max(float(result.time[-1]), float(recording.time[-1]), LEAST)
    labels = _summed({" ".join(label.split()): six for label, six in recording.requests.items()})
    used: set[str] = set()
    pairs: list[Pair] = []
    for quantity in quantities(result):
        label = next((label for label in quantity.labels if label in labels), None)
        if label is None:
            continue
        used.add(label)
        values = quantity.take(labels[label])
        if np.isfinite(values).all():
            rate = labels[label][:, 3:] if quantity.rate else None
            if rate is not None and not np.isfinite(rate).all():
                rate = None
            pairs.append((quantity, _Recorded(recording.time, values, rate, slack)))
    own = series(result) if recording.series else {}
    for name, values in recording.series.items():
        if name in own and np.isfinite(values).all():
            used.add(name)
            here = np.asarray(own[name], float)[:, None]
            column = Quantity(name, _unit(name), here, (name, name), lambda six: six)
            pairs.append((column, _Recorded(recording.time, values[:, None], None, slack)))
    return pairs, [name for name in (*labels, *recording.series) if name not in used]


def _summed(requests: dict[str, Floats]) -> dict[str, Floats]:
    """Requests with those that are parts of one added up, where all parts are there."""
    parts: dict[tuple[str, int], dict[int, str]] = {}
    for label in requests:
        found = whole(label)
        if found is not None:
            parts.setdefault((found[0], found[2]), {})[found[1]] = label
    summed = dict(requests)
    for (label, many), own in parts.items():
        if label not in requests and sorted(own) == list(range(1, many + 1)):
            summed[label] = np.sum([summed.pop(name) for name in own.values()], axis=0)
    return summed


def _unit(column: str) -> str:
    """The unit that stands in the name of a column of series.csv."""
    ends = {"_mm_per_s": "mm/s", "_rad_per_s": "rad/s", "_n_mm": "N mm", "_mm": "mm", "_n": "N", "_w": "W"}
    return next((unit for end, unit in {**ends, "_deg": "deg"}.items() if column.endswith(end)), "")


def _common(result: Result, recording: Recording) -> np.ndarray:
    """Stored times of the run that the recording covers. A static analysis has one time in each."""
    slack = ROUNDED * max(float(result.time[-1]), float(recording.time[-1]), LEAST)
    if result.model.run.analysis == "static" and len(recording.time) == 1:
        return np.array([len(result.time) - 1])
    begin, end = recording.time[0] - slack, recording.time[-1] + slack
    common = np.flatnonzero((result.time >= begin) & (result.time <= end))
    if not len(common):
        raise OutputError(
            f"{recording.file}: it is from {recording.time[0]:g} to {recording.time[-1]:g} ms, the run from "
            f"{result.time[0]:g} to {result.time[-1]:g} ms: no time is in both"
        )
    return common


def _apart(quantity: Quantity, time: Floats, common: np.ndarray, recorded: _Recorded) -> Apart:
    here, there = quantity.values[common], recorded.at(time)
    gap = there - here
    size = np.linalg.norm(gap, axis=1)
    rms, greatest = float(np.sqrt(np.mean(size**2))), int(size.argmax())
    own, other = _size(quantity.values, quantity.moves), _size(there, quantity.moves)
    # of what is round-off in the run, as the yaw of one that is alike on both sides, the file's size
    scale = max(own if own >= ROUND_OFF else max(other, ROUND_OFF), quantity.least)
    return Apart(
        name=quantity.name,
        unit=quantity.unit,
        rms=rms,
        greatest=float(size[greatest]),
        at_ms=float(time[greatest]),
        offset=tuple(gap.mean(axis=0).tolist()),
        scale=scale,
        relative=rms / scale,
        time=time,
        here=here,
        there=there,
    )


def _size(values: Floats, moves: bool) -> float:
    """The greatest value, of a position the greatest motion."""
    return float(np.linalg.norm(values - values[0] if moves else values, axis=1).max())


def _shift(found: list[Apart], pairs: list[Pair], recording: Recording) -> Shift | None:
    """Shift in time by which the recording would fit better, if by more than half."""
    time = found[0].time
    span = float(time[-1] - time[0])
    if len(time) < 3 or len(recording.time) < 3:
        return None

    def away(later: float) -> float:
        """Mean over quantities of the mean squared relative difference where the moved recording is."""
        moved = time - later
        inside = (moved >= recording.time[0]) & (moved <= recording.time[-1])
        parts = []
        for apart, (_, recorded) in zip(found, pairs, strict=True):
            gap = (recorded.at(moved[inside]) - apart.here[inside]) / apart.scale
            parts.append(float(np.mean((gap**2).sum(axis=1))))
        return float(np.mean(parts))

    lags = np.linspace(-_LAG * span, _LAG * span, _LAGS)
    best = int(np.argmin([away(lag) for lag in lags.tolist()]))
    low, high = (float(lags[k]) for k in (max(best - 1, 0), min(best + 1, _LAGS - 1)))
    for _ in range(_HALVINGS):  # thirds of the interval, of which the worse end goes
        one, two = low + (high - low) / 3, high - (high - low) / 3
        low, high = (low, two) if away(one) <= away(two) else (one, high)
    later = 0.5 * (low + high)
    before, after = (float(np.sqrt(away(lag))) for lag in (0.0, later))
    step = ROUNDED * span
    return Shift(later, before, after) if after < _BETTER * before and abs(later) > step else None
