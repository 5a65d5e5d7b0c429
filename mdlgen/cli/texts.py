"""Files for other programs: they are written, read back, and compared with the Model."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mdlgen.cli import completion
from mdlgen.cli.shell import (
    Json,
    Quiet,
    Raised,
    Sets,
    Spec,
    Verbose,
    app,
    count,
    echo_json,
    model_of,
    reports_errors,
    say,
    scene_of,
)
from mdlgen.errors import AccuracyError, OutputError, SpecError


@app.command()
@reports_errors
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
            help="Only the sheets and their contacts, as a system definition to import into your own model.",
            autocompletion=completion.sheets_only,
        ),
    ] = None,
    sets: Sets = None,
    limits: Raised = None,
    set_contact: Annotated[
        bool,
        typer.Option(
            "--set-contact",
            help="Write contact numbers with SetContact, whose order is unverified, not in solver commands.",
        ),
    ] = False,
    target: Annotated[
        str,
        typer.Option(
            "--target",
            metavar="2021|2025",
            help="Version of MotionView: 2025 documents contacts without words for flipped normals.",
        ),
    ] = "2021",
    forces: Annotated[
        bool,
        typer.Option(
            "--forces",
            help="Also record the force of each contact of two parts, whose ids no file shows in an output.",
        ),
    ] = False,
    script: Annotated[
        bool,
        typer.Option(
            "--script",
            help="Also write FILE_mview.py: contact numbers, and forces at nodes, for the model itself.",
        ),
    ] = False,
    companion: Annotated[
        Path | None,
        typer.Option(
            "--companion", metavar="FILE", help="Where to write that script: FILE_mview.py if left out."
        ),
    ] = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write the scene as MotionView text.

    It runs as loaded. A script, FILE_mview.py, is written where it is asked for, and with --only sheets.

    Example: mdlgen mdl samples/transport_4x4.yaml -o note.mdl

    Example: mdlgen mdl samples/transport_4x4.yaml --only sheets
    """
    from mdlgen import paths, registry

    model = model_of(spec, sets, limits)
    backend = registry.emitter(registry.TEXT)
    text = backend.emit(model, set_contact=set_contact, only=only, target=target, forces=forces)
    reasons = backend.companion_reasons(model, set_contact, only)
    wanted = bool(reasons) or script or companion is not None
    program = backend.companion(model, set_contact=set_contact, only=only) if wanted else None
    to_stdout = output is not None and str(output) == "-"
    own_name = Path(f"{model.name}_{only}.mdl" if only else f"{model.name}.mdl")
    path = own_name if output is None or to_stdout else output
    beside = companion or path.with_name(f"{path.stem}_mview.py")
    files: dict[Path, str | bytes] = {} if to_stdout else {path: text}
    if program is not None and (companion is not None or not to_stdout):
        files[beside] = program
    if len({p.resolve() for p in (path, beside)}) == 1:
        raise OutputError(f"{beside}: is named for both the text and the script")
    paths.write_together(files)
    if to_stdout:
        typer.echo(text, nl=False)
    elif not quiet:
        say(f"wrote {path}")
    if program is not None and not quiet:
        state = f"wrote {beside}" if beside in files else "a script goes with it (--companion FILE writes it)"
        say(f"{state}; run it in MotionView after the text" + (", since MDL leaves out:" if reasons else ""))
        for reason in reasons:
            say(f"  {reason}")
    elif program is None and not to_stdout and beside.exists() and not quiet:
        say(f"{beside} is not needed for this text, and may be of an older one")


@app.command()
@reports_errors
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
    """Write the scene as a MotionSolve deck.

    MotionSolve reads it without MotionView.

    Example: mdlgen deck samples/transport_4x4.yaml -o note.xml
    """
    from mdlgen import paths, registry

    model = model_of(spec, sets, limits)
    text = registry.emitter(registry.DECK).emit(model)
    if output is not None and str(output) == "-":
        typer.echo(text, nl=False)
        return
    target = Path(f"{model.name}.xml") if output is None else output
    paths.write_atomic(target, text)
    if not quiet:
        say(f"wrote {target}")


