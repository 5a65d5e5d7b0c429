"""Rows of planes: of pressed ones the slide, its spring and what is recorded."""

from __future__ import annotations

from mdlgen.backends.motionsolve.writer.ids import body_id
from mdlgen.backends.motionsolve.writer.joints import add_slide
from mdlgen.backends.motionsolve.writer.moving import add_gate
from mdlgen.backends.motionsolve.writer.parts.kind import Kind
from mdlgen.backends.motionsolve.writer.requests import add_request
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.model.tables import Model, PlanePart


class _Planes(Kind[PlanePart]):
    rank = 3

    def add_joints(self, deck: Deck, model: Model, part: PlanePart) -> None:
        """A pressed plane is the body of its slide itself."""
        add_gate(deck, model, part, model.bodies.position[part.body])
        if part.press is None:
            return
        add_slide(deck, part, part.press, model.bodies.position[part.body], body_id(part.body))
        markers, label = [deck.bodies[part.body].cm], f"Plane {part.name}: position, velocity"
        add_request(deck, f"o_{part.name}", label, "DX DY DZ VX VY VZ", markers)


KIND = _Planes()
