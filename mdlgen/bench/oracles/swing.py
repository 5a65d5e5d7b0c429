"""Harmonics in a record: rates and damping ratios, by least squares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.model.tables import Floats


@dataclass(frozen=True)
class Harmonic:
    """A part exp(-ratio rate t) cos(sqrt(1 - ratio^2) rate t + phase) of a record."""

    rate: float  # undamped angular frequency [rad per unit of time]
    ratio: float  # of critical damping


def fit(time: Floats, values: Floats, guess: list[float]) -> list[Harmonic]:
    """The harmonics near the rates `guess`, about a constant; amplitudes are eliminated."""
    from scipy.optimize import least_squares

    def parts(numbers: Floats) -> Floats:
        columns = [np.ones_like(time)]
        for rate, ratio in numbers.reshape(-1, 2):
            fade = np.exp(-ratio * rate * time)
            turn = rate * np.sqrt(max(1.0 - ratio**2, 0.0)) * time
            columns += [fade * np.cos(turn), fade * np.sin(turn)]
        return np.stack(columns, axis=1)

    def missing(numbers: Floats) -> Floats:
        base = parts(numbers)
        return values - base @ np.linalg.lstsq(base, values, rcond=None)[0]

    start = np.array([[rate, 1e-3] for rate in guess]).ravel()
    scales = np.array([[1e-2 * rate, 1e-2] for rate in guess]).ravel()
    found = least_squares(missing, start, x_scale=scales, xtol=1e-12, ftol=1e-12, gtol=1e-14)
    return [Harmonic(float(rate), float(ratio)) for rate, ratio in found.x.reshape(-1, 2)]
