"""Names and units under which a text shows what the user gave."""

from __future__ import annotations

from mdlgen.formulas import Dimension
from mdlgen.units import parse_unit, same, unit_of

NAMED_AXES = ("x", "y", "z")
OF_USER = "parameters"  # data set of those that the user named
# Members of a contact -> keys of its friction.
FRICTION = {"mu_s": "static", "mu_d": "dynamic", "v_s": "stiction_velocity", "v_d": "friction_velocity"}
# Internal units as parameters have them.
_UNITS = (
    *("mm", "N", "1", "MPa", "N/mm", "N*mm", "N*mm/rad", "N*mm/rad/mm", "N/mm^1.5", "g", "g/mm^3", "g*mm^2"),
    *("N*mm*ms/rad", "ms", "1/ms", "mm/ms", "rad/ms", "mm/ms^2", "rad"),
)


def unit(dimension: Dimension) -> str:
    """The internal unit of a dimension."""
    for known in _UNITS:
        if same(parse_unit(known).dimension, dimension):
            return known
    named = zip(("mm", "g", "ms", "rad"), dimension, strict=True)
    return "*".join(f"{name}^{power!r}" for name, power in named if power)


def in_text(dimension: Dimension) -> str:
    """The unit in which a text shows a dimension, in the letters that a label may have."""
    shown = unit_of(dimension)
    if shown in ("no unit", "g", "rad"):
        shown = {"no unit": "", "g": "kg", "rad": "deg"}[shown]
    elif shown.startswith("g"):
        shown = f"k{shown}"
    return shown.replace("*", " ").replace("^1.5", " to the 1.5").replace("^", "")
