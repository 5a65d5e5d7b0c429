"""What all pages are made with: templates, and the scripts that draw in space."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from mdlgen.paths import templates
from mdlgen.report.html.wording import percent, shown

if TYPE_CHECKING:
    from jinja2 import Environment

_LIBRARY = ("three.core.min.js", "three.module.min.js")


def library() -> dict[str, str]:
    """The scripts that draw in space, by their names."""
    return {name: (templates() / "report" / "third_party" / name).read_text("utf-8") for name in _LIBRARY}


@lru_cache(maxsize=1)
def environment() -> Environment:
    from mdlgen import templating

    made = templating.environment("report", autoescape=True)
    made.filters |= {"shown": shown, "percent": percent}
    return made
