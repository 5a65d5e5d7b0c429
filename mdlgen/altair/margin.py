"""The note in an MDL file about the pairs that it lists."""

from __future__ import annotations

from mdlgen.model.tables import Model


def margin_note(model: Model) -> tuple[str, ...]:
    """The note that a run with mdlgen may need more pairs than the text lists, where some are left out."""
    if len(model.pairs) >= model.pairs.possible:
        return ()
    return (
        "  A pair that is not listed cannot touch. A local run widens run.margin where a body goes further.",
        "  Where it reports a wider margin (summary.json: pairs.margin_mm), write the text with that one.",
    )
