"""The Jinja environment of the script, for what writes it and for what reads it back."""

from __future__ import annotations

from functools import lru_cache

from jinja2 import Environment

from mdlgen import templating
from mdlgen.altair.refinement import GRAPHICS
from mdlgen.backends.msolve.literals import literal


@lru_cache(maxsize=1)
def environment() -> Environment:
    """One environment for all scripts."""
    made = templating.environment("msolve", autoescape=False)
    made.filters["literal"] = literal
    made.globals.update(GRAPHICS)
    return made
