"""Named values of a scene, and quantities that are formulas over them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from mdlgen import formulas
from mdlgen.formulas import Amount
from mdlgen.units import is_unit, parse_number, parse_unit, same

MOST = 1000  # parameters
MOST_BEHIND = 50  # one follows from another, which follows from another
RANGED = {"value", "range"}  # keys of a parameter with the range of its slider
_PLAIN = re.compile(r"[-+]?[0-9]{1,18}(?:\.[0-9]{0,18})?(?: *%)?")
Path = tuple[str | int, ...]


class Computed(float):
    """A value in internal units that a formula came to, with its text."""

    formula: str


def computed(value: float, text: str) -> Computed:
    found = Computed(value)
    found.formula = text
    return found


class Unknown(ValueError):
    """A formula over a parameter that has a mistake itself, which is reported where it stands."""


class Parameters:
    """Values of all parameters, and the errors of those that have no value.

    One is given as a value, or as `{value: 3 N, range: [1 N, 5 N]}`: the range is that of its slider.
    """

    def __init__(self, given: Mapping[Any, Any]):
        self.given = {name: _plain(item) for name, item in given.items()}
        self.amounts: dict[str, Amount] = {}
        self.errors: dict[str, ValueError] = {}
        for name in given:
            self._find(name, ())
        # of a parameter that follows from a wrong one the mistake is reported there
        self.own = {name: str(e) for name, e in self.errors.items() if not isinstance(e, Unknown)}
        self.ranges: dict[str, tuple[float, float]] = {}  # in internal units
        self.wrong_ranges: dict[str, str] = {}
        for name, item in given.items():
            if name in self.amounts and _is_ranged(item):
                try:
                    self.ranges[name] = self._range(name, item["range"])
                except ValueError as error:
                    self.wrong_ranges[name] = str(error)

    def evaluated(self, text: str) -> Amount:
        """The value of a formula. Raises ValueError."""
        try:
            wrong = [name for name in formulas.names(text) if name in self.errors]
        except ValueError:
            wrong = []
        if wrong:
            raise Unknown(f"the parameter {wrong[0]} has no value")
        return formulas.evaluated(text, self.amounts)

    def _range(self, name: str, ends: Any) -> tuple[float, float]:
        """The ends of the slider of a parameter. Raises ValueError."""
        if not isinstance(ends, list) or len(ends) != 2:
            raise ValueError(f"{ends!r} is not a range"[:200] + "; write like [1 N, 5 N]")
        low, high = (self._amount_of(end, name, ()) for end in ends)
        for end in (low, high):
            if not same(end.dimension, self.amounts[name].dimension):
                raise ValueError(f"the range has {end.unit}, its value {self.amounts[name].unit}")
        if not low.value < high.value:
            raise ValueError("the first value of a range is below the second")
        return low.value, high.value

    def _find(self, name: Any, users: tuple[str, ...]) -> None:
        """The value of one, after those that it follows from."""
        if name in self.amounts or name in self.errors:
            return
        try:
            self.amounts[name] = self._amount(name, users)
        except ValueError as error:
            self.errors[name] = error

    def _amount(self, name: Any, users: tuple[str, ...]) -> Amount:
        value = self.given[name]
        if message := _taken(name):
            raise ValueError(message)
        if len(users) > MOST_BEHIND:
            raise ValueError(f"{name} follows from more than {MOST_BEHIND} others, one behind the other")
        return self._amount_of(value, name, users)

    def _amount_of(self, value: Any, name: str, users: tuple[str, ...]) -> Amount:
        """The amount that a given value of that parameter stands for."""
        if isinstance(value, Amount):
            return value
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return Amount(float(value), formulas.NONE)
        if not isinstance(value, str):
            raise ValueError(f"{value!r} is not a value"[:200] + "; write like 3 N, 0.3 or a formula")
        if _PLAIN.fullmatch(value):
            return Amount(float(value.rstrip("% ")) * (0.01 if "%" in value else 1.0), formulas.NONE)
        if not formulas.is_formula(value, self.given):
            number, unit = parse_number(value)
            return Amount(number, parse_unit(unit).dimension)
        for other in formulas.names(value):
            if other in (*users, name):
                around = (*users, name)[(*users, name).index(other) :]
                raise ValueError(f"{' -> '.join((*around, other))[:200]}: it follows from itself")
            if other in self.given:
                self._find(other, (*users, name))
        return self.evaluated(value)


def _is_ranged(item: Any) -> bool:
    return isinstance(item, dict) and set(item) == RANGED


def _plain(item: Any) -> Any:
    """The value of a parameter without its range."""
    return item["value"] if _is_ranged(item) else item


def _taken(name: object) -> str:
    """Why a parameter may not have a name; "" where it may."""
    if not isinstance(name, str):
        return ""
    kind = "a unit" if is_unit(name) else "a function" if name in formulas.GRAMMAR.functions else ""
    return f"{name} is the name of {kind}; give the parameter another, as {name}_1" if kind else ""


NO_PARAMETERS = Parameters({})
_OF_SCENE: ContextVar[Parameters] = ContextVar("parameters", default=NO_PARAMETERS)


@contextmanager
def of_scene(parameters: Parameters) -> Iterator[None]:
    """While the values of a scene are read, its parameters are those."""
    token = _OF_SCENE.set(parameters)
    try:
        yield
    finally:
        _OF_SCENE.reset(token)


def current() -> Parameters:
    """Those of the scene that is being read."""
    return _OF_SCENE.get()


def amount(text: object) -> Amount | None:
    """The value of a text that is a formula; None where it is none. Raises ValueError."""
    return _OF_SCENE.get().evaluated(text) if isinstance(text, str) and is_formula(text) else None


def is_formula(text: str) -> bool:
    """True if a text is meant as a formula in the scene that is being read."""
    return formulas.is_formula(text, _OF_SCENE.get().given)


def _text_or_number(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        raise PydanticCustomError(
            "spec",
            "{text}",
            {
                "text": f"{value!r} is not a value"[:160]
                + "; write like 3 N, or {value: 3 N, range: [1 N, 5 N]}",
                "path": None,
            },
        )
    return value


ParameterValue = Annotated[
    str | int | float,
    BeforeValidator(_text_or_number),
    WithJsonSchema(
        {
            "anyOf": [
                {
                    "type": "string",
                    "description": "number with a unit, or a formula over other parameters",
                    "examples": ["3 N", "speed/2"],
                },
                {"type": "number"},
                {
                    "type": "object",
                    "description": "a value, and the range of its slider in mdlgen live",
                    "required": ["value", "range"],
                    "additionalProperties": False,
                    "properties": {
                        "value": {"type": ["string", "number"]},
                        "range": {
                            "type": "array",
                            "items": {"type": ["string", "number"]},
                            "minItems": 2,
                            "maxItems": 2,
                            "examples": [["1 N", "5 N"]],
                        },
                    },
                },
            ]
        }
    ),
]


def formulas_of(owner: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Paths of the values of a scene that are formulas, and their texts."""
    if isinstance(owner, Computed):
        yield path, owner.formula
    elif isinstance(owner, BaseModel):
        for name, field in type(owner).model_fields.items():
            yield from formulas_of(getattr(owner, name), (*path, field.alias or name))
    elif isinstance(owner, dict):
        for name, value in owner.items():
            yield from formulas_of(value, (*path, name))
    elif isinstance(owner, tuple):
        for index, value in enumerate(owner):
            yield from formulas_of(value, (*path, index))


def without_formulas(owner: Any) -> Any:
    """The same with plain numbers; what holds no formula is the same object."""
    if isinstance(owner, Computed):
        return float(owner)
    if isinstance(owner, BaseModel):
        changed = {}
        for name in type(owner).model_fields:
            value = getattr(owner, name)
            plain = without_formulas(value)
            if plain is not value:
                changed[name] = plain
        return owner.model_copy(update=changed) if changed else owner
    if isinstance(owner, dict):
        made = {name: without_formulas(value) for name, value in owner.items()}
        return made if any(made[name] is not owner[name] for name in owner) else owner
    if isinstance(owner, tuple):
        items = [without_formulas(value) for value in owner]
        return tuple(items) if any(a is not b for a, b in zip(items, owner, strict=True)) else owner
    return owner
