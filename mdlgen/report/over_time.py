"""Factors over time in words."""

from __future__ import annotations

from mdlgen.model.tables import Floats


def words(profile: Floats) -> str:
    """A factor over time, as a page describes it; "" for none."""
    if not len(profile):
        return ""
    corners = ", ".join(f"{factor:.4g} at {time:.4g} ms" for time, factor in profile.tolist())
    return f"times a factor of {corners}"


def after_comma(profile: Floats) -> str:
    """The same, to follow the multiplied value."""
    return f", {words(profile)}" if len(profile) else ""
