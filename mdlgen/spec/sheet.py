"""The sheet: a grid of rigid boxes joined by bushings (paper section 2.2)."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from mdlgen.spec.fields import (
    Angle,
    Angles,
    Counts2,
    Mass,
    Name,
    Position,
    Size2,
    Spin,
    TimeOrZero,
    Velocity,
    one_of,
    origin,
)
from mdlgen.spec.grading import Graded, Grading
from mdlgen.spec.limits import DEFAULT
from mdlgen.spec.out import FORMS, Outs
from mdlgen.spec.quantities import combined, default, quantity, reading
from mdlgen.spec.shape import Shape
from mdlgen.spec.strict import Strict, fail, with_values
from mdlgen.spec.zone import Zone

MAX_ZONES = 100
MOST_TURN = math.radians(170.0)
FINEST = 1e-4  # of a side: how narrow a place may be that boxes are finer near
Edge = Literal["x_min", "x_max", "y_min", "y_max"]


class Clamp(Strict):
    """Boxes held up to a line; beyond it a half-cell hinge of twice the joint's stiffness."""

    edge: Edge = Field(description="the edge that the clamp starts from")
    length: Annotated[float, quantity("mm", 0.0)] = Field(
        default=default("0 mm"), description="clamped length from that edge: 0, or a line between boxes"
    )


