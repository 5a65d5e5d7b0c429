"""Rows of planes: of pressed ones the slide, its spring and what is recorded."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.ids import body_id
from mdlgen.backends.motionsolve.writer.joints import add_slide
from mdlgen.backends.motionsolve.writer.requests import add_request
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import Model, PlanePart


def add_plane(deck: Deck, model: Model, plane: PlanePart) -> None:
    """A pressed one stands on its slide itself."""
    if plane.press is None:
        return
    add_slide(deck, plane, plane.press, model.bodies.position[plane.body], body_id(plane.body))
    markers, label = [deck.bodies[plane.body].cm], f"Plane {plane.name}: position, velocity"
    add_request(deck, f"o_{plane.name}", label, "DX DY DZ VX VY VZ", markers)
