"""Rows of the bodies: boxes and parts of the machine, each with its two markers, its block and, where it is
held, its joint; and the axes on ground."""

from __future__ import annotations

import numpy as np

from mdlgen.altair.masses import masses
from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.body import add_body
from mdlgen.backends.motionsolve.writer.ids import GROUND_ID, body_id, graphic_id
from mdlgen.backends.motionsolve.writer.joints import fix
from mdlgen.backends.motionsolve.writer.parts.kinds import written
from mdlgen.backends.motionsolve.writer.rows import Deck
from mdlgen.backends.motionsolve.writer.units import numbers, thousandfold, triples
from mdlgen.model.shape import ground_frames
from mdlgen.model.tables import Model


def add_frames(deck: Deck, model: Model) -> None:
    """The global frame and the axes of the sheets on ground, then those of parts of the machine."""
    deck.marker("Global_Frame", "Global Frame", GROUND_ID, None)
    for index, sheet in enumerate(model.sheets):
        at = triples(sheet.center[None])[0]
        deck.marker(f"m_{sheet.name}", f"Axes of {sheet.name}", GROUND_ID, at, cosines(sheet.rotation))
        for frame in ground_frames(model, index):
            (place,) = triples(frame.origin[None])
            deck.marker(frame.name, frame.label, GROUND_ID, place, cosines(frame.axes))
    for kind, part in written(model):
        kind.add_frame(deck, model, part)


def add_bodies(deck: Deck, model: Model) -> None:
    """All bodies of the Model, with the blocks that show them."""
    table = model.bodies
    own = masses(model)
    places, velocities = triples(table.position), _velocities(model)
    positions = triples(own.place)
    turns = [cosines(rotation) for rotation in table.rotation]
    properties = zip(own.mass.tolist(), own.inertia.tolist(), table.half.tolist(), strict=True)
    held = table.fixed.tolist()
    for k, (mass, inertia, half) in enumerate(properties):
        name, label = f"b_{table.name[k]}", table.label[k]
        add_body(deck, name, label, body_id(k), positions[k], turns[k], mass, inertia, velocities.get(k))
        if any(half):
            x, y, z = numbers(2.0 * h for h in half)
            marker = deck.bodies[-1].cm
            if positions[k] != places[k]:  # it is shown where it is, not where its mass is
                shown = f"gbox_{table.name[k]}_center_marker"
                marker = deck.marker(shown, f"{label} - Center Marker", body_id(k), places[k], turns[k])
            deck.box(f"gbox_{table.name[k]}", label, graphic_id(k), marker, (x, y, z))
        if held[k]:
            how = "held" if model.sheet_of(k) else "fixed"
            fix(deck, f"j_{table.name[k]}", f"{label} {how}", body_id(k), positions[k])


def _velocities(model: Model) -> dict[int, tuple[str, ...]]:
    """Initial velocities of the free boxes of sheets that move, and of rollers that spin, global axes."""
    table, found = model.bodies, {}
    for roller in model.rollers:
        if roller.first_spin != 0.0:
            six = (0.0, 0.0, 0.0, *(roller.first_spin * roller.axis).tolist())
            found[roller.body] = tuple(thousandfold(v) for v in six)
    for sheet in model.sheets:
        if np.any(sheet.velocity) or np.any(sheet.spin):
            for k in range(sheet.first, sheet.first + sheet.count):
                if not table.fixed[k]:
                    six = (*table.velocity[k].tolist(), *table.spin[k].tolist())
                    found[k] = tuple(thousandfold(v) for v in six)
    return found
