"""Predicts the cost of a run before it starts, and lints of the inputs that make it expensive.

The cost counts boxes, pairs of bodies by kind, cells of air, steps, stored states, sensors and rules. It is
fitted to the samples and to some of them on other grids and at other tolerances. It holds for one core of
some 3 GHz and the solver lattice with all its runs, coarser ones for the error estimate included.

The processor time of 19 transient samples was 0.54 to 2.0 times the prediction. On other grids and at other
tolerances it was 0.2 to 5 times. The reason: the step is halved until the estimate is within the tolerance,
and how often is not known ahead. Two processors run two passes at a time and take about two thirds of it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from mdlgen.lints.lint import Lint
from mdlgen.mechanics.film_grid import film_grids
from mdlgen.model.parts.kinds import KINDS
from mdlgen.model.passing import passing, share
from mdlgen.model.tables import BOX_BOX, Model

START = 4e-3  # [s]
# Times outside the kernels [s]: of each stored state; of each step of a machine with rules, which is checked
# for an early end, and more for each sensor and each rule; of each step with sheets that come and go. Fitted
# to the samples stall, rubber_nip, register, sorter and stream. Their processor time is 0.5 to 1.9 times the
# prediction where that of transport_tilted is 1.
OUTPUT, LOOK, SENSOR, RULE, PASSING = 0.2e-3, 0.05e-3, 0.02e-3, 0.01e-3, 0.08e-3
PASSES = 1.8  # time of all passes over that of the last one
# Times of one step [s]. BAND counts for each box times the square of the number of boxes on the shorter side
# of its sheet: a factor of its joints takes so long.
STEP, BOX, BAND = 6e-6, 0.03e-6, 2.1e-9
PAIR, CURVED, LAID = 0.26e-6, 1.06e-6, 0.8e-6  # with a roller or a plane, a guide or a mesh, another sheet
MOST_LAID = 4  # of such pairs a box touches so many at a time
AIR = 6e-6  # each cell of a film, between 1 and 15 as it is between free sheets or in a nip
STATIC_BOX, STATIC_BAND = 4e-5, 1e-7  # [s], of a static run
# The step of blocks, or without contacts, at a tolerance of 1e-3 [ms]; it goes with the tolerance's root.
FIRST_STEP, PARTS_AT_LEAST, HALVED = 0.2, 20, 2.0
# Divisors of that step. FINER: sheets in contact need a smaller one. PRESSED: a spring-loaded plate, on which
# they chatter, needs a still smaller one. BY_TOLERANCE: exponent of the step in tolerances below 1e-3.
FINER, PRESSED, BY_TOLERANCE = 3.7, 2.7, 1.27
LONG, MANY_TIMES = 60.0, 4.0  # [s]: below, nothing is said
USUAL_TOLERANCE, USUAL_OUTPUTS, USUAL_DURATION, USUAL_BOXES = 1e-3, 200, 1000.0, 500


@dataclass(frozen=True)
class Cost:
    """Cost of one run: wall time [s] and steps in time, 0 of a static run."""

    seconds: float
    steps: int

    def __str__(self) -> str:
        return duration(self.seconds) + (
            f", some {float(f'{self.steps:.1g}'):.0f} steps" if self.steps else ""
        )


@dataclass(frozen=True)
class _Size:
    """Quantities that determine the cost; times in ms."""

    duration: float
    outputs: float
    tolerance: float
    step: float | None
    boxes: int
    band: float  # boxes, each times the square of those on the shorter side of its sheet
    plain: int  # pairs
    curved: int
    laid: int
    cells: int  # of all films of air
    contact: bool  # of sheets of more than one box
    pressed: bool  # a plate
    watched: float  # what sensors, rules, and sheets that come and go take of each step [s]

    def cost(self) -> Cost:
        """Cost of a transient run."""
        steps = max(self.duration / (self.step or self._step()), self.outputs, 1.0)
        laid = min(self.laid, MOST_LAID * self.boxes)
        each = self.watched + STEP + BOX * self.boxes + BAND * self.band
        each += PAIR * self.plain + CURVED * self.curved + LAID * laid + AIR * self.cells
        return Cost(START + PASSES * (steps * each + self.outputs * OUTPUT), math.ceil(steps))

    def _step(self) -> float:
        """Approximate step that the search for a step ends at [ms]."""
        strict = self.tolerance / 1e-3
        if not self.contact:
            return min(FIRST_STEP * math.sqrt(strict), self.duration / PARTS_AT_LEAST) / HALVED
        first = min(FIRST_STEP * min(strict, 1.0) ** BY_TOLERANCE, self.duration / PARTS_AT_LEAST)
        return first / (FINER * (PRESSED if self.pressed else 1.0))


def cost(model: Model) -> Cost | None:
    """Cost of a run of lattice; None for a static run with contacts, which cannot be predicted well."""
    if model.run.analysis == "static":
        if len(model.pairs):
            return None
        boxes, band = _boxes(model)
        return Cost(START + STATIC_BOX * boxes + STATIC_BAND * band, 0)
    return _size(model).cost()


def _boxes(model: Model) -> tuple[int, float]:
    """Boxes, and what their factors take."""
    sheets = model.sheets
    return sum(s.count for s in sheets), float(sum(s.count * min(s.n_x, s.n_y) ** 2 for s in sheets))


def _size(model: Model) -> _Size:
    run, counts = model.run, {sheet.name: sheet.count for sheet in model.sheets}
    searched = (int(row) for row in model.pairs.searched)
    beside = sum(counts[model.contacts.part_a[row]] + counts[model.contacts.part_b[row]] for row in searched)
    kinds = model.contacts.kind[model.pairs.contact].tolist()
    curved, laid = sum(kinds.count(kind.with_sheet) for kind in KINDS if kind.curved), kinds.count(BOX_BOX)
    boxes, band = _boxes(model)
    part = share(model)
    size = _Size(
        duration=run.duration,
        outputs=run.duration / run.print_step,
        tolerance=run.tolerance,
        step=run.step,
        boxes=boxes,
        band=band,
        plain=len(kinds) - curved - laid,
        curved=curved,
        laid=laid + beside,
        cells=len(film_grids(model).cells),
        contact=len(model.pairs) + beside > 0 and max(counts.values()) > 1,
        pressed=any(plane.press is not None for plane in model.planes),
        watched=_watched(model),
    )
    if part == 1.0:
        return size
    counted = {
        name: math.ceil(part * getattr(size, name)) for name in ("boxes", "plain", "curved", "laid", "cells")
    }
    return replace(size, band=part * size.band, **counted)


def _watched(model: Model) -> float:
    """What Python does at each step [s]."""
    of, found = model.reactions, PASSING if passing(model) else 0.0
    return found + (LOOK + SENSOR * len(of.sensors) + RULE * len(of.rules) if of.rules else 0.0)


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
        part = boxes / size.boxes
        pairs = {name: math.ceil(getattr(size, name) * part) for name in ("plain", "curved", "laid")}
        fewer = replace(size, boxes=boxes, band=size.band * part**2, **pairs)
        others.append((fewer, f"sheets.{largest.name}.boxes", f"{USUAL_BOXES} boxes"))
    if size.cells:
        table = model.contacts
        row = int(np.flatnonzero(table.air_viscosity > 0.0)[0])
        others.append((replace(size, cells=0), f"contacts.{table.called(row)}.air", "no air"))
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
