"""Contact between two parts (paper section 3, Table 4)."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, ValidatorFunctionWrapHandler, WrapValidator, model_validator
from pydantic_core import PydanticCustomError

from mdlgen.spec.fields import Name, SpeedScale
from mdlgen.spec.friction import Friction
from mdlgen.spec.quantities import default, quantity, ratio
from mdlgen.spec.strict import Strict, fail

Share = Annotated[float, ratio(0.0, 1.0)]


class Air(Strict):
    """The air between two faces, as a squeeze film (Reynolds 1886): it holds back what closes or opens."""

    viscosity: Annotated[float, quantity("Pa*s", 0.0, open_low=True)] = Field(
        description="of the air: 18.2 uPa*s at 20 deg C"
    )
    roughness: Annotated[float, quantity("mm", 1e-6, 1.0)] = Field(
        default=default("10 um"),
        description="mean gap of faces that touch; the air has it on top of the gap between the faces, and "
        "flows through it where they press into each other",
    )


def _two(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2 or not all(_is_side(v) for v in value):
        raise fail(f"between needs two names, patterns like 'motor_*', or lists of them, got {value!r}"[:200])
    return tuple(side if isinstance(side, str) else tuple(side) for side in value)


def _is_side(value: Any) -> bool:
    if isinstance(value, (list, tuple)):
        return len(value) > 0 and all(isinstance(item, str) for item in value)
    return isinstance(value, str)


def _number_or_both(schema: dict[str, Any]) -> None:
    """A coefficient, one for each of MD and CD, or a mapping, in the JSON schema."""
    both = {"$ref": schema.pop("$ref")}
    one = [
        {"type": "number", "minimum": 0.0, "maximum": 1e3, "examples": [0.5]},
        {"type": "string", "description": "a percentage or a formula", "examples": ["50 %"]},
    ]
    two = {"type": "array", "minItems": 2, "maxItems": 2, "items": {"anyOf": one}}
    schema["anyOf"] = [*one, two, both]


Side = str | tuple[str, ...]

# True while the scene that is read has a roller with a cover, from which a stiffness may follow.
_COVERED: ContextVar[bool] = ContextVar("covered", default=False)


@contextmanager
def of_covers(data: Any) -> Iterator[None]:
    """While a scene of such plain data is read, contacts may leave their stiffness out if a roller there has
    a cover."""
    rollers = data.get("rollers") if isinstance(data, dict) else None
    parts = rollers.values() if isinstance(rollers, dict) else ()
    token = _COVERED.set(any(isinstance(part, dict) and part.get("cover") is not None for part in parts))
    try:
        yield
    finally:
        _COVERED.reset(token)


def _left_out() -> Any:
    """Until the scene fills it in."""
    return None


def _or_of_a_cover(value: Any, inner: ValidatorFunctionWrapHandler) -> Any:
    """A stiffness; None, which a scene fills in, where it may follow from a cover."""
    if value is not None:
        return inner(value)
    if _COVERED.get():
        return None
    raise PydanticCustomError("missing", "Field required")


class Contact(Strict):
    """Normal force k z^1.5 with restitution (Eqs. 9-11) and friction, for each pair of parts named."""

    name: Name | None = Field(
        default=None, description="its name, where contacts are a list; in a mapping the key is the name"
    )
    between: Annotated[tuple[Side, Side], BeforeValidator(_two)] = Field(
        description="two sides, each a name, a pattern as 'motor_*' or a list of them; each part of one side "
        "has this contact with each part of the other"
    )
    stiffness: Annotated[float, quantity("N/mm^1.5", 0.0, open_low=True), WrapValidator(_or_of_a_cover)] = (
        Field(
            default_factory=_left_out,
            description="k of one pair (Eq. 10); where left out it follows from the cover of a roller",
        )
    )
    restitution: Share = Field(default=0.5, description="coefficient of restitution c_R (Eq. 11)")
    friction: Friction = Field(
        description="coefficient of friction mu (Eq. 12): a number, [md, cd], or a mapping; 0 where there is "
        "none",
        json_schema_extra=_number_or_both,
    )
    smoothing: SpeedScale | None = Field(
        default=None,
        description="slip speed over which friction rises from 0 to its full value, and speed of approach "
        "over which damping does; where left out 1 % of the fastest surface of a roller, or of the fastest "
        "sheet at the start, but 1 mm/s at least and 20 mm/s at most; 1 mm/s where the contact has a sheet "
        "on a sheet",
    )
    rolling_resistance: Share = Field(
        default=0.0,
        description="coefficient f of a roller that rolls on the other part: at a steady speed it is held "
        "back by f N, where N is the normal force. The couple is f N R, against the angular velocity of the "
        "roller relative to the other part. R is its radius; of two rollers 1/R = 1/R1 + 1/R2; on an arc of "
        "radius A 1/R = 1/R1 + 1/A, in its hollow 1/R = 1/R1 - 1/A; of a rim the greatest radius. The couple "
        "rises over `smoothing`, as the angular velocity times R",
    )
    air: Air | None = Field(
        default=None,
        description="air between two sheets, or a sheet and a plane that is not pressed; none where left out",
    )
    share: Literal["width", "pair"] = Field(
        default="width",
        description="width: all boxes under one roller, or on one box of another sheet, have k together, "
        "each by the part that it covers; pair: each box has k, as in MotionSolve",
    )

    @model_validator(mode="after")
    def _order(self) -> Contact:
        smoothing = self.smoothing
        if smoothing is None:  # it follows from the scene, and then is no more than a friction velocity
            smoothing = self.friction.friction_velocity or 0.0
        slow, fast = self.friction.speeds(smoothing)
        if fast < slow:
            raise fail(
                f"friction.friction_velocity {1e3 * fast:g} mm/s is below the stiction velocity "
                f"{1e3 * slow:g} mm/s (the smoothing where that is left out); it must be at least as high"
            )
        return self
