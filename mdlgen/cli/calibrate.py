"""The command that finds a value of a material from a measurement."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli import completion
from mdlgen.cli.shell import (
    SOLVER_FAILED,
    Json,
    Quiet,
    Raised,
    Sets,
    Solver,
    Spec,
    Verbose,
    app,
    count,
    echo_json,
    reports_errors,
    say,
    scene_of,
    solver_output,
)
from mdlgen.errors import SpecError


@app.command()
@reports_errors
def calibrate(
    spec: Spec,
    measured: Annotated[
        str,
        typer.Option(
            "--measured",
            metavar="DROP|FILE.csv",
            help='A drop of the probe along gravity at rest, as "60.76 mm"; or a curve over time: a CSV file '
            "with columns like time_ms,drop_mm.",
        ),
    ],
    fit: Annotated[
        str,
        typer.Option(
            "--fit",
            metavar="NAME",
            help="The value to find, of the probed sheet's material: k_tx, k_ty, D_cd, D_md, damping.ratio, "
            "damping.ratio_ty, damping.time, damping.loss_factor. k_tx takes the place of D_cd, k_ty that of "
            "D_md, and one form of damping that of the others. Or a parameter of the scene, parameters.NAME.",
            autocompletion=completion.fits,
        ),
    ],
    probe: Annotated[
        str | None,
        typer.Option("--probe", metavar="NAME", help="The measured point: the only probe if left out."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.yaml",
            help="Write the value as a piece of a scene file, - for standard output.",
        ),
    ] = None,
    solver: Solver = "auto",
    sets: Sets = None,
    limits: Raised = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Find bending stiffness or damping from a measurement.

    That is the drop of a tip at rest, or a curve of it over time.

    Example: mdlgen calibrate samples/cantilever.yaml --measured "60.76 mm" --fit D_cd

    Example: mdlgen calibrate samples/cantilever.yaml --measured decay.csv --fit damping.time
    --set run.analysis=transient --set run.duration="400 ms"
    """
    from mdlgen import paths, registry
    from mdlgen.calibrate import value
    from mdlgen.calibrate.calibration import calibrate as search
    from mdlgen.calibrate.measured import read_measured
    from mdlgen.calibrate.report import fragment, quantity, report, report_text

    to_stdout = output is not None and str(output) == "-"
    if to_stdout and as_json:
        raise SpecError("--json and -o - both take standard output; give -o a file")
    registry.check_solver(solver)
    value.find(fit)
    wanted = read_measured(measured)
    scene = scene_of(spec, sets, limits)
    with count(quiet, "runs") as progress, solver_output(verbose):
        found = search(scene, wanted, fit, probe, solver, progress)
    if not found.ok:
        say(f"{spec}: {found.status}; nothing was written")
        raise typer.Exit(SOLVER_FAILED)
    if output is not None and not to_stdout:
        paths.write_atomic(output, fragment(found))
    if to_stdout:
        typer.echo(fragment(found), nl=False)
    elif as_json:
        echo_json(report(found))
    elif not quiet:
        typer.echo(report_text(found))
    elif output is None:
        typer.echo(quantity(found))
    if output is not None and not to_stdout and not quiet:
        say(f"wrote {output}")
