"""Factors over time, of loads and of gravity: linear between corners, constant beyond them, 1 without any."""

from __future__ import annotations

import numpy as np

from mdlgen.geometry.arrays import Floats


def no_profile() -> Floats:
    """Corners of what does not change, (0, 2)."""
    return np.zeros((0, 2))


def corners(profile: tuple[tuple[float, float], ...] | None) -> Floats:
    """Corners [ms, 1], (n, 2), as a user gave them."""
    return no_profile() if profile is None else np.array(profile, dtype=float)


def factor(profile: Floats, time: float) -> float:
    """The factor at a time [ms]."""
    return float(np.interp(time, profile[:, 0], profile[:, 1])) if len(profile) else 1.0


def most(profile: Floats) -> float:
    """The greatest size that the factor has at any time."""
    return float(np.abs(profile[:, 1]).max()) if len(profile) else 1.0