@app.command()
@reports_errors
def script(
    spec: Spec,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE.py",
            help="Where to write: NAME.py if left out, - for standard output.",
        ),
    ] = None,
    sets: Sets = None,
    limits: Raised = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write the scene as a script for MotionSolve's Python.

    It makes the model, runs it, and writes what is recorded as CSV.

    Example: mdlgen script samples/transport_4x4.yaml -o note.py
    """
    from mdlgen import paths, registry

    model = model_of(spec, sets, limits)
    text = registry.emitter(registry.SCRIPT).emit(model)
    if output is not None and str(output) == "-":
        typer.echo(text, nl=False)
        return
    target = Path(f"{model.name}.py") if output is None else output
    paths.write_atomic(target, text)
    if not quiet:
        say(f"wrote {target}")


@app.command()
@reports_errors
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
    as_json: Annotated[bool, typer.Option("--json", help="Print the findings as JSON.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Check a MotionView text: syntax, names, arguments, values.

    Example: mdlgen lint note.mdl --values note.json
    """
    import json

    from mdlgen import paths
    from mdlgen.registry import TEXT, emitter

    to_stdout = values is not None and str(values) == "-"
    if to_stdout and as_json:
        raise SpecError("--json and --values - both take standard output; give --values a file")
    reading = emitter(TEXT).read(paths.read_exactly(text), str(text), text.parent)
    if values is not None:
        found = json.dumps(reading.values, allow_nan=False, indent=1) + "\n"
        typer.echo(found, nl=False) if to_stdout else paths.write_atomic(values, found)
    report = reading.report
    if as_json:
        findings = [
            {"severity": f.severity, "code": f.code, "place": str(f.place), "message": f.message}
            for f in report.findings
        ]
        counts = {"errors": len(report.errors), "warnings": len(report.warnings)}
        echo_json({"file": str(text), "statements": report.statements, **counts, "findings": findings})
    for finding in () if as_json else report.errors if quiet else report.findings:
        typer.echo(str(finding), err=to_stdout)
    if not quiet and not as_json:
        counts = f"{len(report.errors)} errors, {len(report.warnings)} warnings"
        typer.echo(f"{text}: {report.statements} statements, {counts}", err=to_stdout)
    if report.errors:
        raise typer.Exit(SpecError.exit_code)


@app.command()
@reports_errors
def verify(
    spec: Spec,
    text: Annotated[
        Path | None,
        typer.Option("--text", metavar="FILE.mdl", help="A text to check in place of the one mdlgen writes."),
    ] = None,
    script: Annotated[
        Path | None,
        typer.Option(
            "--script",
            metavar="FILE.py",
            help="Its companion script: FILE_mview.py in the folder of --text if left out.",
        ),
    ] = None,
    deck: Annotated[
        Path | None,
        typer.Option("--deck", metavar="FILE.xml", help="A deck to check in place of the one mdlgen writes."),
    ] = None,
    msolve: Annotated[
        Path | None,
        typer.Option(
            "--msolve",
            metavar="FILE.py",
            help="A script for MotionSolve to check in place of the one mdlgen writes; it is not run.",
        ),
    ] = None,
    only: Annotated[
        str | None,
        typer.Option(
            "--only",
            metavar="sheets",
            help="Check the sheets only; --text may be a whole model that holds them.",
            autocompletion=completion.sheets_only,
        ),
    ] = None,
    perturb: Annotated[
        bool,
        typer.Option(
            "--perturb/--no-perturb",
            "--turn/--no-turn",
            help="Also change each value of the data sets, in text and scene, and compare again.",
        ),
    ] = True,
    sets: Sets = None,
    limits: Raised = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Compare text, deck and scripts with the model that is run.

    They are read back; every number in them is compared with the tables of the local run.

    Example: mdlgen verify samples/transport_4x4.yaml

    Example: mdlgen verify samples/transport_4x4.yaml --text note.mdl
    """
    from mdlgen.model.lower import lower
    from mdlgen.verify.report import report, report_text
    from mdlgen.verify.verification import verify as compare

    scene = scene_of(spec, sets, limits)
    files = {"text": text, "companion": script, "deck": deck, "msolve": msolve}
    with count(quiet, "values changed") as progress:
        found = compare(scene, lower(scene), **files, only=only, perturb=perturb, progress=progress)
    if as_json:
        echo_json(report(found))
    elif not quiet:
        typer.echo(report_text(found))
    if not found.ok:
        differences = found.all_differences()
        more = f" and {len(differences) - 1} more" if len(differences) > 1 else ""
        raise AccuracyError(f"{text or spec}: not the same as the model: {differences[0]}{more}")
