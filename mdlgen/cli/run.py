"""The command `run`, which can also resume a run that was cut off."""

from __future__ import annotations

import contextlib
import sys
import time
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mdlgen.cli.shell import (
    SOLVER_FAILED,
    CheckStep,
    Pictures,
    Quiet,
    Raised,
    Sets,
    Solver,
    Strict,
    Verbose,
    app,
    beside,
    echo_json,
    progress_bar,
    reports_errors,
    say,
    solver_output,
    source_of,
    strictly,
)
from mdlgen.errors import AccuracyError, RequirementError, SpecError
from mdlgen.extras import require

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.results.result import Result
    from mdlgen.runs.checkpoint import Checkpointer

# Compiled code comes back for a moment some thousand times a second: how long it waits for what another
# thread does in Python [s]. By default that is 5 ms each time; operations on large arrays come back, too.
INTERVAL = 1e-5
# A run that takes longer than this [s] leaves time for other tasks: it may be stored, and its code may change
# meanwhile.
LONG = 1.0


@app.command()
@reports_errors
def run(
    spec: Annotated[
        Path | None, typer.Argument(metavar="SPEC", help="The scene: a YAML or JSON file.")
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DIR", help="Where the results go: out/NAME if left out."),
    ] = None,
    solver: Solver = "auto",
    check_step: CheckStep = False,
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
            help="Seconds between the states that --resume can continue from; 60 if left out.",
        ),
    ] = None,
    keep_partial: Annotated[
        bool,
        typer.Option(
            "--keep-partial", help="After Ctrl-C write the results so far into DIR/partial, marked as a part."
        ),
    ] = False,
    page: Annotated[
        bool,
        typer.Option(
            "--page", help="Write the page, report.html, too. Where DIR has it already, it is written anyway."
        ),
    ] = False,
    pictures: Pictures = False,
    sets: Sets = None,
    limits: Raised = None,
    strict: Strict = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print summary.json.")] = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Simulate a scene; write its results into DIR.

    The files are summary.json, series.csv and result.h5; mdlgen view DIR
    makes the page of them and opens it.

    Example: mdlgen run samples/transport_4x4.yaml -o out --check-step

    Example: mdlgen run --resume out
    """
    from mdlgen import registry
    from mdlgen.checks import lints
    from mdlgen.lints.smoothing import notice
    from mdlgen.runs import resume as runs

    _check_single(spec, resume, bool(sets or limits or output or check_step or solver != "auto"))
    registry.check_solver(solver)
    if resume is not None:
        request, there = runs.resumed(resume)
        model = request.model()
        runs.check_same(resume, there, model, registry.packages(registry.chosen(request.solver, model)[0]))
    else:
        assert spec is not None
        request = runs.request(spec, sets, limits, solver, check_step)
        model = request.model()
    if strict:
        strictly(model)
    from mdlgen.paths import check_folder
    from mdlgen.processors import processors
    from mdlgen.report import PAGE
    from mdlgen.report.figures.pictures import are_drawn, pictures_of
    from mdlgen.runs.checkpoint import Checkpointer

    folder = resume or output or Path("out") / model.name
    check_folder(folder)
    name, why = registry.chosen(request.solver, model)
    if request.solver == "auto" and why and not quiet:
        say(f"{name} runs this scene ({why})")
    for asked, option in ((keep_partial, "--keep-partial"), (checkpoint is not None, "--checkpoint")):
        if asked:
            registry.check_resumes(name, why, option)
    if not quiet:
        for text in filter(None, (*map(str, lints(model)), notice(model))):
            say(text)
    # a page or a picture of an older result in the folder would not match this one
    paged, drawn = page or (folder / PAGE).exists(), pictures or are_drawn(folder)
    if drawn:
        require("matplotlib")
    every = 60.0 if checkpoint is None else checkpoint
    packages = registry.packages(name)
    if resume is not None:
        checkpointer = Checkpointer(folder / runs.FOLDER, every)
    elif registry.solver(name).capabilities.resumes:
        checkpointer = runs.checkpointer(folder, request, model, every, packages)
    else:
        checkpointer = Checkpointer()
        checkpointer.free.set()
    Thread(target=_ahead, args=(checkpointer, model, paged, drawn, packages), daemon=True).start()
    if resume is None and runs.can_resume(folder) and not quiet:
        say(f"{folder} holds a run that was cut off; this one replaces it (--resume {folder} continues it)")
    # a solver may print on standard output, which is reserved for results
    try:
        with progress_bar(quiet, request.check_step, verbose) as progress, solver_output(verbose):
            asked = request.solver, progress, request.check_step, checkpointer, processors()
            result = beside(lambda: registry.solve(model, *asked))
    except KeyboardInterrupt:
        checkpointer.lock.acquire(timeout=0.5)  # a file that is being written is soon complete
        if keep_partial:
            _save_part(checkpointer, folder)
        if checkpointer.written:
            say(f"mdlgen run --resume {folder} continues this run")
        raise
    if not len(result.time):  # a static run that found no rest
        if checkpointer.written:
            checkpointer.drop()
            with contextlib.suppress(OSError):  # the folder is empty where it was made for what was kept
                folder.rmdir()
        say(f"{request.spec}: the run failed: {result.status}; there is no state to write into {folder}")
        raise typer.Exit(SOLVER_FAILED)
    from mdlgen.report.text import summary_text
    from mdlgen.results.io.store import save

    result.source = source_of(request.text, request.sets)
    also = pictures_of(result) if drawn else {}
    if paged:
        from mdlgen.report.html.page import page as page_of

        also[PAGE] = page_of([result]).encode("utf-8")
    summary = save(result, folder, also)
    checkpointer.drop()
    if as_json:
        echo_json(summary)
    elif not quiet:
        typer.echo(summary_text(summary))
        typer.echo(f"wrote {folder}; mdlgen view {folder} shows it")
    if request.check_step and result.usable and result.step <= 0.0 and not quiet:
        say("a static run has no step: --check-step compared nothing")
    _judge(result, summary, str(request.spec), folder)


def _judge(result: Result, summary: dict[str, Any], spec: str, folder: Path) -> None:
    """Ends the command by what the run is. Raises AccuracyError, RequirementError.

    A run that ended early: exit code 4. A requirement that is missed: 6, unless the run is inaccurate and the
    miss is within its error. Every other inaccurate run: 5.
    """
    from mdlgen.results.audit import made_by_nips
    from mdlgen.results.mark import chaotic

    if not result.usable:
        say(f"{spec}: {summary['mark']}; the files in {folder} hold what there is up to then")
        raise typer.Exit(SOLVER_FAILED)
    rows = [row for row in summary["verdict"]["requirements"] if not row["passed"]]
    missed = [row["requirement"] for row in rows if result.ok or not row["doubtful"]]
    if missed:
        many = len(summary["verdict"]["requirements"])
        also = "" if result.ok else f"; {summary['mark']}"
        what = f"{len(missed)} of {many} requirements missed: {'; '.join(missed)}"
        raise RequirementError(f"{spec}: {what}{also}")
    if not result.ok:
        advice = "give a smaller run.step, or leave it out, so that a step is searched"
        if result.model.run.step is None:
            advice = "a larger run.tolerance, a smaller run.step or more damping of the material may help"
        if made_by_nips(result.energy) is not None:
            advice = "no step changes that"
        advice = chaotic(result, spec) or advice
        raise AccuracyError(f"{spec}: {summary['mark']}; the files in {folder} hold this result; {advice}")


def _check_single(spec: Path | None, resume: Path | None, others: bool) -> None:
    """Raises SpecError unless exactly one of a scene and a run to continue is named."""
    if (spec is None) == (resume is None):
        raise SpecError("name a scene, mdlgen run SPEC, or a run to continue, mdlgen run --resume DIR")
    if resume is not None and others:
        raise SpecError("--resume takes scene, values, solver and folder from the run that it continues")


def _ahead(
    checkpointer: Checkpointer, model: Model, paged: bool, drawn: bool, packages: tuple[str, ...]
) -> None:
    """Does what is needed later on, once compiled code leaves a second core to it: what comes before does
    not."""
    from mdlgen.runs.resume import code

    checkpointer.free.wait(LONG)
    before = sys.getswitchinterval()
    sys.setswitchinterval(INTERVAL)
    # a failure here occurs again where the module is needed, and is reported there
    with contextlib.suppress(Exception):
        from mdlgen.report.figures.pictures import load_drawing
        from mdlgen.report.text import summary_text  # noqa: F401
        from mdlgen.results.io.store import prepare

        prepare(model)
        if paged:
            from mdlgen.report.html import page

            page.prepare(model)
        if drawn:
            load_drawing()
    sys.setswitchinterval(before)
    if checkpointer.folder is not None:
        time.sleep(LONG)
        code(packages)


def _save_part(checkpointer: Checkpointer, folder: Path) -> None:
    from mdlgen.results.io.store import save

    if checkpointer.part is None:
        say("the run was interrupted before its first stored state: --keep-partial has nothing to write")
        return
    part = checkpointer.part()
    part = part.part(
        f"interrupted at {part.time[-1]:.6g} of {part.model.run.duration:g} ms, at {part.step:g} ms a step"
    )
    save(part, folder / "partial")
    say(f"wrote {folder / 'partial'}: {part.status}")
