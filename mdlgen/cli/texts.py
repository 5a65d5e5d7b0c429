"""What other programs read: written, read again, compared with the Model."""

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
    count,
    echo_json,
    model_of,
    say,
    scene_of,
    told,
)
from mdlgen.errors import AccuracyError, OutputError, SpecError


@app.command()
@told
def mdl(
    spec: Spec,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.mdl",
            help="Where to write: NAME.mdl if left out (NAME_sheets.mdl with --only sheets), "
            "- for standard output.",
        ),
    ] = None,
    only: Annotated[
        str | None,
        typer.Option(
            "--only",
            metavar="sheets",
            help="The sheets and their contacts alone, as a system definition to bring into your own model.",
        ),
    ] = None,
    sets: Sets = None,
    limits: Raised = None,
    set_contact: Annotated[
        bool,
        typer.Option("--set-contact", help="Write contact numbers with SetContact, unverified in its order."),
    ] = False,
    companion: Annotated[
        Path | None,
        typer.Option(
            "--companion", metavar="FILE", help="The script for MotionView: FILE_mview.py if left out."
        ),
    ] = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write the scene as MotionView text, and beside it a script for what the text cannot say.

    Example: mdlgen mdl samples/transport_4x4.yaml -o note.mdl

    Example: mdlgen mdl samples/transport_4x4.yaml --only sheets
    """
    from mdlgen import paths, registry

    model = model_of(spec, sets, limits)
    backend = registry.emitter("motionview")
    text = backend.emit(model, set_contact=set_contact, only=only)
    script = backend.companion(model, set_contact=set_contact, only=only)
    to_stdout = output is not None and str(output) == "-"
    own_name = Path(f"{model.name}_{only}.mdl" if only else f"{model.name}.mdl")
    target = own_name if output is None or to_stdout else output
    beside = companion or target.with_name(f"{target.stem}_mview.py")
    files: dict[Path, str | bytes] = {} if to_stdout else {target: text}
    if script is not None and (companion is not None or not to_stdout):
        files[beside] = script
    if len({p.resolve() for p in (target, beside)}) == 1:
        raise OutputError(f"{beside}: is named for both the text and the script")
    paths.write_together(files)
    if to_stdout:
        typer.echo(text, nl=False)
    elif not quiet:
        say(f"wrote {target}")
    if script is not None and not quiet:
        state = (
            f"wrote {beside}" if beside in files else "a script is needed too (--companion FILE writes it)"
        )
        say(f"{state}; run it in MotionView after the text, since MDL leaves out:")
        for reason in backend.companion_reasons(model, set_contact, only):
            say(f"  {reason}")
    elif script is None and not to_stdout and beside.exists() and not quiet:
        say(f"{beside} is not needed for this text, and may be of an older one")


@app.command()
@told
def deck(
    spec: Spec,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.xml",
            help="Where to write: NAME.xml if left out, - for standard output.",
        ),
    ] = None,
    sets: Sets = None,
    limits: Raised = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write the scene as a MotionSolve deck, which the solver reads without MotionView.

    Example: mdlgen deck samples/transport_4x4.yaml -o note.xml
    """
    from mdlgen import paths, registry

    model = model_of(spec, sets, limits)
    text = registry.emitter("motionsolve").emit(model)
    if output is not None and str(output) == "-":
        typer.echo(text, nl=False)
        return
    target = Path(f"{model.name}.xml") if output is None else output
    paths.write_atomic(target, text)
    if not quiet:
        say(f"wrote {target}")


@app.command()
@told
def lint(
    text: Annotated[Path, typer.Argument(metavar="FILE.mdl", help="Any MotionView text.")],
    values: Annotated[
        Path | None,
        typer.Option(
            "--values",
            metavar="JSON",
            help="Write every evaluated entity, - for standard output (remarks then go to standard error); "
            "mm, N, kg, s, rad; inertia is xx, yy, zz, xy, yz, xz about the centre of mass.",
        ),
    ] = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Read a MotionView text: syntax, names, numbers of arguments, expressions.

    Example: mdlgen lint note.mdl --values note.json
    """
    import json

    from mdlgen import paths
    from mdlgen.registry import reader

    reading = reader("motionview").read(paths.read_exactly(text), str(text), text.parent)
    to_stdout = values is not None and str(values) == "-"
    if values is not None:
        found = json.dumps(reading.values, allow_nan=False, indent=1) + "\n"
        typer.echo(found, nl=False) if to_stdout else paths.write_atomic(values, found)
    report = reading.report
    for finding in report.errors if quiet else report.findings:
        typer.echo(str(finding), err=to_stdout)
    if not quiet:
        counts = f"{len(report.errors)} errors, {len(report.warnings)} warnings"
        typer.echo(f"{text}: {report.statements} statements, {counts}", err=to_stdout)
    if report.errors:
        raise typer.Exit(SpecError.exit_code)


@app.command()
@told
def verify(
    spec: Spec,
    text: Annotated[
        Path | None,
        typer.Option("--text", metavar="FILE.mdl", help="A text to take in place of the one mdlgen writes."),
    ] = None,
    script: Annotated[
        Path | None,
        typer.Option(
            "--script",
            metavar="FILE.py",
            help="Its companion script: FILE_mview.py beside --text if left out.",
        ),
    ] = None,
    deck: Annotated[
        Path | None,
        typer.Option("--deck", metavar="FILE.xml", help="A deck to take in place of the one mdlgen writes."),
    ] = None,
    only: Annotated[
        str | None,
        typer.Option(
            "--only", metavar="sheets", help="The sheets alone; --text may be a model that has them."
        ),
    ] = None,
    turn: Annotated[
        bool,
        typer.Option("--turn/--no-turn", help="Also turn each value of the data sets, in text and spec."),
    ] = True,
    sets: Sets = None,
    limits: Raised = None,
    as_json: Annotated[bool, typer.Option("--json", help="The result as JSON.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Read text, script and deck back, and compare all they say with the model that is run.

    Example: mdlgen verify samples/transport_4x4.yaml

    Example: mdlgen verify samples/transport_4x4.yaml --text note.mdl
    """
    from mdlgen.model.lower import lower
    from mdlgen.verify.report import report, report_text
    from mdlgen.verify.verification import verify as compare

    scene = scene_of(spec, sets, limits)
    files = {"text": text, "companion": script, "deck": deck}
    with count(quiet, "values turned") as progress:
        found = compare(scene, lower(scene), **files, only=only, turn=turn, progress=progress)
    if as_json:
        echo_json(report(found))
    elif not quiet:
        typer.echo(report_text(found))
    if not found.ok:
        differences = found.all_differences()
        more = f" and {len(differences) - 1} more" if len(differences) > 1 else ""
        raise AccuracyError(f"{text or spec}: not the same as the model: {differences[0]}{more}")
