"""Shared code of all commands: options, how an error ends a command, progress on a terminal."""

from __future__ import annotations

import contextlib
import functools
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from threading import Event, Lock, Thread
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer
from typer.core import TyperGroup

from mdlgen.cli import completion
from mdlgen.cli.heard import compiling, slow
from mdlgen.errors import MdlgenError, OutputError, SpecError, printable
from mdlgen.extras import advice

if TYPE_CHECKING:
    from mdlgen.model.tables import Model
    from mdlgen.spec.scene import Scene

SOLVER_FAILED, INTERRUPTED = 4, 130


@contextlib.contextmanager
def _in_one_line() -> Iterator[None]:
    try:
        yield
    except Exception as error:
        message, context = getattr(error, "format_message", None), getattr(error, "ctx", None)
        text = message() if message else ""
        if context is None or not text or "\n" in text:  # no wrong call, or the whole help
            raise
        path = context.command_path
        say(f"{path}: {text.rstrip('.')}; {path} --help shows what there is")
        raise typer.Exit(getattr(error, "exit_code", 2)) from None


class Commands(TyperGroup):
    """A wrong call is reported in one line, as every other mistake is."""

    def make_context(self, *args: Any, **more: Any) -> Any:
        with _in_one_line():
            return super().make_context(*args, **more)

    def invoke(self, ctx: Any) -> Any:
        with _in_one_line():
            return super().invoke(ctx)


