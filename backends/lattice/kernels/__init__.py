"""All compiled code of this solver, imported in one place so that it is cached by its content."""

from __future__ import annotations

from pathlib import Path

from mdlgen.mechanics import keep_compiled_code
from mdlgen.mechanics.compiling import go_on_unkept

go_on_unkept()
keep_compiled_code(Path(__file__).resolve().parent)

from backends.lattice import (  # noqa: E402
    alone,
    balance,
    band,
    border,
    chain,
    coupled,
    dense,
    forces,
    growth,
    image,
    march,
    momentum,
    observe,
    search,
    sides,
    step,
    stiffness,
    tangent,
    touching,
)

keep_compiled_code()

__all__ = [
    "alone",
    "balance",
    "band",
    "border",
    "chain",
    "coupled",
    "dense",
    "forces",
    "growth",
    "image",
    "march",
    "momentum",
    "observe",
    "search",
    "sides",
    "step",
    "stiffness",
    "tangent",
    "touching",
]
