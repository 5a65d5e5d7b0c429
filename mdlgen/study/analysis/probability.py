"""How often something happens under scatter, and how sure that is after so many cases."""

from __future__ import annotations

from dataclasses import dataclass

from mdlgen.errors import SpecError

LEVEL = 0.95


@dataclass(frozen=True)
class Probability:
    """Probability of an event: it happened in `hits` of `known` cases; `failed` cases do not count.

    `low` and `high` hold the true value with the probability `level` at least, where cases are independent.
    """

    hits: int
    known: int
    failed: int
    level: float
    low: float
    high: float

    @property
    def value(self) -> float:
        """Part of the cases with an answer in which it happened; nan without any."""
        return self.hits / self.known if self.known else float("nan")


def probability(hits: int, known: int, failed: int = 0, level: float = LEVEL) -> Probability:
    """The interval of Clopper and Pearson (Biometrika 26, 1934): of all probabilities with which so few or so
    many hits are no rarer than (1 - level)/2 on either side.

    A failed case could have gone either way, so the lower end counts all of them as misses and the upper end
    as hits. Raises SpecError for counts that cannot be.
    """
    if not 0 <= hits <= known or failed < 0 or not 0.0 < level < 1.0:
        raise SpecError(f"{hits} hits of {known} cases and {failed} failed, level {level:g}: cannot be")
    from scipy.stats import beta

    tail, cases = 0.5 * (1.0 - level), known + failed
    most = hits + failed
    low = float(beta.ppf(tail, hits, cases - hits + 1)) if hits else 0.0
    high = float(beta.ppf(1.0 - tail, most + 1, cases - most)) if most < cases else 1.0
    return Probability(hits, known, failed, level, low, high)


def caveat(kind: str) -> str:
    """The caveat about the interval for cases that were drawn in this way; "" for independent ones."""
    if kind == "random":
        return ""
    if kind in ("lhs", "sobol"):
        return (
            f"the cases of --sample {kind} are spread evenly, not drawn one by one: mostly their part is "
            "nearer to the probability than the interval says, but only --sample random is sure of it"
        )
    return f"the cases of a {kind} are not drawn at random: this is a share of the cases, not a probability"
