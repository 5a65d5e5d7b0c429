"""Springs of pressed rollers and plates that a program with real spring lengths cannot hold."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_compressed(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a spring that starts with no length left."""
    rollers = [("rollers", "roller", r.name, r.press) for r in model.rollers if r.press is not None]
    plates = [("planes", "plane", plate.name, press) for plate, press in model.plates]
    for group, kind, name, press in (*rollers, *plates):
        compressed = press.touch - press.start
        if compressed >= press.free_length:
            raise RefusedError(
                f"{who}: the spring of {kind} {name} would start compressed by "
                f"{compressed:.6g} mm, all of its free length of {press.free_length:.6g} mm; "
                "a longer free_length means the same in a local run",
                (group, name, "press", "free_length"),
            )
