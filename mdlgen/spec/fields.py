"""The field types of the spec: quantities, vectors, names."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from datetime import date
from typing import Annotated, Any

from pydantic import (
    BeforeValidator,
    WithJsonSchema,
)

from mdlgen.spec.quantities import default, is_number, numbers, one_or_two, quantity, ratio
from mdlgen.spec.strict import fail

UNIT = 4e-16  # how far the length of a unit vector is from 1, in round-off
IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
MOST_WORDS = 100  # characters of a text in the head of the report
RESERVED = frozenset(
    (
        *("b_ground", "p_global_origin", "v_global_x", "v_global_y", "v_global_z", "global_frame"),
        *("model", "this", "parent", "pi", "time", "true", "false", "left", "right", "ground", "all"),
        *("if", "else", "elseif", "endif", "none", "run", "name"),
    )
)


def one_of(*names: str) -> Callable[[dict[str, Any]], None]:
    """For a model's JSON schema: exactly one of these keys is required."""

    def change(schema: dict[str, Any]) -> None:
        schema["required"] = [name for name in schema.get("required", []) if name not in names]
        schema["oneOf"] = [{"required": [name]} for name in names]

    return change


def origin(unit: str) -> tuple[float, float, float]:
    """Three zeros as a default."""
    return (default(f"0 {unit}"), default(f"0 {unit}"), default(f"0 {unit}"))


def _fixed_length(count: int, what: str):
    def check(value: Any) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) != count:
            raise fail(f"expected a list of {count} {what}, got {value!r}"[:200])
        return tuple(value)

    return BeforeValidator(check)


def read_direction(value: Any) -> tuple[float, float, float]:
    """The unit vector of a direction; raises an error that names the allowed forms."""
    if isinstance(value, str):
        match = re.fullmatch(r"([-+]?)([xyz])", value)
        if not match:
            word = value.strip().lower()
            meant = f"; did you mean {word}?" if re.fullmatch(r"[-+]?[xyz]", word) else ""
            raise fail(
                f"{value!r} is not a direction; allowed: x, y, z, -x, -y, -z or a vector [1, 0, 0]{meant}"
            )
        sign = -1.0 if match[1] == "-" else 1.0
        x, y, z = (sign * (c == match[2]) + 0.0 for c in "xyz")
        return x, y, z
    if isinstance(value, (list, tuple)) and len(value) == 3 and all(is_number(v) for v in value):
        length = math.hypot(*value)
        if 1e-100 < length < 1e100:
            if abs(length - 1.0) < UNIT:  # as written from one that was read
                length = 1.0
            x, y, z = (float(v) / length + 0.0 for v in value)
            return x, y, z
    raise fail(f"{value!r} is not a direction; allowed: x, y, z, -x, -y, -z or a non-zero vector"[:200])


def _name(value: Any) -> str:
    if not isinstance(value, str) or not IDENTIFIER.fullmatch(value):
        raise fail(
            f"{str(value)[:80]!r} is not a name; allowed: a letter, then letters, digits or _, 63 at most"
        )
    if value.lower() in RESERVED:
        raise fail(f"{value!r} is a name that MotionView reserves; choose another")
    return value


def _words(value: object) -> str:
    """A short text of one line; numbers and dates, which YAML makes of some, as they are written."""
    if isinstance(value, bool) or not isinstance(value, (str, int, float, date)):
        raise fail("must be a text")
    text = str(value).strip()
    if not text or len(text) > MOST_WORDS or not text.isprintable():
        raise fail(f"must be one line of 1 to {MOST_WORDS} characters")
    return text


def _triple(unit: str) -> BeforeValidator:
    return _fixed_length(3, f"quantities like '1 {unit}'")


Length = Annotated[float, quantity("mm")]
LengthOrZero = Annotated[float, quantity("mm", 0.0)]
PositiveLength = Annotated[float, quantity("mm", 0.0, open_low=True)]
Mass = Annotated[float, quantity("g", 0.0, open_low=True)]
Time = Annotated[float, quantity("ms", 0.0, open_low=True)]
TimeOrZero = Annotated[float, quantity("ms", 0.0)]
Frequency = Annotated[float, quantity("Hz", 0.0, open_low=True)]
Times = Annotated[float | tuple[float, float], one_or_two("ms", 0.0)]
Curvatures = Annotated[float | tuple[float, float], one_or_two("1/mm", 0.0, open_low=True)]
Hardenings = Annotated[float | tuple[float, float], *numbers(0.01, 0.99)]
LossFactors = Annotated[float | tuple[float, float], *numbers(0.0, 10.0)]
Ratio = Annotated[float, ratio(0.0, 10.0)]
Stiffness = Annotated[float, quantity("N/mm", 0.0)]
Torsion = Annotated[float, quantity("N*mm/rad", 0.0)]
CreaseStiffness = Annotated[float, quantity("N*mm/rad/mm", 0.0, open_low=True)]
Modulus = Annotated[float, quantity("MPa", 0.0, open_low=True)]
Plate = Annotated[float, quantity("N*mm", 0.0, open_low=True)]
Angle = Annotated[float, quantity("deg")]
SpeedScale = Annotated[float, quantity("mm/s", 0.0, open_low=True)]
_Speed = Annotated[float, quantity("m/s")]
_Rate = Annotated[float, quantity("rad/s")]
_Rise = Annotated[float, quantity("m/s^2")]
_Force = Annotated[float, quantity("N")]
_Moment = Annotated[float, quantity("N*mm")]

Position = Annotated[tuple[Length, Length, Length], _triple("mm")]
Velocity = Annotated[tuple[_Speed, _Speed, _Speed], _triple("m/s")]
Spin = Annotated[tuple[_Rate, _Rate, _Rate], _triple("rad/s")]
Acceleration = Annotated[tuple[_Rise, _Rise, _Rise], _triple("m/s^2")]
ForceVector = Annotated[tuple[_Force, _Force, _Force], _triple("N")]
MomentVector = Annotated[tuple[_Moment, _Moment, _Moment], _triple("N*mm")]
Angles = Annotated[tuple[Angle, Angle, Angle], _triple("deg")]
Size2 = Annotated[tuple[PositiveLength, PositiveLength], _fixed_length(2, "lengths like '1 mm'")]
Size3 = Annotated[
    tuple[PositiveLength, PositiveLength, PositiveLength], _fixed_length(3, "lengths like '1 mm'")
]
Point2 = Annotated[tuple[Length, Length], _fixed_length(2, "lengths like '1 mm'")]
Counts2 = Annotated[tuple[int, int], _fixed_length(2, "whole numbers")]
Direction = Annotated[
    tuple[float, float, float],
    BeforeValidator(read_direction),
    WithJsonSchema(
        {
            "anyOf": [
                {"enum": ["x", "y", "z", "-x", "-y", "-z", "+x", "+y", "+z"]},
                {"minItems": 3, "maxItems": 3, "type": "array", "items": {"type": "number"}},
            ]
        }
    ),
]
Words = Annotated[
    str, BeforeValidator(_words), WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number"}]})
]
Name = Annotated[
    str, BeforeValidator(_name), WithJsonSchema({"type": "string", "pattern": IDENTIFIER.pattern})
]
