"""The command line: the only room that prints, exits or draws progress. What it does stands elsewhere."""

from __future__ import annotations

from mdlgen.cli import calibrate as calibrate
from mdlgen.cli import commands as commands
from mdlgen.cli import optimize as optimize
from mdlgen.cli import report as report
from mdlgen.cli import sweep as sweep
from mdlgen.cli.shell import app

__all__ = ["app", "main"]


def main() -> None:
    """Entry point of the command `mdlgen`."""
    app()
