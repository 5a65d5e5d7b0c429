"""The commands that show what a run left."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli.shell import Pictures, Quiet, Verbose, app, reports_errors, say
from mdlgen.errors import OutputError, SpecError
from mdlgen.extras import require
from mdlgen.report import PAGE


@app.command()
@reports_errors
def report(
    folders: Annotated[
        list[Path],
        typer.Argument(metavar="DIR ...", help="Folders that `mdlgen run` wrote; several go on one page."),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.html",
            help="The page: DIR/report.html if left out; of several runs compare.html.",
        ),
    ] = None,
    at: Annotated[
        str | None,
        typer.Option(
            "--stills",
            metavar="TIMES",
            help="Pictures for print at these times, as 0,18,30,50ms, next to the page: still_18ms.png ...",
        ),
    ] = None,
    pictures: Pictures = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Rebuild the report of a run, or put several on one page.

    Example: mdlgen report out/transport_4x4

    Example: mdlgen report out/coarse out/fine -o compare.html

    Example: mdlgen report out/transport_4x4 --stills 0,18,30,50ms
    """
    from mdlgen import paths
    from mdlgen.report.figures.pictures import pictures_of
    from mdlgen.report.figures.stills import stills, times
    from mdlgen.report.html.page import page
    from mdlgen.results.io.store import load

    wanted = None if at is None else times(at)
    if wanted is not None and len(folders) > 1:
        raise SpecError("--stills are of one run; name one folder")
    if pictures and len(folders) > 1:
        raise SpecError("--pictures are of one run; name one folder")
    if wanted is not None or pictures:
        require("matplotlib")
    results = [load(folder) for folder in folders]
    names = _names(folders)
    target = output or (folders[0] / PAGE if len(folders) == 1 else Path("compare.html"))
    files: dict[Path, str | bytes] = {target: page(results, names if len(folders) > 1 else ())}
    if wanted is not None:
        files |= {target.with_name(name): picture for name, picture in stills(results[0], wanted).items()}
    if pictures:
        files |= {target.with_name(name): picture for name, picture in pictures_of(results[0]).items()}
    paths.write_together(files)
    if not quiet:
        for file in files:
            say(f"wrote {file}")


@app.command()
@reports_errors
def export(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of `mdlgen run`.")],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.glb|FILE.vtkhdf",
            help="An animated GLB for viewers of 3D, or VTKHDF for ParaView, by its ending.",
        ),
    ],
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write a run for other programs that show motion.

    Example: mdlgen export out/transport_4x4 -o note.glb

    Example: mdlgen export out/transport_4x4 -o note.vtkhdf
    """
    from mdlgen import paths
    from mdlgen.report.export.gltf import glb
    from mdlgen.report.export.vtkhdf import vtkhdf
    from mdlgen.results.io.store import load

    writers = {".glb": glb, ".vtkhdf": vtkhdf}
    if output.suffix.lower() not in writers:
        raise SpecError(f"{output}: the name's ending chooses the format; there are: {', '.join(writers)}")
    paths.write_atomic(output, writers[output.suffix.lower()](load(folder)))
    if not quiet:
        say(f"wrote {output}")


@app.command()
@reports_errors
def view(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of `mdlgen run`.")],
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Open the report of a run in the browser.

    It is made first where it is missing or older than the run.

    Example: mdlgen view out/transport_4x4
    """
    import webbrowser

    from mdlgen import paths
    from mdlgen.report.html.page import page
    from mdlgen.results.io.store import load

    target, states = folder / PAGE, folder / "result.h5"
    try:
        fresh = target.exists() and not (
            states.exists() and states.stat().st_mtime_ns > target.stat().st_mtime_ns
        )
    except OSError as error:
        raise OutputError(f"{folder}: cannot read: {error.strerror or error}") from None
    if not fresh:
        paths.write_atomic(target, page([load(folder)]))
    if not webbrowser.open(target.resolve().as_uri()) and not quiet:
        say("no browser was found; open the page yourself:")
    typer.echo(target)


def _names(folders: list[Path]) -> list[str]:
    """Names of runs: their folders, with as much of the path as makes them differ."""
    if len({folder.resolve() for folder in folders}) != len(folders):
        raise SpecError("a folder is named twice; name different runs")
    short = [folder.resolve().name for folder in folders]
    return short if len(set(short)) == len(short) else [str(folder) for folder in folders]
