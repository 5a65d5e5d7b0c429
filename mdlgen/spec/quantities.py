"""Quantities of a scene: numbers with a unit, or formulas, as texts are read into them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from pydantic import (
    GetCoreSchemaHandler,
    WithJsonSchema,
    WrapValidator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from mdlgen.spec.parameter import Computed, Unknown, amount, computed
from mdlgen.spec.strict import fail
from mdlgen.units import check_unit, exact_quantity, parse_quantity, parse_unit

# Allowed range of a quantity in the unit of its field, except 0: products of some of them stay finite.
SMALLEST, LARGEST = 1e-20, 1e20


class quantity:
    """Marks a float as text with a unit of the dimension of `unit`, stored in internal units.

    `Annotated[float, quantity("mm", 0.0)]` takes "1 mm" and refuses what is below 0 mm; `slip` is the
    factor of a likely mistake in the unit, for the hint "did you mean".
    """

    def __init__(
        self,
        unit: str,
        low: float | None = None,
        high: float | None = None,
        *,
        open_low: bool = False,
        slip: float | None = None,
    ):
        self.unit, self.low, self.high, self.open_low, self.slip = unit, low, high, open_low, slip

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        written = core_schema.plain_serializer_function_ser_schema(self.written)
        return core_schema.no_info_wrap_validator_function(
            _keeping(self.read), handler(source), serialization=written
        )

    def written(self, value: Any) -> Any:
        """A value, or a list of them, as a file has it: a text that reads back as the same."""
        if isinstance(value, (list, tuple)):
            return [self.written(item) for item in value]
        return exact_quantity(value, self.unit)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: Any) -> dict[str, Any]:
        limits = f"; {self.allowed()}" if self.low is not None else ""
        return {
            "type": "string",
            "description": f"number with a unit such as {self.unit}, or a formula{limits}",
            "examples": [f"1 {self.unit}"],
        }

    def read(self, text: Any) -> float:
        """The value in internal units, a Computed where it is a formula; raises the error that names the unit
        or range expected."""
        if isinstance(text, (Default, Computed)):
            return text
        value = _or_error(lambda: of_text(text, self.unit))
        size = abs(value) / parse_unit(self.unit).factor
        if value != 0.0 and not SMALLEST <= size <= LARGEST:
            raise fail(
                f"{text} cannot be computed with; allowed are 0 and {SMALLEST:g} to {LARGEST:g} {self.unit}"
            )
        too_low = self.low is not None and (value < self.low or (self.open_low and value == self.low))
        if too_low or (self.high is not None and value > self.high):
            raise fail(f"{text} is outside what is allowed: {self.allowed()}{self._meant(value)}")
        return value

    def allowed(self) -> str:
        """The range in words."""
        word = "more than" if self.open_low else "at least"
        if self.high is None:
            return f"{word} {self.low:g} {self.unit}"
        return f"{self.low:g} to {self.high:g} {self.unit}"

    def _meant(self, value: float) -> str:
        if self.slip is None:
            return ""
        for factor in (self.slip, 1.0 / self.slip):
            other = value * factor
            if self.low is not None and self.high is not None and self.low < other < self.high:
                return f". Did you mean {other:g} {self.unit}?"
        return ""


class one_or_two(quantity):
    """A quantity, or a list of two of them: a value for both MD and CD, or one for each."""

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: Any) -> dict[str, Any]:
        one = super().__get_pydantic_json_schema__(schema, handler)
        return {"anyOf": [one, {"type": "array", "minItems": 2, "maxItems": 2, "items": one}]}

    def read(self, text: Any) -> Any:
        """One value, or two, in internal units; raises as `quantity.read` does."""
        return _each(super().read, text, f"'1 {self.unit}'")


def _each(read: Callable[[Any], float], value: Any, example: str) -> float | tuple[float, float]:
    """The value that `read` returns for a value, or for each of two in a list."""
    if not isinstance(value, (list, tuple)):
        return read(value)
    if len(value) != 2:
        raise fail(
            f"expected one value like {example} or a list of two, MD and CD; got a list of {len(value)}"
        )
    found: list[float] = []
    for k, item in enumerate(value):
        try:
            found.append(read(item))
        except PydanticCustomError as error:
            raise fail(str((error.context or {})["text"]), within=(k,)) from None
    return found[0], found[1]


class ratio:
    """Marks a float from `low` to `high` as a plain number, or text in percent."""

    def __init__(self, low: float, high: float):
        self.low, self.high = low, high

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_wrap_validator_function(_keeping(self.read), handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: Any) -> dict[str, Any]:
        number = {"type": "number", "minimum": self.low, "maximum": self.high}
        return {"anyOf": [number, _PERCENT_OR_FORMULA]}

    def read(self, value: Any) -> float:
        """The plain number, a Computed where it is a formula; raises the error that names the range."""
        number = of_percent(_or_error(lambda: of_formula(value, "1")))
        allowed = f"allowed: {self.low:g} to {self.high:g}, as {(self.low + min(self.high, 1.0)) / 2:g}"
        if not is_number(number):
            comma = isinstance(value, str) and re.fullmatch(r"[0-9]+,[0-9]+( *%)?", value)
            meant = f"write {value.replace(',', '.')}; " if comma else ""
            raise fail(f"{value!r} is not a number or a percentage; {meant}{allowed}"[:200])
        if not self.low <= number <= self.high:
            raise fail(f"{value} is outside what is {allowed}"[:200])
        return number if isinstance(number, Computed) else float(number)


def _keeping(read: Callable[[Any], Any]) -> Callable[[Any, Callable[[Any], Any]], Any]:
    """A validator that lets a Computed pass as it is: pydantic makes a plain number of it."""

    def validate(value: Any, inner: Callable[[Any], Any]) -> Any:
        found = read(value)
        checked = inner(found)
        if isinstance(found, tuple):
            return tuple(f if isinstance(f, Computed) else c for f, c in zip(found, checked, strict=True))
        return found if isinstance(found, Computed) else checked

    return validate


def of_formula(value: Any, unit: str) -> Any:
    """A Computed of a text that is a formula of the dimension of `unit`; anything else as it is.

    Raises ValueError.
    """
    found = amount(value)
    if found is None:
        return value
    check_unit(value, found.dimension, unit)
    return computed(found.value, value)


def of_text(text: Any, unit: str) -> float:
    """The value of a text in internal units, a Computed where it is a formula. Raises ValueError."""
    found = of_formula(text, unit)
    return found if isinstance(found, Computed) else parse_quantity(found, unit)


def _or_error(read: Callable[[], Any]) -> Any:
    """The value that `read` returns, with its mistakes as errors for pydantic."""
    try:
        return read()
    except Unknown as error:
        raise PydanticCustomError("unknown", "{text}", {"text": str(error)}) from None
    except ValueError as error:
        raise fail(str(error)) from None


_PERCENT = re.compile(r"^[-+]?(?:[0-9]{1,18}(?:\.[0-9]{0,18})?|\.[0-9]{1,18}) *%$")


_PERCENT_OR_FORMULA = {"type": "string", "description": "a percentage or a formula", "examples": ["50 %"]}


def of_percent(value: Any) -> Any:
    """`30 %` as 0.3; any other value as it is."""
    if isinstance(value, str) and _PERCENT.match(value):
        return float(value.rstrip("% ")) / 100.0
    return value


def reading(text: Any, unit: str, otherwise: float) -> float:
    """A value that another one follows from, in internal units; `otherwise` where it cannot be read, which
    its own field reports."""
    if isinstance(text, Default):
        return float(text)
    try:
        return of_text(text, unit) or otherwise
    except ValueError:
        return otherwise


def combined(value: float, template: str, *parts: tuple[Any, str]) -> float:
    """A value that follows from others, for a field that `quantity` marks: a formula where one of its parts
    is one. Each part is what was given, and its unit; {0}, {1} stand for them in `template`."""
    if any(isinstance(part, Computed) or amount(part) is not None for part, _ in parts):
        texts = [_as_text(part, unit) for part, unit in parts]
        text = template.format(*(f"({text})" for text in texts))
        with suppress(ValueError):  # of a part with a mistake: its own field reports it
            found = amount(text)
            value = value if found is None else found.value  # to the last bit
        return computed(value, text)
    return following(value)


def _as_text(part: Any, unit: str) -> str:
    if isinstance(part, Computed):
        return part.formula
    return exact_quantity(part, unit) if isinstance(part, float) else str(part)


def following(value: float) -> Default:
    """A value that follows from others, for a field that `quantity` marks."""
    found = Default(value)
    found.text = ""
    return found


def numbers(low: float, high: float) -> tuple[WrapValidator, WithJsonSchema]:
    """One plain number, or a list of two, MD and CD, from `low` to `high`."""

    def read(value: Any) -> float:
        value = of_percent(_or_error(lambda: of_formula(value, "1")))
        if not is_number(value):
            raise fail(f"{value!r} is not a number; allowed are {low:g} to {high:g}"[:200])
        if not low <= value <= high:
            raise fail(f"{value:g} is outside what is allowed: {low:g} to {high:g}")
        return value if isinstance(value, Computed) else float(value)

    one = {"anyOf": [{"type": "number", "minimum": low, "maximum": high}, _PERCENT_OR_FORMULA]}
    example = f"{(low + high) / 2:g}"
    return WrapValidator(_keeping(lambda value: _each(read, value, example))), WithJsonSchema(
        {"anyOf": [*one["anyOf"], {"type": "array", "minItems": 2, "maxItems": 2, "items": one}]}
    )


class Default(float):
    """A default in internal units that remembers how a user would write it."""

    text: str


def default(text: str) -> float:
    """A default value like "1 mm/s", for fields that `quantity` marks."""
    number, _, unit = text.partition(" ")
    value = Default(parse_quantity(text, unit))
    value.text = f"{number} {unit}"
    return value


def is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
