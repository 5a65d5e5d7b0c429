"""Boxes that show parts without their own form in a deck, each around its own marker."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.model.parts.guide import Facet


class Shown(NamedTuple):
    """One of the boxes that show a part."""

    name: str
    label: str
    facet: Facet
