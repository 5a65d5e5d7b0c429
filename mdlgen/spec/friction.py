"""Friction of a contact: one coefficient, or as it is measured (Eq. 12)."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Annotated, Any

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)

from mdlgen.spec.fields import PositiveLength, SpeedScale
from mdlgen.spec.parameter import is_formula
from mdlgen.spec.quantities import of_percent, quantity, ratio
from mdlgen.spec.strict import Strict, fail, with_values

Coefficient = Annotated[float, ratio(0.0, 1e3)]
MOST_SPEEDS = 8  # rows of a table over the speed
# What a coefficient may be given as: keys that go together.
_FORMS = (("mu",), ("static", "dynamic"), ("md", "cd"), ("front", "back"), ("speed",))
_HOW = "mu, static and dynamic, md and cd, front and back, or speed"
# Forms that may be combined: the table of speeds is then relative to its first coefficient.
_SHAPED = ({("md", "cd"), ("speed",)}, {("front", "back"), ("speed",)})


def _point(value: Any) -> Any:
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        raise fail(f"expected [slip speed, coefficient], as ['10 mm/s', 0.4], got {value!r}"[:200])
    return tuple(value)


_Point = Annotated[tuple[SpeedScale, Coefficient], BeforeValidator(_point)]


class ByPressure(Strict):
    """How friction goes with the pressure p of a face: mu = mu_0 (p/p_0)^n."""

    at: Annotated[float, quantity("MPa", 0.0, open_low=True)] = Field(
        description="p_0, at which friction has the coefficients given: normal force over the area of a "
        "box's face"
    )
    exponent: Annotated[float, ratio(-0.9, 1.0)] = Field(
        description="exponent n, below 0 where friction falls as the pressure rises"
    )


class Scatter(Strict):
    """How friction scatters over a sheet: a random field, the same whatever the boxes are."""

    deviation: Annotated[float, ratio(0.0, 0.5)] = Field(
        description="standard deviation of the coefficient over its mean"
    )
    length: PositiveLength = Field(
        description="correlation length L: places at the distance d have the correlation exp(-(d/L)^2)"
    )
    seed: Annotated[int, Field(ge=0, le=2**31)] = Field(
        default=1, description="the same seed gives the same field; sheets have different ones"
    )


def _any_form(schema: dict[str, Any]) -> None:
    """No key is required for itself, but one of the forms."""
    schema.pop("required", None)
    schema["anyOf"] = [{"required": list(form)} for form in (*_FORMS, ("static", "kinetic"))]
    keys = schema.get("properties", {})
    for other, key in (("kinetic", "dynamic"), ("mu", "static")):
        if key in keys:
            keys[other] = keys[key]


class Friction(Strict):
    """Coulomb friction, regularised: the coefficient rises over the slip speed (Eq. 12).

    A plain number is both coefficients, `mu` in a mapping; a list of two is `md` and `cd`. The speeds follow
    the contact's `smoothing` where left out.
    """

    model_config = ConfigDict(json_schema_extra=_any_form)

    static: Coefficient = Field(
        default=0.0, description="coefficient at the stiction velocity; `mu` is it and dynamic at once"
    )
    dynamic: Coefficient = Field(
        default=0.0, description="coefficient from the friction velocity on; `kinetic` is the same"
    )
    stiction_velocity: SpeedScale | None = Field(
        default=None, description="slip speed at which friction is static; the smoothing where left out"
    )
    friction_velocity: SpeedScale | None = Field(
        default=None,
        description="slip speed from which on friction is dynamic; where left out the stiction velocity, or "
        "1.5 times that where the two coefficients differ",
    )
    stribeck_velocity: SpeedScale | None = Field(
        default=None,
        description="in place of friction_velocity: v_S of dynamic + (static - dynamic) "
        "exp(-((v - v_s)/v_S)^2) at slip speeds v above the stiction velocity v_s",
    )
    md: Coefficient | None = Field(
        default=None,
        description="with cd, in place of static and dynamic: coefficient along the machine direction, the "
        "sheet's x; between both the limit of friction is an ellipse",
    )
    cd: Coefficient | None = Field(default=None, description="coefficient along the cross direction")
    front: Coefficient | None = Field(
        default=None,
        description="with back, in place of static and dynamic: coefficient of the sheet's front, at its +z",
    )
    back: Coefficient | None = Field(default=None, description="coefficient of the sheet's back, at its -z")
    speed: tuple[_Point, ...] | None = Field(
        default=None,
        strict=False,
        description="in place of static and dynamic: [slip speed, coefficient] as measured, speeds "
        f"increasing, 2 to {MOST_SPEEDS}; friction rises over the first speed. With md "
        "and cd, or front and back, the coefficients count relative to the first one",
    )
    pressure: ByPressure | None = Field(
        default=None, description="friction by pressure; the same at any pressure where left out"
    )
    scatter: Scatter | None = Field(
        default=None, description="friction that is not the same everywhere on a sheet"
    )
    sticking: Annotated[float, quantity("N/mm", 0.0, open_low=True)] | None = Field(
        default=None,
        description="stiffness of sticking along the faces: of one pair of boxes of two sheets, of a "
        "sheet and a roller, of one box and another part. A held part then yields by "
        "force/stiffness, does not creep, and slides from the limit mu N on. Where left out friction rises "
        "over the slip speed alone",
    )

    @model_validator(mode="before")
    @classmethod
    def _number(cls, value: Any) -> Any:
        value = of_percent(value)
        if isinstance(value, str) and is_formula(value):
            return {"static": value, "dynamic": value}
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return {"static": value, "dynamic": value}
        if isinstance(value, (list, tuple)) and len(value) == 2:
            return {"md": value[0], "cd": value[1]}
        if isinstance(value, dict):
            return _one_form(value)
        if not isinstance(value, Friction):
            comma = re.fullmatch(r"[0-9]+,[0-9]+( *%)?", str(value))
            meant = (
                f"; write {str(value).replace(',', '.')}"
                if comma
                else "; give a number, [md, cd], or static and dynamic"
            )
            raise fail(f"{value!r} is not a friction{meant}"[:200])
        return value

    @model_validator(mode="after")
    def _derived(self) -> Friction:
        """The reference coefficients, the least of the form given; all other values are relative to them."""
        if self.stribeck_velocity is not None and self.friction_velocity is not None:
            raise fail("give stribeck_velocity or friction_velocity, not both")
        if self.speed is not None:
            self._check_speeds(self.speed)
        for form in (("md", "cd"), ("front", "back")):
            both = [getattr(self, key) for key in form]
            if both[0] is None:
                continue
            if min(both) <= 0.0 < max(both):
                raise fail(f"{form[0]} and {form[1]}: {both[0]:g} and {both[1]:g}; neither may be 0 alone")
            if form[0] == "md" and self.sticking is not None:
                raise fail(
                    "sticking does not go with md and cd: a spring along the faces has one stiffness; leave "
                    "sticking out, or give one coefficient"
                )
            return self._with(min(both), min(both))
        if self.speed is not None:
            return self._with(self.speed[0][1], self.speed[-1][1])
        return self

    def _check_speeds(self, rows: tuple[tuple[float, float], ...]) -> None:
        for key in ("stiction_velocity", "friction_velocity", "stribeck_velocity"):
            if getattr(self, key) is not None:
                raise fail(f"speed has speeds of its own; leave {key} out")
        if not 2 <= len(rows) <= MOST_SPEEDS:
            raise fail(f"speed: {len(rows)} points; allowed 2 to {MOST_SPEEDS}")
        for k, ((before, _), (v, _)) in enumerate(pairwise(rows), 1):
            if not v > before:
                raise fail(
                    f"speed.{k}: {1e3 * v:g} mm/s is not above the speed before, {1e3 * before:g} mm/s"
                )
        if rows[0][1] == 0.0:
            raise fail("speed.0: the first coefficient is 0; the others are relative to it")

    def _with(self, static: float, dynamic: float) -> Friction:
        slow, fast = self.stiction_velocity, self.friction_velocity
        if self.speed is not None:
            slow, fast = float(self.speed[0][0]), float(self.speed[-1][0])
        given = set(self.model_fields_set)
        # plain numbers: a formula stands where it was given
        static, dynamic = float(static), float(dynamic)
        found = with_values(
            self, static=static, dynamic=dynamic, stiction_velocity=slow, friction_velocity=fast
        )
        found.model_fields_set.intersection_update(given)
        return found

    @model_serializer(mode="wrap")
    def _as_given(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Without what follows from the form given."""
        data = handler(self)
        if self.md is not None or self.front is not None or self.speed is not None:
            follows = {"static", "dynamic"}
            if self.speed is not None:
                follows |= {"stiction_velocity", "friction_velocity"}
            return {key: value for key, value in data.items() if key not in follows}
        # of no friction, too, which a dump without defaults would leave empty
        return {"static": 0.0, "dynamic": 0.0, **data}

    @property
    def measured(self) -> bool:
        """True if it is more than two coefficients and their speeds."""
        forms = (self.md, self.front, self.pressure, self.scatter, self.stribeck_velocity)
        return any(form is not None for form in forms) or (self.speed is not None and len(self.speed) > 2)

    def speeds(self, smoothing: float) -> tuple[float, float]:
        """(stiction velocity, friction velocity) [mm/ms]; where left out the first is the smoothing and the
        second the same, or half as much again where the two coefficients differ."""
        slow = self.stiction_velocity if self.stiction_velocity is not None else smoothing
        if self.friction_velocity is not None:
            return slow, self.friction_velocity
        return slow, slow if self.static == self.dynamic else 1.5 * slow


def _one_form(value: dict[Any, Any]) -> dict[Any, Any]:
    """The keys of a friction with static and dynamic where one number or two are given; raises the error
    where they say it in two ways, or in none."""
    value = dict(value)
    if "kinetic" in value:
        if "dynamic" in value:
            raise fail("kinetic and dynamic are the same; give one of them")
        value["dynamic"] = value.pop("kinetic")
    given = [form for form in _FORMS if any(value.get(key) is not None for key in form)]
    if not given:
        raise fail(f"no coefficient is given; give one of {_HOW}")
    if len(given) > 1 and set(given) not in _SHAPED:
        both = " and ".join("/".join(form) for form in given[:2])
        if set(given[:2]) == {("md", "cd"), ("front", "back")}:
            raise fail(f"{both} at once are not modelled; give md and cd, or front and back")
        raise fail(f"{both} say it twice; give one of {_HOW}")
    for form in given:
        missing = [key for key in form if value.get(key) is None]
        if missing:
            example = ", ".join(f"{key}: 0.{5 - k}" for k, key in enumerate(form))
            raise fail(f"{missing[0]} is missing, as in {{{example}}}")
    if "mu" in value:
        value["static"] = value["dynamic"] = value.pop("mu")
    return value
