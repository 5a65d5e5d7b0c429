"""The command that looks for the best values of a scene."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli import completion
from mdlgen.cli.shell import (
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
from mdlgen.cli.sweep import runner_of
from mdlgen.errors import SpecError

FRAGMENT = "best.yaml"


@app.command()
@reports_errors
def optimize(
    spec: Annotated[
        Path | None,
        typer.Argument(
            metavar="SPEC",
            help="The scene: a YAML or JSON file; with --resume alone, the folder of a search.",
        ),
    ] = None,
    minimise: Annotated[
        str | None,
        typer.Option(
            "--minimise",
            "--minimize",
            metavar="EXPR",
            help="The number to make small: arithmetic over summary.json, as 'sheets.note.yaw_deg**2'. A "
            "square is found in fewer runs than an abs().",
        ),
    ] = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="PATH=LO:HI",
            help="A value that may differ; PATH=[a, b, c] for one of a list. May be given more than once.",
            autocompletion=completion.scene_paths,
        ),
    ] = None,
    subject_to: Annotated[
        list[str] | None,
        typer.Option(
            "--subject-to",
            metavar="CONDITION",
            help="A condition that has to hold, A <= B or A >= B. May be given more than once.",
        ),
    ] = None,
    lets: Lets = None,
    measure: Annotated[
        list[str] | None,
        typer.Option("--measure", metavar="NAME|NAME=EXPR", help="Another number for the table."),
    ] = None,
    most: Annotated[int, typer.Option("--most", metavar="N", help="The greatest number of runs.")] = 25,
    precision: Annotated[
        float,
        typer.Option(
            "--precision", metavar="PART", help="Stop when the best value is known to this part of its range."
        ),
    ] = 1e-3,
    method: Annotated[
        str,
        typer.Option(
            "--method",
            metavar="auto|brent|cobyqa|optuna",
            help="brent for one value, cobyqa for several or with conditions, optuna (extra `optuna`) for "
            "lists and for noise.",
            autocompletion=completion.methods,
        ),
    ] = "auto",
    seed: Annotated[int, typer.Option("--seed", help="Seed of --method optuna.")] = 1,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="DIR",
            help="Where table and page go: out/NAME_optimisation if left out.",
        ),
    ] = None,
    text: Annotated[
        Path | None,
        typer.Option("--mdl", metavar="FILE.mdl", help="Write the best design as MotionView text too."),
    ] = None,
    folder: Annotated[Path | None, typer.Option("--folder", hidden=True)] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Resume the search in DIR: mdlgen optimize --resume DIR."),
    ] = False,
    workers: Annotated[
        int,
        typer.Option("--workers", min=1, max=256, help="Number of designs that optuna tries at a time."),
    ] = 1,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="Address of a Dask scheduler whose workers run the designs.",
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
    """Find the values for which a number of a run is least.

    Writes each run into a table in DIR, and the best values as a piece of a scene file.

    Example: mdlgen optimize samples/tilt_correction.yaml --vary "delta=0 rad/s:50 rad/s"
    --let "rollers.motor_2_left.drive.speed=186 rad/s - delta"
    --let "rollers.motor_2_right.drive.speed=186 rad/s + delta"
    --minimise "sheets.note.yaw_deg**2" --mdl best.mdl

    Example: mdlgen optimize --resume out/tilt_correction_optimisation
    """
    from mdlgen import paths, registry
    from mdlgen.cli.texts import mdl
    from mdlgen.study.design.task import task
    from mdlgen.study.optimise import optimisation as study
    from mdlgen.study.optimise.goal import goal
    from mdlgen.study.output.files import write
    from mdlgen.study.output.fragment import design, fragment, report_text
    from mdlgen.study.output.page import write_page

    output, text, notices = _places(output, text, folder)
    if spec is None:
        raise SpecError(
            "name a scene, mdlgen optimize SPEC, or a search to continue, mdlgen optimize --resume DIR"
        )
    registry.check_solver(solver)
    if text is not None and str(text) == "-":
        raise SpecError("--mdl: give a file; standard output has the best values")
    if resume and minimise is None:
        if (
            output
            or vary
            or subject_to
            or lets
            or measure
            or sets
            or limits
            or check_step
            or solver != "auto"
        ):
            raise SpecError("--resume DIR takes scene, values, goal and solver from the search that is there")
        where, wanted = spec, None
    elif minimise is None:
        raise SpecError("name what is to be small: --minimise EXPR")
    else:
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
        where = output or Path("out") / f"{wanted.name}_optimisation"
    for notice in () if quiet else notices:
        say(notice)
    with closing(runner_of(scheduler, workers, quiet)) as runner:
        wanted, journal = study.opened(where, wanted, resume)
        with journal:
            try:
                with count(quiet, "runs") as progress:
                    rows, best = study.run(wanted, journal, runner, progress)
            except KeyboardInterrupt:
                say(f"{len(journal.rows)} runs are done; mdlgen optimize --resume {where} continues")
                raise
    files = [*write(where, wanted.task, rows, parquet=False), write_page(where, wanted, rows, best)]
    if best is None:
        why = "met the conditions" if any(row.measured for row in rows) else "came to an end"
        say(f"{spec}: none of {len(rows)} runs {why}; {files[0]} has them")
        raise typer.Exit(SOLVER_FAILED)
    piece = fragment(wanted, rows, best)
    paths.write_atomic(where / FRAGMENT, piece)
    written = [str(file) for file in (*files, where / FRAGMENT)]
    if not quiet and not as_json:
        typer.echo(report_text(wanted, rows, best))
    if not quiet:
        say(f"wrote {', '.join(written)}")
    if as_json:
        sets = list(design(wanted, best))
        echo_json({"runs": len(rows), "best": best.json(), "set": sets, "files": written})
    else:
        typer.echo(piece, nl=False)
    if text is not None:
        there = wanted.task
        own = [*there.sets, *design(wanted, best)]
        mdl(Path(there.spec), text, sets=own, limits=list(there.limits), quiet=quiet)


def _places(
    output: Path | None, text: Path | None, folder: Path | None
) -> tuple[Path | None, Path | None, list[str]]:
    """Folder and text file that are meant, and notices: -o named the text before it named the folder, and
    --folder the folder; both still do."""
    notices = []
    if output is not None and output.suffix.lower() == ".mdl":
        if text is not None:
            raise SpecError("-o names the folder, --mdl the text; two texts are named")
        output, text = None, output
        notices.append(f"-o {text}: write --mdl {text}; -o names the folder")
    if folder is not None:
        if output is not None:
            raise SpecError("-o and --folder name the same folder; give -o")
        output = folder
        notices.append(f"--folder {folder}: write -o {folder}")
    return output, text, notices
