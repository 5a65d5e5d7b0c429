"""The Jinja environment of the XML templates: its own braces serve, and all that is pasted is escaped."""

from __future__ import annotations

from functools import lru_cache

from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

from mdlgen.paths import cache, templates


def comment(text: str) -> str:
    """`text` without the two dashes that would end an XML comment."""
    return text.replace("--", "- -")


@lru_cache(maxsize=1)
def environment() -> Environment:
    """One environment for all decks."""
    compiled = cache("templates_motionsolve")  # compiling them takes longer than a text of 200 boxes
    made = Environment(
        bytecode_cache=FileSystemBytecodeCache(str(compiled)) if compiled else None,
        loader=FileSystemLoader(templates() / "motionsolve"),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters["comment"] = comment
    return made
