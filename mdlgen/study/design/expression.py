"""Arithmetic over the numbers of a summary."""

from __future__ import annotations

import math
from typing import Any

from mdlgen import expressions
from mdlgen.errors import SpecError
from mdlgen.expressions import Expression as Expression
from mdlgen.expressions import Function, Grammar
from mdlgen.expressions import Value as Value


def _norm(vector: Any) -> float:
    if not isinstance(vector, (list, tuple)):
        raise ValueError("norm() takes a vector")
    return math.hypot(*vector)


_GRAMMAR = Grammar(
    functions={
        "abs": Function(abs),
        "sqrt": Function(math.sqrt),
        "min": Function(min, 2, math.inf),
        "max": Function(max, 2, math.inf),
        "norm": Function(_norm, of="vector"),
    },
    allowed="numbers, names, + - * / **, < <= > >= == !=, and, or, not, abs, sqrt, min, max, norm",
    logic=True,
)
MOST_CHARACTERS = _GRAMMAR.characters


def read(text: str, option: str) -> Expression:
    """The Expression of a text; `option` is what an error names. Raises SpecError."""
    try:
        return expressions.read(text, _GRAMMAR)
    except expressions.Refused as error:
        if len(text) > MOST_CHARACTERS:
            raise SpecError(f"{option}: {error}") from None
        raise SpecError(f"{option}: {text[:80]!r}: {error}; allowed are {_GRAMMAR.allowed}") from None
