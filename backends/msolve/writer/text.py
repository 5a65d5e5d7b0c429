"""Model -> the script."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.air import refuse_air
from mdlgen.altair.axles import refuse_axles
from mdlgen.altair.covers import refuse_covers
from mdlgen.altair.moving import refuse_moving
from mdlgen.altair.parts import refuse_unwritten
from mdlgen.altair.poisson import refuse_poisson
from mdlgen.altair.reactions import refuse_rules
from mdlgen.altair.rolling import refuse_rolling
from mdlgen.altair.springs import refuse_compressed
from mdlgen.altair.starts import refuse_starts
from mdlgen.altair.statics import static_method
from mdlgen.altair.streams import refuse_passing
from mdlgen.backends.msolve.environment import environment
from mdlgen.backends.msolve.writer import contacts, gate, sheets
from mdlgen.backends.msolve.writer.banner import banner
from mdlgen.backends.msolve.writer.bodies import moves, spins, stops
from mdlgen.backends.msolve.writer.parts.kinds import MACHINE, WRITTEN
from mdlgen.backends.msolve.writer.units import acceleration, per_thousand, row
from mdlgen.errors import SpecError
from mdlgen.model.external import refuse_externals
from mdlgen.model.frictions import refuse_measured
from mdlgen.model.parameters.run import longest_step
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.sticking import refuse_sticking
from mdlgen.model.tables import Model
from mdlgen.model.yielding import refuse_yield

# The smallest step that MotionView writes [s]; a smaller largest step needs a smaller one.
_H_MIN, _STEPS = 1e-6, 100.0
_ERROR = 1e-3  # of the integrator, as MotionView writes it


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the script cannot represent."""
    who = "MotionSolve script"
    refuse_externals(model, who)
    refuse_axles(model, who)
    refuse_passing(model, who)
    refuse_sticking(model, who)
    refuse_measured(model, who)
    refuse_yield(model, who)
    refuse_covers(model, who)
    refuse_rules(model, who)
    refuse_moving(model, who)
    refuse_searched(model, who)
    refuse_unwritten(model, WRITTEN, who)
    refuse_compressed(model, who)
    refuse_rolling(model, who)
    refuse_air(model, who)
    refuse_poisson(model, who)
    refuse_starts(model, who)


def tables(model: Model) -> dict[str, Any]:
    """The values of the script by name; a table of which a scene has nothing is empty."""
    grids, listed = sheets.sheets(model)
    return {
        "NAME": model.name,
        "GRAVITY": row(model.gravity, acceleration),
        "RUN": _run(model),
        "CURVES": sheets.curves(model),
        "SHEETS": grids,
        "LISTED": listed,
        **{
            of.variable: {part.name: of.kind.table(model, part) for part in model.parts_of(of.part)}
            for of in MACHINE
        },
        "SPINS": spins(model),
        "MOVES": moves(model),
        "STOPS": stops(model),
        "SUPPORTS": sheets.supports(model),
        "LOADS": sheets.loads(model),
        "FACTORS": sheets.load_factors(model),
        "PROBES": sheets.probes(model),
        "CONTACTS": contacts.contacts(model),
        "FORCES": contacts.forces(model),
    }


def emit(model: Model) -> str:
    """The whole script, ASCII with LF line ends; the same Model always yields the same text.

    Raises RefusedError (see `check`), and SpecError where two names would meet in the script.
    """
    check(model)
    values = tables(model)
    gate.check(model, values)
    there = {name for name, value in values.items() if value}
    template = environment().get_template("script.py.j2")
    text = template.render(
        **values,
        values=values,
        name=model.name,
        banner=banner(model),
        tables=there,
        machine=MACHINE,
        static="end" not in values["RUN"],
    )
    if not text.isascii() or "\r" in text:
        raise SpecError("the script would hold characters other than ASCII")
    return text


def _run(model: Model) -> dict[str, Any]:
    """Times and steps [s] of a transient run; of a static one whether it is by MKEAM, for contacts."""
    run = model.run
    if run.analysis == "static":
        return {"skip_mkeam": static_method(model) != "MKEAM"}
    h_max = per_thousand(longest_step(run))
    return {
        "end": per_thousand(run.duration),
        "dtout": per_thousand(run.print_step),
        "error": _ERROR,
        "hmax": h_max,
        "hmin": min(_H_MIN, float(f"{h_max / _STEPS:.15g}")),
    }
