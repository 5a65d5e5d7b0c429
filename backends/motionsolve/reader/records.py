"""Records of each kind of entity in the list of values. Units: mm, N, kg, s, rad."""

from __future__ import annotations

import math
import re
from typing import Any, NamedTuple

from mdlgen.backends.motionsolve.reader.entity import Entity
from mdlgen.backends.motionsolve.reader.index import Index
from mdlgen.backends.motionsolve.reader.markers import Marker

_ID = re.compile(r"(?<![\w.])[0-9]+(?![\w.])")
_CALL = re.compile(r"[A-Za-z]\w*\([^()]*\)")
_MEASURE = re.compile(r"(?:[DVW][XYZ]|AZ)\([^()]*\)")
_CURVED = re.compile(r"-LINSPL\((.*),0,([0-9]{1,10})\)")
_CONTACT = re.compile(r"CONTACT\(([0-9]{1,10}),([01]),([1-8]),([0-9]{1,10})\)")
_SIX = (2, 3, 4, 6, 7, 8)  # expressions of a request that are written
_CAPS = {"CLOSED": "CAPBOTH", "TOP_ONLY": "CAPEND", "BOTTOM_ONLY": "CAPBEGIN", "OPEN": "CAPNONE"}
_QUANTITIES = {"D": "DISP", "V": "VEL", "A": "ACCL"}
_FREEDOMS = {"R": "ROT", "T": "TRANS"}
_FRICTION = {"COULOMB_ON": "ON", "COULOMB_OFF": "OFF", "COULOMB_DYNAMICONLY": "DYNAMIC_ONLY"}


class Deck(NamedTuple):
    """Where an entity finds the others."""

    elements: Index
    markers: dict[int, Marker]

    def marker(self, user: Entity, attribute: str) -> Marker:
        """The marker that an attribute names."""
        return self.by_id(user, user.id(attribute))

    def by_id(self, user: Entity, number: int) -> Marker:
        """The marker with an id, which `user` needs."""
        self.elements.by_id(user, number, "Reference_Marker")
        return self.markers[number]

    def ends(self, user: Entity) -> tuple[Marker, Marker]:
        """Markers i and j."""
        return self.marker(user, "i_marker_id"), self.marker(user, "j_marker_id")


def _known(entity: Entity, attribute: str, words: dict[str, str]) -> str:
    word = entity.word(attribute)
    if word not in words:
        raise entity.wrong(f"{attribute} is {word[:80]!r}, not {' or '.join(words)}")
    return words[word]


def body(deck: Deck, entity: Entity) -> dict[str, Any] | None:
    """Mass, inertia about the axes of its inertia marker, centre of mass; None for ground."""
    if entity.word("IsGround", "FALSE") == "TRUE":
        return None
    center = deck.marker(entity, "cg_id")
    own = deck.marker(entity, "im_id") if entity.has("im_id") else center
    return {
        "label": entity.word("label", ""),
        "mass": entity.number("mass"),
        "inertia": tuple(
            entity.number(f"inertia_{pair}", 0.0) for pair in ("xx", "yy", "zz", "xy", "yz", "xz")
        ),
        "cm": center.origin,
        "axes": own.axes,
    }


def velocity(entity: Entity) -> tuple[float, ...]:
    """vx, vy, vz and wx, wy, wz at the start, global axes."""
    return tuple(entity.number(f"{kind}_ic_{axis}", 0.0) for kind in "vw" for axis in "xyz")


def bushing(deck: Deck, entity: Entity) -> dict[str, Any]:
    """Stiffness and damping along and about the axes of its markers."""
    i, j = deck.ends(entity)

    def three(form: str) -> tuple[float, float, float]:
        return entity.vector(*(form.format(axis) for axis in "xyz"))

    return {
        "label": entity.word("label", ""),
        "bodies": (i.body, j.body),
        "origin": i.origin,
        "axes": i.axes,
        "k": three("k{}"),
        "c": three("c{}"),
        "kt": three("kt{}"),
        "ct": three("ct{}"),
        "force": three("preload_{}"),
        "torque": three("preload_t{}"),
    }


def spline(deck: Deck, entity: Entity) -> dict[str, Any]:
    """x and y of its points, as many as it says."""
    numbers, count = entity.numbers(), entity.id("num_x")
    if len(numbers) != 2 * count:
        raise entity.wrong(f"{len(numbers)} numbers, not {count} times two")
    beyond = entity.word("linear_extrap", "FALSE")
    return {"label": entity.word("label", ""), "beyond": beyond, "x": numbers[::2], "y": numbers[1::2]}


