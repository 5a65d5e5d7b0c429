"""`mdlgen cache`: the cached files, and a check that the shipped programs fit."""

from __future__ import annotations

from typing import Annotated

import typer

from mdlgen.cli.shell import Quiet, Verbose, app, reports_errors

UNFIT = 3


@app.command()
@reports_errors
def cache(
    clear: Annotated[bool, typer.Option("--clear", help="Remove what is kept.")] = False,
    check: Annotated[
        bool,
        typer.Option("--check", help="Print which shipped programs fit; exit code 3: not all do."),
    ] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Show where compiled code and templates are kept.

    The folder is printed with its size.

    Example: mdlgen cache --clear
    """
    from mdlgen import paths

    if check:
        _check(quiet)
    elif clear:
        gone = paths.clear_cache()
        if not quiet:
            typer.echo(f"removed {gone / 1e6:.1f} MB")
    else:
        typer.echo(f"{paths.user_cache()}: {paths.cache_size() / 1e6:.1f} MB")


def _check(quiet: bool) -> None:
    from mdlgen.program.build import programs
    from mdlgen.program.file import Unfit
    from mdlgen.program.kernel import alone

    wrong = False
    for program in programs():
        try:
            program.head()
            if (why := program.why_not()) is not None and not alone():
                raise Unfit(why)
        except Unfit as error:
            wrong = True
            typer.echo(f"{error}: numba compiles, some minutes once on a machine")
        else:
            if not quiet:
                typer.echo(f"{program.path.name} fits: {program.code()}")
    if wrong:
        raise typer.Exit(UNFIT)
