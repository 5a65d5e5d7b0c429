"""All shapes, by the names of their classes; each module of this package is found."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from mdlgen.backends.msolve.reader import shapes
from mdlgen.backends.msolve.reader.shapes.kind import Shape

_FILES = sorted(file.name for file in iter_modules(shapes.__path__) if file.name not in ("kind", "kinds"))
_FOUND: tuple[Shape, ...] = tuple(import_module(f"{shapes.__name__}.{name}").SHAPE for name in _FILES)
SHAPES = {shape.name: shape for shape in _FOUND}