def curved_spring(
    deck: Deck, entity: Entity, bushings: dict[str, dict[str, Any]]
) -> tuple[str, dict[str, dict[str, str]], str] | None:
    """The bushing whose markers a force has, its laws by component as in the text, and the floating marker;
    None for a force that is something else.

    A law has the name of its curve, the method, and the independent variable with the names of markers.
    """
    i, j = deck.marker(entity, "i_marker_id"), deck.marker(entity, "ref_marker_id")
    floating = deck.marker(entity, "j_floating_marker_id")
    name = i.name.removesuffix(".i")
    if name not in bushings or j.name != f"{name}.j" or floating[2:] != j[2:]:
        return None
    laws = {}
    for k, axis in enumerate("xyz"):
        text = "".join(entity.word(f"f{axis}_expression").split())
        if text == "0":
            continue
        form = _CURVED.fullmatch(text)
        if form is None:
            raise entity.wrong(f"f{axis}_expression is {text[:80]!r}, not -LINSPL of a curve")
        variable = _CALL.sub(lambda call: _named(deck, entity, call[0]), form[1])
        curve = deck.elements.by_id(entity, int(form[2]), "Reference_Spline").name
        laws[f"k.{k}"] = {"curve": curve, "method": "LINEAR", "variable": variable}
    return name, laws, floating.name


def _named(deck: Deck, user: Entity, text: str) -> str:
    """A call with the names of its markers in place of their ids."""
    return _ID.sub(lambda number: deck.by_id(user, int(number[0])).name, text)


def spring(deck: Deck, entity: Entity) -> dict[str, Any]:
    """Stiffness, damping, and the force that it has at a length."""
    i, j = deck.ends(entity)
    return {
        "label": entity.word("label", ""),
        "bodies": (i.body, j.body),
        "points": (i.origin, j.origin),
        "distance": math.dist(i.origin, j.origin),
        "k": entity.number("stiffness"),
        "c": entity.number("damping"),
        "force": entity.number("preload"),
        "length": entity.number("length"),
    }


def graphic(deck: Deck, entity: Entity) -> dict[str, Any] | None:
    """Boxes, cylinders (cut cones), spheres and meshes with their numbers; None for other shapes."""
    shape = entity.word("type")
    if shape not in ("BoxDefinedFromCenter", "Frustum", "Sphere", "TriaMesh"):
        return None
    marker = _under(deck, entity)
    label = entity.word("label", "")
    if shape == "BoxDefinedFromCenter":
        lengths = entity.vector("length_x", "length_y", "length_z")
        sizes: dict[str, Any] = {"center": marker.origin, "axes": marker.axes, "lengths": lengths}
        return {"label": label, "type": "BOX", "body": marker.body, **sizes}
    if shape == "Sphere":
        round_: dict[str, Any] = {"center": marker.origin, "radius": entity.number("radius")}
        return {"label": label, "type": "SPHERE", "body": marker.body, **round_}
    if shape == "TriaMesh":
        corners, triangles = _triangles(entity)
        place: dict[str, Any] = {"origin": marker.origin, "axes": marker.axes}
        triangular: dict[str, Any] = {"corners": corners, "triangles": triangles}
        return {"label": label, "type": "CADGRAPHIC", "body": marker.body, **place, **triangular}
    return {
        "label": label,
        "type": "CYLINDER",
        "body": marker.body,
        "start": marker.origin,
        "axis": marker.axes[2],
        "radii": (entity.number("bottom_radius"), entity.number("top_radius")),
        "length": entity.number("length"),
        "caps": _known(entity, "ends_type", _CAPS),
    }


def _under(deck: Deck, entity: Entity) -> Marker:
    """The marker that a shape moves with."""
    return deck.marker(entity, "ref_marker_id" if entity.word("type") == "TriaMesh" else "center_marker_id")


def _triangles(entity: Entity) -> tuple[list[list[float]], list[list[int]]]:
    """Corners, and the numbers of those of each triangle from 0 on, as many as it says."""
    numbers, nodes, faces = entity.numbers(), entity.id("num_point"), entity.id("num_triangle")
    if len(numbers) != 3 * (nodes + faces):
        raise entity.wrong(f"{len(numbers)} numbers, not three times {nodes} + {faces}")
    corners = [numbers[k : k + 3] for k in range(0, 3 * nodes, 3)]
    named = [int(v) if v == int(v) and 0 <= v < nodes else -1 for v in numbers[3 * nodes :]]
    if min(named) < 0:
        raise entity.wrong("a face names a node that is not there")
    return corners, [named[k : k + 3] for k in range(0, 3 * faces, 3)]


def joint(deck: Deck, entity: Entity) -> dict[str, Any]:
    """Its axis is Z of marker i; a fixed joint has none."""
    i, j = deck.ends(entity)
    kind = entity.word("type")
    return {
        "label": entity.word("label", ""),
        "type": kind,
        "bodies": (i.body, j.body),
        "origin": i.origin,
        "axis": None if kind in ("FIXED", "SPHERICAL") else i.axes[2],
        "markers": (i.name, j.name),
    }


