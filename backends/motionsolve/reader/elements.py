"""All elements of a deck with their attributes, with the names of entities in place of their ids."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader.parse import children, line, name_of
from mdlgen.backends.motionsolve.reader.references import USES

Key = tuple[str, str, str]  # section, kind, name or number


def elements(root: etree._Element) -> Iterator[tuple[Key, int, dict[str, str]]]:
    """Key, line and attributes of each, without its id; of a section the order of what it holds.

    Two things with one name differ by a number.
    """
    for section in children(root):
        name = str(section.tag)
        known = _names(section)
        seen: Counter[tuple[str, str]] = Counter()
        if name != "Model":
            order = " ".join(str(child.tag) for child in children(section))
            own = {str(k): str(v) for k, v in section.attrib.items()}
            yield (name, "", ""), line(section), {**own, "order": order}
        for element in children(section):
            tag, called = str(element.tag), name_of(element) or ""
            seen[tag, called] += 1
            number = str(seen[tag, called]) if seen[tag, called] > 1 else ""
            yield (name, tag, f"{called} {number}".strip()), line(element), _attributes(element, known)


def _names(section: etree._Element) -> dict[tuple[str, str], str]:
    """Name by kind and id."""
    return {
        (str(e.tag), str(e.get("id"))): name_of(e) or "" for e in children(section) if e.get("id") is not None
    }


def _attributes(element: etree._Element, known: dict[tuple[str, str], str]) -> dict[str, str]:
    found = {}
    for attribute, text in element.attrib.items():
        attribute, text = str(attribute), str(text)
        kind = USES.get(attribute)
        if attribute == "id":
            continue
        if kind is not None:
            text = " ".join(known.get((kind, i)) or f"id {i}" for i in text.replace(",", " ").split())
        found[attribute] = text
    return found
