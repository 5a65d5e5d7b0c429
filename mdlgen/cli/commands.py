"""The commands that make, check, write, read and run a scene. What they do stands elsewhere."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Annotated

import typer

from mdlgen.cli.shell import (
    SOLVER_FAILED,
    Pictures,
    Quiet,
    Raised,
    Sets,
    Spec,
    Verbose,
    app,
    beside,
    chatter,
    count,
    echo_json,
    model_of,
    progress_bar,
    say,
    scene_of,
    source_of,
    told,
)
from mdlgen.errors import AccuracyError, OutputError, SpecError, did_you_mean

if TYPE_CHECKING:
    from mdlgen.results.keep import Keep


@app.command()
@told
def new(
    folder: Annotated[Path | None, typer.Argument(metavar="DIR", help="Where to put the scene.")] = None,
    sample: Annotated[
        str, typer.Option("--from", metavar="SAMPLE", help="The sample to copy.")
    ] = "transport_4x4",
    show: Annotated[bool, typer.Option("--list", help="List the samples instead.")] = False,
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
        for name, path in known.items():
            first = path.read_text("utf-8").partition("\n")[0].lstrip("# ")
            typer.echo(f"{name:20} {first}")
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
@told
def check(
    spec: Spec,
    sets: Sets = None,
    limits: Raised = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON, in mm, N, g, ms, rad.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Validate a scene; show derived quantities, counts and lints.

    Example: mdlgen check samples/transport_4x4.yaml --set sheets.note.boxes=[20,30]
    """
    from mdlgen.cli import tables
    from mdlgen.report.overview import overview
    from mdlgen.report.text import overview_text

    found = overview(model_of(spec, sets, limits))
    if as_json:
        echo_json(found)
    elif not quiet and sys.stdout.isatty():
        tables.show(found)
    elif not quiet:
        typer.echo(overview_text(found))
    else:
        for lint in found["lints"]:
            typer.echo("{code} {where}: {message}; {remedy}".format(**lint))


