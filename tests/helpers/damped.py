"""Strips of the sample cantilever whose paper damps, and what is read off their decay."""

from __future__ import annotations

import math

import numpy as np

from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.result import Result
from mdlgen.spec.load import load

CANTILEVER = samples() / "cantilever.yaml"
AREA = 0.72 / (67.0 * 127.0)  # mass per area [g/mm^2]
LENGTH, WIDTH = 34.0, 12.0  # [mm]


def model(*overrides: str) -> Model:
    return lower(load(CANTILEVER, overrides))


def damped(text: str) -> str:
    return f"materials.eur10.damping={text}"


def strip(rows: int, damping: str, *more: str, layout: str = "edge_to_edge") -> Model:
    """A strip along CD, held at y_min, without gravity."""
    return model(
        f"sheets.note.size=[{WIDTH} mm, {LENGTH} mm]",
        f"sheets.note.mass={AREA * WIDTH * LENGTH!r} g",
        f"sheets.note.boxes=[1,{rows}]",
        f"sheets.note.layout={layout}",
        "gravity=[0 m/s^2, 0 m/s^2, 0 m/s^2]",
        damped(damping),
        *more,
    )


def decrement(result: Result, wave: np.ndarray) -> tuple[float, float]:
    """Damping ratio and angular frequency [rad/ms] of a decaying wave, from its peaks (logarithmic decrement
    from each to the next of the other sign, in the mean)."""
    time = result.time
    at = [k for k in range(1, len(wave) - 1) if abs(wave[k]) >= max(abs(wave[k - 1]), abs(wave[k + 1]))]
    peaks, when = [], []
    for k in at:  # the parabola through three points
        a, b, c = np.abs(wave[k - 1 : k + 2])
        off = 0.5 * (a - c) / (a - 2 * b + c)
        peaks.append(b - 0.25 * (a - c) * off)
        when.append(time[k] + off * (time[1] - time[0]))
    assert len(peaks) >= 4
    falls = math.log(peaks[0] / peaks[-1]) / (len(peaks) - 1)
    half = (when[-1] - when[0]) / (len(peaks) - 1)
    zeta = falls / math.hypot(math.pi, falls)
    return zeta, math.pi / half / math.sqrt(1.0 - zeta**2)
