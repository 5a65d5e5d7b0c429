"""Limits on the size of a scene. Counts are checked before anything is built; a limit is raised by name."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from mdlgen.errors import SpecError

_COUNT = re.compile(r"[0-9]{1,12}(?:\.[0-9]{1,6})?(?:[eE]\+?[0-9]{1,2})?")
_MOST = 1e12  # above this nothing is a count


class Limits(NamedTuple):
    """Greatest counts: boxes of all sheets, stored pairs of bodies, and pairs of parts that the contacts
    name. States that a run stores (bodies times outputs, some 150 bytes each), and values in the MDL file.
    Triangles of all meshes, and points of all measured curves."""

    boxes: int = 100_000
    pairs: int = 1_000_000
    contacts: int = 10_000
    states: int = 25_000_000
    values: int = 50_000
    triangles: int = 100_000
    points: int = 10_000

    def raised(self, wishes: Iterable[str]) -> Limits:
        """With the limits of texts like `boxes=200000`. Raises SpecError."""
        found = self
        for wish in wishes:
            name, _, value = (part.strip() for part in wish.partition("="))
            if name not in self._fields or not _COUNT.fullmatch(value) or not 1 <= float(value) <= _MOST:
                raise SpecError(
                    f"--limit {wish[:80]!r} is not NAME=COUNT; names: {', '.join(self._fields)}; "
                    "write like boxes=200000 or pairs=2e6"
                )
            found = found._replace(**{name: int(float(value))})
        return found

    def exceeded(self, name: str, count: float, what: str) -> str:
        """Words for a count that is above the limit `name`, "" where it is not."""
        most = getattr(self, name)
        if count <= most:
            return ""
        return f"{what}: {count:.10g}, allowed are {most}; --limit {name}={count:.10g} raises this limit"


DEFAULT = Limits()


class Tally:
    """Sums over the files that a scene names, since many small ones are as much as a large one."""

    def __init__(self, limits: Limits = DEFAULT):
        self.limits = limits
        self._sums: Counter[tuple[str, int]] = Counter()

    def exceeded(self, name: str, count: int, what: str, each: int = 1) -> str:
        """Words where the sum with so many more, `each` of which make one, is above a limit; else ""."""
        most = math.ceil((self._sums[name, each] + count) / each)
        return self.limits.exceeded(name, most, f"{what}, with those of the files before")

    def add(self, name: str, count: int, each: int = 1) -> None:
        """Counts what was read."""
        self._sums[name, each] += count
