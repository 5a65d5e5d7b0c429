"""The Jinja environments for the written files: MDL files, decks, pages."""

from __future__ import annotations

from typing import Any

from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined
from jinja2.bccache import Bucket

from mdlgen.paths import cache, templates


class Compiled(FileSystemBytecodeCache):
    """Compiled templates, which also work where they cannot be cached, as on a full disk."""

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Writes them, if that can be done."""
        try:
            super().dump_bytecode(bucket)
        except OSError:
            return


def environment(room: str, *, autoescape: bool, **settings: Any) -> Environment:
    """An environment for the templates in the folder of that name; undefined names are errors."""
    compiled = cache(f"templates/{room}")  # compiling them takes longer than a text of 200 boxes
    return Environment(
        bytecode_cache=Compiled(str(compiled)) if compiled else None,
        loader=FileSystemLoader(templates() / room),
        undefined=StrictUndefined,
        autoescape=autoescape,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        **settings,
    )
