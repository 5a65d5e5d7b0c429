"""The error of a run in each of its quantities, estimated from runs of the same scene at coarser steps.

The difference of two runs is the error of the coarser one where errors fall with the step; in contact they
often do with its first power only. So the estimate is the difference times a safety factor. A third run shows
how errors fall: where differences do not, they say little, and where they grow, or are a large part of the
scale, there is no estimate. Those of a trajectory that stay far below the least that is estimated of it may
grow. The factors come from a study of random scenes (`tests/results/test_estimates_study.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from mdlgen.model.nips import facets
from mdlgen.results.audit import MOST, made_by_nips
from mdlgen.results.quantities import Difference, differences
from mdlgen.results.result import INACCURATE, OK
from mdlgen.results.wording import percent

if TYPE_CHECKING:
    from mdlgen.results.result import Result

# Safety factors on the difference of the last two runs. SAFETY: a trajectory, which the tolerance judges.
# SAFETY_REST: forces, peaks, speeds and probes, for which two runs agree by accident more often.
SAFETY, SAFETY_REST = 2.0, 4.0
# Times that again where boxes are too long to follow a roller: they rattle in its nip, and runs at several
# steps may share an error.
FACETS = 4.0
# Ratio of two successive differences of a method of second order: the error is at least this part of
# `before`.
SECOND_ORDER = 0.25
# Ratios of the difference before the last to the last one. Below FALLS (an order of about a third)
# differences do not fall; below GROWS they grow.
FALLS, GROWS = 1.25, 0.5
# Factor on the greater of two differences that do not fall.
STILL = 4.0
# An error above MOST of the scale is not estimated: such differences do not say how large it is. For
# trajectories that only two runs judge the limit is MOST_OF_TWO. Where steps do not resolve a contact, both
# runs may be wrong by more than they differ.
MOST_OF_TWO = 0.02
# Parts of the tolerance below which nothing is estimated. Without contacts: of trajectories; of forces and
# peaks. With contacts, whose first touch may fall into another step: of trajectories; of forces and peaks.
# The tolerance judges trajectories, slides and arms too: there a floor above 1 would fail every run.
FREE, FREE_PEAKS, TOUCHING, TOUCHING_PEAKS = 1e-6, 1e-3, 1e-2, 3.0
# The same of trajectories where sheets that bend touch something: they flutter.
FLUTTERING = 0.25
# The same from two runs alone: both may miss what a nip does by more than they differ, and no third one shows
# it. An arm that presses a sheet was off by 0.62 of the tolerance where two runs differed by 0.12 of it.
FLUTTERING_OF_TWO = 0.75
# Part of the root mean square over like quantities of a scene: a single one may agree by accident.
ALIKE = 0.5
# How a result says that its error may be of any size.
NOT_KNOWN = "the error is not known"
SAME_STEPS = "the solver divided the steps of all runs to the same, so that nothing was compared"
# Least error of a pair's means, as a part of that of its greatest force: short touches change the time in
# contact.
OF_GREATEST = 0.25


@dataclass(frozen=True)
class Estimate:
    """Error of one quantity relative to `scale` [`unit`]; None where there is no estimate."""

    value: float | None
    scale: float
    unit: str
    judged: float | None = None  # scale by which run.tolerance judges it; None: it does not
    # true if the two runs agree to less than the value, which is then the least that is estimated of such a
    # quantity: the error is below it, and how far is not known
    below: bool = False


def between(runs: Sequence[Result], judged: bool = False) -> dict[str, Estimate]:
    """Estimates by name for the first of up to three runs, each at half the step of the next one.

    All quantities, or only those that `run.tolerance` judges. A quantity without an estimate has the value
    None. Where the run only checks another one (`Result.checks`), the quantities that are judged have the
    plain difference.
    """
    result, found = runs[0], {}
    after = differences(result, runs[1], judged) if len(runs) > 1 else {}
    if not after:  # there is no other run, or it ended elsewhere
        known = differences(result, result, judged)
        return {name: Estimate(None, q.scale, q.unit, q.judged) for name, q in known.items()}
    before = differences(runs[1], runs[2], judged) if len(runs) > 2 else {}
    touching = any(run.touched for run in runs)
    faceted = FACETS if any(facets(result.model)) else 1.0
    for name, last in after.items():
        there = before.get(name)
        earlier = None if there is None else there.value * there.scale / last.scale
        judged = last.judged is not None
        asked = judged and result.checks
        safety, times = (1.0, 1.0) if asked else (_safety(last), faceted)
        part = MOST_OF_TWO if judged and not asked and len(runs) == 2 else MOST
        most = part * (last.judged or last.scale) / last.scale
        value = rule(times * last.value, earlier and times * earlier, safety, judged, most)
        least = result.model.run.tolerance * _floor(last, touching, runs)
        if value is None and judged and times * STILL * max(last.value, earlier or 0.0) <= least:
            value = least
        found[name] = Estimate(value, last.scale, last.unit, last.judged)
        found[name] = _at_least(found[name], least)
    return _pooled(found)


def _safety(of: Difference) -> float:
    return SAFETY if of.judged is not None or of.kind == "contacts.force" else SAFETY_REST


def _floor(of: Difference, touching: bool, runs: Sequence[Result]) -> float:
    result = runs[0]
    if of.judged is not None or of.kind in ("probes.displacement", "rollers.omega", "sensors.times"):
        bends = any(sheet.count > 1 for sheet in result.model.sheets)
        # of one that checks another the difference itself is asked for
        flutters = FLUTTERING_OF_TWO if len(runs) == 2 and not result.checks else FLUTTERING
        return (flutters if bends else TOUCHING) if touching else FREE
    return TOUCHING_PEAKS if touching else FREE_PEAKS


def rule(last: float, before: float | None, safety: float, judged: bool, most: float = MOST) -> float | None:
    """The estimate from the difference to the coarser run, and that of it to the next (None: two runs)."""
    if before is None or last == 0.0:
        found = safety * last
    elif before < GROWS * last:
        return None
    elif before < FALLS * last:
        found = STILL * max(last, before)
    else:
        # Remainder of a geometric series, and a safety factor. A third run that comes much closer leaves a
        # trajectory's difference as it is; a peak's may still agree by accident.
        left = last / (before / last - 1.0)
        found = max(last, SAFETY * left) if judged else max(safety * last, left)
        found = max(min(found, STILL * before), SECOND_ORDER * before)
    return found if found <= most else None


def _pooled(estimates: dict[str, Estimate]) -> dict[str, Estimate]:
    """None is below a part of the root mean square of all of its kind."""
    groups: dict[str, list[float]] = {}
    for name, found in estimates.items():
        if found.value is not None:
            groups.setdefault(_alike(name), []).append(found.value**2)
    least = {kind: ALIKE * (sum(squares) / len(squares)) ** 0.5 for kind, squares in groups.items()}
    pooled = _raised(estimates, lambda name: least.get(_alike(name), 0.0))
    return _raised(pooled, partial(_related, pooled))


def _raised(estimates: dict[str, Estimate], least: Callable[[str], float]) -> dict[str, Estimate]:
    """None is below the least value for its name."""
    return {name: _at_least(found, least(name)) for name, found in estimates.items()}


def _at_least(estimate: Estimate, least: float) -> Estimate:
    """The same, or the least value where that is as much: the error is below it."""
    if estimate.value is None or estimate.value > least:
        return estimate
    return replace(estimate, value=least, below=True) if least > 0.0 else estimate


def _alike(name: str) -> str:
    """All peaks of joints are alike; else what has the same kind of part and the same last word."""
    head, _, rest = name.partition(".")
    peak = any(f".{kind}." in name for kind in ("strain", "curvature", "twist", "residual"))
    return f"{head}.peaks" if peak else f"{head}.{rest.rpartition('.')[2]}"


def _related(estimates: dict[str, Estimate], name: str) -> float:
    """Least error of a quantity that follows from other quantities. A pair's means change together with the
    time that it touches, and follow its greatest force; a probe is carried by a sheet."""
    if name.endswith((".mean_force", ".mean_penetration")):
        pair = name.rpartition(".")[0]
        means = [_value(estimates, f"{pair}.mean_{what}") for what in ("force", "penetration")]
        return max(*means, OF_GREATEST * _value(estimates, f"{pair}.max_force"))
    if name.startswith("probes."):
        carried = (
            e for key, e in estimates.items() if key.startswith("sheets.") and key.endswith(".position")
        )
        scale = estimates[name].scale
        return min(((e.value or 0.0) * e.scale / scale for e in carried), default=0.0)
    return 0.0


def _value(estimates: dict[str, Estimate], name: str) -> float:
    found = estimates.get(name)
    return 0.0 if found is None or found.value is None else found.value


def headline(estimates: Mapping[str, Estimate]) -> tuple[float | None, str | None]:
    """The worst of the estimates that `run.tolerance` judges, by their scales for it, and its name.

    One that is not known is worse than any. (None, None) where there are none.
    """
    worst, of = None, None
    for name, found in estimates.items():
        if found.judged is None:
            continue
        if found.value is None:
            return None, name
        value = found.value * found.scale / found.judged
        if worst is None or value > worst:
            worst, of = value, name
    return worst, of


def taken(result: Result, coarser: Result) -> bool:
    """True if a run took so many more steps than another that the two can be compared.

    A solver divides steps that do not converge. If both runs are divided to the same steps, their difference
    says nothing. Let errors fall with the first power of the step. Then the error of the finer run is at most
    SAFETY times the difference if the steps of the coarser are at least 1 + 1 / SAFETY times as long. A run
    without a count of steps is accepted.
    """
    if not result.steps or not coarser.steps:
        return True
    return result.steps >= (1.0 + 1.0 / SAFETY) * coarser.steps


def open_yet(result: Result) -> bool:
    """True if two runs cannot show that `run.tolerance` is met, but a third run may."""
    worst, tolerance = result.error_estimate, result.model.run.tolerance
    return len(result.coarser) == 1 and worst is not None and worst > tolerance >= worst / SAFETY


def unlike(result: Result, coarser: Result) -> str | None:
    """Name of a quantity that `run.tolerance` judges and in which the two runs differ too much to estimate
    the error, with the difference; None: there is no such quantity."""
    known = between([result, coarser], judged=True)
    for name, found in differences(result, coarser, judged=True).items():
        if known[name].judged is not None and known[name].value is None:
            return f"{name} by {100.0 * found.value * found.scale / (found.judged or found.scale):.1f} %"
    return None


def estimated(result: Result, coarser: Sequence[Result]) -> Result:
    """The same result with its headline, and with the coarser runs from which `complete` finds the rest.

    Only those runs are compared that took longer steps, see `taken`. Where there is none, nothing is known of
    the error, which `error_unknown` says.
    """
    runs = [result]
    for run in coarser:
        if taken(runs[-1], run):
            runs.append(run)
    known = between(runs, judged=True)
    value, name = headline(known)
    same = f"{NOT_KNOWN}: {SAME_STEPS}" if coarser and len(runs) == 1 else ""
    return replace(
        result,
        error_estimate=value,
        error_estimate_of=name,
        error_below=name is not None and known[name].below,
        error_unknown=same,
        coarser=tuple(runs[1:]),
        estimates={},
    )


def by_finer(result: Result, finer: Result) -> Result:
    """The same result with an error estimated from a run at finer steps. The difference of the two is that
    error, apart from the error of the finer run. If that run took as many steps, nothing is known."""
    if not taken(finer, result):
        return replace(estimated(result, []), error_unknown=f"{NOT_KNOWN}: {SAME_STEPS}")
    known = between([result, finer], judged=True)
    value, name = headline(known)
    below = name is not None and known[name].below
    return replace(
        result,
        error_estimate=value,
        error_estimate_of=name,
        error_below=below,
        error_unknown="",
        coarser=(finer,),
        estimates={},
    )


def within(result: Result) -> bool:
    """True if the error of a complete run by its step is known to be within `run.tolerance`."""
    known = result.error_estimate
    return known is not None and known <= result.model.run.tolerance and not result.error_unknown


def marked(result: Result) -> Result:
    """A complete run with its status: OK where its error is known to be within `run.tolerance`, else
    INACCURATE, with the reason where there is no estimate, or where nips made energy."""
    if not result.usable:
        return result
    known = result.error_estimate
    nips = made_by_nips(result.energy)
    if nips is not None and not result.error_unknown:
        result = replace(result, error_unknown=f"{NOT_KNOWN}: {nips}")
    if known is None and not result.error_unknown:
        why = f"{result.error_estimate_of} does not come closer as steps are halved"
        if len(result.coarser) == 1:
            why = f"{result.error_estimate_of} of two runs differs by much, and no third run was compared"
        elif not result.coarser:
            why = "nothing was compared"
        result = replace(result, error_unknown=f"{NOT_KNOWN}: {why}")
    return replace(result, status=OK if within(result) else INACCURATE)


def accuracy(result: Result) -> str:
    """How accurate a complete run is, in a line: its estimate compared with the tolerance, or why that is not
    known."""
    tolerance = f"run.tolerance {percent(result.model.run.tolerance)}"
    if result.error_unknown or result.error_estimate is None:
        text = result.error_unknown or "no error estimate"
    else:
        below = "below " if result.error_below else ""
        above = "above" if result.error_estimate > result.model.run.tolerance else "within"
        text = f"the error estimate of {result.error_estimate_of} is {below}{percent(result.error_estimate)}"
        text += f", {above} {tolerance}"
    return f"{text}; {result.search_ended}" if result.search_ended else text


def complete(result: Result) -> dict[str, Estimate]:
    """All estimates of a result by name: those that were loaded with it, or those from its coarser runs,
    which are then released. Without either, each is None."""
    if not result.estimates and len(result.time) > 1:
        result.estimates = between([result, *result.coarser])
        result.coarser = ()
    return result.estimates
