"""What the solver records, as the text's outputs have it."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.ids import GLOBAL_FRAME
from mdlgen.backends.motionsolve.writer.rows import Deck


def add_request(deck: Deck, name: str, label: str, quantities: str, markers: list[int]) -> None:
    """Six quantities in global axes; the mean over the markers where there are several."""
    deck.request(name, label, [_mean(quantity, markers) for quantity in quantities.split()])


def _mean(quantity: str, markers: list[int]) -> str:
    terms = "+".join(f"{quantity}({marker},{GLOBAL_FRAME},{GLOBAL_FRAME})" for marker in markers)
    return f"({terms})/{len(markers)}" if len(markers) > 1 else terms
