"""An element of a deck: its name, its attributes as numbers or words, and its place."""

from __future__ import annotations

import math

import lxml.etree as etree

from mdlgen.backends.motionsolve.reader.parse import line, name_of, trouble
from mdlgen.errors import SpecError

Vector = tuple[float, float, float]


class Entity:
    """One element; an attribute that is due and missing or no number raises SpecError with file:line."""

    __slots__ = ("_element", "_file", "name")

    def __init__(self, element: etree._Element, file: str):
        self._element = element
        self._file = file
        self.name = name_of(element) or f"{element.tag}:{element.get('id', '')}"

    def wrong(self, message: str) -> SpecError:
        """An error at this element."""
        return trouble(self._file, line(self._element), f"{self._element.tag} {self.name}: {message}")

    def has(self, attribute: str) -> bool:
        return attribute in self._element.attrib

    def word(self, attribute: str, default: str | None = None) -> str:
        """An attribute as it is written."""
        found = self._element.get(attribute, default)
        if found is None:
            raise self.wrong(f"{attribute} is missing")
        return str(found)

    def number(self, attribute: str, default: float | None = None) -> float:
        """An attribute as a finite number."""
        if default is not None and not self.has(attribute):
            return default
        text = self.word(attribute)
        try:
            found = float(text)
        except ValueError:
            found = math.nan
        if not math.isfinite(found) or "_" in text:
            raise self.wrong(f"{attribute} is {text[:80]!r}, not a number")
        return found

    def vector(self, *attributes: str, default: float | None = None) -> Vector:
        """Three attributes."""
        x, y, z = (self.number(a, default) for a in attributes)
        return (x, y, z)

    def id(self, attribute: str = "id") -> int:
        """An attribute as a positive integer."""
        return self._positive(self.word(attribute), attribute)

    def ids(self, attribute: str) -> list[int]:
        """An attribute as a list of positive integers."""
        return [self._positive(part, attribute) for part in self.word(attribute).replace(",", " ").split()]

    def rows(self) -> list[list[int]]:
        """The content as lines of positive integers."""
        lines = (self._element.text or "").split("\n")
        return [[self._positive(part, "content") for part in row.split()] for row in lines if row.strip()]

    def numbers(self) -> list[float]:
        """The content as finite numbers; comments may stand between them."""
        found = []
        content = (self._element.text, *(child.tail for child in self._element))
        for part in " ".join(text or "" for text in content).split():
            try:
                found.append(float(part))
            except ValueError:
                found.append(math.nan)
            if not math.isfinite(found[-1]) or "_" in part:
                raise self.wrong(f"content holds {part[:80]!r}, not a number")
        return found

    def _positive(self, text: str, attribute: str) -> int:
        if not (text.isascii() and text.isdigit() and 0 < len(text) <= 10 and int(text)):
            raise self.wrong(f"{attribute} holds {text[:80]!r}, not a positive integer")
        return int(text)
