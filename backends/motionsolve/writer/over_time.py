"""Values over time as expressions of the solver: linear between corners, constant beyond them."""

from __future__ import annotations

from itertools import pairwise

from mdlgen.backends.motionsolve.writer.units import number, per_thousand
from mdlgen.model.tables import Floats


def linear(times: list[str], values: list[str]) -> str:
    """The sum of terms, one for each piece between two corners."""
    parts = [values[0]]
    for (t, w), (t_end, w_end) in pairwise(zip(times, values, strict=True)):
        parts.append(f"({w_end}-({w}))*MAX(0,1-MAX(0,({t_end}-TIME)/({t_end}-{t})))")
    return "+".join(parts)


def load_factor(corners: Floats) -> str:
    """The factor of a load with corners [ms, 1], (n, 2)."""
    times, factors = corners.T.tolist()
    return linear([per_thousand(t) for t in times], [number(f) for f in factors])
