"""Values that several kinds of parts have: those of a body, of a spring that presses it, of a box."""

from __future__ import annotations

from typing import Any

from mdlgen.altair.masses import masses
from mdlgen.altair.stops import stopped
from mdlgen.backends.msolve.writer.units import Row, axes, per_thousand, row, same, thousandfold
from mdlgen.mechanics.gate import BLUNT
from mdlgen.model.parts.guide import Facet
from mdlgen.model.tables import Model, PlanePart, Press, RollerPart

Table = dict[str, Any]


def body(model: Model, body: int) -> Table:
    """Place, axes, mass and inertia of a body."""
    table, own = model.bodies, masses(model)
    return {
        "center": row(table.position[body]),
        "axes": axes(table.rotation[body]),
        "mass": per_thousand(own.mass[body]),
        "inertia": row(own.inertia[body], per_thousand),
    }


def press(part: RollerPart | PlanePart, spring: Press) -> Table:
    """A spring that is anchored its free length from where it touches."""
    anchor = part.center + (spring.touch - spring.free_length) * spring.direction
    return {
        "direction": row(spring.direction),
        "anchor": row(anchor),
        "k": same(spring.stiffness),
        "c": per_thousand(spring.damping),
        "force": same(spring.preload),
        "length": same(spring.free_length),
    }


def box(facet: Facet) -> tuple[Any, ...]:
    """Place, axes and lengths of a box."""
    return row(facet.center), axes(facet.rotation), row(list(facet.lengths))


def spins(model: Model) -> dict[str, Row]:
    """Angular velocity [rad/s] along global axes that a roller begins with, of those that have one."""
    return {
        roller.name: row(roller.first_spin * roller.axis, thousandfold)
        for roller in model.rollers
        if roller.first_spin != 0.0
    }


def moves(model: Model) -> dict[str, Table]:
    """Axis and pivot, or direction, of parts that move; the corners of the profile, or the spring, and where
    the mass is of what turns freely."""
    found, own = {}, masses(model)
    for part, motion in model.gates:
        way: Table = {"along": row(motion.axis)}
        if motion.turns:
            way = {"about": row(motion.axis), "pivot": row(motion.pivot)}
        if not motion.free:
            way["corners"] = [[per_thousand(t), same(q)] for t, q in motion.corners[:, :2].tolist()]
        elif motion.turns:
            way["middle"] = row(own.place[part.body])
        if motion.sprung:
            way |= {
                "k": same(motion.stiffness),
                "c": per_thousand(motion.damping),
                "force": same(motion.force),
            }
        found[part.name] = way
    return found


def stops(model: Model) -> dict[str, Table]:
    """Of what has stops: its joint, their places from where it begins, stiffness, beta of their damping, and
    the rate over the way beyond [1/s] at which that has changed its sign."""
    return {
        one.name: {
            "joint": one.joint,
            "ends": [same(end) for end in one.ends],
            "k": same(one.stops.stiffness),
            "share": same(one.share),
            "blunt": thousandfold(one.blunt),
        }
        for one in stopped(model, BLUNT)
    }
