"""Ids of a deck: unique for each kind of element, and none used that is missing."""

from __future__ import annotations

import re
from collections.abc import Iterator

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader.parse import children, line

Problem = tuple[int, str]

# Attribute -> the kind of element that its ids are of.
MARKER = "Reference_Marker"
USES = {
    "body_id": "Body_Rigid",
    **dict.fromkeys(("cg_id", "im_id", "lprf_id", "vm_id", "wm_id", "center_marker_id"), MARKER),
    **dict.fromkeys(("i_marker_id", "j_marker_id", "marker_id", "ref_marker_id"), MARKER),
    "j_floating_marker_id": MARKER,
    "joint_id": "Constraint_Joint",
    "i_graphics_id": "Post_Graphic",
    "j_graphics_id": "Post_Graphic",
    "ref_dsurface_id": "Reference_DeformSurface",
}
_COUNTED = {"i_graphics_id": "num_i_graphics", "j_graphics_id": "num_j_graphics"}
_OWN = ("cg_id", "im_id", "lprf_id")  # markers that must be of the body itself
# Functions of markers, by name and ids; others of the solver's take other ids.
_CALL = re.compile(r"\b(?:[DVWFT][XYZM]|ACC[XYZM]|A[XYZ]|WDT[XYZM]|ROLL|PITCH|YAW)\(([^()]*)\)", re.I)
# The spline of an interpolation, behind its two variables.
_SPLINE = re.compile(r"\b(?:LIN|AKI|CUB|FIT)SPL\((?:[^()]|\([^()]*\))*,[^(),]*,\s*([0-9]+)\s*\)", re.I)
# The force of a contact: its id, side, component, and a marker.
_CONTACT = re.compile(r"\bCONTACT\(([0-9]+),[^(),]*,[^(),]*,([0-9]+)\)", re.I)
_BIG = re.compile(r"[0-9]{11,}")


def dangling(root: etree._Element) -> list[Problem]:
    """All problems, in the order of the deck."""
    (model,) = [child for child in children(root) if child.tag == "Model"][:1] or [None]
    if model is None:
        return []
    problems: list[Problem] = []
    known: dict[str, dict[int, etree._Element]] = {}
    for element in children(model):
        for number in _numbers(element.get("id", "")):
            kind = known.setdefault(str(element.tag), {})
            if kind.setdefault(number, element) is not element:
                message = f"{element.tag} {number} is there twice, first in line {line(kind[number])}"
                problems.append((line(element), message))
    for element in children(model):
        problems += [(line(element), f"{element.tag} {element.get('id')}: {m}") for m in _of(element, known)]
    return sorted(problems)


def _of(element: etree._Element, known: dict[str, dict[int, etree._Element]]) -> Iterator[str]:
    """Errors in the ids that one element uses."""
    for attribute, text in element.attrib.items():
        attribute, text = str(attribute), str(text)
        kind = USES.get(attribute)
        if kind is not None:
            yield from _missing(attribute, kind, _numbers(text), known)
            if attribute in _COUNTED and element.get(_COUNTED[attribute]) != str(len(_numbers(text))):
                yield f"{attribute} does not hold {_COUNTED[attribute]} ids"
            if attribute in _OWN:
                yield from _foreign(element, attribute, known)
        elif attribute.startswith("expr") or attribute.endswith("_expression"):
            for call in _CALL.finditer(text):
                yield from _missing(attribute, MARKER, _numbers(call[1]), known)
            for call in _CONTACT.finditer(text):
                yield from _missing(attribute, "Force_Contact", _numbers(call[1]), known)
                yield from _missing(attribute, MARKER, _numbers(call[2]), known)
            for call in _SPLINE.finditer(text):
                yield from _missing(attribute, "Reference_Spline", _numbers(call[1]), known)
    if element.tag == "Reference_DeformSurface":
        numbers = _numbers(element.text or "")
        yield from _missing("content", MARKER, numbers, known)
        sides = [_numbers(element.get(a, "")) for a in ("num_marker_row", "num_marker_col")]
        if sides[0] and sides[1] and len(numbers) != sides[0][0] * sides[1][0]:
            yield f"{len(numbers)} markers, not {sides[0][0]} x {sides[1][0]}"


def _missing(
    attribute: str, kind: str, numbers: list[int], known: dict[str, dict[int, etree._Element]]
) -> Iterator[str]:
    ids = known.get(kind, {})
    for number in numbers:
        if number not in ids:
            yield f"{attribute} names {kind} {number}, which there is not"


def _foreign(
    body: etree._Element, attribute: str, known: dict[str, dict[int, etree._Element]]
) -> Iterator[str]:
    """A body's own markers must lie on it."""
    for number in _numbers(body.get(attribute, "")):
        marker = known.get(MARKER, {}).get(number)
        if marker is not None and marker.get("body_id") != body.get("id"):
            yield f"{attribute} is a marker of another body"


def _numbers(text: str) -> list[int]:
    """The integers in a list; what is no id is for the schema to say."""
    if _BIG.search(text):
        return []
    return [int(part) for part in text.replace(",", " ").split() if part.isascii() and part.isdigit()]
