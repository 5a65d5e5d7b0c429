"""Rows of contacts: their numbers by entry, their pairs of bodies, and what is recorded of them."""

from __future__ import annotations

from typing import NamedTuple

from mdlgen.backends.motionview.writer.rows import Value


class ContactView(NamedTuple):
    """One entry of the spec's list."""

    data_set: str
    label: str
    given: list[Value]
    share: str


class Pair(NamedTuple):
    """One contact statement."""

    name: str
    label: str
    body_1: str
    graphic_1: str
    body_2: str
    graphics_2: list[str]
    friction: str  # ON or OFF
    data_set: str
    rough: str = ""  # friction of its boxes relative to that of the contact, where that is not 1
    rougher: float = 1.0  # and its number
    stiff: str = ""  # the same of the stiffness
    stiffer: float = 1.0
    bouncy: str = ""  # reference to a restitution in place of the contact's
    restitution: float | None = None
    master: str = ""  # I or J: the side whose mesh is the finer one; empty: the solver chooses


class LawView(NamedTuple):
    """Contacts with the same numbers, as solver commands give them."""

    label: str
    master: str
    numbers: list[tuple[str, str, str]]  # variable of the template, attribute of the command, formula
    contacts: list[str]


class ForceView(NamedTuple):
    """Force of the contacts of two parts on the second one, recorded as a sum over them."""

    name: str
    label: str
    terms: list[tuple[str, int]]  # contact, and its side that is the second part: 0 or 1
