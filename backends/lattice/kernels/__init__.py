"""All compiled code of this solver: whoever imports a part of it comes by here first, so that all of it is
kept by its content."""

from __future__ import annotations

from pathlib import Path

from mdlgen.mechanics import keep_compiled_code

keep_compiled_code("lattice", Path(__file__).resolve().parent)

from backends.lattice.kernels import (  # noqa: E402
    alone,
    balance,
    band,
    border,
    chain,
    coupled,
    damped,
    dense,
    forces,
    growth,
    image,
    march,
    momentum,
    observe,
    search,
    sides,
    slopes,
    step,
    stiffness,
    tangent,
    touching,
    two_sets,
)

keep_compiled_code()

__all__ = [
    "alone",
    "balance",
    "band",
    "border",
    "chain",
    "coupled",
    "damped",
    "dense",
    "forces",
    "growth",
    "image",
    "march",
    "momentum",
    "observe",
    "search",
    "sides",
    "slopes",
    "step",
    "stiffness",
    "tangent",
    "touching",
    "two_sets",
]