class Sheet(Strict):
    """One sheet of material, flat, with x = machine direction and y = cross direction."""

    model_config = ConfigDict(json_schema_extra=one_of("mass", "grammage", "density"))

    material: Name = Field(description="name of a material")
    size: Size2 = Field(description="[L_x, L_y] of the outline")
    thickness: Annotated[float, quantity("mm", 0.01, 50.0, slip=1000.0)] = Field(description="thickness s")
    mass: Mass = Field(description="mass M of the whole sheet")
    grammage: Annotated[float, quantity("g/m^2", 0.0, open_low=True)] | None = Field(
        default=None, description="mass per area, in place of mass"
    )
    density: Annotated[float, quantity("kg/m^3", 0.0, open_low=True)] | None = Field(
        default=None, description="density, in place of mass; the mass is density times size and thickness"
    )
    boxes: Counts2 = Field(description="[n_x, n_y] boxes; [1, 1] is one rigid block")
    layout: Literal["edge_to_edge", "center_to_center", "plate"] = Field(
        default="edge_to_edge",
        description="how two boxes are joined. edge_to_edge: two bushings at the shared corners; "
        "center_to_center: one in the middle of the shared edge; plate: one there with the bending, twist, "
        "membrane and shear stiffness of an orthotropic plate",
    )
    grid: Literal["tiled", "paper"] = Field(
        default="tiled",
        description="tiled: d = L/n; paper: d = L/(n-1) (Eq. 1), an outline of n boxes of that size",
    )
    grading: Grading | None = Field(default=None, description="boxes of different sizes, finer where needed")
    zones: dict[Name, Zone] = Field(default_factory=dict, description="rectangles that are unlike the rest")
    shape: Shape | None = Field(
        default=None, description="a shape in which it is free of stress, if not flat"
    )
    center: Position = Field(default=origin("mm"), description="middle of the sheet's mid-plane")
    turn: Angle | None = Field(default=None, description="rotation about z")
    rotation: Angles | None = Field(
        default=None, description="rotations about the global x, then y, then z axis, in place of turn"
    )
    velocity: Velocity = Field(
        default=origin("m/s"),
        description="initial velocity of the middle of the outline, which is at `center`. The centre of mass "
        "of a sheet with zones is elsewhere, so that `spin` adds to its velocity",
    )
    spin: Spin = Field(
        default=origin("rad/s"),
        description="initial angular velocity about the middle of the outline, global axes",
    )
    clamp: Clamp | None = Field(default=None, description="an edge that is held")
    surface: bool = Field(
        default=False, description="deformable surface on the box centres, to look at in MotionView"
    )
    enters: TimeOrZero = Field(
        default=default("0 ms"),
        description="when it comes in; until then it is not there, and nothing meets it",
    )
    by_rule: bool = Field(default=False, description="it comes in when a rule says so, in place of enters")
    out: Outs = Field(
        default=(),
        description=f"where it leaves, after which it is not there any more: {FORMS}. Beyond a plane: all of "
        "it is on the other side of it than where it came in",
    )

    @model_validator(mode="before")
    @classmethod
    def _mass(cls, value: Any) -> Any:
        given = [
            n for n in ("mass", "grammage", "density") if isinstance(value, dict) and value.get(n) is not None
        ]
        if len(given) > 1:
            raise fail(f"{' and '.join(given)} are given; give one of them", within=(given[1],))
        if given in ([], ["mass"]):
            return value
        size = value.get("size")
        parts = [(side, "mm") for side in (size if isinstance(size, (list, tuple)) else ())]
        if given == ["density"]:
            parts.append((value.get("thickness"), "mm"))
        parts.append((value[given[0]], {"grammage": "g/m^2", "density": "kg/m^3"}[given[0]]))
        mass = math.prod(reading(part, unit, 1.0) for part, unit in parts)
        product = "*".join(f"{{{k}}}" for k in range(len(parts)))
        return {**value, "mass": combined(mass, product, *parts)}

    @model_validator(mode="after")
    def _plain(self) -> Sheet:
        """The same with its mass alone."""
        if self.grammage is None and self.density is None:
            return self
        return with_values(self, grammage=None, density=None)

    @model_validator(mode="after")
    def _counts(self, info: ValidationInfo) -> Sheet:
        least = 2 if self.grid == "paper" else 1
        n_x, n_y = self.boxes
        if min(n_x, n_y) < least:
            raise fail(f"boxes [{n_x}, {n_y}]: at least {least} each way with grid: {self.grid}")
        limits = (info.context or {}).get("limits", DEFAULT)
        if message := limits.exceeded("boxes", n_x * n_y, f"boxes [{n_x}, {n_y}]"):
            raise fail(message, within=("boxes",))
        if self.turn is not None and self.rotation is not None:
            raise fail("turn and rotation are both given; give one of them")
        if self.by_rule and self.enters > 0.0:
            raise fail("enters and by_rule are both given; give one of them", within=("enters",))
        if self.surface and min(n_x, n_y) < 2:
            raise fail("surface needs at least 2 x 2 boxes")
        self._check_grading()
        self.clamped_rows()
        self._check_zones()
        self._check_shape()
        return self

    def _check_grading(self) -> None:
        if self.grading is None:
            return
        if self.grid == "paper":
            raise fail("grading goes with grid: tiled; the paper's grid has equal boxes", within=("grading",))
        for axis, graded, count, length in zip(
            "xy", (self.grading.x, self.grading.y), self.boxes, self.size, strict=True
        ):
            if graded is None:
                continue
            if graded.sizes and len(graded.sizes) != count:
                raise fail(
                    f"grading.{axis} has {len(graded.sizes)} lengths for {count} boxes; give one each",
                    within=("grading", axis),
                )
            if graded.width is not None and graded.width < FINEST * length:
                raise fail(
                    f"grading.{axis}.width {graded.width:g} mm; allowed at least {FINEST * length:g} mm",
                    within=("grading", axis, "width"),
                )
            for place in graded.near:
                if abs(place) > length / 2:
                    raise fail(
                        f"grading.{axis}.near: {place:g} mm is off the sheet; "
                        f"allowed -{length / 2:g} to {length / 2:g} mm",
                        within=("grading", axis, "near"),
                    )

    def _check_zones(self) -> None:
        if len(self.zones) > MAX_ZONES:
            raise fail(f"zones are {len(self.zones)}; allowed are {MAX_ZONES} in a sheet")
        names = list(self.zones)
        for k, name in enumerate(names):
            zone = self.zones[name]
            for axis, side, lines in zip("xy", (zone.x, zone.y), self.lines, strict=True):
                if side[0] < lines[0] * (1 + 1e-9) or side[1] > lines[-1] * (1 + 1e-9):
                    raise fail(
                        f"zone {name}: {axis} from {side[0]:g} mm to {side[1]:g} mm leaves the sheet; "
                        f"allowed {lines[0]:g} to {lines[-1]:g} mm",
                        within=("zones", name, axis),
                    )
            for other in names[:k]:
                if zone.meets(self.zones[other]):
                    raise fail(
                        f"the zones {other} and {name} overlap; end one where the other begins",
                        within=("zones", name),
                    )

    def _check_shape(self) -> None:
        if self.shape is None:
            return
        self._check_turns()
        for k, fold in enumerate(self.shape.folds):
            lines = self.lines["xy".index(fold.along)][1:-1]
            away = sorted(lines, key=lambda line: abs(line - fold.at))
            if not away or abs(away[0] - fold.at) > 1e-6 * self.pitch["xy".index(fold.along)]:
                near = " and ".join(f"{line:.6g} mm" for line in sorted(away[:2])) or "none: there is one box"
                raise fail(
                    f"fold {k}: {fold.at:g} mm is not a line between boxes; the nearest are {near}",
                    within=("shape", "folds", k),
                )
            if any(abs(other.at - fold.at) < 1e-6 * self.pitch[0] for other in self.shape.folds[:k]):
                raise fail(
                    f"fold {k}: there is a fold at {fold.at:g} mm already", within=("shape", "folds", k)
                )
            if self.clamp is not None and self.clamp.edge[0] == fold.along and self._held(fold.at):
                raise fail(f"fold {k}: at {fold.at:g} mm the sheet is clamped", within=("shape", "folds", k))
        half = (self.lines[0][-1], self.lines[1][-1])
        taken: set[tuple[str, str]] = set()
        for k, ear in enumerate(self.shape.dog_ears):
            if ear.size[0] > half[0] or ear.size[1] > half[1]:
                raise fail(
                    f"dog_ears {k}: size is more than half of the sheet, {half[0]:g} mm x {half[1]:g} mm"
                )
            if not ear.beyond(*self._corner_box(ear.corner), half):
                raise fail(
                    f"dog_ears {k}: no box has its centre beyond the crease; the boxes are larger",
                    within=("shape", "dog_ears", k),
                )
            if ear.corner in taken:
                raise fail(f"dog_ears {k}: that corner is folded already", within=("shape", "dog_ears", k))
            taken.add(ear.corner)
            if self.clamp is not None and self.clamp.edge in ear.corner:
                raise fail(
                    f"dog_ears {k}: the edge {self.clamp.edge} is clamped", within=("shape", "dog_ears", k)
                )

    def made_names(self, name: str) -> list[tuple[str, tuple[str | int, ...]]]:
        """Names that are made from the sheet's, each with where what it is made for stands in the scene."""
        own = ("sheets", name)
        made: list[tuple[str, tuple[str | int, ...]]] = []
        graded = self.grading
        if graded is not None:
            sides = (("x", graded.x), ("y", graded.y))
            made += [(f"{name}_grid_{axis}", (*own, "grading", axis)) for axis, side in sides if side]
        made += [(f"{name}_zone_{zone}", (*own, "zones", zone)) for zone in self.zones]
        if graded is not None or self.zones or self.shape is not None:
            why = "grading" if graded is not None else "zones" if self.zones else "shape"
            made += [(f"{name}_{what}", (*own, why)) for what in ("cells", "joints")]
        if self.shape is not None:
            made.append((f"{name}_shape", (*own, "shape")))
            # frames of a bent sheet, at most one for each column, row or ear
            made += [(f"{name}_f{k}", (*own, "shape")) for k in range(1, max(self.boxes) + 5)]
        return made

    def _check_turns(self) -> None:
        """No joint may turn by more than a fold may: beyond half a turn it would be the other way round."""
        shape = self.shape
        if shape is None or shape.along is None:
            return
        axis = "xy".index(shape.along)
        if self.boxes[axis] == 1 and (self.clamp is None or self.clamp.edge[0] != shape.along):
            raise fail(f"one box along {shape.along} cannot be bent; take more boxes", within=("shape",))
        radius = shape.curl.radius if shape.curl is not None else math.inf
        lines = self.lines[axis]
        for k, line in enumerate(lines):
            near = [b - a for a, b in pairwise(lines[max(k - 1, 0) : k + 2])]
            folds = sum(f.angle for f in shape.folds if abs(f.at - line) < 1e-6 * self.pitch[axis])
            turn = sum(near) / 2 / radius + folds
            if not abs(turn) <= MOST_TURN * (1 + 1e-12):
                raise fail(
                    f"joints at {shape.along} = {line:g} mm turn by {math.degrees(turn):.4g} deg (length of "
                    "a box over the radius, and fold); allowed are 170 deg; take more boxes, or a wider curl",
                    within=("shape",),
                )

    def _corner_box(self, corner: tuple[str, str]) -> tuple[float, float]:
        """Centre of the box at a corner, from the sheet's centre."""
        x, y = (
            0.5 * (lines[0] + lines[1]) if edge.endswith("min") else 0.5 * (lines[-1] + lines[-2])
            for lines, edge in zip(self.lines, corner, strict=True)
        )
        return x, y

    def _held(self, at: float) -> bool:
        """True if a coordinate along the clamp's direction lies behind the clamp line, or on it."""
        assert self.clamp is not None
        lines, row = self.lines["xy".index(self.clamp.edge[0])], self.clamped_rows()
        slack = 1e-6 * self.pitch[0]
        if self.clamp.edge.endswith("min"):
            return at < lines[row] + slack
        return at > lines[-1 - row] - slack

    @property
    def normal(self) -> tuple[float, float, float]:
        """Unit normal of the flat sheet as it starts, global axes."""
        a, b, c = self.rotation if self.rotation is not None else (0.0, 0.0, 0.0)
        y, z = -math.sin(a), math.cos(a)  # about x, then y, then z
        x, z = z * math.sin(b), z * math.cos(b)
        return x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c), z

    @property
    def lines(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Coordinates of the lines between boxes, from the sheet's centre [mm], n_x + 1 and n_y + 1."""
        graded = (None, None) if self.grading is None else (self.grading.x, self.grading.y)
        x, y = (_lines(*side) for side in zip(self.pitch, self.boxes, graded, strict=True))
        return x, y

    @property
    def pitch(self) -> tuple[float, float]:
        """Mean box lengths (d_x, d_y) [mm]: L/n, or L/(n-1) on the paper's grid (Eq. 1)."""
        less = 1 if self.grid == "paper" else 0
        return self.size[0] / (self.boxes[0] - less), self.size[1] / (self.boxes[1] - less)

    def clamped_rows(self) -> int:
        """Rows of boxes behind the clamp line; 0 where the clamp sits on the edge or is absent."""
        if self.clamp is None or self.clamp.length == 0.0:
            return 0
        axis = 0 if self.clamp.edge[0] == "x" else 1
        lines, length = self.lines[axis], self.clamp.length
        away = [line - lines[0] for line in lines]
        if self.clamp.edge.endswith("max"):
            away = [lines[-1] - line for line in reversed(lines)]
        row = min(range(len(away) - 1), key=lambda k: abs(away[k] - length))
        if abs(length - away[row]) > 1e-6 * self.pitch[axis]:
            near = sorted(sorted(away[:-1], key=lambda line: abs(line - length))[:2])
            raise fail(
                f"clamp.length {length:.6g} mm is not a line between boxes; "
                f"the nearest are {' and '.join(f'{line:.6g} mm' for line in near)}"
            )
        return row


def _lines(pitch: float, count: int, graded: Graded | None) -> tuple[float, ...]:
    if graded is None:
        return tuple((k - count / 2) * pitch for k in range(count + 1))
    length = pitch * count
    sizes = graded.relative(count, length)
    whole, at = math.fsum(sizes), [0.0]
    for size in sizes:
        at.append(at[-1] + size)
    return tuple((value / whole - 0.5) * length for value in at)
