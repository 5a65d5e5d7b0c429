"""The field types of the spec: quantities, vectors, names, and the strict base model."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, WithJsonSchema
from pydantic_core import PydanticCustomError

from mdlgen.units import parse_quantity

IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
RESERVED = frozenset(
    "b_ground p_global_origin v_global_x v_global_y v_global_z global_frame model this parent pi time "
    "true false left right if else elseif endif ground all none run name plane_ground".split()
)


class Strict(BaseModel):
    """Extra keys forbidden, no coercion, finite numbers only, frozen after validation."""

    model_config = ConfigDict(
        extra="forbid", strict=True, allow_inf_nan=False, frozen=True, validate_default=True
    )


def fail(message: str, path: tuple[str | int, ...] | None = None) -> PydanticCustomError:
    """An error for pydantic to raise; `path` (from the scene's root) where it is not the field itself."""
    return PydanticCustomError("spec", "{text}", {"text": message, "path": path})  # type: ignore[arg-type]


class _Limits:
    """Range of a quantity in internal units, with the text to show for it."""

    def __init__(self, unit: str, low: float | None, high: float | None, open_low: bool, slip: float | None):
        self.unit, self.low, self.high, self.open_low, self.slip = unit, low, high, open_low, slip

    def __call__(self, text: Any) -> float:
        if isinstance(text, _Internal):
            return float(text)
        try:
            value = parse_quantity(text, self.unit)
        except ValueError as error:
            raise fail(str(error)) from None
        too_low = self.low is not None and (value < self.low or (self.open_low and value == self.low))
        if too_low or (self.high is not None and value > self.high):
            raise fail(f"{text} is outside what is allowed: {self.allowed()}{self._meant(value)}")
        return value

    def allowed(self) -> str:
        word = "more than" if self.open_low else "at least"
        if self.high is None:
            return f"{word} {self.low:g} {self.unit}"
        return f"{self.low:g} to {self.high:g} {self.unit}"

    def _meant(self, value: float) -> str:
        """The unit slip that is likely: metres for millimetres and the reverse."""
        if self.slip is None:
            return ""
        for factor in (self.slip, 1.0 / self.slip):
            other = value * factor
            if self.low is not None and self.high is not None and self.low < other < self.high:
                return f". Did you mean {other:g} {self.unit}?"
        return ""


class _Internal(float):
    """A default that is already in internal units."""


def quantity(
    unit: str,
    low: float | None = None,
    high: float | None = None,
    *,
    open_low: bool = False,
    slip: float | None = None,
) -> Any:
    """A field type: text with a unit of the dimension of `unit`, stored as float in internal units."""
    schema: dict[str, Any] = {"type": "string", "examples": [f"1 {unit}"]}
    limits = _Limits(unit, low, high, open_low, slip)
    schema["description"] = f"number with a unit such as {unit}" + (
        f"; {limits.allowed()}" if low is not None else ""
    )
    return Annotated[float, BeforeValidator(limits), WithJsonSchema(schema)]


def internal(value: float) -> Any:
    """A default value in internal units, for fields that `quantity` describes."""
    return _Internal(value)


def _fixed_length(count: int, what: str):
    def check(value: Any) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) != count:
            raise fail(f"expected a list of {count} {what}, got {value!r}"[:200])
        return tuple(value)

    return BeforeValidator(check)


def _axis(value: Any) -> tuple[float, float, float]:
    if isinstance(value, str):
        match = re.fullmatch(r"([-+]?)([xyz])", value)
        if not match:
            raise fail(f"{value!r} is not a direction; allowed: x, y, z, -x, -y, -z or a vector [1, 0, 0]")
        sign = -1.0 if match[1] == "-" else 1.0
        return tuple(sign * (c == match[2]) + 0.0 for c in "xyz")  # type: ignore[return-value]
    if isinstance(value, (list, tuple)) and len(value) == 3:
        if all(isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) for v in value):
            length = math.hypot(*value)
            if 1e-100 < length < 1e100:
                return tuple(float(v) / length + 0.0 for v in value)  # type: ignore[return-value]
    raise fail(f"{value!r} is not a direction; allowed: x, y, z, -x, -y, -z or a non-zero vector"[:200])


def _name(value: Any) -> str:
    if not isinstance(value, str) or not IDENTIFIER.fullmatch(value):
        raise fail(
            f"{str(value)[:80]!r} is not a name; allowed: a letter, then letters, digits or _, 63 at most"
        )
    if value.lower() in RESERVED:
        raise fail(f"{value!r} is a name that MotionView reserves; choose another")
    return value


Length = quantity("mm")
PositiveLength = quantity("mm", 0.0, open_low=True)
Mass = quantity("g", 0.0, open_low=True)
Time = quantity("ms", 0.0, open_low=True)
TimeOrZero = quantity("ms", 0.0)
Stiffness = quantity("N/mm", 0.0)
Torsion = quantity("N*mm/rad", 0.0)
Angle = quantity("deg")
Force = quantity("N")
SpeedScale = quantity("mm/s", 0.0, open_low=True)

_schema = {"minItems": 3, "maxItems": 3, "type": "array"}
_Quantities = {
    unit: Annotated[
        tuple[quantity(unit), quantity(unit), quantity(unit)],
        _fixed_length(3, f"quantities like '1 {unit}'"),
    ]
    for unit in ("mm", "m/s", "rad/s", "m/s^2", "N", "N*mm", "deg")
}
Position = _Quantities["mm"]
Velocity = _Quantities["m/s"]
Spin = _Quantities["rad/s"]
Acceleration = _Quantities["m/s^2"]
ForceVector = _Quantities["N"]
MomentVector = _Quantities["N*mm"]
Angles = _Quantities["deg"]
Size2 = Annotated[tuple[PositiveLength, PositiveLength], _fixed_length(2, "lengths like '1 mm'")]
Size3 = Annotated[
    tuple[PositiveLength, PositiveLength, PositiveLength], _fixed_length(3, "lengths like '1 mm'")
]
Point2 = Annotated[tuple[Length, Length], _fixed_length(2, "lengths like '1 mm'")]
Counts2 = Annotated[tuple[int, int], _fixed_length(2, "whole numbers")]
Direction = Annotated[
    tuple[float, float, float],
    BeforeValidator(_axis),
    WithJsonSchema({"anyOf": [{"enum": ["x", "y", "z", "-x", "-y", "-z"]}, {**_schema, "items": {"type": "number"}}]}),
]
Name = Annotated[str, BeforeValidator(_name), WithJsonSchema({"type": "string", "pattern": IDENTIFIER.pattern})]
