"""The functions that expressions of real files and of the reference use. Angles are in radians."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from mdlgen.backends.motionview.reader.operators import named, shown
from mdlgen.backends.motionview.reader.report import Trouble

if TYPE_CHECKING:
    from mdlgen.backends.motionview.reader.scope import Scope

Function = Callable[["Scope", Sequence[Any], int], Any]


def _numbers(name: str, values: Sequence[Any], count: int | None, shift: int) -> list[float]:
    if count is not None and len(values) != count:
        raise Trouble("function", f"{name} takes {count} values, not {len(values)}", shift)
    for value in values:
        if not isinstance(value, (bool, float)):
            raise Trouble("evaluate", f"{name} takes numbers, not {named(value)}", shift)
    return [float(v) for v in values]


def _of_numbers(name: str, count: int | None, function: Callable[..., float]) -> Function:
    def run(scope: Scope, values: Sequence[Any], shift: int) -> float:
        numbers = _numbers(name, values, count, shift)
        try:
            value = float(function(*numbers))
        except (ValueError, OverflowError, ZeroDivisionError, TypeError):
            text = ", ".join(shown(n) for n in numbers)
            raise Trouble("evaluate", f"{name}({text}) has no value", shift) from None
        if not math.isfinite(value):
            raise Trouble("evaluate", f"{name} gives no finite number here", shift)
        return value

    return run


def _trigonometric(name: str, function: Callable[[float], float]) -> Function:
    plain = _of_numbers(name, 1, function)

    def run(scope: Scope, values: Sequence[Any], shift: int) -> float:
        if len(values) == 1 and isinstance(values[0], float) and abs(values[0]) > 2 * math.pi + 1e-9:
            scope.world.remark_angle(name, values[0])
        return plain(scope, values, shift)

    return run


def _mag(scope: Scope, values: Sequence[Any], shift: int) -> float:
    if len(values) != 1:
        raise Trouble("function", f"mag takes one vector, not {len(values)} values", shift)
    return math.hypot(*scope.world.vector(values[0]))


def _length(scope: Scope, values: Sequence[Any], shift: int) -> float:
    if len(values) == 1 and isinstance(values[0], (str, tuple)):
        return float(len(values[0]))
    raise Trouble("function", "length takes one text or vector", shift)


def _strstr(scope: Scope, values: Sequence[Any], shift: int) -> float:
    """Place of the second text in the first, -1 where it does not."""
    if len(values) != 2 or not all(isinstance(v, str) for v in values):
        raise Trouble("function", "strstr takes two texts", shift)
    return float(values[0].find(values[1]))


def _getenv(scope: Scope, values: Sequence[Any], shift: int) -> str:
    """Stays as it is written: a text must not depend on the machine that reads it."""
    if len(values) != 1 or not isinstance(values[0], str):
        raise Trouble("function", "getenv takes one text", shift)
    return f"${{{values[0]}}}"


def _loc_rel_to(scope: Scope, values: Sequence[Any], shift: int) -> tuple[float, ...]:
    """Global coordinates of a point given in the axes of a marker."""
    if len(values) != 2:
        raise Trouble("function", f"loc_rel_to takes a vector and a marker, not {len(values)} values", shift)
    world = scope.world
    a, b, c = world.vector(values[0])
    (x, y, z), (ax, ay, az) = world.frame(values[1], shift)
    return tuple([o + a * p + b * q + c * r for o, p, q, r in zip((x, y, z), ax, ay, az, strict=True)])


def _eval(scope: Scope, values: Sequence[Any], shift: int) -> Any:
    if len(values) != 1 or not isinstance(values[0], str):
        raise Trouble("function", "eval takes one text", shift)
    return scope.world.evaluated(values[0], scope, shift)


FUNCTIONS: dict[str, Function] = {
    **{name: _trigonometric(name, getattr(math, name)) for name in ("sin", "cos", "tan")},
    **{
        name: _of_numbers(name, 1, getattr(math, name))
        for name in ("sqrt", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "floor", "ceil")
    },
    "abs": _of_numbers("abs", 1, math.fabs),
    "ln": _of_numbers("ln", 1, math.log),
    "log": _of_numbers("log", 1, math.log),
    "log10": _of_numbers("log10", 1, math.log10),
    "int": _of_numbers("int", 1, lambda v: float(math.trunc(v))),
    "atan2": _of_numbers("atan2", 2, math.atan2),
    "mod": _of_numbers("mod", 2, math.fmod),
    "max": _of_numbers("max", None, lambda *v: max(v)),
    "min": _of_numbers("min", None, lambda *v: min(v)),
    "mag": _mag,
    "length": _length,
    "strlen": _length,
    "strstr": _strstr,
    "getenv": _getenv,
    "loc_rel_to": _loc_rel_to,
    "eval": _eval,
}
