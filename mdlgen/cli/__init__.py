"""The command line: the only room that prints, exits or draws progress. What it does stands elsewhere."""

from __future__ import annotations

from mdlgen.cli import bench as bench
from mdlgen.cli import cache as cache
from mdlgen.cli import calibrate as calibrate
from mdlgen.cli import optimize as optimize
from mdlgen.cli import report as report
from mdlgen.cli import run as run
from mdlgen.cli import scene as scene
from mdlgen.cli import sweep as sweep
from mdlgen.cli import texts as texts
from mdlgen.cli.shell import app

__all__ = ["app", "main"]

# as one comes by them
ORDER = (
    *("new", "check", "mdl", "deck", "verify", "lint", "run", "report", "view", "export"),
    *("sweep", "optimize", "calibrate", "bench", "explain", "schema", "cache"),
)
app.registered_commands.sort(key=lambda command: ORDER.index(getattr(command.callback, "__name__", "")))


def main() -> None:
    """Entry point of the command `mdlgen`."""
    app()
