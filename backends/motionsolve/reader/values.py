"""All entities of a deck, in the shape that the reader of MotionView text has for them.

Kinds: bodies, markers, bushings, springs, graphics, joints, motions, contacts, velocities; surfaces, outputs,
contact outputs, forces (one-body loads) by name; gravity [mm/s^2]; run. Left out are, as there, the global
frame and the markers of graphics, and floating ones. A deck has no points, vectors or data sets.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader import records
from mdlgen.backends.motionsolve.reader.entity import Entity
from mdlgen.backends.motionsolve.reader.index import Index
from mdlgen.backends.motionsolve.reader.markers import markers
from mdlgen.backends.motionsolve.reader.parse import children, line, trouble

_Record = Callable[[records.Deck, Entity], dict[str, Any] | list[Any] | None]

# Kind of element -> where it is listed, and how it is read; None leaves it out.
KINDS: tuple[tuple[str, str, _Record], ...] = (
    ("Body_Rigid", "bodies", records.body),
    ("Force_Bushing", "bushings", records.bushing),
    ("Force_SpringDamper", "springs", records.spring),
    ("Post_Graphic", "graphics", records.graphic),
    ("Constraint_Joint", "joints", records.joint),
    ("Motion_Joint", "motions", records.motion),
    ("Force_Contact", "contacts", records.contact),
    ("Reference_DeformSurface", "surfaces", records.surface),
    ("Post_Request", "outputs", records.output),
    ("Post_Request", "contact outputs", records.contact_output),
    ("Force_Vector_OneBody", "forces", records.load),
    ("Reference_Spline", "curves", records.spline),
)


def values(root: etree._Element, file: str) -> dict[str, Any]:
    """Every entity of the kinds above. Raises SpecError with file:line for what cannot be read."""
    sections = {str(child.tag): child for child in children(root)}
    for needed in ("Model", "Command"):
        if needed not in sections:
            raise trouble(file, line(root), f"there is no {needed}")
    index = Index(sections["Model"], file)
    deck = records.Deck(index, markers(index))
    found: dict[str, Any] = {"markers": {}, "velocities": {}}
    for tag, where, record in KINDS:
        listed = found.setdefault(where, {})
        for entity in index.of_kind(tag):
            value = record(deck, entity)
            if value is not None:
                _put(listed, entity, value)
    own = {graphic + "_center_marker" for graphic in found["graphics"]}
    for entity in index.of_kind("Force_Vector_TwoBody"):
        spring = records.curved_spring(deck, entity, found["bushings"])
        if spring is not None:
            bushing, laws, floating = spring
            found["bushings"][bushing].setdefault("curves", {}).update(laws)
            own.add(floating)
    for entity in index.of_kind("Reference_Marker"):
        if entity.name != "Global_Frame" and entity.name not in own:
            _put(found["markers"], entity, deck.markers[entity.id()].record())
    for entity in index.of_kind("Body_Rigid"):
        if entity.has("v_ic_x"):
            found["velocities"][entity.name] = records.velocity(entity)
    found["gravity"] = _gravity(index)
    found["run"] = _steps(index) | _run(sections["Command"], file)
    found["standard"] = {"units": _units(index)}
    return found


def _put(listed: dict[str, Any], entity: Entity, value: Any) -> None:
    if listed.setdefault(entity.name, value) is not value:
        raise entity.wrong("this name is taken by another one of its kind")


def _gravity(index: Index) -> list[float]:
    force = index.single.get("Force_Gravity")
    return list(force.vector("grav_x", "grav_y", "grav_z")) if force is not None else [0.0, 0.0, 0.0]


def _steps(index: Index) -> dict[str, Any]:
    """Steps [s] and error of the integrator, and how a state of rest is found."""
    found: dict[str, Any] = {}
    if (transient := index.single.get("Param_Transient")) is not None:
        found["integrator"] = transient.word("integrator_type")
        for own, name in (("tol", "integr_tol"), ("h_max", "h_max"), ("h_min", "h_min")):
            found[own] = transient.number(name)
    if (static := index.single.get("Param_Static")) is not None:
        found["method"] = static.word("method")
    return found


def _units(index: Index) -> dict[str, str]:
    """As the data set of units of a text has them."""
    given = index.single.get("Param_Unit")
    names = ("force", "length", "mass", "time")
    return {} if given is None else {f"op_{name}": given.word(f"{name}_unit") for name in names}


def _run(command: etree._Element, file: str) -> dict[str, Any]:
    """The first analysis; times in s."""
    for element in children(command):
        if element.tag == "Simulate":
            entity = Entity(element, file)
            return {
                "analysis": entity.word("analysis_type"),
                "end": entity.number("end_time", 0.0),
                "print": entity.number("print_interval", 0.0),
            }
    raise trouble(file, line(command), "there is no Simulate in the Command")
