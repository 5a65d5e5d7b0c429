"""The sheet: a grid of rigid boxes joined by bushings (paper section 2.2)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from mdlgen.spec.fields import (
    Angle,
    Angles,
    Counts2,
    Mass,
    Name,
    Position,
    Size2,
    Spin,
    Strict,
    Velocity,
    default,
    fail,
    origin,
    quantity,
)

MAX_BOXES = 100_000
Edge = Literal["x_min", "x_max", "y_min", "y_max"]


class Clamp(Strict):
    """Boxes held up to a line; beyond it a half-cell hinge of twice the joint's stiffness."""

    edge: Edge = Field(description="the edge that the clamp starts from")
    length: Annotated[float, quantity("mm", 0.0)] = Field(
        default=default("0 mm"), description="clamped length from that edge: 0, or a line between boxes"
    )


class Sheet(Strict):
    """One sheet of material, flat, with x = machine direction and y = cross direction."""

    material: Name = Field(description="name of a material")
    size: Size2 = Field(description="[L_x, L_y] of the outline")
    thickness: Annotated[float, quantity("mm", 0.01, 50.0, slip=1000.0)] = Field(description="thickness s")
    mass: Mass = Field(description="mass M of the whole sheet")
    boxes: Counts2 = Field(description="[n_x, n_y] boxes; [1, 1] is one rigid block")
    layout: Literal["edge_to_edge", "center_to_center"] = Field(
        default="edge_to_edge",
        description="two bushings per pair at the shared corners, or one at the edge's middle",
    )
    grid: Literal["tiled", "paper"] = Field(
        default="tiled",
        description="tiled: d = L/n; paper: d = L/(n-1) (Eq. 1), an outline of n boxes of that size",
    )
    center: Position = Field(default=origin("mm"), description="middle of the sheet's mid-plane")
    turn: Angle | None = Field(default=None, description="rotation about z")
    rotation: Angles | None = Field(
        default=None, description="rotations about the global x, then y, then z axis, in place of turn"
    )
    velocity: Velocity = Field(default=origin("m/s"), description="initial velocity of the centre")
    spin: Spin = Field(default=origin("rad/s"), description="initial angular velocity, global axes")
    clamp: Clamp | None = Field(default=None, description="an edge that is held")
    surface: bool = Field(
        default=False, description="deformable surface on the box centres, to look at in MotionView"
    )

    @model_validator(mode="after")
    def _counts(self) -> Sheet:
        least = 2 if self.grid == "paper" else 1
        n_x, n_y = self.boxes
        if min(n_x, n_y) < least:
            raise fail(f"boxes [{n_x}, {n_y}]: at least {least} each way with grid: {self.grid}")
        if n_x * n_y > MAX_BOXES:
            raise fail(f"boxes [{n_x}, {n_y}] are {n_x * n_y}; allowed are {MAX_BOXES} in a sheet")
        if self.turn is not None and self.rotation is not None:
            raise fail("turn and rotation are both given; give one of them")
        if self.surface and min(n_x, n_y) < 2:
            raise fail("surface needs at least 2 x 2 boxes")
        self.clamped_rows()
        return self

    @property
    def pitch(self) -> tuple[float, float]:
        """Box lengths (d_x, d_y) [mm]: L/n, or L/(n-1) on the paper's grid (Eq. 1)."""
        less = 1 if self.grid == "paper" else 0
        return self.size[0] / (self.boxes[0] - less), self.size[1] / (self.boxes[1] - less)

    def clamped_rows(self) -> int:
        """Rows of boxes behind the clamp line; 0 where the clamp sits on the edge or is absent."""
        if self.clamp is None or self.clamp.length == 0.0:
            return 0
        axis = 0 if self.clamp.edge[0] == "x" else 1
        pitch, count = self.pitch[axis], self.boxes[axis]
        rows = round(self.clamp.length / pitch)
        if abs(self.clamp.length - rows * pitch) > 1e-6 * pitch or not 0 <= rows < count:
            low = min(int(self.clamp.length / pitch), count - 2 if count > 1 else 0)
            lines = [f"{line * pitch:.6g} mm" for line in (low, low + 1) if line < count]
            raise fail(
                f"clamp.length {self.clamp.length:.6g} mm is not a line between boxes; "
                f"the nearest are {' and '.join(lines)}"
            )
        return rows
