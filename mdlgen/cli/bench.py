"""Run time against error."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen import paths
from mdlgen.cli import completion
from mdlgen.cli.shell import (
    SOLVER_FAILED,
    Json,
    Quiet,
    Verbose,
    app,
    echo_json,
    reports_errors,
    say,
)
from mdlgen.errors import AccuracyError


@app.command()
@reports_errors
def bench(
    suites: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SUITE ...",
            help="transport, elastica, impact, friction, flight, scaling, skip, feeder, piles, stability, "
            "validation: all if left out.",
            autocompletion=completion.suites,
        ),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path(
        "out/bench"
    ),
    solver: Annotated[
        list[str] | None,
        typer.Option(
            "--solver",
            metavar="NAME",
            help="One of the solvers: all if left out.",
            autocompletion=completion.every_solver,
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A few short cases of each suite.")] = False,
    repeat: Annotated[int, typer.Option("--repeat", min=1, help="Runs whose median is the wall time.")] = 3,
    peers: Annotated[
        bool | None,
        typer.Option(
            "--peers/--no-peers",
            help="Run MuJoCo and a plain Exudyn script in transport too; if left out, where the extra "
            "`peers` is installed and no solver is chosen.",
        ),
    ] = None,
    beside: Annotated[
        Path | None,
        typer.Option(
            "--beside",
            metavar="FOLDER",
            help="A checkout of another state of mdlgen, which runs each case, too, right after this one, "
            "with its own samples and measures.",
        ),
    ] = None,
    page: Annotated[
        Path | None,
        typer.Option(
            "--page",
            metavar="FILE",
            help="Write the page of one suite too: stability or validation.",
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Measure run time against error.

    Writes bench.json, bench.md and bench.png into DIR.

    Example: mdlgen bench impact friction --solver exudyn

    Example: mdlgen bench stability --repeat 1 --page samples/stability.md
    """
    from mdlgen.bench import page as pages
    from mdlgen.bench.run import bench as run_bench
    from mdlgen.bench.table import markdown
    from mdlgen.paths import check_folder

    shown = "" if page is None else pages.check_page(suites or ())
    check_folder(output)
    heard = (lambda _: None) if quiet else say
    found = run_bench(suites or (), output, solver or (), quick, repeat, heard, peers, beside)
    if as_json:
        echo_json(found.json())
    elif not quiet:
        typer.echo(markdown(found), nl=False)
        typer.echo(f"wrote {output}")
    if page is not None:
        paths.write_atomic(page, pages.page(shown, found))
        if not quiet:
            say(f"wrote {page}")
    if found.wrong:
        row = found.wrong[0]
        raise AccuracyError(f"{len(found.wrong)} wrong: {row.case}, {row.solver}: {row.reason}")
    if found.failed:
        row = found.failed[0]
        say(f"{len(found.failed)} failed: {row.case}, {row.solver}: {row.reason}")
        raise typer.Exit(SOLVER_FAILED)
