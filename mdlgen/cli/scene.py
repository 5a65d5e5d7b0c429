"""Commands on the scene itself: a first scene, its overview, the meaning of a code, the schema."""

from __future__ import annotations

import sys
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
    Strict,
    Verbose,
    app,
    echo_json,
    model_of,
    reports_errors,
    say,
    strictly,
)
from mdlgen.errors import OutputError, SpecError, did_you_mean


@app.command()
@reports_errors
def new(
    folder: Annotated[Path | None, typer.Argument(metavar="DIR", help="Where to put the scene.")] = None,
    sample: Annotated[
        str,
        typer.Option(
            "--from", metavar="SAMPLE", help="The sample to copy.", autocompletion=completion.sample_names
        ),
    ] = "transport_4x4",
    show: Annotated[bool, typer.Option("--list", help="List the samples instead.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the list as JSON.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Copy a commented starter scene into DIR.

    Example: mdlgen new my_scene --from cantilever
    """
    from mdlgen import paths
    from mdlgen.spec.load import load

    root = paths.samples()
    known = {p.relative_to(root).with_suffix("").as_posix(): p for p in sorted(root.rglob("*.yaml"))}
    if show:
        first = {n: p.read_text("utf-8").partition("\n")[0].lstrip("# ") for n, p in known.items()}
        if as_json:
            echo_json(first)
        else:
            typer.echo("\n".join(f"{name:20} {line}" for name, line in first.items()))
        return
    if folder is None:
        raise SpecError("name a folder: mdlgen new DIR (or --list for the samples)")
    if sample.removesuffix(".yaml") not in known:
        close = did_you_mean(sample[:80], known)
        raise SpecError(f"there is no sample {sample[:80]!r}{close or ';'} there are: {', '.join(known)}")
    source = known[sample.removesuffix(".yaml")]
    target = folder / source.name
    if target.exists() or target.is_symlink():
        raise OutputError(f"{target}: exists already; choose another folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot make this folder: {error.strerror or error}") from None
    for mesh in load(source).meshes.values():
        beside = folder / mesh.file
        if beside.exists() or beside.is_symlink():
            raise OutputError(f"{beside}: exists already; choose another folder")
        beside.parent.mkdir(parents=True, exist_ok=True)
        paths.write_atomic(beside, (source.parent / mesh.file).read_bytes())
    paths.write_atomic(target, source.read_bytes())
    typer.echo(target)
    if not quiet:
        say(f"next: mdlgen check {target}")


@app.command()
@reports_errors
def check(
    spec: Spec,
    sets: Sets = None,
    limits: Raised = None,
    strict: Strict = False,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON, in mm, N, g, ms, rad.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Validate a scene; show derived quantities, counts and lints.

    Example: mdlgen check samples/transport_4x4.yaml --set sheets.note.boxes=[20,30]
    """
    from mdlgen.cli import tables
    from mdlgen.lints.smoothing import notice
    from mdlgen.report.overview import overview
    from mdlgen.report.text import overview_text
    from mdlgen.results.required import check as check_required

    model = model_of(spec, sets, limits)
    check_required(model)
    found = overview(model)
    if as_json:
        echo_json(found)
    elif not quiet and sys.stdout.isatty():
        tables.show(found)
    elif not quiet:
        typer.echo(overview_text(found))
    else:
        for lint in found["lints"]:
            typer.echo("{code} {where}: {message}; {remedy}".format(**lint))
    if not quiet and (message := notice(model)):
        say(message)
    if strict:
        strictly(model)


@app.command()
@reports_errors
def explain(
    code: Annotated[
        str | None,
        typer.Argument(
            metavar="CODE",
            help="A code, as W104 or dangling; all are listed if left out.",
            autocompletion=completion.codes,
        ),
    ] = None,
    as_json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Say what a code of check or lint means, and what to do.

    Example: mdlgen explain W104
    """
    from mdlgen.explain import SCENE, TEXT
    from mdlgen.explain import explain as meaning

    if code is not None:
        text = meaning(code)
        echo_json({code: text}) if as_json else typer.echo(text)
        return
    if as_json:
        echo_json({**SCENE, **TEXT})
        return
    for title, table in (("mdlgen check", SCENE), ("mdlgen lint", TEXT)):
        typer.echo(title)
        for name, text in table.items():
            typer.echo(f"  {name:10} {text.partition('. ')[0].rstrip('.')}.")


@app.command()
@reports_errors
def schema(
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", metavar="FILE.json", help="Where to write: standard output if left out, or -."
        ),
    ] = Path("-"),
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Print the JSON schema of a scene file, for editors.

    Example: mdlgen schema -o scene.schema.json
    """
    import json

    from mdlgen import paths
    from mdlgen.spec.schema import json_schema

    if str(output) == "-":
        echo_json(json_schema())
        return
    paths.write_atomic(output, json.dumps(json_schema(), indent=2) + "\n")
    if not quiet:
        say(f"wrote {output}")


@app.command()
@reports_errors
def upgrade(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The scene file, which is rewritten.")],
    check: Annotated[
        bool, typer.Option("--check", help="Say what would be written; exit code 3: something.")
    ] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Write into a scene of an older version what must be said today.

    A contact without friction had none: it gets `friction: 0`. Without smoothing it had 1 mm/s: it gets that
    where it would have another value today. Comments and form stay.

    Example: mdlgen upgrade scene.yaml --check
    """
    from mdlgen import paths
    from mdlgen.spec.load import read
    from mdlgen.spec.upgrade import upgraded

    text, changes = upgraded(read(file), str(file), folder=file.parent)
    if not quiet:
        for change in changes:
            typer.echo(change)
        if not changes:
            typer.echo(f"{file}: nothing to write")
    if changes and check:
        raise typer.Exit(3)
    if changes:
        paths.write_atomic(file, text.encode("utf-8"))
