"""Second gate for names: all are from the allow-list, and none is that of two things."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mdlgen.altair.labels import check_allowed
from mdlgen.backends.msolve.writer.parts.kinds import WRITTEN
from mdlgen.model import naming
from mdlgen.model.tables import Model


def check(model: Model, values: dict[str, Any]) -> None:
    """Raises SpecError for a name not from the allow-list, and one that two things have."""
    names = [*_things(model), *(f"o_{by}_on_{on}" for by, on in values["FORCES"])]
    check_allowed((model.name, *names))
    naming.check_unique("things in the script", names)


def _things(model: Model) -> Iterator[str]:
    """Labels of what is made, by which it is found again."""
    yield from ("B_Ground", "Global_Frame")
    for name in model.bodies.name:
        yield f"b_{name}"
    for part in model.machine:
        yield from WRITTEN[type(part)].labels(part)
    for name in model.bushings.name:
        yield f"bsh_{name}"
    for probe in model.probes:
        yield f"o_{probe.name}"
