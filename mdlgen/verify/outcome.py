"""The findings of a verification."""

from __future__ import annotations

from dataclasses import dataclass, field

from mdlgen.verify.tables import Compared, Difference


@dataclass
class Perturbed:
    """The outcome of changing each value, in the MDL file and in the spec."""

    values: int = 0
    largest: float = 0.0
    where: str = ""
    shown_only: set[str] = field(default_factory=set)  # NO_EDIT in the text
    differences: list[Difference] = field(default_factory=list)


@dataclass
class Verification:
    """The findings: compared kinds by source (`text`, `deck`), differences, and outcomes of changed
    values."""

    kinds: dict[str, dict[str, Compared]] = field(default_factory=dict)
    differences: list[Difference] = field(default_factory=list)
    perturbed: Perturbed | None = None
    notes: list[str] = field(default_factory=list)
    script: str | None = None  # the file that was read; None for the one that mdlgen writes, or none

    @property
    def ok(self) -> bool:
        return not self.all_differences()

    def all_differences(self) -> list[Difference]:
        """Differences of the values as they are, then of those perturbed."""
        return [*self.differences, *(self.perturbed.differences if self.perturbed else [])]

    def add(self, source: str, compared: Compared, within: str = "") -> None:
        """One kind of one source; of two texts, or of several systems, the larger difference counts.

        `within` goes before the names of what differs.
        """
        kinds = self.kinds.setdefault(source, {})
        before = kinds.get(compared.kind)
        if before is None or compared.largest > before.largest:
            kinds[compared.kind] = compared
        self.differences += (d._replace(name=within + d.name) for d in compared.differences)

    def differs(self, kind: str, name: str, what: str) -> None:
        """One difference more."""
        self.differences.append(Difference(kind, name, what))
