"""Model -> the XML deck."""

from __future__ import annotations

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
from mdlgen.backends.motionsolve.writer import gate
from mdlgen.backends.motionsolve.writer.banner import banner
from mdlgen.backends.motionsolve.writer.environment import environment
from mdlgen.backends.motionsolve.writer.parts.kinds import WRITTEN
from mdlgen.backends.motionsolve.writer.views import deck_view
from mdlgen.errors import SpecError
from mdlgen.model.external import refuse_externals
from mdlgen.model.frictions import refuse_measured
from mdlgen.model.sheet_pairs import refuse_searched
from mdlgen.model.sticking import refuse_sticking
from mdlgen.model.tables import Model
from mdlgen.model.yielding import refuse_yield

_BUFFERED = 4096  # pieces of text that are joined at once: a large deck has millions


def check(model: Model) -> None:
    """Raises RefusedError, with the name, for features that the deck cannot represent."""
    refuse_externals(model, "MotionSolve deck")
    refuse_axles(model, "MotionSolve deck")
    refuse_passing(model, "MotionSolve deck")
    refuse_sticking(model, "MotionSolve deck")
    refuse_measured(model, "MotionSolve deck")
    refuse_yield(model, "MotionSolve deck")
    refuse_covers(model, "MotionSolve deck")
    refuse_rules(model, "MotionSolve deck")
    refuse_moving(model, "MotionSolve deck")
    refuse_searched(model, "MotionSolve deck")
    refuse_unwritten(model, WRITTEN, "MotionSolve deck")
    refuse_compressed(model, "MotionSolve deck")
    refuse_rolling(model, "MotionSolve deck")
    refuse_air(model, "MotionSolve deck")
    refuse_poisson(model, "MotionSolve deck")
    refuse_starts(model, "MotionSolve deck")


def emit(model: Model) -> str:
    """The whole deck, ASCII with LF line ends; the same Model always yields the same text.

    Raises RefusedError (see `check`), and SpecError where two names would meet in the deck.
    """
    check(model)
    deck = deck_view(model)
    gate.check(model, deck)
    stream = environment().get_template("deck.xml.j2").stream(deck=deck, banner=banner(model, deck))
    stream.enable_buffering(_BUFFERED)
    text = "".join(stream)
    if not text.isascii() or "\r" in text:
        raise SpecError("the deck would hold characters other than ASCII")
    return text
