"""The command that runs a scene many times, each with other values."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mdlgen.cli import completion
from mdlgen.cli.shell import (
    COMPILING,
    PREPARING,
    SOLVER_FAILED,
    CheckStep,
    Json,
    Lets,
    Quiet,
    Raised,
    Sets,
    Solver,
    Verbose,
    app,
    count,
    echo_json,
    reports_errors,
    say,
)
from mdlgen.errors import OutputError, SpecError

if TYPE_CHECKING:
    from mdlgen.study.execution.workers import Runner


@app.command()
@reports_errors
def sweep(
    spec: Annotated[
        Path | None,
        typer.Argument(
            metavar="SPEC", help="The scene: a YAML or JSON file; with --resume alone, the folder of a sweep."
        ),
    ] = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            metavar="PATH=VALUES",
            help="A value that differs: START:STOP:N or [a, b, c], every combination of them; with --sample "
            "LO:HI, normal(MEAN, DEVIATION), normal(MEAN, DEVIATION, LO:HI), lognormal(MEDIAN, SPREAD). "
            "Quantities have their units: 180 rad/s:200 rad/s:5. May be given more than once.",
            autocompletion=completion.scene_paths,
        ),
    ] = None,
    measure: Annotated[
        list[str] | None,
        typer.Option(
            "--measure",
            metavar="NAME|NAME=EXPR",
            help="A number of summary.json by dotted name, or arithmetic over them, as "
            "slip='1 - sheets.note.travel_mm.x/93': travel, speed and yaw of each sheet if left out. "
            "events.jam counts jams.",
        ),
    ] = None,
    event: Annotated[
        list[str] | None,
        typer.Option(
            "--event",
            metavar="NAME=EXPR",
            help="A condition, as jam='events.jam > 0', whose probability is printed with its interval of "
            "95 %; take it from --sample random, whose cases are independent. May be given more than once.",
        ),
    ] = None,
    lets: Lets = None,
    sample: Annotated[
        tuple[str, int] | None,
        typer.Option(
            "--sample",
            metavar="KIND COUNT",
            help="Cases drawn by lhs, sobol or random; saltelli COUNT makes COUNT times (variables + 2) of "
            "them, for Sobol's indices.",
        ),
    ] = None,
    seed: Annotated[
        int, typer.Option("--seed", help="Seed of --sample; the same seed gives the same cases.")
    ] = 1,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="DIR", help="Where the table goes: out/NAME_sweep if left out."
        ),
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Go on with the sweep in DIR: mdlgen sweep --resume DIR."),
    ] = False,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers", min=1, max=256, help="Number of processes: one for each processor if left out."
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="Address of a Dask scheduler whose workers run the cases, as tcp://host:8786.",
        ),
    ] = None,
    keep: Annotated[
        bool, typer.Option("--keep", help="Keep the results of each case in DIR/case_N.")
    ] = False,
    parquet: Annotated[
        bool | None,
        typer.Option(
            "--parquet/--no-parquet",
            help="Write table.parquet too: where pyarrow is installed if left out (extra `sweep`).",
        ),
    ] = None,
    solver: Solver = "auto",
    check_step: CheckStep = False,
    sets: Sets = None,
    limits: Raised = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Run a scene many times with other values.

    Writes a table with a row for each case into DIR, and a page, study.html.

    Example: mdlgen sweep samples/transport_4x4.yaml --over contacts.4.friction=0.1:0.5:9 -o out/friction

    Example: mdlgen sweep --resume out/friction
    """
    from mdlgen import registry
    from mdlgen.study import sweep as study
    from mdlgen.study.analysis.table import check_parquet, installed
    from mdlgen.study.design.task import task

    if spec is None:
        raise SpecError("name a scene, mdlgen sweep SPEC, or a sweep to continue, mdlgen sweep --resume DIR")
    if scheduler is not None and workers is not None:
        raise SpecError("--workers are processes of this machine; those of a cluster are started with it")
    registry.check_solver(solver)
    if parquet:
        check_parquet()
    alone = resume and not over
    if alone and (
        output
        or measure
        or event
        or lets
        or sample
        or sets
        or limits
        or keep
        or check_step
        or solver != "auto"
    ):
        raise SpecError("--resume DIR takes scene, values, measures and solver from the sweep that is there")
    if alone:
        folder, wanted = spec, None
    else:
        cases, how = study.over(over or (), sample, seed)
        asked = task(
            spec, sets, limits, lets=tuple(lets or ()), solver=solver, check_step=check_step, keep=keep
        )
        wanted = study.sweep(asked, cases, how, measure or (), event or ())
        folder = output or Path("out") / f"{wanted.name}_{study.WHAT}"

    # a cluster that does not answer leaves no journal
    with closing(runner_of(scheduler, workers, quiet)) as runner:
        wanted, journal = study.opened(folder, wanted, resume)
        with journal:
            try:
                with count(quiet, "cases") as progress:
                    rows = study.run(wanted, journal, runner, progress)
            except (KeyboardInterrupt, OutputError):
                done = f"{len(journal.rows)} of {len(wanted.cases)} cases are done"
                say(f"{done}; mdlgen sweep --resume {folder} continues")
                raise
    from mdlgen.study.output.files import write, write_findings

    files = write(folder, wanted.task, rows, installed() if parquet is None else parquet)
    more, words = write_findings(folder, wanted, rows)
    files += more
    if as_json:
        names = [str(file) for file in files]
        failed = sum(not row.measured for row in rows)
        echo_json({"cases": len(rows), "failed": failed, "files": names, "rows": [r.json() for r in rows]})
    elif not quiet:
        typer.echo("\n".join([study.summary(rows), *words]))
        typer.echo(f"wrote {', '.join(str(file) for file in files)}")
    if not any(row.measured for row in rows):
        say(f"{spec}: all cases failed; {files[0]} has the reasons")
        raise typer.Exit(SOLVER_FAILED)


def runner_of(scheduler: str | None, workers: int | None, quiet: bool) -> Runner:
    """A cluster where one is named, else processes of this machine."""
    if scheduler is not None:
        from mdlgen.study.execution.cluster import Cluster

        return Cluster(scheduler)
    from mdlgen.study.execution.workers import COMPILING as COMPILES
    from mdlgen.study.execution.workers import Workers

    return Workers(workers, lambda word: None if quiet else say(COMPILING if word == COMPILES else PREPARING))
