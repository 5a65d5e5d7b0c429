"""Model -> .mdl text."""

from __future__ import annotations

from dataclasses import replace

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
from mdlgen.altair.streams import refuse_passing
from mdlgen.backends.motionview.writer import gate
from mdlgen.backends.motionview.writer.banner import banner
from mdlgen.backends.motionview.writer.contacts import force_views
from mdlgen.backends.motionview.writer.environment import environment
from mdlgen.backends.motionview.writer.notes import notes
from mdlgen.backends.motionview.writer.parts.kinds import WRITTEN
from mdlgen.backends.motionview.writer.system import system_view
from mdlgen.backends.motionview.writer.views import scene_view
from mdlgen.errors import SpecError
from mdlgen.model.external import refuse_externals
from mdlgen.model.frictions import refuse_measured
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.sticking import refuse_sticking
from mdlgen.model.tables import Model
from mdlgen.model.yielding import refuse_yield

TARGETS = ("2021", "2025")
"""Versions of MotionView whose form of Contact is written. Which one changed it is not known."""


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the text cannot represent."""
    refuse_externals(model, "MotionView text of the whole scene")
    refuse_axles(model, "MotionView text")
    refuse_passing(model, "MotionView text")
    check_sheets(model)
    refuse_compressed(model, "MotionView text")
    refuse_rolling(model, "MotionView text")
    refuse_starts(model, "MotionView text")


def check_sheets(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the text of the sheets cannot represent."""
    refuse_sticking(model, "MotionView text")
    refuse_measured(model, "MotionView text")
    refuse_yield(model, "MotionView text")
    refuse_covers(model, "MotionView text")
    refuse_rules(model, "MotionView text")
    refuse_moving(model, "MotionView text")
    refuse_searched(model, "MotionView text")
    refuse_air(model, "MotionView text")
    refuse_poisson(model, "MotionView text")
    refuse_unwritten(model, WRITTEN, "MotionView text")


def emit(
    model: Model,
    *,
    set_contact: bool = False,
    only: str | None = None,
    target: str = TARGETS[0],
    forces: bool = False,
) -> str:
    """The .mdl text, ASCII with LF line ends; the same Model always yields the same text.

    `set_contact` also writes the contact numbers with SetContact, whose argument order is documented but
    not seen in a file; without it they are set by the companion script. `only="sheets"` gives the sheets
    alone, as a system definition to bring into another model.

    `forces` also records the force of each contact of two parts, as the deck does: a sum over its pairs of
    the solver's CONTACT, with ids of contacts, which no file shows in an output.

    `target` is the version of MotionView: 2021 has a word for each graphic of a Contact, whether its normals
    are flipped, which 2025 documents without.

    Raises RefusedError (see `check`), and SpecError where two names would meet in the text.
    """
    if target not in TARGETS:
        raise SpecError(f"there is no target {target[:80]!r}; there are: {', '.join(TARGETS)}")
    if only is not None:
        check_only(only)
        if forces:
            raise SpecError(
                "forces of contacts are recorded in the whole text, not in that of the sheets alone"
            )
        return _sheets(model, set_contact, target)
    check(model)
    gate.check_names(model)
    scene = replace(scene_view(model, set_contact), target=target)
    if forces:
        scene = replace(scene, forces=force_views(model, scene.pairs))
    text = environment().get_template("model.mdl.j2").render(scene=scene, banner=banner(model, scene))
    gate.check_text(text)
    return text


def check_only(word: str) -> None:
    """Raises SpecError for a part of the text that cannot stand alone."""
    if word != "sheets":
        raise SpecError(f"{word[:80]!r} cannot be written alone; there is: sheets")


def _sheets(model: Model, set_contact: bool, target: str) -> str:
    check_sheets(model)
    gate.check_names(model)
    system = system_view(model, set_contact)
    system = replace(system, scene=replace(system.scene, target=target))
    gate.check_free(system.variable)
    template = environment().get_template("system.mdl.j2")
    text = template.render(system=system, scene=system.scene, banner=notes(model, system))
    gate.check_text(text)
    return text
