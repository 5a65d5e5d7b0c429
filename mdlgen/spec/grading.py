"""Boxes of different sizes along one side of a sheet: given one by one, or finer near named places."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from pydantic import Field, model_validator

from mdlgen.spec.fields import Length, PositiveLength
from mdlgen.spec.strict import Strict, fail

MOST_UNLIKE = 1e3  # the largest relative length over the smallest one
_STATIONS = 4001  # where the density of lines is evaluated


class Graded(Strict):
    """Lengths of the boxes along one side: relative ones, or more lines near some places.

    A plain list is `sizes`.
    """

    sizes: tuple[float, ...] = Field(
        default=(), description="relative lengths of the boxes from x_min or y_min on, one for each"
    )
    near: tuple[Length, ...] = Field(
        default=(), strict=False, description="places along the side, from the sheet's centre"
    )
    width: PositiveLength | None = Field(
        default=None,
        description="boxes are shortest up to half of this away from each place, and grow to their full "
        "length at this distance",
    )
    ratio: Annotated[float, Field(gt=1, le=100)] | None = Field(
        default=None, description="length of the boxes elsewhere over that of the shortest"
    )

    @model_validator(mode="before")
    @classmethod
    def _list(cls, value: Any) -> Any:
        if isinstance(value, Graded):
            return value
        if isinstance(value, (list, tuple)):
            value = {"sizes": value}
        if not isinstance(value, dict):
            raise fail(f"{value!r} is no grading; give relative lengths, or near, width and ratio"[:200])
        sizes = value.get("sizes", ())
        for k, size in enumerate(sizes if isinstance(sizes, (list, tuple)) else ()):
            number = isinstance(size, (int, float)) and not isinstance(size, bool)
            if not number or not 1e-6 <= size <= 1e6:
                raise fail(f"relative length {k}: {size!r} is not a number from 1e-6 to 1e6"[:200])
        return {**value, "sizes": tuple(map(float, sizes))} if isinstance(sizes, (list, tuple)) else value

    @model_validator(mode="after")
    def _one_way(self) -> Graded:
        finer = (bool(self.near), self.width is not None, self.ratio is not None)
        if bool(self.sizes) == any(finer) or (any(finer) and not all(finer)):
            raise fail("give either relative lengths, or all of near, width and ratio")
        if self.sizes and max(self.sizes) > MOST_UNLIKE * min(self.sizes):
            raise fail(f"the relative lengths differ by more than {MOST_UNLIKE:g} times")
        return self

    def relative(self, count: int, length: float) -> tuple[float, ...]:
        """Relative lengths of `count` boxes on a side of `length` [mm]."""
        if self.sizes:
            return self.sizes
        assert self.width is not None and self.ratio is not None, "the spec has all of them, or sizes"
        at = np.linspace(-0.5, 0.5, _STATIONS) * length
        away = np.min([np.abs(at - place) for place in self.near], axis=0) / (0.5 * self.width)
        density = 1.0 + (self.ratio - 1.0) * np.clip(2.0 - away, 0.0, 1.0)
        lines = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
        found = np.interp(np.linspace(0.0, lines[-1], count + 1), lines, np.linspace(0.0, 1.0, _STATIONS))
        return tuple(float(v) for v in np.diff(found) * count)


class Grading(Strict):
    """Boxes whose lengths differ, along x, along y or both."""

    x: Graded | None = Field(default=None, description="along x (MD), from x_min")
    y: Graded | None = Field(default=None, description="along y (CD), from y_min")

    @model_validator(mode="after")
    def _some(self) -> Grading:
        if self.x is None and self.y is None:
            raise fail("give lengths along x, along y or both, or leave grading out")
        return self
