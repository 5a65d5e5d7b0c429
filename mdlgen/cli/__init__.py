"""The command line: the only package that prints, exits or draws progress. The work is in other packages."""

from __future__ import annotations

import copy
import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import typer

    app: typer.Typer

__all__ = ["app", "main"]

# Commands as one comes by them, and the module of each.
COMMANDS = {
    "new": "scene",
    "check": "scene",
    "preview": "preview",
    "live": "live",
    "mdl": "texts",
    "deck": "texts",
    "script": "texts",
    "verify": "texts",
    "lint": "texts",
    "run": "run",
    "compare": "compare",
    "report": "report",
    "view": "report",
    "export": "report",
    "sweep": "sweep",
    "optimize": "optimize",
    "calibrate": "calibrate",
    "bench": "bench",
    "explain": "scene",
    "schema": "scene",
    "upgrade": "scene",
    "cache": "cache",
}


def __getattr__(name: str) -> Any:
    if name == "app":  # with all commands
        return _app(list(COMMANDS))
    raise AttributeError(f"module 'mdlgen.cli' has no attribute {name!r}")


def _app(names: list[str]) -> typer.Typer:
    """The command line with some of its commands: to make all of them ready takes longer than most do."""
    from mdlgen.cli.shell import app

    for room in {COMMANDS[name] for name in names}:
        import_module(f"mdlgen.cli.{room}")
    made = copy.copy(app)
    there = {getattr(command.callback, "__name__", ""): command for command in app.registered_commands}
    made.registered_commands = [there[name] for name in names]
    return made


def main() -> None:
    """Entry point of the command `mdlgen`."""
    if os.environ.get("_MDLGEN_COMPLETE") == "complete_bash":
        from mdlgen.cli.completion import mend_bash

        mend_bash()
    wanted = sys.argv[1] if len(sys.argv) > 1 else ""
    _app([wanted] if wanted in COMMANDS else list(COMMANDS))()
