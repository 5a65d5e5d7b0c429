"""All entities of a script, in the shape that the readers of MotionView text and of decks have for them.

Names are labels. Kinds: bodies, markers, bushings, springs, graphics, joints, motions, contacts, velocities;
curves, outputs, contact outputs, forces (loads), clutches by name; gravity [mm/s^2]; run; standard.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

from mdlgen.backends.msolve.reader.build import Made
from mdlgen.backends.msolve.reader.frames import GLOBAL, frame, label, on
from mdlgen.backends.msolve.reader.shapes.kinds import SHAPES
from mdlgen.backends.msolve.reader.standin import Thing
from mdlgen.errors import Place, SpecError

_IDS = re.compile(r"\b([DVW][XYZ]|AZ)\(([0-9]{1,10}(?:,[0-9]{1,10})*)\)")
_CURVED = re.compile(r"-LINSPL\((.*),0,([0-9]{1,10})\)")
_CONTACT = re.compile(r"CONTACT\(([0-9]{1,10}),([01]),([1-8]),([0-9]{1,10})\)")
_SIX = ("f2", "f3", "f4", "f6", "f7", "f8")


class Objects:
    """Objects of a script, by class and by id; a duplicate name within a kind raises SpecError."""

    def __init__(self, made: Made, file: str):
        self._things = made.things
        self._file = file

    def of(self, kind: str) -> Iterator[tuple[str, Thing]]:
        """Objects of a class with their labels."""
        for thing in self._things:
            if type(thing).__name__ == kind:
                yield label(thing), thing

    def one(self, kind: str) -> dict[str, Any]:
        """Arguments of the only object of a class; empty where there is none."""
        return next((thing.given for _, thing in self.of(kind)), {})

    def by_id(self, number: int, kind: str) -> str:
        """The label of an object of a class; its number where there is none."""
        if 1 <= number <= len(self._things):
            thing = self._things[number - 1]
            if type(thing).__name__ == kind:
                return label(thing)
        return f"{kind} {number}"

    def put(self, listed: dict[str, Any], name: str, value: Any) -> None:
        """Stores a record under its name."""
        if listed.setdefault(name, value) is not value:
            raise SpecError(f"{name} is there twice", place=Place(self._file, 1, 1))


def values(made: Made, file: str) -> dict[str, Any]:
    """Every entity of the kinds above. Raises SpecError for two of a name."""
    objects = Objects(made, file)
    found: dict[str, Any] = {"velocities": {}}
    for kind, where, record in (
        ("Part", "bodies", _body),
        ("Bushing", "bushings", _bushing),
        ("SpringDamper", "springs", _spring),
        *((name, "graphics", shape.record) for name, shape in SHAPES.items()),
        ("Joint", "joints", _joint),
        ("Motion", "motions", _motion),
        ("Contact", "contacts", _contact),
        ("Spline", "curves", _spline),
        ("Marker", "markers", _marker),
    ):
        listed = found.setdefault(where, {})
        for name, thing in objects.of(kind):
            value = record(thing)
            if value is not None:
                objects.put(listed, name, value)
    for name, part in objects.of("Part"):
        if "vx" in part.given:
            found["velocities"][name] = tuple(float(part.given[f"{k}{a}"]) for k in "vw" for a in "xyz")
    _requests(objects, found)
    _forces(objects, found)
    _curves(objects, found)
    gravity = objects.one("Accgrav")
    found["gravity"] = [float(gravity.get(f"{a}grav", 0.0)) for a in "ijk"]
    found["run"] = _run(objects, made.simulate)
    units = objects.one("Units")
    found["standard"] = {"units": {f"op_{name}": value for name, value in units.items()}}
    return found


def _marker(marker: Thing) -> dict[str, Any] | None:
    if marker.given.get("floating") or label(marker) == "Global_Frame":
        return None
    origin, axes = frame(marker)
    return {"label": label(marker), "body": on(marker), "origin": origin, "axes": axes}


def _body(part: Thing) -> dict[str, Any] | None:
    given = part.given
    if given.get("ground"):
        return None
    origin, axes = frame(part.cm) if "cm" in given else ((math.nan,) * 3, GLOBAL)
    inertia = tuple(float(v) for v in given.get("ip", [math.nan] * 6))
    own = "cm" in given and part.cm.part is part
    mass = float(given.get("mass", math.nan)) if own else math.nan
    return {"label": label(part), "mass": mass, "inertia": inertia, "cm": origin, "axes": axes}


def _ends(thing: Thing) -> tuple[str, str]:
    return on(thing.i), on(thing.j)


def _bushing(bushing: Thing) -> dict[str, Any]:
    origin, axes = frame(bushing.i)
    same = frame(bushing.j) == (origin, axes)
    numbers = {
        name: tuple(float(v) for v in bushing.given.get(name, [0.0] * 3))
        for name in ("k", "c", "kt", "ct", "force", "torque")
    }
    place = origin if same else (math.nan,) * 3  # both markers are where the bushing is
    return {"label": label(bushing), "bodies": _ends(bushing), "origin": place, "axes": axes, **numbers}


def _spring(spring: Thing) -> dict[str, Any]:
    points = frame(spring.i)[0], frame(spring.j)[0]
    numbers = {name: float(spring.given.get(name, 0.0)) for name in ("k", "c", "force", "length")}
    return {"label": label(spring), "bodies": _ends(spring), "points": points, **numbers}


def _joint(joint: Thing) -> dict[str, Any]:
    origin, axes = frame(joint.i)
    same = frame(joint.j) == (origin, axes)
    return {
        "label": label(joint),
        "type": joint.type,
        "bodies": _ends(joint),
        "origin": origin if same else (math.nan,) * 3,
        "axis": None if joint.type == "FIXED" else axes[2],
    }


def _motion(motion: Thing) -> dict[str, Any]:
    return {
        "label": label(motion),
        "joint": label(motion.joint),
        "freedom": {"ROTATION": "ROT", "TRANSLATION": "TRANS"}[motion.jtype],
        "quantity": {"VELOCITY": "VEL", "DISPLACEMENT": "DISP"}[motion.dtype],
        "type": "EXPR",
        "value": motion.function,
    }


def _contact(contact: Thing) -> dict[str, Any]:
    given = contact.given
    sides = [one if isinstance(one, list) else [one] for one in (contact.igeom, contact.jgeom)]
    bodies = [{on(shape.given.get("cm") or shape.rm) for shape in side} for side in sides]
    record: dict[str, Any] = {
        "label": label(contact),
        "type": contact.type,
        "friction": contact.coulomb_friction,
        "bodies": tuple(" ".join(sorted(side)) for side in bodies),
        "graphics": tuple(tuple(label(shape) for shape in side) for side in sides),
        "penalty": float(contact.penalty),
        "restitution": float(contact.restitution_coefficient),
    }
    if "master_surface" in given:
        record["master"] = given["master_surface"]
    for own, name in (
        ("mu_static", "mu_static"),
        ("mu_dynamic", "mu_dynamic"),
        ("stiction_velocity", "stiction_transition_velocity"),
        ("friction_velocity", "friction_transition_velocity"),
    ):
        if record["friction"] != "OFF" and name in given:
            record[own] = float(given[name])
    return record


def _spline(spline: Thing) -> dict[str, Any]:
    beyond = "TRUE" if spline.given.get("linear_extrapolate") else "FALSE"
    x, y = ([float(v) for v in values] for values in (spline.x, spline.y))
    if len(x) != len(y):
        raise SpecError(f"{label(spline)}: {len(x)} places, {len(y)} values")
    return {"label": label(spline), "beyond": beyond, "x": x, "y": y}


def _named(objects: Objects, text: str) -> str:
    """A solver expression with the names of its markers in place of their ids."""

    def call(found: re.Match[str]) -> str:
        names = [objects.by_id(int(number), "Marker") for number in found[2].split(",")]
        return f"{found[1]}({','.join(names)})"

    return _IDS.sub(call, text)


def _requests(objects: Objects, found: dict[str, Any]) -> None:
    """Requests of markers, and those of contacts: of each component the contacts, with the side."""
    found["outputs"], found["contact outputs"] = {}, {}
    for name, request in objects.of("Request"):
        texts = [str(request.given.get(key, "")) for key in _SIX]
        if not texts[0].startswith("CONTACT("):
            record = {
                "label": request.given.get("comment", ""),
                "expressions": [_named(objects, t) for t in texts],
            }
            objects.put(found["outputs"], name, record)
            continue
        terms = [[_CONTACT.fullmatch(term) for term in text.split("+")] for text in texts]
        objects.put(
            found["contact outputs"],
            name,
            [
                [
                    (objects.by_id(int(t[1]), "Contact"), t[2], t[3], objects.by_id(int(t[4]), "Marker"))
                    if t
                    else ("", "", "", "")
                    for t in component
                ]
                for component in terms
            ],
        )


def _forces(objects: Objects, found: dict[str, Any]) -> None:
    """Loads with their numbers; clutches, and other torques about axles, with an expression."""
    found["forces"], found["clutches"] = {}, {}
    for name, force in objects.of("Gforce"):
        given = force.given
        three = [tuple(given.get(f"{kind}{a}", "0") for a in "xyz") for kind in "ft"]
        if name.endswith(("_clutch", "_axle", "_stops")):
            push, torque = ([_named(objects, text) for text in own] for own in three)
            ends = (on(force.i), label(force.i), label(force.rm))
            objects.put(found["clutches"], name, {"ends": ends, "force": tuple(push), "torque": torque})
            continue
        load = {
            "label": name,
            "body": on(force.i),
            "origin": frame(force.i)[0],
            "reference": label(force.rm) if "rm" in given else "",
            "force": tuple(_constant(v) for v in three[0]),
            "torque": tuple(_constant(v) for v in three[1]),
        }
        objects.put(found["forces"], name, load)


def _constant(text: str) -> float | str:
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else text


def _curves(objects: Objects, found: dict[str, Any]) -> None:
    """Forces along curves, with the bushings whose markers they have."""
    for _, force in objects.of("Vforce"):
        name = label(force.i).removesuffix(".i")
        bushing = found["bushings"].get(name)
        if bushing is None or label(force.rm) != f"{name}.j" or on(force.jfloat) != bushing["bodies"][1]:
            raise SpecError(f"{label(force)}: its markers are not those of a bushing")
        for k, axis in enumerate("xyz"):
            text = str(force.given.get(f"f{axis}", "0"))
            if text == "0":
                continue
            form = _CURVED.fullmatch(text)
            if form is None:
                raise SpecError(f"{label(force)}: f{axis} is {text[:80]!r}, not -LINSPL of a curve")
            curve = objects.by_id(int(form[2]), "Spline")
            law = {"curve": curve, "method": "LINEAR", "variable": _named(objects, form[1])}
            bushing.setdefault("curves", {})[f"k.{k}"] = law


def _run(objects: Objects, simulate: dict[str, Any]) -> dict[str, Any]:
    """The analysis with its times [s], and the settings of its integrator or of its method."""
    if simulate["type"] == "STATICS":
        settings = objects.one("Equilibrium")
        method = "FIM_D" if settings.get("skip_mkeam") else "MKEAM"
        return {"analysis": "Static", "method": method, "end": 0.0, "print": 0.0}
    settings = objects.one("Integrator")
    found: dict[str, Any] = {"analysis": "Transient", "integrator": settings.get("type")}
    found |= {
        own: settings.get(name) for own, name in (("tol", "error"), ("h_max", "hmax"), ("h_min", "hmin"))
    }
    return found | {"end": float(simulate["end"]), "print": float(simulate["dtout"])}


def comparable(made: Made) -> list[tuple[tuple[str, str], dict[str, Any]]]:
    """Class and label of every object, with its arguments: numbers, words, names of other objects."""
    objects = Objects(made, "")
    found = []
    for thing in made.things:
        given = {name: _plain(objects, value) for name, value in thing.given.items()}
        found.append(((type(thing).__name__, label(thing)), given))
    return [*found, (("simulate", ""), dict(made.simulate))]


def _plain(objects: Objects, value: Any) -> Any:
    if isinstance(value, Thing):
        return label(value)
    if isinstance(value, str):
        text = _CONTACT.sub(
            lambda found: (
                f"CONTACT({objects.by_id(int(found[1]), 'Contact')},{found[2]},{found[3]},"
                f"{objects.by_id(int(found[4]), 'Marker')})"
            ),
            _named(objects, value),
        )
        curve = _CURVED.fullmatch(text)
        return text if curve is None else f"-LINSPL({curve[1]},0,{objects.by_id(int(curve[2]), 'Spline')})"
    if isinstance(value, (list, tuple)):
        return [_plain(objects, item) for item in value]
    return value
