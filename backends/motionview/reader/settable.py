"""Set statements that change values, by the kind of entity and the property that they set."""

from __future__ import annotations

import re

from mdlgen.backends.motionview.reader.statement import Statement
from mdlgen.backends.motionview.reader.things.joints import JOINTS

Parts = dict[str, tuple[str, ...]]  # by kind of thing: itself is the part ""

_ITSELF = ("",)
_BODY: Parts = {"Body": _ITSELF}
_VALUES: Parts = {
    **dict.fromkeys(("Real", "Integer", "String", "Boolean", "Filename"), ("", "value")),
    "Table": (),  # its cells
}
_LINKS: Parts = dict.fromkeys(
    ("Bush", "CoilSpring", "ActionReactionForce", "ActionOnlyForce", "Output"), _ITSELF
)
_BUSHES: Parts = dict.fromkeys(JOINTS, ("bush",))
# Statement, in lower case -> what of it the values act on.
ACTED: dict[str, Parts] = {
    "setpoint": {"Point": _ITSELF},
    "setvector": {"Vector": _ITSELF},
    "setorientation": {"Marker": _ITSELF, "Body": ("cm",), **_LINKS, **_BUSHES},
    "setbodyinertia": _BODY,
    "setbody": _BODY,
    "setbodyic": _BODY,
    "setbodyicflag": _BODY,
    "setbush": {"Bush": _ITSELF, **_BUSHES},
    "setcoilspring": {"CoilSpring": _ITSELF},
    "setmotion": {"Motion": _ITSELF},
    "setforce": {"ActionOnlyForce": _ITSELF},
    "setcontact": {"Contact": _ITSELF},
    "setcurve": {"Curve": _ITSELF},
    "setcoupler": {"Coupler": _ITSELF},
    "setpolybeamprops": {"PolyBeam": _ITSELF},
    "setoption": dict.fromkeys(("Option", "StandardOption", "Op_Compliant"), _ITSELF),
    "set": {"Body": ("inertia_props_from_graphic",), "Table": ("numrecs",)},
    "setreal": _VALUES,
    "setinteger": _VALUES,
    "setstring": _VALUES,
    "setboolean": _VALUES,
    "setfilename": _VALUES,
    "setval": _VALUES,
}
# Frequent statements that no value shows: the magnitude of a force between two bodies.
NOT_SHOWN = {("ActionReactionForce", "setforce")}
# Properties of *Set that change no value, as far as files and their exported decks show; and for which value.
_HARMLESS = {"usecm": "true", "hide_in_post": "", "mesh_coarsening_level": ""}
_CELL = re.compile(r"\w+\[\d+\]\Z")


def acts(kind: str, key: str, part: str) -> bool:
    """True if a statement `key` about a property of an entity changes values."""
    parts = ACTED.get(key, {}).get(kind)
    if parts is None:
        return False
    return part in parts or (kind == "Table" and key != "set" and _CELL.match(part) is not None)


def harmless(statement: Statement, part: str) -> bool:
    """True if a *Set is of a property that changes no value."""
    due = _HARMLESS.get(part) if statement.key == "set" else None
    return due is not None and due in ("", statement.arg(1).lower())
