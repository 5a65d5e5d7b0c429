"""Boxes that show what has no form of its own in a deck, each round a marker of its own."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.model.parts.guide import Facet


class Shown(NamedTuple):
    """One of the boxes that show a part."""

    name: str
    label: str
    facet: Facet
