"""Base class for the properties of a shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from mdlgen.backends.msolve.forms import Form


class Shape(NamedTuple):
    """A class of msolve, its form, and what of one of its objects is read."""

    name: str
    form: Form
    record: Callable[[Any], dict[str, Any]]
