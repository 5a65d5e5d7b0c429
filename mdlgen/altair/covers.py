"""Covers of rollers, which no text can say."""

from __future__ import annotations

from mdlgen.errors import RefusedError
from mdlgen.model.tables import Model


def refuse_covers(model: Model, who: str) -> None:
    """Raises RefusedError, by name and path, for a roller with a cover. Contacts of Altair's programs are
    between rigid solids: no documented form lets a sheet run faster than the surface that drives it."""
    for roller in model.rollers:
        cover = roller.cover
        if cover is None:
            continue
        stiffness = cover.force / cover.depth**1.5
        raise RefusedError(
            f"{who}: {roller.name} has a cover, on which a sheet goes at {1.0 + cover.gain:.5g} times the "
            "speed of its surface; a contact there is one of rigid bodies, which has no such ratio; run it "
            f"locally, or leave the cover out and write the contact's stiffness: {stiffness:.4g} N/mm^1.5, "
            "and that many times the speed of the drive: torque and power then differ by the ratio",
            ("rollers", roller.name, "cover"),
        )
