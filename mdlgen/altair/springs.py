"""Springs of pressed rollers that a program with real spring lengths cannot hold."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_compressed(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a spring that starts with no length left."""
    for roller in model.rollers:
        press = roller.press
        if press is None:
            continue
        compressed = press.touch - press.start
        if compressed >= press.free_length:
            raise RefusedError(
                f"{who}: the spring of roller {roller.name} would start compressed by "
                f"{compressed:.6g} mm, all of its free length of {press.free_length:.6g} mm; "
                "a longer free_length means the same in a local run",
                ("rollers", roller.name, "press", "free_length"),
            )
