"""Rules: what a machine does when a condition comes true."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, Field, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from mdlgen.conditions import condition
from mdlgen.spec.drive import AngularSpeed
from mdlgen.spec.fields import Name, Time, TimeOrZero
from mdlgen.spec.quantities import default, quantity
from mdlgen.spec.strict import Strict, fail


def _short(key: str):
    """A command that is written as its value alone."""

    def read(value: Any) -> Any:
        return value if isinstance(value, dict) else {key: value}

    return BeforeValidator(read)


def _names(value: Any) -> Any:
    return (value,) if isinstance(value, str) else value


class _OrText:
    """For the JSON schema of what may be written as one text alone."""

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"type": "string"}, handler(core)]}


OR_TEXT = _OrText()


class ToSpeed(Strict):
    """A speed that a drive goes to."""

    speed: AngularSpeed | None = Field(
        default=None, description="angular speed about the roller's axis (right-hand rule)"
    )
    surface_speed: Annotated[float, quantity("mm/s", 0.0)] | None = Field(
        default=None,
        description="in place of speed: that of the surface, in the sense in which the drive turns by itself",
    )
    ramp: TimeOrZero = Field(default=default("0 ms"), description="time that it takes, linear")

    @model_validator(mode="after")
    def _one(self) -> ToSpeed:
        if (self.speed is None) == (self.surface_speed is None):
            raise fail("give exactly one of speed and surface_speed")
        return self


class ToPlace(Strict):
    """A place that a gate goes to."""

    model_config = ConfigDict(populate_by_name=True)

    to: str = Field(description="a name of its `positions`, or a place, as 20 deg or 4 mm")
    in_: Time = Field(
        default=default("5 ms"), alias="in", description="time that it takes; it stands at the end of it"
    )


class Action(Strict):
    """Actions of a rule: any of these, at once."""

    speed: dict[str, Annotated[ToSpeed, _short("speed"), OR_TEXT]] = Field(
        default_factory=dict,
        description="drives by roller, pattern, nip or shaft, and the speed that each goes to: "
        "{entry: 0 rad/s} or {entry: {surface_speed: 300 mm/s, ramp: 5 ms}}",
    )
    press: dict[str, Annotated[float, quantity("N")]] = Field(
        default_factory=dict,
        description="rollers or planes with `press`, and the force of the spring where it touches: "
        "below 0 N it lifts; or nips, and the force with which each roller presses the sheet",
    )
    torque: dict[str, Annotated[float, quantity("N*mm")]] = Field(
        default_factory=dict,
        description="rollers on an arm, and the torque of the arm's spring in its place at the start",
    )
    move: dict[str, Annotated[ToPlace, _short("to"), OR_TEXT]] = Field(
        default_factory=dict,
        description="guides, planes and meshes with a prescribed `pivot` or `slide`, and the place that each "
        "goes to: {gate: open} or {gate: {to: 20 deg, in: 8 ms}}",
    )
    enter: Annotated[tuple[str, ...], BeforeValidator(_names), OR_TEXT] = Field(
        default=(),
        strict=False,
        description="streams, or sheets, with `by_rule`: the next sheet of each comes in",
    )
    go: Name | None = Field(
        default=None,
        description="state that the machine goes to, see `in`; in one that no `in` names, only rules "
        "without `in` hold",
    )
    end: bool = Field(default=False, description="true: the run ends well, at the next stored time")

    @model_validator(mode="after")
    def _something(self) -> Action:
        given = (self.speed, self.press, self.torque, self.move, self.enter, self.go, self.end)
        if not any(given):
            raise fail("a rule has to do something: speed, press, torque, move, enter, go or end")
        return self


class Rule(Strict):
    """Acts each time a condition becomes true. A condition that is true as the run begins acts then."""

    model_config = ConfigDict(populate_by_name=True)

    when: str = Field(
        description="a condition: exit covered, count(exit) == 3, gap(entry) < 20 mm, time > 30 ms, "
        "note.x > 120 mm, note_3 left, left(infeed) == 20, with and, or, not"
    )
    after: TimeOrZero = Field(default=default("0 ms"), description="time from then until it acts")
    once: bool = Field(default=False, description="true: only the first time")
    in_: Annotated[tuple[Name, ...], BeforeValidator(_names), OR_TEXT] = Field(
        default=(),
        strict=False,
        alias="in",
        description="state or states of the machine in which the rule holds; all if left out. The machine "
        "begins in the first one of the first rule that has `in` or `go`; where that rule has `go` alone, it "
        "begins in no state, and rules without `in` hold until it goes to one",
    )
    do: Action = Field(description="what it does")

    @model_validator(mode="after")
    def _reads(self) -> Rule:
        try:
            condition(self.when)
        except ValueError as error:
            raise fail(str(error), within=("when",)) from None
        return self
