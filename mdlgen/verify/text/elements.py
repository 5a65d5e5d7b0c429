"""Elements of a deck apart from the numbers of the Model: against the deck that mdlgen writes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mdlgen.verify.tables import Difference

# Attributes whose numbers and formulas are compared with the Model's, by kind of element.
_XYZ = ("x", "y", "z")
_COMPARED: dict[str, frozenset[str]] = {
    "Reference_Marker": frozenset(
        (*(f"pos_{a}" for a in _XYZ), *(f"a{i}{j}" for i in range(3) for j in (0, 2)))
    ),
    "Body_Rigid": frozenset(
        (
            "mass",
            *(f"inertia_{p}" for p in ("xx", "yy", "zz", "xy", "yz", "xz")),
            *(f"{kind}_ic_{a}" for kind in "vw" for a in _XYZ),
        )
    ),
    "Motion_Joint": frozenset(("expr", "q")),
    "Force_Gravity": frozenset(f"grav_{a}" for a in _XYZ),
    "Force_SpringDamper": frozenset(("length", "stiffness", "damping", "preload")),
    "Force_Bushing": frozenset(
        f"{word}{a}" for word in ("k", "c", "kt", "ct", "preload_", "preload_t") for a in _XYZ
    ),
    "Force_Vector_TwoBody": frozenset(f"f{a}_expression" for a in _XYZ),
    "Force_Contact": frozenset(
        (
            *("penalty", "restitution_coef", "normal_trans_vel"),
            *("mu_static", "mu_dynamic", "stiction_trans_vel", "friction_trans_vel"),
        )
    ),
    "Post_Request": frozenset(f"expr{k}" for k in (2, 3, 4, 6, 7, 8)),
    "Post_Graphic": frozenset(
        (*(f"length_{a}" for a in _XYZ), "length", "radius", "top_radius", "bottom_radius")
    ),
    "Simulate": frozenset(("end_time", "print_interval")),
}
# Attributes that name the place in a tree of systems, for panels.
_FREE = frozenset(("full_label",))


def element_differences(own: Any, given: Any, file: str) -> Iterator[Difference]:
    """Elements that are missing or too many, attributes that differ; `own` is the deck that mdlgen writes."""
    due = {key: attributes for key, _, attributes in own.elements()}
    for key, line, attributes in given.elements():
        mine = due.pop(key, None)
        if mine is None:
            yield Difference(
                "deck", "", f"{file}:{line}: {_named(key)} is not in the deck that mdlgen writes"
            )
            continue
        compared = _COMPARED.get(key[1], frozenset[str]())
        for name in sorted({*mine, *attributes} - _FREE):
            want, have = mine.get(name), attributes.get(name)
            if want is not None and have is not None and (name in compared or _same(want, have)):
                continue
            if name in compared and key[1] in ("Reference_Marker", "Body_Rigid"):  # 0 or global, left out
                continue
            what = f"{name} is {have or 'not there'}, not {want or 'there'}"
            yield Difference("deck", "", f"{file}:{line}: {_named(key)}: {what}")
    for key in due:
        yield Difference("deck", "", f"{_named(key)} is missing")


def _same(one: str, other: str) -> bool:
    if one.split() == other.split():
        return True
    try:
        return float(one) == float(other)
    except ValueError:
        return False


def _named(key: tuple[str, str, str]) -> str:
    section, kind, name = key
    place = "" if section == "Model" else f" of {section}"
    return f"{kind} {name}".strip() + place if kind else section
