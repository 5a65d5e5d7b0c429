"""A value of the scene that follows a variable: `--let "rollers.left.drive.speed=186 rad/s - delta"`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from mdlgen.errors import SpecError, did_you_mean
from mdlgen.study.design.variable import check_paths, quantity, quantity_text, split
from mdlgen.units import parse_unit

_NUMBER = r"(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_FORM = re.compile(
    rf"(?:(?P<offset>[-+]?{_NUMBER}(?:\s*[A-Za-zµ°]\S*?)?)\s*(?=[-+]))?(?P<sign>[-+])?\s*"
    rf"(?:(?P<factor>{_NUMBER})\s*\*\s*)?(?P<name>[A-Za-z]\w*)"
)
HOW = (
    'write PATH=NAME or PATH=186 rad/s - 0.5*NAME, with NAME of an --over, as "--over NAME=0 rad/s:50 rad/s"'
)


@dataclass(frozen=True)
class Link:
    """The value at `path` is offset + factor times the variable `name`; `offset` is a number in `unit`, nan
    where none was given, and the value has the variable's unit then."""

    path: str
    name: str
    factor: float
    offset: float
    unit: str

    def text(self, value: str) -> str:
        """The value as it stands in a scene file, of that of the variable. Raises SpecError."""
        found = quantity(value)
        if found is None:
            raise SpecError(f"--let {self.path}: {value[:40]!r} is not a number, or one with a unit")
        number, unit = found
        if self.offset != self.offset:
            return quantity_text(float(f"{self.factor * number:.12g}"), unit)
        if unit != self.unit:
            if not unit or not self.unit or parse_unit(unit).dimension != parse_unit(self.unit).dimension:
                raise SpecError(
                    f"--let {self.path}: {self.name} is {value[:40]!r}, which does not go with the unit "
                    f"{self.unit or 'none'}"
                )
            number *= parse_unit(unit).factor / parse_unit(self.unit).factor
        return quantity_text(float(f"{self.offset + self.factor * number:.12g}"), self.unit)


def parse_link(text: str) -> Link:
    """Parses `PATH=NAME` or `PATH=QUANTITY + FACTOR*NAME`. Raises SpecError."""
    path, rest = split(text, "--let", HOW)
    match = _FORM.fullmatch(rest)
    if match is None:
        raise SpecError(f"--let {text[:80]!r}: is no multiple of a name; {HOW}")
    factor = float(match["factor"] or 1.0) * (-1.0 if match["sign"] == "-" else 1.0)
    offset = quantity(match["offset"]) if match["offset"] else (float("nan"), "")
    if offset is None:
        raise SpecError(f"--let {text[:80]!r}: {match['offset'][:40]!r} is not a number, or one with a unit")
    return Link(path, match["name"], factor, *offset)


def check_links(texts: Sequence[str], paths: Sequence[str]) -> None:
    """Raises SpecError for a link to what is no variable, and for a place that is given twice.

    `texts` are as of `parse_link`, `paths` those of the variables.
    """
    links = [parse_link(text) for text in texts]
    names = {link.name for link in links}
    for link in links:
        if link.name not in paths:
            close = did_you_mean(link.name, paths) or f"; there are: {', '.join(paths) or 'none'}"
            raise SpecError(f"--let {link.path}: there is no variable {link.name[:40]!r}{close}")
    check_paths([*(path for path in paths if path not in names), *(link.path for link in links)])
