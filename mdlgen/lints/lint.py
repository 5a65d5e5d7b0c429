"""One finding of a check of a Model."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Lint:
    """One finding: `where` is the path in the spec."""

    code: str
    where: str
    message: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.code} {self.where}: {self.message}; {self.remedy}"
