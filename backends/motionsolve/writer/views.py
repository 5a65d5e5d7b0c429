"""Model -> the rows that the main template loops over."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.bodies import add_bodies, add_frames
from mdlgen.backends.motionsolve.writer.contacts import add_contacts
from mdlgen.backends.motionsolve.writer.machine import add_machine
from mdlgen.backends.motionsolve.writer.rows import Deck, Run
from mdlgen.backends.motionsolve.writer.sheets import add_bushings, add_loads, add_probes, add_surfaces
from mdlgen.backends.motionsolve.writer.units import acceleration, number, per_thousand
from mdlgen.model.tables import Model

# The longest step where nothing else is said: the paper's, in the Model's unit [ms].
_PAPER_STEP = 0.01
# The smallest step that MotionView writes [s]; a smaller largest step needs a smaller one.
_H_MIN, _STEPS = 1e-6, 100.0


def deck_view(model: Model) -> Deck:
    """All rows of a Model."""
    x, y, z = (acceleration(g) for g in model.gravity.tolist())
    deck = Deck((x, y, z), _run(model))
    add_frames(deck, model)
    add_bodies(deck, model)
    add_machine(deck, model)
    add_bushings(deck, model)
    add_surfaces(deck, model)
    add_probes(deck, model)
    add_loads(deck, model)
    add_contacts(deck, model)
    return deck


def _run(model: Model) -> Run:
    """Of the force imbalance methods none takes contacts (documented), so MKEAM solves those."""
    run = model.run
    h_max = per_thousand(run.step if run.step is not None else min(_PAPER_STEP, run.print_step))
    return Run(
        static=run.analysis == "static",
        method="MKEAM" if len(model.pairs) else "FIM_D",
        end=per_thousand(run.duration),
        print=per_thousand(run.print_step),
        h_max=h_max,
        h_min=number(min(_H_MIN, float(h_max) / _STEPS)),
    )
