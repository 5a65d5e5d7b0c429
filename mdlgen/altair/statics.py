"""Settings of MotionSolve for a state of rest."""

from __future__ import annotations

from mdlgen.model.tables import Model

# With the values that MotionView writes.
_IMBALANCE = (
    ("max_error", "0.0001"),
    ("max_imbalance", "0.0001"),
    ("stability", "1.0000E-10"),
)
_ENERGY = (("max_ke_tol", "1.0000E-05"), ("max_dq_tol", "0.001"))
_MOST_ITERATIONS = ("max_num_iter", "75")


def static_method(model: Model) -> str:
    """MKEAM for a model with contacts: no force imbalance method supports them (documented)."""
    return "MKEAM" if len(model.pairs) else "FIM_D"


def static_settings(model: Model) -> list[tuple[str, str]]:
    """Attributes of the Param_Static command for its method."""
    method = static_method(model)
    return [("method", method), *(_ENERGY if method == "MKEAM" else _IMBALANCE), _MOST_ITERATIONS]
