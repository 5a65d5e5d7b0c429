"""Parts of the machine, by kind."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.rims import rim_facets
from mdlgen.backends.msolve.writer.units import axes, per_thousand, row, same, thousandfold
from mdlgen.model.meshes import origin
from mdlgen.model.parts.guide import Facet, facets
from mdlgen.model.tables import (
    GuidePart,
    MeshPart,
    Model,
    PlanePart,
    Press,
    RollerPart,
)

Table = dict[str, Any]
WRITTEN = (RollerPart, PlanePart, GuidePart, MeshPart)


def _body(model: Model, body: int) -> Table:
    table = model.bodies
    return {
        "center": row(table.position[body]),
        "axes": axes(table.rotation[body]),
        "mass": per_thousand(table.mass[body]),
        "inertia": row(table.inertia[body], per_thousand),
    }


def _press(part: RollerPart | PlanePart, press: Press) -> Table:
    """A spring that is anchored its free length from where it touches."""
    anchor = part.center + (press.touch - press.free_length) * press.direction
    return {
        "direction": row(press.direction),
        "anchor": row(anchor),
        "k": same(press.stiffness),
        "c": per_thousand(press.damping),
        "force": same(press.preload),
        "length": same(press.free_length),
    }


def _facet(facet: Facet) -> tuple[Any, ...]:
    return row(facet.center), axes(facet.rotation), row(list(facet.lengths))


def rollers(model: Model) -> Table:
    """All rollers by name."""
    return {roller.name: _roller(model, roller) for roller in model.rollers}


def _roller(model: Model, roller: RollerPart) -> Table:
    table = {**_body(model, roller.body), "radius": same(roller.radius), "width": same(roller.width)}
    if roller.press is not None:
        mass = roller.press.carrier_mass
        ball = 0.4 * mass * roller.radius**2  # a solid ball, as the text has it
        own = {"mass": per_thousand(mass), "inertia": row([ball] * 3, per_thousand)}
        table["press"] = {**_press(roller, roller.press), **own}
    if roller.arm is not None:
        arm = roller.arm
        table["arm"] = {
            "pivot": row(arm.pivot),
            "center": row(arm.center),
            "mass": per_thousand(arm.mass),
            "inertia": row([arm.inertia] * 3, per_thousand),
        }
        if arm.sprung:
            spring = {"kt": same(arm.stiffness), "ct": per_thousand(arm.damping), "torque": same(arm.torque)}
            table["arm"] |= spring
    if roller.profile is not None:
        corners = [[per_thousand(t), thousandfold(w)] for t, w in roller.profile.tolist()]
        table["drive"] = {"profile": corners}
    elif roller.speed is not None:
        table["drive"] = {"speed": thousandfold(roller.speed), "ramp": per_thousand(roller.ramp)}
    if roller.one_way is not None:
        way = roller.one_way
        clutch = {"torque": same(way.torque), "creep": thousandfold(way.creep)}
        table["clutch"] = {"direction": way.direction, **clutch}
    if roller.rim is not None:
        rim: dict[str, list[Any]] = {name: [] for name in roller.rim.name}
        place, turned = model.bodies.position[roller.body], model.bodies.rotation[roller.body]
        for part, facet in rim_facets(roller, place, turned):
            rim[part.removeprefix(f"{roller.name}_").split("_")[0]].append(_facet(facet))
        table["rim"] = rim
    return table


def planes(model: Model) -> Table:
    """All planes by name."""
    found: Table = {}
    for plane in model.planes:
        table = {**_body(model, plane.body), "lengths": row(2.0 * model.bodies.half[plane.body])}
        if plane.press is not None:
            table["press"] = _press(plane, plane.press)
        found[plane.name] = table
    return found


def guides(model: Model) -> Table:
    """All guides by name."""
    return {
        guide.name: {**_body(model, guide.body), "boxes": [_facet(facet) for facet in facets(guide)]}
        for guide in model.guides
    }


def meshes(model: Model) -> Table:
    """All meshes by name: triangles in the axes of their file."""
    return {
        mesh.name: {
            **_body(model, mesh.body),
            "on": "ground" if mesh.on < 0 else model.rollers[mesh.on].name,
            "origin": row(origin(mesh, model.rollers)),
            "file_axes": axes(mesh.axes),
            "nodes": [row(corner) for corner in mesh.corners],
            "faces": mesh.triangles.tolist(),
        }
        for mesh in model.meshes
    }
