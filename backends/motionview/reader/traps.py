"""Traps of MDL: texts that read well and mean something else than was meant."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from mdlgen.backends.motionview.reader.report import Notes, Trouble
from mdlgen.backends.motionview.reader.things.bodies import Body
from mdlgen.backends.motionview.reader.things.drives import ContactThing
from mdlgen.backends.motionview.reader.things.external import External
from mdlgen.backends.motionview.reader.things.forces import GROUPS, Bush
from mdlgen.backends.motionview.reader.things.graphics import CAPS, Graphic
from mdlgen.backends.motionview.reader.things.joints import Joint
from mdlgen.backends.motionview.reader.things.thing import Thing
from mdlgen.backends.motionview.reader.things.vectors import dot
from mdlgen.backends.motionview.reader.world import World

_SLACK = 1e-9  # relative, for sums of inertia that are equal but for rounding


def traps(world: World, notes: Notes) -> None:
    """Checks all entities that could be evaluated."""
    for thing in world.things():
        if isinstance(thing, Joint) and _is_bush(thing):
            thing = thing.ask("bush")
        rule = _RULES.get(type(thing))
        if rule is not None:
            try:
                world.force(partial(rule, thing, notes))
            except Trouble:  # reported where the values were found
                continue


def _is_bush(joint: Joint) -> bool:
    try:
        return joint.ask("isbush")
    except Trouble:
        return False


def _bushing(bush: Thing, notes: Notes) -> None:
    assert isinstance(bush, Bush)
    numbers = bush.ask("numbers")
    if numbers is None:
        notes.add("warning", "unset", bush.statement.place(), f"{bush} has no *SetBush; it has no stiffness")
        return
    k, c, kt, ct = ([v for v in numbers[g] if isinstance(v, float)] for g in GROUPS)
    negative = min((*k, *c, *kt, *ct), default=0.0) < 0
    dashpot = sum(v != 0.0 for v in (*c, *ct)) == 1  # one damper along or about one axis
    damped_only = len(kt) == 3 and not any(kt) and any(ct) and not dashpot
    preload = [*(numbers["force"] or ()), *(numbers["torque"] or ())]
    slack = len(k) == len(kt) == 3 and not any((*k, *kt, *preload)) and not dashpot
    if not (negative or damped_only or slack):
        return
    chosen = bush.chosen("setbush", bush.part)
    place = (chosen or bush).statement.place()
    if negative:
        notes.add("error", "bushing", place, f"{bush} has a negative stiffness or damping")
    if damped_only:
        message = "has rotational damping and no rotational stiffness; the order is 3 k, 3 c, 3 kt, 3 ct"
        notes.add("warning", "bushing", place, f"{bush} {message}")
    if slack:
        notes.add("warning", "bushing", place, f"{bush} has no stiffness at all")


def _body(body: Thing, notes: Notes) -> None:
    assert isinstance(body, Body)
    place = body.statement.place
    given, from_graphics = body.ask("numbers"), body.ask("from_graphics")
    if from_graphics and given is not None:
        message = f"{body} takes its mass from its graphics; the numbers of *SetBodyInertia are not used"
        notes.add("warning", "mass", place(), message)
    found = body.ask("properties")
    if found is None:
        notes.add("warning", "mass", place(), f"{body} has no mass")
        return
    if found.mass < 0 or min(found.inertia[:3]) < 0:
        notes.add("error", "mass", place(), f"{body} has a negative mass or inertia")
    x, y, z = sorted(found.inertia[:3])
    if z > (x + y) * (1 + _SLACK):
        message = f"{body} has an inertia that no body can have: one is more than the sum of the other two"
        notes.add("warning", "inertia", place(), message)


def _graphic(graphic: Thing, notes: Notes) -> None:
    assert isinstance(graphic, Graphic)
    shape = graphic.shape
    if shape == "BOX" and min(graphic.ask("lengths")) <= 0:
        notes.add("warning", "size", graphic.statement.place(), f"{graphic} has a side of no length")
    if shape == "SPHERE" and graphic.ask("radius") <= 0:
        notes.add("warning", "size", graphic.statement.place(), f"{graphic} has no radius")
    if shape == "CYLINDER":
        _cylinder(graphic, notes)


def _cylinder(graphic: Graphic, notes: Notes) -> None:
    cap = graphic.statement.arg(11).upper()
    if cap not in CAPS:
        message = f"{', '.join(sorted(CAPS))} is due here, not {cap or 'nothing'}"
        notes.add("error", "keyword", graphic.statement.place(11), message)
    length, offset = graphic.ask("length"), graphic.ask("offset")
    if length <= 0 or max(graphic.ask("r1"), graphic.ask("r2")) <= 0:
        notes.add("warning", "size", graphic.statement.place(), f"{graphic} has no length or no radius")
    body = graphic.ask("body")
    start = graphic.position(4)
    if offset == 0 and graphic.statement.arg(5).upper() == "VECTOR" and not _is_ground(body):
        turns_about_it = any(
            joint.ask("type") == "REVOLUTE"
            and joint.ask("origin") == start
            and abs(dot(joint.ask("sides")[0][2], graphic.ask("axes")[2])) > 1 - _SLACK
            for joint in graphic.world.joined_to(body)
        )
        if turns_about_it and body.ask("cm").ask("origin") == start:
            message = f"{graphic} starts at the centre of its roller; centred, its offset is -length/2"
            notes.add("warning", "offset", graphic.statement.place(10), message)


def _is_ground(body: Thing) -> bool:
    return body is body.world.built_in("B_Ground")


def _contact(contact: Thing, notes: Notes) -> None:
    assert isinstance(contact, ContactThing)
    friction = contact.statement.arg(3).upper()
    if friction not in ("OFF", "ON", "DYNAMIC_ONLY", "USER"):
        message = f"OFF, ON, DYNAMIC_ONLY or USER is due here, not {friction or 'nothing'}"
        notes.add("error", "keyword", contact.statement.place(3), message)
    for body, graphics in contact.ask("sides"):
        for graphic in graphics:
            if not isinstance(graphic, External) and graphic.ask("body") is not body:
                message = f"{graphic} is not on {body}"
                notes.add("error", "contact", contact.statement.place(), message)


_RULES: dict[type[Thing], Callable[[Thing, Notes], None]] = {
    Bush: _bushing,
    Body: _body,
    Graphic: _graphic,
    ContactThing: _contact,
}
