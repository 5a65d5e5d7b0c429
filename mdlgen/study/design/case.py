"""One run of a study: which values of the scene it has."""

from __future__ import annotations

from dataclasses import dataclass

# Several places that take one value stand in one path, with commas between.
BETWEEN = ","


@dataclass(frozen=True)
class Case:
    """`values` are (path, value) texts as of `--set PATH=VALUE`; `index` counts from 0."""

    index: int
    values: tuple[tuple[str, str], ...]

    @property
    def overrides(self) -> tuple[str, ...]:
        """Overrides for `mdlgen.load`: `PATH=VALUE`, one for each place of a path that names several."""
        return tuple(f"{place}={text}" for path, text in self.values for place in path.split(BETWEEN))

    @property
    def name(self) -> str:
        """`case_12`, of its folder."""
        return f"case_{self.index}"
