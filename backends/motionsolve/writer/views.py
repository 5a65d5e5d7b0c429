"""Model -> the rows that the main template loops over."""

from __future__ import annotations

from mdlgen.altair.statics import static_method
from mdlgen.backends.motionsolve.writer.bodies import add_bodies, add_frames
from mdlgen.backends.motionsolve.writer.contacts import add_contacts
from mdlgen.backends.motionsolve.writer.machine import add_machine
from mdlgen.backends.motionsolve.writer.requests import add_forces
from mdlgen.backends.motionsolve.writer.rows import Deck, Run
from mdlgen.backends.motionsolve.writer.sheets import add_bushings, add_loads, add_probes, add_surfaces
from mdlgen.backends.motionsolve.writer.units import acceleration, number, per_thousand
from mdlgen.model.parameters.run import longest_step
from mdlgen.model.tables import Model

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
    add_forces(deck, model)
    return deck


def _run(model: Model) -> Run:
    run = model.run
    h_max = per_thousand(longest_step(run))
    return Run(
        static=run.analysis == "static",
        method=static_method(model),
        end=per_thousand(run.duration),
        print=per_thousand(run.print_step),
        h_max=h_max,
        h_min=number(min(_H_MIN, float(f"{float(h_max) / _STEPS:.15g}"))),
    )
