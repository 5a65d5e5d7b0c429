"""The command that follows a scene as it is edited and turned."""

from __future__ import annotations

from threading import Thread
from typing import Annotated

import typer

from mdlgen.cli.shell import Quiet, Raised, Sets, Solver, Spec, Verbose, app, reports_errors, say
from mdlgen.errors import OutputError

EXTRA = ("starlette", "uvicorn", "watchfiles")


@app.command()
@reports_errors
def live(
    spec: Spec,
    sets: Sets = None,
    limits: Raised = None,
    solver: Solver = "auto",
    port: Annotated[
        int, typer.Option("--port", metavar="N", min=0, max=65535, help="The port; a free one if left out.")
    ] = 0,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page in the browser.")
    ] = True,
    quiet: Quiet = False,
    verbose: Verbose = False,
) -> None:
    """Follow a scene on a local page, and turn its values.

    Edits of the file appear as they are saved; each value has a slider. Each change runs
    the scene again, in the background. The page is served on this machine alone, at an address with a token,
    which is printed. Ctrl-C ends it. Needs the extra live: pip install "mdlgen[live]".

    Example: mdlgen live samples/transport_4x4.yaml

    Example: mdlgen live samples/transport_4x4.yaml --no-browser --port 8123
    """
    from mdlgen import registry
    from mdlgen.spec.limits import DEFAULT
    from mdlgen.spec.load import read

    _check_extra()
    registry.check_solver(solver)
    DEFAULT.raised(limits or ())
    read(spec)  # a file that cannot be read is not followed
    from mdlgen.live.server import listening, serve
    from mdlgen.live.session import Session

    def ready(address: str) -> None:
        typer.echo(address)  # flushed
        if not quiet:
            say(f"follows {spec}; Ctrl-C ends it")
        if browser:  # one in a terminal would keep the server from answering
            Thread(target=_open, args=(address, quiet), daemon=True).start()

    try:
        serve(Session(spec, tuple(sets or ()), tuple(limits or ()), solver), listening(port), ready)
    except KeyboardInterrupt:  # the way it ends
        if not quiet:
            say("ended")


def _open(address: str, quiet: bool) -> None:
    import webbrowser

    if not webbrowser.open(address) and not quiet:
        say("no browser was found; open the address yourself")


def _check_extra() -> None:
    """Raises OutputError where a package of the extra is missing."""
    from importlib.util import find_spec

    missing = [name for name in EXTRA if find_spec(name) is None]
    if missing:
        raise OutputError(f'mdlgen live needs {", ".join(missing)}: pip install "mdlgen[live]"')
