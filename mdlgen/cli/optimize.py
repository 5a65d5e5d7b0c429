"""The command that looks for the best values of a scene."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli.shell import (
    SOLVER_FAILED,
    CheckStep,
    Lets,
    Quiet,
    Raised,
    Sets,
    Solver,
    Spec,
    Verbose,
    app,
    count,
    say,
    told,
)
from mdlgen.cli.sweep import runner_of
from mdlgen.errors import SpecError

FRAGMENT = "best.yaml"


@app.command()
@told
def optimize(
    spec: Spec,
    minimise: Annotated[
        str,
        typer.Option(
            "--minimise",
            "--minimize",
            metavar="EXPR",
            help="What is to be small: arithmetic over numbers of summary.json, as 'sheets.note.yaw_deg**2'. "
            "A square is found in fewer runs than an abs().",
        ),
    ],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="PATH=LO:HI",
            help="A value that may differ; PATH=[a, b, c] for one of a list. May be given more than once.",
        ),
    ] = None,
    subject_to: Annotated[
        list[str] | None,
        typer.Option(
            "--subject-to",
            metavar="CONDITION",
            help="What has to hold: A <= B or A >= B. May be given more than once.",
        ),
    ] = None,
    lets: Lets = None,
    measure: Annotated[
        list[str] | None,
        typer.Option("--measure", metavar="NAME|NAME=EXPR", help="Another number for the table."),
    ] = None,
    most: Annotated[int, typer.Option("--most", metavar="N", help="Runs that it may take.")] = 25,
    precision: Annotated[
        float,
        typer.Option("--precision", metavar="PART", help="Where the best value is known, of its range."),
    ] = 1e-3,
    method: Annotated[
        str,
        typer.Option(
            "--method",
            metavar="auto|brent|cobyqa|optuna",
            help="brent for one value, cobyqa for several or with conditions, optuna (extra `optuna`) for "
            "lists and for noise.",
        ),
    ] = "auto",
    seed: Annotated[int, typer.Option("--seed", help="Of --method optuna.")] = 1,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE.mdl", help="Write the best design as MotionView text too."
        ),
    ] = None,
    folder: Annotated[
        Path | None,
        typer.Option(
            "--folder", metavar="DIR", help="Where table and page go: out/NAME_optimisation if left out."
        ),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with what is in DIR.")] = False,
    workers: Annotated[
        int,
        typer.Option("--workers", min=1, max=256, help="Designs that optuna tries at a time."),
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option("--scheduler", metavar="ADDRESS", help="Of a Dask cluster that runs the designs."),
    ] = None,
    solver: Solver = "auto",
    check_step: CheckStep = False,
    sets: Sets = None,
    limits: Raised = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Find the values with which a number of the run is least; write each run into a table in DIR, and the
    best values as a piece of a scene file.

    Example: mdlgen optimize samples/tilt_correction.yaml --vary "delta=0 rad/s:50 rad/s"
    --let "rollers.motor_2_left.drive.speed=186 rad/s - delta"
    --let "rollers.motor_2_right.drive.speed=186 rad/s + delta"
    --minimise "sheets.note.yaw_deg**2" -o best.mdl
    """
    from mdlgen import paths, registry
    from mdlgen.cli.texts import mdl
    from mdlgen.study import optimisation as study
    from mdlgen.study.fragment import design, fragment, report_text
    from mdlgen.study.goal import goal
    from mdlgen.study.page import write_page
    from mdlgen.study.sweep import write
    from mdlgen.study.task import task

    registry.check_solver(solver)
    if output is not None and str(output) == "-":
        raise SpecError("-o: give a file; standard output has the best values")
    asked = task(spec, sets, limits, lets=tuple(lets or ()), solver=solver, check_step=check_step)
    wanted = study.optimisation(
        asked,
        vary or (),
        goal(minimise, subject_to or ()),
        measure or (),
        method,
        most,
        seed,
        precision,
        workers,
    )
    where = folder or Path("out") / f"{wanted.name}_optimisation"
    with closing(runner_of(scheduler, workers, quiet)) as runner:
        journal = study.opened(where, wanted, resume)
        with journal:
            try:
                with count(quiet, "runs") as progress:
                    rows, best = study.run(wanted, journal, runner, progress)
            except KeyboardInterrupt:
                say(f"the same with --resume goes on with this search ({len(journal.rows)} runs are done)")
                raise
    files = [*write(where, wanted.task, rows, parquet=False), write_page(where, wanted, rows, best)]
    if best is None:
        why = "met the conditions" if any(row.measured for row in rows) else "came to an end"
        say(f"{spec}: none of {len(rows)} runs {why}; {files[0]} has them")
        raise typer.Exit(SOLVER_FAILED)
    piece = fragment(wanted, rows, best)
    paths.write_atomic(where / FRAGMENT, piece)
    if not quiet:
        typer.echo(report_text(wanted, rows, best))
        say(f"wrote {', '.join(str(file) for file in (*files, where / FRAGMENT))}")
    typer.echo(piece, nl=False)
    if output is not None:
        mdl(spec, output, sets=[*(sets or ()), *design(wanted, best)], limits=limits, quiet=quiet)
