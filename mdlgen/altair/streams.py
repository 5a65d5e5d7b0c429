"""Sheets that come in and leave during a run, which no text can say."""

from __future__ import annotations

import math

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_passing(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a sheet that comes in later or leaves: MotionSolve has no
    statement that makes a body, or takes one away, as a run goes."""
    for sheet in model.sheets:
        if not sheet.passes:
            continue
        late = math.isnan(sheet.enters) or sheet.enters > 0.0
        when = "when a rule says so" if math.isnan(sheet.enters) else f"at {sheet.enters:g} ms"
        does, key = (f"comes in {when}", "enters") if late else ("leaves during the run", "out")
        key = "by_rule" if math.isnan(sheet.enters) else key
        raise RefusedError(
            f"{who}: {sheet.name} {does}, and MotionSolve makes no body and takes none away as it runs; run "
            "it locally, or write a scene of the sheets that are there at one time",
            ("sheets", sheet.name, key),
        )
