"""Text -> the elements of a deck. Nothing outside of the text is read, and no entity is expanded."""

from __future__ import annotations

from collections.abc import Iterator

import lxml.etree as etree

from mdlgen.errors import SpecError

_SHOWN = 80  # characters of a wrong value that a message shows


def root(text: str, file: str) -> etree._Element:
    """The root element. Raises SpecError with file:line for a text that is no deck."""
    declared = text.find("<!DOCTYPE")
    if declared >= 0:  # in it stand entities, which can grow without bound or name other files
        raise trouble(file, text.count("\n", 0, declared) + 1, "a deck has no document type declaration")
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        attribute_defaults=False,
        huge_tree=False,
        remove_pis=True,
        encoding="utf-8",
    )
    try:
        found = etree.fromstring(text.encode("utf-8", "replace"), parser)
    except etree.XMLSyntaxError as error:
        raise trouble(file, error.lineno or 1, error.msg or "this is no XML") from None
    except ValueError as error:
        raise trouble(file, 1, str(error)) from None
    if found.tag != "MultiBodySystem":
        raise trouble(file, line(found), f"a deck is a MultiBodySystem, not {str(found.tag)[:_SHOWN]}")
    return found


def line(element: etree._Element) -> int:
    """Line at which the start tag of an element ends, counted from 1."""
    return int(element.sourceline or 1)


def trouble(file: str, at: int, message: str) -> SpecError:
    """An error with its file and line."""
    return SpecError(f"{file}:{at}: {message}")


def children(parent: etree._Element) -> Iterator[etree._Element]:
    """The elements in another one, without comments."""
    for child in parent:
        if isinstance(child.tag, str):
            yield child


def name_of(element: etree._Element) -> str | None:
    """The name in the comment before an element (`<!-- MODEL.b_note_0_0 -->`), or None."""
    before = element.getprevious()
    if before is None or before.tag is not etree.Comment:
        return None
    said = (before.text or "").strip()
    return said.removeprefix("MODEL.") if said.startswith("MODEL.") else None
