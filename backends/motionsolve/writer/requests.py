"""Requests for the quantities that the solver records, as in the outputs of the MDL file."""

from __future__ import annotations

from mdlgen.altair.recorded import called, recorded
from mdlgen.altair.rims import meetings
from mdlgen.backends.motionsolve.writer.ids import GLOBAL_FRAME, body_id
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import Model

# The force of a contact along x, y and z, and its torque about them, as the solver's CONTACT counts them.
_COMPONENTS = (2, 3, 4, 6, 7, 8)


def add_request(deck: Deck, name: str, label: str, quantities: str, markers: list[int]) -> None:
    """Six quantities in global axes; the mean over the markers where there are several."""
    deck.request(name, label, [_mean(quantity, markers) for quantity in quantities.split()])


def _mean(quantity: str, markers: list[int]) -> str:
    terms = "+".join(f"{quantity}({marker},{GLOBAL_FRAME},{GLOBAL_FRAME})" for marker in markers)
    return f"({terms})/{len(markers)}" if len(markers) > 1 else terms


def add_forces(deck: Deck, model: Model) -> None:
    """Adds requests for the contact forces of two parts on the second one, summed over their pairs: force,
    and torque about its centre of mass."""
    pairs, table = model.pairs, model.contacts
    sides: dict[int, list[tuple[int, int]]] = {row: [] for row in recorded(model)}
    bodies = {marker.id: marker.body for marker in deck.markers}
    on = {shape.id: bodies[shape.marker] for shape in (*deck.solids, *deck.shells)}
    for met, contact in zip(meetings(model), deck.contacts, strict=True):
        row, b = int(pairs.contact[met.pair]), int(pairs.b[met.pair])
        if row in sides:  # 0: the first side, 1: the second
            sides[row].append((contact.id, 0 if on[contact.i] == body_id(b) else 1))
    for row, terms in sides.items():
        label = f"Contact of {table.part_a[row]} on {table.part_b[row]}: force, torque"
        sums = [
            "+".join(f"CONTACT({id},{side},{component},{GLOBAL_FRAME})" for id, side in terms)
            for component in _COMPONENTS
        ]
        deck.request(called(model, row), label, sums)
