"""The way from some designs to a better one: scipy for few smooth ones, Optuna for noisy or discrete.

A design is a point of the unit cube, of which each coordinate runs from the least to the greatest value of a
variable; what a run at it came to is an Outcome.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mdlgen.errors import RefusedError, SpecError, did_you_mean
from mdlgen.study.design.distribution import Choice, Distribution

METHODS = ("auto", "brent", "cobyqa", "optuna")
# Where the best value is known, as a part of its range.
PRECISION = 1e-3
# First steps of COBYQA, as a part of each range.
_FIRST_STEP = 0.25
# COBYQA begins so far from the middle: conditions in round numbers pass through the middle itself. Rounding
# then decides whether they hold, and the search ended next to the best point.
_OFF_MIDDLE = 0.0137
# Where conditions hold only within round-off, it may still end next to the best point, depending on how a
# machine rounds sums. It then restarts next to the best point that it found, on the other side, with steps of
# this part, until that point stays the best; at most so often.
_CLOSER, _BEGUN = 0.25, 3
# Designs that Optuna draws before it learns from them.
_AT_RANDOM = 8
# So often may Optuna ask for a design that is known already, for each run.
_ASKED_AGAIN = 20

Variables = Sequence[Distribution | Choice]


@dataclass(frozen=True)
class Outcome:
    """The value of a run: its objective, and how much each condition is missed by (0 or less: it holds)."""

    objective: float
    margins: tuple[float, ...]


Evaluate = Callable[[list[tuple[float, ...]]], list[Outcome]]


class Enough(Exception):
    """The allowed number of runs has been used up."""


def method(asked: str, variables: Variables, conditions: int) -> str:
    """The method by name. Raises SpecError for one that does not go with the variables, RefusedError where
    Optuna is asked for and not installed."""
    if asked not in METHODS:
        close = did_you_mean(asked, METHODS) or f"; there are: {', '.join(METHODS)}"
        raise SpecError(f"--method: there is no {asked[:40]!r}{close}")
    discrete = [variable.path for variable in variables if isinstance(variable, Choice)]
    if asked in ("brent", "cobyqa") and discrete:
        raise SpecError(f"--method {asked}: {discrete[0]} has a list of values; --method optuna takes lists")
    if asked == "brent" and (len(variables) > 1 or conditions):
        raise SpecError("--method brent: is for one variable without conditions; cobyqa takes more")
    if asked == "auto":
        asked = "optuna" if discrete else "brent" if len(variables) == 1 and not conditions else "cobyqa"
    if asked == "optuna":
        _optuna()
    return asked


def brent(evaluate: Evaluate, precision: float) -> None:
    """Brent's method between bounds, for one variable without conditions."""
    from scipy.optimize import minimize_scalar

    def objective(at: float) -> float:
        return evaluate([(float(at),)])[0].objective

    minimize_scalar(objective, bounds=(0.0, 1.0), method="bounded", options={"xatol": precision})


def cobyqa(evaluate: Evaluate, size: int, conditions: int, precision: float) -> None:
    """COBYQA (Ragonneau and Zhang, 2022): quadratic models from values alone, in a region of trust that
    shrinks from a quarter of the ranges to `precision`; begins near the middle, and with conditions again
    where it has ended."""
    from scipy.optimize import NonlinearConstraint, minimize

    known: dict[tuple[float, ...], Outcome] = {}

    def outcome(at: Any) -> Outcome:
        point = tuple(float(v) for v in at)
        if point not in known:
            known[point] = evaluate([point])[0]
        return known[point]

    limits = []
    if conditions:
        limits = [
            NonlinearConstraint(lambda at: np.array(outcome(at).margins), -np.inf, np.zeros(conditions))
        ]
    aside, best, radius = _OFF_MIDDLE * (-1.0) ** np.arange(size), (0.5,) * size, _FIRST_STEP
    for _ in range(_BEGUN if conditions else 1):
        minimize(
            lambda at: outcome(at).objective,
            np.clip(best + aside, 0.0, 1.0),
            method="COBYQA",
            bounds=[(0.0, 1.0)] * size,
            constraints=limits,
            options={"initial_tr_radius": radius, "final_tr_radius": precision},
        )
        holds = [point for point, found in known.items() if max(found.margins, default=0.0) <= 0.0]
        before, best = best, min(holds, key=lambda point: known[point].objective, default=best)
        if best == before:
            return
        aside, radius = -aside, _CLOSER * radius


def optuna(evaluate: Evaluate, variables: Variables, seed: int, most: int, together: int) -> None:
    """Optuna's tree-structured Parzen estimator, which takes lists of values and bears noise; `together`
    designs are asked for at a time."""
    study_of = _optuna()

    sampler = study_of.samplers.TPESampler(seed=seed, n_startup_trials=_AT_RANDOM, constant_liar=together > 1)
    study = study_of.create_study(sampler=sampler)
    for _ in range(_ASKED_AGAIN * most):
        trials = [study.ask() for _ in range(together)]
        outcomes = evaluate([tuple(_suggested(trial, v) for v in variables) for trial in trials])
        for trial, outcome in zip(trials, outcomes, strict=True):
            for k, margin in enumerate(outcome.margins):
                trial.set_constraint(f"condition {k}", margin)
            study.tell(trial, outcome.objective)


def _suggested(trial: Any, variable: Distribution | Choice) -> float:
    if isinstance(variable, Choice):
        places = list(range(len(variable.texts)))
        # the middle of its part of the unit interval
        return (trial.suggest_categorical(variable.path, places) + 0.5) / len(places)
    return trial.suggest_float(variable.path, 0.0, 1.0)


def _optuna() -> Any:
    try:
        import optuna
    except ImportError:
        raise RefusedError(
            '--method optuna needs Optuna, which is not installed: python -m pip install "mdlgen[optuna]"'
        ) from None
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    return optuna
