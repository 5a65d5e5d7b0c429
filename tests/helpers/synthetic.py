"""A Result that no solver made: a small scene whose boxes move as a formula says."""

from __future__ import annotations

import numpy as np

from mdlgen.model.lower import lower
from mdlgen.model.tables import Model
from mdlgen.paths import samples
from mdlgen.results.result import ContactStatistics, Result
from mdlgen.spec.load import load

SPEED = 1.4  # mm/ms, along x


def small_model(*overrides: str) -> Model:
    return lower(load(samples() / "transport_4x4.yaml", ["sheets.note.boxes=[2,3]", *overrides]))


def moving(model: Model, times: int = 11, speed: float = SPEED, shift: float = 0.0) -> Result:
    """All bodies move along x at `speed` [mm/ms], `shift` [mm] above where they start; rollers spin."""
    time = np.linspace(0.0, model.run.duration, times)
    bodies = len(model.bodies.name)
    start = model.bodies.position + np.array([0.0, 0.0, shift])
    position = start + time[:, None, None] * np.array([speed, 0.0, 0.0])
    velocity = np.broadcast_to([speed, 0.0, 0.0], position.shape).copy()
    rotation = np.zeros((times, bodies, 4))
    rotation[:, :, 0] = 1.0
    spin = np.zeros((times, bodies, 3))
    for roller in model.rollers:
        spin[:, roller.body] = 0.1867 * roller.axis
    rows = len(model.contacts)
    force = np.tile(np.arange(rows, dtype=float), (times, 1))
    ramp = np.arange(rows, dtype=float)
    return Result(
        model=model,
        solver="synthetic",
        status="ok",
        time=time,
        position=position,
        rotation=rotation,
        velocity=velocity,
        spin=spin,
        contact_force=force,
        statistics=ContactStatistics(
            ramp * 0.01, ramp * 0.005, ramp * 2, ramp, np.where(ramp < 2, np.nan, ramp)
        ),
        touched=3,
        step=0.05,
        steps=1000,
        wall_s=1.0,
    )
