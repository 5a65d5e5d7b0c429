"""The command that compares a run with what another program recorded."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli.shell import Json, Quiet, Verbose, app, echo_json, reports_errors, say
from mdlgen.errors import AccuracyError

PAGE = "compare.html"


@app.command()
@reports_errors
def compare(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of `mdlgen run`.")],
    recorded: Annotated[
        Path,
        typer.Option(
            "--with",
            metavar="FILE",
            help="Recording of the same scene by another program: NAME.plt or NAME_requests.csv of "
            "MotionSolve, or a table with the columns of series.csv.",
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE.html", help="The page with both: DIR/compare.html if left out."
        ),
    ] = None,
    within: Annotated[
        float | None,
        typer.Option(
            metavar="FRACTION",
            min=0.0,
            help="The largest relative difference that is allowed, such as 0.05: above it, exit code 5.",
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Compare a run with what MotionSolve recorded.

    Probes, rollers and contact forces on one clock: differences as numbers, and both on a page.

    Example: mdlgen compare out/transport_4x4 --with transport_4x4.plt
    """
    from mdlgen import paths
    from mdlgen.report.html.page import page
    from mdlgen.report.html.recorded import lines
    from mdlgen.results.io.store import load
    from mdlgen.results.recorded.against import against
    from mdlgen.results.recorded.files import read

    result = load(folder)
    found = against(result, read(recorded))
    target = output or folder / PAGE
    paths.write_atomic(target, page([result], (), found))
    if as_json:
        echo_json(found.record())
    elif not quiet:
        typer.echo("\n".join(lines(found)))
    if not quiet:
        say(f"wrote {target}")
    worst = max(found.quantities, key=lambda one: one.relative)
    if within is not None and not worst.relative <= within:
        apart = sum(not one.relative <= within for one in found.quantities)
        raise AccuracyError(
            f"{recorded}: {apart} of {len(found.quantities)} quantities are further than {within:g} from "
            f"the run; furthest {worst.name}: {worst.relative:.3g}"
        )
