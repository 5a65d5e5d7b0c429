"""Shared code of the peers: the scenes they run, where rollers stand on the sheet, and what they return."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Floats, Model, RollerPart
from mdlgen.results.result import ContactStatistics, Result


def check(model: Model, peer: str) -> None:
    """Raises RefusedError for a scene that is not one flat, free sheet between rollers along y."""
    sheet = model.sheets[0] if len(model.sheets) == 1 else None
    reasons = {
        "has not exactly one sheet": sheet is None,
        "has a turned sheet": sheet is not None and not np.array_equal(sheet.rotation, np.eye(3)),
        "has a clamped sheet": sheet is not None and sheet.clamp is not None,
        "has a sheet that moves at the start": bool(model.bodies.velocity.any() or model.bodies.spin.any()),
        "has loads or supports": bool(len(model.loads.body) or model.supports or model.tension),
        "has external parts": bool(model.externals),
        "has drives with a profile, or one-way rollers": any(
            r.profile is not None or r.one_way is not None for r in model.rollers
        ),
        "is static": model.run.analysis != "transient",
        "has rollers that are not along y": any(abs(r.axis[1]) != 1.0 for r in model.rollers),
        "has rollers that are not pressed along z": any(
            r.press is not None and abs(r.press.direction[2]) != 1.0 for r in model.rollers
        ),
        "has guides": bool(model.guides),
        "has meshes": bool(model.meshes),
        "has rims or arms": any(r.rim is not None or r.arm is not None for r in model.rollers),
        "has spring plates": bool(model.plates),
        "has planes that do not face up": any(p.normal[2] != 1.0 for p in model.planes),
    }
    for reason, found in reasons.items():
        if found:
            raise RefusedError(f"{model.name} {reason}; {peer} is written for a flat sheet between rollers")


def anchor(press_of: RollerPart) -> tuple[Floats, float]:
    """Where the spring of a pressed roller ends [mm], and its length without force [mm]."""
    press = press_of.press
    assert press is not None
    end = press_of.center + (press.touch - press.free_length) * press.direction
    return end, press.free_length + press.preload / press.stiffness


@dataclass(frozen=True)
class Lane:
    """A row of boxes under a roller."""

    row: int
    offset: float  # from the roller's centre along y to the middle of the part of the row that it covers [mm]
    share: float  # of the roller's width


def lanes(model: Model, roller: RollerPart) -> list[Lane]:
    """The rows of boxes that a roller stands on; the sheet is taken to run straight along x."""
    sheet, found = model.sheets[0], []
    for row in range(sheet.n_y):
        middle = model.bodies.position[sheet.body(0, row), 1] - roller.center[1]
        low = max(-roller.width / 2, middle - sheet.d_y / 2)
        high = min(roller.width / 2, middle + sheet.d_y / 2)
        if high - low > 1e-9 * roller.width:
            found.append(Lane(row, (low + high) / 2, (high - low) / roller.width))
    return found


@dataclass(frozen=True)
class Motion:
    """The run of a peer: the box centres at the stored times [ms], (t,) and [mm], (t, boxes, 3)."""

    time: Floats
    position: Floats
    step: float  # [ms]
    steps: int
    wall_s: float
    build_s: float

    def result(self, model: Model, solver: str, status: str) -> Result:
        """As a Result in which only the positions of the boxes move: peers give no more."""
        times, bodies = len(self.time), len(model.bodies.name)
        position = np.repeat(model.bodies.position[None], times, axis=0)
        position[:, : self.position.shape[1]] = self.position
        still, none = np.zeros((times, bodies, 3)), np.zeros(len(model.contacts))
        return Result(
            model=model,
            solver=solver,
            status=status,
            time=self.time,
            position=position,
            rotation=np.tile((1.0, 0.0, 0.0, 0.0), (times, bodies, 1)),
            velocity=still,
            spin=still,
            contact_force=np.zeros((times, len(model.contacts))),
            statistics=ContactStatistics(none, none, none, none, none),
            step=self.step,
            steps=self.steps,
            wall_s=self.wall_s,
            build_s=self.build_s,
        )