@app.command()
@told
def explain(
    code: Annotated[
        str | None, typer.Argument(metavar="CODE", help="As W104, or dangling: all are listed if left out.")
    ] = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Say what a code of `mdlgen check` or `mdlgen lint` means, and what to do.

    Example: mdlgen explain W104
    """
    from mdlgen.explain import SCENE, TEXT
    from mdlgen.explain import explain as meaning

    if code is not None:
        typer.echo(meaning(code))
        return
    for title, table in (("mdlgen check", SCENE), ("mdlgen lint", TEXT)):
        typer.echo(title)
        for name, text in table.items():
            typer.echo(f"  {name:10} {text.partition('. ')[0].rstrip('.')}.")


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
def run(
    spec: Annotated[
        Path | None, typer.Argument(metavar="SPEC", help="The scene: a YAML or JSON file.")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where the results go: out/NAME if left out."),
    ] = None,
    solver: Annotated[
        str, typer.Option("--solver", metavar="auto|lattice|exudyn", help="What runs it.")
    ] = "auto",
    check_step: Annotated[
        bool,
        typer.Option("--check-step", help="Run again at half the step; the difference estimates the error."),
    ] = False,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="DIR", help="Go on with the run in DIR that was cut off."),
    ] = None,
    checkpoint: Annotated[
        float | None,
        typer.Option(
            "--checkpoint",
            metavar="SECONDS",
            min=0.0,
            help="How often a state to go on from is kept in DIR/checkpoint: 60 if left out.",
        ),
    ] = None,
    keep_partial: Annotated[
        bool,
        typer.Option("--keep-partial", help="After Ctrl-C write what there is into DIR/partial, marked so."),
    ] = False,
    pictures: Pictures = False,
    sets: Sets = None,
    limits: Raised = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Simulate a scene; write summary.json, series.csv, result.h5 and report.html into DIR.

    Example: mdlgen run samples/transport_4x4.yaml -o out --check-step

    Example: mdlgen run --resume out
    """
    from mdlgen import registry
    from mdlgen.cli import kept

    kept.single(spec, resume, bool(sets or limits or output or check_step or solver != "auto"))
    registry.check_solver(solver)
    if resume is not None:
        task, seal = kept.again(resume)
        model = task.model()
        kept.compare(resume, seal, model)
    else:
        assert spec is not None
        task, seal = kept.task(spec, sets, limits, solver, check_step), None
        model = task.model()
    from mdlgen.report.page import load_page, page
    from mdlgen.report.pictures import are_drawn, load_drawing, pictures_of
    from mdlgen.report.text import summary_text
    from mdlgen.results.keep import Keep
    from mdlgen.results.store import check_folder, save

    folder = resume or output or Path("out") / model.name
    check_folder(folder)
    name, why = registry.chosen(task.solver, model)
    if task.solver == "auto" and why and not quiet:
        say(f"{name} runs this scene ({why})")
    for asked, wish in ((keep_partial, "--keep-partial"), (checkpoint is not None, "--checkpoint")):
        if asked:
            kept.check(name, why, wish)
    drawn = pictures or are_drawn(folder)
    every = 60.0 if checkpoint is None else checkpoint
    if seal is not None:
        keep = Keep(folder / kept.FOLDER, every)
    elif name == "lattice":
        keep = kept.kept(folder, task, model, every)
    else:
        keep = Keep()
        keep.begun.set()
    # what draws takes half a second to load: compiled code leaves a second core to it, not what comes before
    for load in (load_drawing, load_page) if drawn else (load_page,):
        Thread(target=lambda load=load: keep.begun.wait() and load(), daemon=True).start()
    if seal is None and kept.is_kept(folder) and not quiet:
        say(f"{folder} holds a run that was cut off; this one takes its place (--resume {folder} goes on)")
    # a solver may talk on standard output, which is kept for results
    try:
        with progress_bar(quiet, task.check_step) as progress, chatter(verbose):
            result = beside(lambda: registry.solve(model, task.solver, progress, task.check_step, keep))
    except KeyboardInterrupt:
        keep.lock.acquire(timeout=0.5)  # a file that is being written is soon complete
        if keep_partial:
            _save_part(keep, folder)
        if keep.written:
            say(f"mdlgen run --resume {folder} goes on with this run")
        raise
    if not result.ok:
        if keep.written:
            keep.drop()
            with contextlib.suppress(OSError):  # the folder is empty where it was made for what was kept
                folder.rmdir()
        say(f"{task.spec}: the run failed: {result.status}; nothing was written into {folder}")
        raise typer.Exit(SOLVER_FAILED)
    result.source = source_of(task.text, task.sets)
    also = pictures_of(result) if drawn else {}
    save(result, folder, {**also, "report.html": page([result]).encode("utf-8")})
    keep.drop()
    if not quiet:
        typer.echo(summary_text(result.summary()))
        typer.echo(f"wrote {folder}")
    if task.check_step and result.error_estimate is None and not quiet:
        say("a static run has no step: --check-step compared nothing")
    if result.error_estimate is not None and not result.error_estimate <= model.run.tolerance:
        raise AccuracyError(
            f"{task.spec}: the error estimate {result.error_estimate:.3g} is above run.tolerance "
            f"{model.run.tolerance:g}; the files in {folder} hold this result; give a smaller run.step"
        )


def _save_part(keep: Keep, folder: Path) -> None:
    from mdlgen.results.store import save

    if keep.part is None:
        say("there is no part to keep yet")
        return
    part = keep.part()
    part = part.part(
        f"interrupted at {part.time[-1]:.6g} of {part.model.run.duration:g} ms, at {part.step:g} ms a step"
    )
    save(part, folder / "partial")
    say(f"wrote {folder / 'partial'}: {part.status}")


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


@app.command()
@told
def bench(
    suites: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="SUITE ...",
            help="transport, elastica, impact, friction, flight, scaling, skip, stability: all if left out.",
        ),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the files go.")] = Path(
        "out/bench"
    ),
    solver: Annotated[
        list[str] | None,
        typer.Option("--solver", metavar="NAME", help="One of the solvers: all if left out."),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A few short cases of each suite.")] = False,
    repeat: Annotated[int, typer.Option("--repeat", min=1, help="Runs whose median is the wall time.")] = 3,
    peers: Annotated[
        bool | None,
        typer.Option(
            "--peers/--no-peers",
            help="MuJoCo and an Exudyn script beside ours in transport: where the extra `peers` is "
            "installed and no solver is chosen, if left out.",
        ),
    ] = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Run time against error: write bench.json, bench.md and bench.png into DIR.

    Example: mdlgen bench impact friction --solver exudyn

    Example: mdlgen bench stability --quick
    """
    from mdlgen.bench.run import bench as run_bench
    from mdlgen.bench.table import markdown
    from mdlgen.results.store import check_folder

    check_folder(output)
    heard = (lambda _: None) if quiet else say
    found = run_bench(suites or (), output, solver or (), quick, repeat, heard, peers)
    if not quiet:
        typer.echo(markdown(found), nl=False)
        typer.echo(f"wrote {output}")
    if found.wrong:
        row = found.wrong[0]
        raise AccuracyError(f"{len(found.wrong)} wrong: {row.case}, {row.solver}: {row.reason}")
    if found.failed:
        row = found.failed[0]
        say(f"{len(found.failed)} failed: {row.case}, {row.solver}: {row.reason}")
        raise typer.Exit(SOLVER_FAILED)


@app.command()
@told
def schema(quiet: Quiet = False, verbose: Verbose = False) -> None:
    """Print the JSON schema of a scene file, for editors.

    Example: mdlgen schema > scene.schema.json
    """
    from mdlgen.spec.schema import json_schema

    echo_json(json_schema())
