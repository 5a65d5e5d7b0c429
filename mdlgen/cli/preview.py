"""The command that shows a scene before it is run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli.shell import (
    Quiet,
    Raised,
    Sets,
    Spec,
    Verbose,
    app,
    model_of,
    reports_errors,
    say,
    source_of,
)
from mdlgen.errors import OutputError, SpecError

PAGE = "preview.html"


@app.command()
@reports_errors
def preview(
    spec: Spec,
    sets: Sets = None,
    limits: Raised = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.png|FILE.html",
            help="A still, or the page, by its ending; out/NAME/preview.html if left out.",
        ),
    ] = None,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser; not with -o.")
    ] = True,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Show a scene as it begins, without a run.

    Names, axes and scale, arrows of drives, presses, speeds and loads, the sheets with zones and grid;
    contacts and how deep they are, and what check finds, at their parts.

    Example: mdlgen preview samples/transport_4x4.yaml

    Example: mdlgen preview samples/transport_4x4.yaml --set sheets.note.turn="5 deg" -o start.png
    """
    from mdlgen import paths

    wanted = "" if output is None else output.suffix.lower()
    if output is not None and wanted not in (".png", ".html"):
        raise SpecError(f"{output}: the name's ending chooses what is written; there are: .png, .html")
    model = model_of(spec, sets, limits)
    target = output or _folder(Path("out") / model.name) / PAGE
    if wanted == ".png":
        from mdlgen.report.figures.start import still

        paths.write_atomic(target, still(model))
    else:
        from mdlgen.report.html.preview import preview as page
        from mdlgen.spec.load import read

        source = source_of(read(spec), sets or ()) if spec.is_file() else ""
        paths.write_atomic(target, page(model, source))
    if output is None and browser:
        import webbrowser

        if not webbrowser.open(target.resolve().as_uri()) and not quiet:
            say("no browser was found; open the page yourself:")
    typer.echo(target)


def _folder(folder: Path) -> Path:
    """A folder, which is made where it is not there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    return folder
