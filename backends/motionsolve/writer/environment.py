"""The Jinja environment of the XML templates: its own braces serve, and all that is pasted is escaped."""

from __future__ import annotations

from functools import lru_cache

from jinja2 import Environment

from mdlgen import templating


def comment(text: str) -> str:
    """`text` without the two dashes that would end an XML comment."""
    return text.replace("--", "- -")


@lru_cache(maxsize=1)
def environment() -> Environment:
    """One environment for all decks."""
    made = templating.environment("motionsolve", autoescape=True)
    made.filters["comment"] = comment
    return made