def motion(deck: Deck, entity: Entity) -> dict[str, Any]:
    """The joint, what is prescribed, and the solver expression."""
    constant = entity.word("type") == "CONSTANT"
    return {
        "label": entity.word("label", ""),
        "joint": deck.elements.get(entity, "joint_id", "Constraint_Joint").name,
        "freedom": _known(entity, "motion_type", _FREEDOMS),
        "quantity": _known(entity, "val_type", _QUANTITIES),
        "type": "LIN" if constant else "EXPR",
        "value": entity.number("q") if constant else entity.word("expr"),
    }


def contact(deck: Deck, entity: Entity) -> dict[str, Any]:
    """The graphics of both sides and the numbers of both forces."""
    sides = [
        [deck.elements.by_id(entity, number, "Post_Graphic") for number in entity.ids(attribute)]
        for attribute in ("i_graphics_id", "j_graphics_id")
    ]
    friction = _known(entity, "cff_type", _FRICTION)
    found: dict[str, Any] = {
        "label": entity.word("label", ""),
        "type": entity.word("cnf_type"),
        "friction": friction,
        "bodies": tuple(_body_of(deck, entity, side) for side in sides),
        "graphics": tuple(tuple(graphic.name for graphic in side) for side in sides),
        "penalty": entity.number("penalty"),
        "restitution": entity.number("restitution_coef"),
        "normal_trans_vel": entity.number("normal_trans_vel"),
    }
    if entity.has("master_surface"):
        found["master"] = entity.word("master_surface")
    if friction != "OFF":
        found["mu_static"] = entity.number("mu_static", 0.0)
        found["mu_dynamic"] = entity.number("mu_dynamic")
        found["stiction_velocity"] = entity.number("stiction_trans_vel", 0.0)
        found["friction_velocity"] = entity.number("friction_trans_vel")
    return found


def _body_of(deck: Deck, contact: Entity, side: list[Entity]) -> str:
    bodies = {_under(deck, graphic).body for graphic in side}
    if len(bodies) != 1:
        raise contact.wrong(f"the graphics of one side lie on {len(bodies)} bodies, not on one")
    return bodies.pop()


def surface(deck: Deck, entity: Entity) -> dict[str, Any]:
    """The markers that it goes through, row by row."""
    rows = entity.rows()
    count, across = entity.id("num_marker_row"), entity.id("num_marker_col")
    numbers = [number for row in rows for number in row]
    if len(numbers) != count * across:
        raise entity.wrong(f"{len(numbers)} markers, not {count} x {across}")
    names = [deck.by_id(entity, number).name for number in numbers]
    return {
        "label": entity.word("label", ""),
        "type": entity.word("end_type", "NATURAL"),
        "markers": tuple(tuple(names[k * across : (k + 1) * across]) for k in range(count)),
    }


def output(deck: Deck, entity: Entity) -> dict[str, Any] | None:
    """Its six expressions, with the names of the markers; None for a request of another form."""
    if entity.word("type") != "EXPRESSION" or _of_contacts(entity):
        return None

    def named(call: re.Match[str]) -> str:
        return _named(deck, entity, call[0])

    texts = [entity.word(f"expr{k}") for k in _SIX]
    return {"label": entity.word("comment", ""), "expressions": [_CALL.sub(named, text) for text in texts]}


def _of_contacts(entity: Entity) -> bool:
    """True if a request is for the forces of contacts."""
    return entity.word(f"expr{_SIX[0]}", "").startswith("CONTACT(")


def contact_output(deck: Deck, entity: Entity) -> list[list[tuple[str, str, str, str]]] | None:
    """Contacts that are summed in each component: name, side, component and its frame; None for another
    request."""
    if entity.word("type") != "EXPRESSION" or not _of_contacts(entity):
        return None

    def named(term: str) -> tuple[str, str, str, str]:
        form = _CONTACT.fullmatch(term)
        if form is None:
            raise entity.wrong(f"{term[:80]!r} is not a component of a contact")
        contact = deck.elements.by_id(entity, int(form[1]), "Force_Contact").name
        return contact, form[2], form[3], deck.by_id(entity, int(form[4])).name

    return [[named(term) for term in entity.word(f"expr{k}").split("+")] for k in _SIX]


def load(deck: Deck, entity: Entity) -> dict[str, Any]:
    """Force and torque on a body, as numbers where they are, in the axes of its reference marker."""
    at, reference = deck.marker(entity, "marker_id"), deck.marker(entity, "ref_marker_id")

    def named(call: re.Match[str]) -> str:
        return _named(deck, entity, call[0])

    def three(form: str) -> tuple[float | str, ...]:
        return tuple(_constant(_MEASURE.sub(named, entity.word(form.format(axis), "0"))) for axis in "xyz")

    return {
        "label": entity.word("label", ""),
        "body": at.body,
        "origin": at.origin,
        "reference": reference.name,
        "force": three("f{}_expression"),
        "torque": three("t{}_expression"),
    }


def _constant(text: str) -> float | str:
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else text
