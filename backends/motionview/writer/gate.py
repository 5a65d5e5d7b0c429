"""Second gate for names and labels, and for the finished text: nothing typed becomes a statement."""

from __future__ import annotations

import re

from mdlgen.altair.labels import check_allowed
from mdlgen.errors import SpecError
from mdlgen.model.tables import Model

_RESERVED = (
    "B_Ground",
    "P_Global_Origin",
    "V_Global_X",
    "V_Global_Y",
    "V_Global_Z",
    "Global_Frame",
    "MODEL",
    "DS_MotionSolve_Simopts",
    "Solver_Filename",
    "sys_misc",
)
# Entities are what has a label as the second argument, or is a definition; members of data sets are not.
_DEFINED = re.compile(r'^ *\*(?!Real\b)(?:\w+\( *(\w+), "|Define\w+\( *(\w+))', re.M)


def check_names(model: Model) -> None:
    """Raises SpecError where a name or label of the Model is not from the allow-lists."""
    check_allowed(
        identifiers=(
            model.name,
            *(s.name for s in model.sheets),
            *(part.name for part in model.machine),
            *(p.name for p in model.probes),
            *(p.data_set for p in model.parameters),
            *(p.member for p in model.parameters),
            *(e.name for e in model.externals),
            *(word for e in model.externals for path in (e.body, *e.graphics) for word in path.split(".")),
            *model.bodies.name,
            *model.bushings.name,
        ),
        labels=(*model.bodies.label, *model.bushings.label, *(p.label for p in model.parameters)),
    )


def check_free(name: str) -> None:
    """Raises SpecError for a name that MotionView has already."""
    if name.lower() in (taken.lower() for taken in _RESERVED):
        raise SpecError(f"the system would be called {name!r}, a name of MotionView; rename the scene")


def check_text(text: str) -> None:
    """Raises SpecError where the text defines an identifier twice or is not plain ASCII."""
    seen = {name.lower(): name for name in _RESERVED}
    for match in _DEFINED.finditer(text):
        name = match[1] or match[2]
        if seen.setdefault(name.lower(), name) is not name:
            raise SpecError(f"two things in the text would be called {name!r}; rename the part of that name")
    if not text.isascii() or "\r" in text:
        raise SpecError("the text would hold characters other than ASCII")
