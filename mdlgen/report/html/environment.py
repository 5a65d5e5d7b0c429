"""Shared parts of all pages: templates, and the scripts that draw in space."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from mdlgen.model.parts.kinds import KINDS
from mdlgen.paths import templates
from mdlgen.report.html.happened import happened
from mdlgen.report.html.logic import logic
from mdlgen.report.html.wording import percent, shown

if TYPE_CHECKING:
    from jinja2 import Environment

_SPACE = ("three.core.min.js", "three.module.min.js", "OrbitControls.js")
_FIGURES = ("uPlot.iife.min.js",)


def library(figures: bool = True) -> dict[str, str]:
    """The scripts that draw in space, and `figures`, by their names."""
    return {name: _third(name) for name in (*_SPACE, *(_FIGURES if figures else ()))}


def licences(figures: bool = True) -> dict[str, str]:
    """Licences of the libraries that draw a page, by name."""
    found = {"three.js (MIT)": _third("LICENSE")}
    return found | ({"uPlot (MIT)": _third("LICENSE.uPlot")} if figures else {})


def style(*more: str) -> str:
    """Styles of pages with figures; `more` are files behind it."""
    return "\n".join([_third("uPlot.min.css"), *scripts(("style.css", *more))])


def scripts(names: Sequence[str]) -> list[str]:
    """Texts of files of our own."""
    return [_text(name) for name in names]


def _third(name: str) -> str:
    return _text(f"third_party/{name}")


@lru_cache(maxsize=32)
def _text(name: str) -> str:
    return (templates() / "report" / name).read_text("utf-8")


@lru_cache(maxsize=1)
def environment() -> Environment:
    from mdlgen import templating

    made = templating.environment("report", autoescape=True)
    made.globals["machine"] = [kind.table for kind in KINDS]
    made.filters |= {"shown": shown, "percent": percent, "happened": happened, "logic": logic}
    return made
