"""Rows of the bodies: ground, boxes, rollers, planes, guides and meshes, each with its two markers, its
graphics and, where it is held, its joint.

Ids follow the Model's numbers: body k is Body_Rigid k + 2, behind ground, and has Post_Graphic k + 1.
"""

from __future__ import annotations

import numpy as np

from mdlgen.altair.rims import WHOLE, graphics, rim_facets
from mdlgen.backends.motionsolve.writer.axes import cosines
from mdlgen.backends.motionsolve.writer.rows import Body, Box, Cosines, Deck, Shell
from mdlgen.backends.motionsolve.writer.units import Triple, numbers, per_thousand, thousandfold, triples
from mdlgen.model.meshes import origin
from mdlgen.model.parts.guide import facets
from mdlgen.model.shape import ground_frames
from mdlgen.model.tables import MeshPart, Model

GROUND_ID = 1
GLOBAL_FRAME = 1  # the first marker


def body_id(body: int) -> int:
    """Of a body of the Model, or of GROUND (-1)."""
    return body + 2


def graphic_id(body: int) -> int:
    """Of the graphic of a body of the Model."""
    return body + 1


def facet_ids(model: Model) -> list[tuple[int, ...]]:
    """Ids of the boxes that show each guide, behind the graphics of bodies and of surfaces."""
    after, found = len(model.bodies.name) + len(model.sheets) + 1, []
    for guide in model.guides:
        found.append(tuple(range(after, after + guide.facets)))
        after += guide.facets
    return found


def rim_ids(model: Model) -> dict[str, int]:
    """Ids of the boxes that show the rims of rollers, by name of the graphic, behind those of guides."""
    after = len(model.bodies.name) + len(model.sheets) + 1 + sum(map(len, facet_ids(model)))
    names = [name for roller in model.rollers if roller.rim is not None for name in graphics(roller, WHOLE)]
    return {name: after + k for k, name in enumerate(names)}


def add_frames(deck: Deck, model: Model) -> None:
    """The global frame and the axes of the sheets, of the guides and of rollers with a rim, on ground; those
    of meshes on what they move with."""
    deck.marker("Global_Frame", "Global Frame", GROUND_ID, None)
    for index, sheet in enumerate(model.sheets):
        at = triples(sheet.center[None])[0]
        deck.marker(f"m_{sheet.name}", f"Axes of {sheet.name}", GROUND_ID, at, cosines(sheet.rotation))
        for frame in ground_frames(model, index):
            (place,) = triples(frame.origin[None])
            deck.marker(frame.name, frame.label, GROUND_ID, place, cosines(frame.axes))
    for guide in model.guides:
        (at,) = triples(guide.center[None])
        deck.marker(f"m_{guide.name}", f"Axes of {guide.name}", GROUND_ID, at, cosines(guide.axes))
    for mesh in model.meshes:
        (at,) = triples(origin(mesh, model.rollers)[None])
        deck.marker(f"m_{mesh.name}", f"Axes of {mesh.name}", _under(model, mesh), at, cosines(mesh.axes))
    for roller in (part for part in model.rollers if part.rim is not None):
        (at,) = triples(model.bodies.position[roller.body][None])
        axes = cosines(model.bodies.rotation[roller.body])
        deck.marker(f"m_{roller.name}", f"Axes of {roller.name}", GROUND_ID, at, axes)


def add_bodies(deck: Deck, model: Model) -> None:
    """All bodies of the Model; cylinders are added with the machine."""
    table = model.bodies
    positions, velocities = triples(table.position), _velocities(model)
    turns = [cosines(rotation) for rotation in table.rotation]
    properties = zip(table.mass.tolist(), table.inertia.tolist(), table.half.tolist(), strict=True)
    held = table.fixed.tolist()
    for k, (mass, inertia, half) in enumerate(properties):
        name, label = f"b_{table.name[k]}", table.label[k]
        add_body(deck, name, label, body_id(k), positions[k], turns[k], mass, inertia, velocities.get(k))
        if any(half):
            x, y, z = numbers(2.0 * h for h in half)
            marker = deck.bodies[-1].cm
            deck.boxes.append(Box(f"gbox_{table.name[k]}", label, graphic_id(k), marker, (x, y, z)))
        if held[k]:
            how = "held" if model.sheet_of(k) else "fixed"
            _fix(deck, f"j_{table.name[k]}", f"{label} {how}", body_id(k), positions[k])
    _add_facets(deck, model)
    _add_shells(deck, model)


