"""What a run costs, before it is run, and lints of what makes it cost so much.

Fitted to the samples on one core of some 3 GHz, with all that the solver lattice runs: the coarser runs from
which the error is estimated, too. Of 13 transient samples that take 0.25 s or more, processor time was 0.5 to
1.8 times what is said here, and 3.1 and 3.2 times in `channel` and `spring_plate`, whose steps take more
iterations. Where two processors run two passes at a time, a run takes about two thirds of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from mdlgen.lints.lint import Lint
from mdlgen.model.tables import Model

START, START_OF_A_BOX = 0.1, 5e-4  # [s]
STEP, STEP_OF_A_BOX, STEP_OF_A_PAIR = 10e-6, 0.8e-6, 0.6e-6  # [s]
MANY_BOXES = 2000.0  # with so many a step takes twice what it does by their number alone
STATIC_BOX = 2e-3  # [s], of a static run
# The step that a run begins with at a tolerance of 1e-3 [ms]; it goes with the root of the tolerance. It is
# halved until the estimate is within the tolerance: for sheets in contact mostly to a sixth.
FIRST_STEP, PARTS_AT_LEAST, HALVED, HALVED_IN_CONTACT = 0.2, 20, 2.0, 6.0
LONG, MANY_TIMES = 60.0, 4.0  # [s]: below, nothing is said
USUAL_TOLERANCE, USUAL_OUTPUTS, USUAL_DURATION, USUAL_BOXES = 1e-3, 200, 1000.0, 500


@dataclass(frozen=True)
class Cost:
    """Of one run: wall time [s] and steps in time, 0 of a static run."""

    seconds: float
    steps: int

    def __str__(self) -> str:
        return duration(self.seconds) + (
            f", some {float(f'{self.steps:.1g}'):.0f} steps" if self.steps else ""
        )


@dataclass(frozen=True)
class _Size:
    """What a cost follows from; times in ms."""

    duration: float
    outputs: float
    tolerance: float
    step: float | None
    boxes: int
    pairs: int
    contact: bool  # of sheets of more than one box

    def cost(self) -> Cost:
        """Of a transient run."""
        step = self.step
        if step is None:
            first = min(FIRST_STEP * math.sqrt(self.tolerance / 1e-3), self.duration / PARTS_AT_LEAST)
            step = first / (HALVED_IN_CONTACT if self.contact else HALVED)
        steps = max(self.duration / step, self.outputs, 1.0)
        each = STEP + STEP_OF_A_BOX * self.boxes + STEP_OF_A_PAIR * self.pairs
        many = 1.0 + self.boxes / MANY_BOXES
        return Cost(START + START_OF_A_BOX * self.boxes + steps * each * many, math.ceil(steps))


def cost(model: Model) -> Cost | None:
    """What a run of lattice costs; None for a static run with contacts, of which little is known."""
    if model.run.analysis == "static":
        if len(model.pairs):
            return None
        return Cost(START + STATIC_BOX * sum(sheet.count for sheet in model.sheets), 0)
    return _size(model).cost()


def _size(model: Model) -> _Size:
    run, counts = model.run, {sheet.name: sheet.count for sheet in model.sheets}
    searched = (int(row) for row in model.pairs.searched)
    beside = sum(counts[model.contacts.part_a[row]] + counts[model.contacts.part_b[row]] for row in searched)
    return _Size(
        duration=run.duration,
        outputs=run.duration / run.print_step,
        tolerance=run.tolerance,
        step=run.step,
        boxes=sum(counts.values()),
        pairs=len(model.pairs) + beside,
        contact=len(model.pairs) > 0 and max(counts.values()) > 1,
    )


def costly(model: Model) -> Iterator[Lint]:
    """The one value that makes a long run so long."""
    if model.run.analysis == "static":
        return
    size = _size(model)
    whole = size.cost().seconds
    if whole < LONG:
        return
    others = [(replace(size, duration=min(size.duration, USUAL_DURATION)), "run.duration", "1 s")]
    others.append((replace(size, outputs=USUAL_OUTPUTS), "run.print_step", f"{USUAL_OUTPUTS} outputs"))
    if size.step is not None:
        others.append((replace(size, step=None), "run.step", "the step that follows from the tolerance"))
    elif size.tolerance < USUAL_TOLERANCE:
        others.append((replace(size, tolerance=USUAL_TOLERANCE), "run.tolerance", f"{USUAL_TOLERANCE:g}"))
    largest = max(model.sheets, key=lambda sheet: sheet.count)
    if largest.count > USUAL_BOXES:
        boxes = size.boxes - largest.count + USUAL_BOXES
        fewer = replace(size, boxes=boxes, pairs=math.ceil(size.pairs * boxes / size.boxes))
        others.append((fewer, f"sheets.{largest.name}.boxes", f"{USUAL_BOXES} boxes"))
    best, where, instead = min(others, key=lambda other: other[0].cost().seconds)
    if best.cost().seconds * MANY_TIMES <= whole:
        yield Lint(
            "W134",
            where,
            f"this value makes the run take {duration(whole)}; with {instead} it would be "
            f"{duration(best.cost().seconds)}",
            "change it, unless it is meant",
        )


def duration(seconds: float) -> str:
    """A time in one digit, two from ten on, with its unit."""
    if seconds < 1.0:
        return "less than 1 s"
    units = ((1.0, "s", 90.0), (60.0, "min", 5400.0), (3600.0, "h", 172800.0), (86400.0, "days", math.inf))
    size, unit = next((size, unit) for size, unit, end in units if seconds < end)
    value = seconds / size
    return f"about {float(f'{value:.{1 if value < 9.5 else 2}g}'):g} {unit}"