app = typer.Typer(
    name="mdlgen",
    cls=Commands,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    add_completion=True,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        from mdlgen.version import version

        typer.echo(f"mdlgen {version()}")
        raise typer.Exit


@app.callback()
def _general(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None:
    """Paper sheets in machines: one scene file, MotionView text and a local run of the same model."""


Spec = Annotated[Path, typer.Argument(metavar="SPEC", help="The scene: a YAML or JSON file.")]
Sets = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="Set a value of the scene; may be given more than once.",
        autocompletion=completion.scene_paths,
    ),
]
Raised = Annotated[
    list[str] | None,
    typer.Option(
        "--limit",
        metavar="NAME=COUNT",
        help="Allow more boxes, pairs, contacts, states, values, triangles or points; may be given more than "
        "once.",
        autocompletion=completion.limits,
    ),
]
Solver = Annotated[
    str,
    typer.Option(
        "--solver",
        metavar="auto|lattice|exudyn",
        help="The solver that runs the scene.",
        autocompletion=completion.solvers,
    ),
]
CheckStep = Annotated[
    bool,
    typer.Option(
        "--check-step", help="Run again at half the step, and estimate the error from the difference."
    ),
]
Pictures = Annotated[
    bool,
    typer.Option(
        "--pictures",
        help="Draw report.png and strain.png too. Where DIR has them already, they are drawn in any case.",
    ),
]
Lets = Annotated[
    list[str] | None,
    typer.Option(
        "--let",
        metavar="PATH=FORM",
        help="A value that follows a variable, as 'rollers.left.drive.speed=186 rad/s - 0.5*delta'; may be "
        "given more than once.",
    ),
]
Strict = Annotated[bool, typer.Option("--strict", help="Take what check finds as errors: exit code 2.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
Quiet = Annotated[bool, typer.Option("-q", "--quiet", help="Print errors and asked-for output only.")]
Verbose = Annotated[
    bool, typer.Option("-v", "--verbose", help="Say more; show the traceback of internal errors.")
]


def reports_errors(command: Callable[..., None]) -> Callable[..., None]:
    """Ends a command that raises with one line on standard error and the exit code of its error."""

    @functools.wraps(command)
    def run(*args: Any, **options: Any) -> None:
        try:
            command(*args, **options)
        except (typer.Exit, BrokenPipeError):
            raise
        except KeyboardInterrupt:
            say("mdlgen: interrupted")
            if _busy.locked():
                # compiled code runs in parallel: an orderly end would wait for it, or crash
                sys.stdout.flush()
                sys.stderr.flush()
                os._exit(INTERRUPTED)
            raise typer.Exit(INTERRUPTED) from None
        except MdlgenError as error:
            _complain(_located(error, options.get("spec")))
            raise typer.Exit(error.exit_code) from None
        except MemoryError:
            say("mdlgen: not enough memory for this; take fewer boxes, or a longer run.print_step")
            raise typer.Exit(SOLVER_FAILED) from None
        except Exception as error:
            if isinstance(error, ModuleNotFoundError) and (needed := advice(error.name or "")) is not None:
                say(f"mdlgen: this {needed}")
                raise typer.Exit(OutputError.exit_code) from None
            if options.get("verbose"):
                import traceback

                traceback.print_exc()
            hint = "" if options.get("verbose") else " (-v shows the traceback)"
            say(f"mdlgen: internal error: {type(error).__name__}: {error}{hint}")
            raise typer.Exit(1) from None

    return run


def strictly(model: Model) -> None:
    """Raises SpecError where a scene has lints, with all of them."""
    from mdlgen.checks import lints

    found = [SpecError(str(lint)) for lint in lints(model)]
    if found:
        raise found[0].with_others(found[1:])


_busy = Lock()
T = TypeVar("T")


def beside(work: Callable[[], T]) -> T:
    """Does `work` in a thread of its own, so that an interrupt is heard at once while compiled code runs."""
    ended = Event()
    found: list[T] = []
    failed: list[BaseException] = []

    def target() -> None:
        with _busy:
            try:
                found.append(work())
            except BaseException as error:
                failed.append(error)
        ended.set()

    Thread(target=target, daemon=True).start()
    while not ended.wait(0.5):  # some systems hear an interrupt only between two waits
        pass
    if failed:
        raise failed[0]
    return found[0]


def scene_of(spec: Path, sets: list[str] | None, limits: list[str] | None) -> Scene:
    from mdlgen.spec.limits import DEFAULT
    from mdlgen.spec.load import load

    return load(spec, sets or (), DEFAULT.raised(limits or ()))


def model_of(spec: Path, sets: list[str] | None, limits: list[str] | None = None) -> Model:
    from mdlgen.model.lower import lower

    return lower(scene_of(spec, sets, limits))


def source_of(text: str, sets: Iterable[str]) -> str:
    """The text of a scene as it was written, with the values of `--set`."""
    return text + "".join(f"# --set {item}\n" for item in sets)


def echo_json(value: Any) -> None:
    import json

    typer.echo(json.dumps(value, indent=2, allow_nan=False))


def say(text: str) -> None:
    """One line on standard error."""
    typer.echo(printable(text), err=True)


def _complain(error: MdlgenError) -> None:
    """One line for each mistake; on a terminal with its line of the text below it, and a caret."""
    for one in (error, *error.others) if isinstance(error, SpecError) else (error,):
        say(str(one))
        if isinstance(one, SpecError) and one.marked and sys.stderr.isatty():
            typer.echo(one.marked, err=True)


def _located(error: MdlgenError, spec: Path | None) -> MdlgenError:
    """An error of a later stage, with the place of the value in the file."""
    if spec is None or not isinstance(error, SpecError) or error.place is not None or not error.path:
        return error
    from mdlgen.spec.load import parse, read
    from mdlgen.spec.mistakes import located

    try:
        if not spec.is_file():  # a pipe has been read
            return error
        return located(error, parse(read(spec), str(spec)))
    except (OSError, ValueError, MdlgenError):
        return error


# Where the solver's program fits, seconds; where numba compiles instead, minutes, in about so many parts.
PREPARING = "preparing the solver, once on this machine"
COMPILING = "compiling the solver, once on this machine (some minutes)"
ABOUT = 290
# Seconds between two lines about a cause of delay.
BETWEEN = 5.0


@contextlib.contextmanager
def solver_output(verbose: bool) -> Iterator[None]:
    import io

    with contextlib.redirect_stdout(sys.stderr if verbose else io.StringIO()):
        yield


@contextlib.contextmanager
def count(quiet: bool, what: str) -> Iterator[Callable[[int, int], None] | None]:
    """A progress bar on a terminal for things that are counted."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


@contextlib.contextmanager
def progress_bar(
    quiet: bool, twice: bool, verbose: bool = False
) -> Iterator[Callable[[float, float, int, int], None] | None]:
    """A progress bar on a terminal: time, steps, pairs that touch, rate, time left; and what is compiled
    before; where a run is slow, it names the step and the body that hold it up.

    Elsewhere a line says that something is compiled; with `verbose`, from time to time what holds it up.
    """
    if quiet:
        yield None
        return
    if not sys.stderr.isatty():
        said: set[str] = set()

        def line(done: int) -> None:
            text = COMPILING if done else PREPARING
            if text not in said:
                said.add(text)
                say(text)

        reported = time.monotonic()

        def held_up(text: str) -> None:
            nonlocal reported
            if time.monotonic() - reported >= BETWEEN:
                reported = time.monotonic()
                say(text)

        with compiling(line), slow(held_up) if verbose else contextlib.nullcontext():
            yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[message]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        tasks: list[Any] = []
        parts: list[Any] = []
        waiting: list[Any] = []
        last, held = 0.0, ""

        def held_up(text: str) -> None:
            nonlocal held
            held = text

        def progress(at: float, end: float, steps: int, touching: int) -> None:
            nonlocal last, held
            while waiting:
                bar.remove_task(waiting.pop())
            if not tasks or at < last:
                name = "half the step" if tasks else "first run" if twice else "run"
                tasks.append(bar.add_task(name, total=end, message=""))
            last = at
            message = f"{at:.2f} of {end:g} ms, step {steps}, {touching} pairs touch"
            speed = bar.tasks[-1].speed
            if speed:
                message += f", {speed:.3g} ms a second"
            if held:
                message, held = f"{message}; {held}", ""
            bar.update(tasks[-1], completed=at, message=message)

        def compiled(done: int) -> None:
            if done == 0:
                waiting.append(bar.add_task(PREPARING, total=None, message=""))
                return
            if not parts:
                parts.append(bar.add_task(COMPILING, total=ABOUT, message=""))
            bar.update(parts[0], completed=done, message=f"{done} parts")

        with compiling(compiled), slow(held_up):
            yield progress