def _add_facets(deck: Deck, model: Model) -> None:
    """The boxes that show guides and rims, each round a marker of its own."""
    for guide, ids in zip(model.guides, facet_ids(model), strict=True):
        for k, (facet, id) in enumerate(zip(facets(guide), ids, strict=True)):
            part = "" if guide.radius == 0.0 else f", part {k}"
            name, label = f"gbox_{guide.name}_{k}", f"{guide.name}{part}"
            (at,) = triples(facet.center[None])
            axes = cosines(facet.rotation)
            marker = deck.marker(
                f"{name}_center_marker", f"{label} - Center Marker", body_id(guide.body), at, axes
            )
            x, y, z = numbers(facet.lengths)
            deck.boxes.append(Box(name, label, id, marker, (x, y, z)))
    ids, table = rim_ids(model), model.bodies
    for roller in model.rollers:
        body = roller.body
        for part, facet in rim_facets(roller, table.position[body], table.rotation[body]):
            name, pieces = f"gbox_{part}", part.removeprefix(f"{roller.name}_").split("_")
            label = f"{roller.name}, {pieces[0]}, part {pieces[1]}"
            (at,) = triples(facet.center[None])
            axes = cosines(facet.rotation)
            marker = deck.marker(f"{name}_center_marker", f"{label} - Center Marker", body_id(body), at, axes)
            x, y, z = numbers(facet.lengths)
            deck.boxes.append(Box(name, label, ids[name], marker, (x, y, z)))


def _under(model: Model, mesh: MeshPart) -> int:
    """Id of the body that a mesh is fixed to."""
    return GROUND_ID if mesh.on < 0 else body_id(model.rollers[mesh.on].body)


def _add_shells(deck: Deck, model: Model) -> None:
    """The triangles of meshes, each round a marker of its own; and the joints of those on rollers."""
    for mesh in model.meshes:
        name, label = f"gcad_{mesh.name}", model.bodies.label[mesh.body]
        (at,) = triples(origin(mesh, model.rollers)[None])
        axes = cosines(mesh.axes)
        marker = deck.marker(
            f"{name}_center_marker", f"{label} - Center Marker", body_id(mesh.body), at, axes
        )
        corners, triangles = triples(mesh.corners), mesh.triangles.tolist()
        deck.shells.append(Shell(name, label, graphic_id(mesh.body), marker, corners, triangles))
        if mesh.on >= 0:
            (middle,) = triples(model.bodies.position[mesh.body][None])
            on = _under(model, mesh)
            _fix(deck, f"j_{mesh.name}", f"{label} fixed", body_id(mesh.body), middle, on)


def add_body(
    deck: Deck,
    name: str,
    label: str,
    id: int,
    at: Triple,
    axes: Cosines | None,
    mass: float,
    inertia: list[float],
    velocity: tuple[str, ...] | None = None,
) -> None:
    """A body and its markers: where its coordinates start, and its mass centre along the inertia's axes."""
    lprf = deck.marker(f"{name}.lprf", f"{label}-Marker LPRF", id, None)
    cm = deck.marker(f"{name}.cm", f"{label}-Marker CM", id, at, axes)
    x, y, z = (per_thousand(v) for v in inertia)
    deck.bodies.append(Body(name, label, id, cm, lprf, per_thousand(mass), (x, y, z), velocity))


def _velocities(model: Model) -> dict[int, tuple[str, ...]]:
    """Initial velocities of the free boxes of sheets that move, global axes."""
    table, found = model.bodies, {}
    for sheet in model.sheets:
        if np.any(sheet.velocity) or np.any(sheet.spin):
            for k in range(sheet.first, sheet.first + sheet.count):
                if not table.fixed[k]:
                    six = (*table.velocity[k].tolist(), *table.spin[k].tolist())
                    found[k] = tuple(thousandfold(v) for v in six)
    return found


def _fix(deck: Deck, name: str, label: str, body: int, at: Triple, on: int = GROUND_ID) -> None:
    """A fixed joint to ground or another body, along the global axes."""
    i = deck.marker(f"{name}.joint_i", f"{label}-Marker I", body, at)
    j = deck.marker(f"{name}.joint_j", f"{label}-Marker J", on, at)
    deck.joint(name, label, "FIXED", i, j)
