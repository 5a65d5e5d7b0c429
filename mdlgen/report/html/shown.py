"""The page of a run in a notebook."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape


@dataclass(frozen=True, repr=False)
class Shown:
    """A page in a frame of its own, whose scripts and styles do not meet those of the notebook."""

    page: str
    height: int  # [px]

    def __repr__(self) -> str:
        return f"<report of {len(self.page)} characters>"

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self.page)}" width="100%" height="{self.height}" '
            'sandbox="allow-scripts" style="border: 0"></iframe>'
        )
