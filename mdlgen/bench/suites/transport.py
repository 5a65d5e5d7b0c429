"""The paper's note between four pairs of rollers (section 4.1) over the step, against a converged run."""

from __future__ import annotations

import numpy as np

from mdlgen.bench.case import BenchCase, Finding, Reference, Run
from mdlgen.bench.peers import PEERS, SHEETS, PeerRun
from mdlgen.bench.peers import STEPS as PEER_STEPS
from mdlgen.registry import REFERENCE
from mdlgen.results.compare import compare, scale, travel
from mdlgen.results.result import Result

SAMPLE = "transport_4x4"
# Steps [ms]; exudyn's shorter list because its time is minutes. The reference's step, per solver: below a
# tenth of the finest step that is measured, but for exudyn, which would take an hour.
STEPS = {REFERENCE: (0.1, 0.05, 0.025)}
OTHER_STEPS = (0.25, 0.125, 0.0625, 0.025)
FINEST = {REFERENCE: 0.0125}
OTHER_FINEST = 0.002
QUICK = ("run.duration=4 ms", "run.print_step=0.1 ms")
GRIDS = ((10, 20), (20, 30))
# A nip that carries less than this part of the largest mean force is left out of the comparison.
GRAZE = 0.05


def cases(solver: str, reference: str, quick: bool) -> list[BenchCase]:
    """Every step and the solver's own choice; the paper's finer grid at the solver's choice."""
    steps = STEPS.get(solver, OTHER_STEPS)
    made = []
    for grid in GRIDS[:1] if quick else GRIDS:
        sets = (f"sheets.note.boxes=[{grid[0]},{grid[1]}]", *(QUICK if quick else ()))
        fine = FINEST.get(reference, OTHER_FINEST)
        exact = Reference(Run(SAMPLE, sets, fine if grid == GRIDS[0] else 2 * fine), reference)
        if solver in PEERS:
            run, peer_steps = PeerRun(SAMPLE, sets, quick=quick), PEER_STEPS[solver]
            case = BenchCase("transport", SHEETS[solver], run, peer, exact)
            return [case.at(step) for step in (peer_steps[-1:] if quick else peer_steps)]
        name = f"{grid[0]} x {grid[1]} boxes"
        chosen = BenchCase("transport", f"{name}, step chosen", Run(SAMPLE, sets), promised, exact)
        made.append(chosen)
        if grid == GRIDS[0]:
            forced = BenchCase("transport", f"{name}, step given", chosen.run, forced_step, exact)
            made += [forced.at(step) for step in (steps[:2] if quick else steps)]
    # another solver's grid of 600 boxes costs minutes and adds nothing to the comparison
    return made if solver != REFERENCE else [case for case in made if "20 x 30" not in case.name]


def promised(result: Result, reference: Result | None) -> list[Finding]:
    """Errors of a run that chose its step for `run.tolerance`."""
    return _findings(result, reference, result.model.run.tolerance)


def forced_step(result: Result, reference: Result | None) -> list[Finding]:
    """Errors of a run whose step was given: no tolerance was promised."""
    return _findings(result, reference, None)


def peer(result: Result, reference: Result | None) -> list[Finding]:
    """Errors of another tool: its sheet is its own, so that of the mean displacement stands by itself."""
    position, _ = _findings(result, reference, None)
    assert reference is not None
    # a tool may store other times than the reference
    moved, exact = (
        np.array([travel(run, at=k) for k in range(len(run.time))]) for run in (result, reference)
    )
    apart = [moved[:, k] - np.interp(result.time, reference.time, exact[:, k]) for k in range(3)]
    mean = float(np.sqrt(np.mean(np.square(apart).sum(axis=0))))
    return [position, Finding("mean displacement, RMS over time, over the travel", mean / scale(result))]


def _findings(result: Result, reference: Result | None, tolerance: float | None) -> list[Finding]:
    assert reference is not None, "the cases of transport have one"
    found = compare(result, reference)
    mean = {
        f"{a} / {b}": float(result.contact_force[:, row].mean())
        for row, (a, b) in enumerate(
            zip(result.model.contacts.part_a, result.model.contacts.part_b, strict=True)
        )
    }
    carried = [row for row in found.nip_force if mean[row] > GRAZE * max(mean.values())]
    return [
        Finding(
            "position, RMS over boxes and time, over the travel",
            found.relative,
            tolerance,
            {"position_max_mm": found.position_max_mm, "travel_difference_mm": found.travel_difference_mm},
        ),
        Finding(
            "nip force, mean difference over mean force, worst nip",
            max((found.nip_force[row] for row in carried), default=0.0),
        ),
    ]
